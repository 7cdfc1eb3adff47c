#include "app/viewport/shadow_map.hpp"

namespace flyball {

ShadowMap::ShadowMap() : depth_(make_texture()), framebuffer_(make_framebuffer()) {
  glBindTexture(GL_TEXTURE_2D, depth_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size, size, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  constexpr float lit[] = {1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.get(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw GlError("OpenGL cannot make a shadow map");
}

void ShadowMap::begin(const Vec3& center, double radius, const Vec3& key) {
  const Vec3 z = key.normalized(), x = z.unitOrthogonal(), y = z.cross(x);
  const double scale = 1 / (1.02 * radius);
  matrix_ = Mat4::Identity();
  matrix_.block<1, 3>(0, 0) = scale * x.transpose();
  matrix_.block<1, 3>(1, 0) = scale * y.transpose();
  matrix_.block<1, 3>(2, 0) = -scale * z.transpose();
  matrix_.block<3, 1>(0, 3) = -matrix_.block<3, 3>(0, 0) * center;
  texel_ = 2 * 1.02 * radius / size;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, size, size);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
}

Mat4 ShadowMap::lookup_matrix() const {
  Mat4 to_unit = Mat4::Identity();
  to_unit.diagonal() << 0.5, 0.5, 0.5, 1;
  to_unit.block<3, 1>(0, 3).setConstant(0.5);
  return to_unit * matrix_;
}

} // namespace flyball
