#include "app/viewport/shadow_map.hpp"

namespace flyball {

namespace {

constexpr double margin = 1.02; // of the map round the scene

} // namespace

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

void ShadowMap::begin(const Bounds& bounds, const Vec3& key) {
  units_ = {bounds.center(), bounds.radius() > 0 ? bounds.radius() : 1};
  key_ = key.normalized();
  across_ = key_.unitOrthogonal();
  matrix_ = Mat4::Identity();
  matrix_.block<1, 3>(0, 0) = across_.transpose() / margin;
  matrix_.block<1, 3>(1, 0) = key_.cross(across_).transpose() / margin;
  matrix_.block<1, 3>(2, 0) = -key_.transpose() / margin;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, size, size);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
}

double ShadowMap::texel() const {
  return 2 * margin * units_.length / size;
}

Sight ShadowMap::sight() const {
  Sight light;
  light.eye = units_.origin;
  light.right = across_;
  light.up = key_.cross(across_);
  light.backward = key_;
  light.parallel = true;
  light.half_width = light.half_height = margin * units_.length;
  light.pixel = 2 * texel(); // shadows are softened over several texels
  light.thinnest = 0;        // a net of wires is no roof
  light.flat_coil = 5;
  return light;
}

Mat4 ShadowMap::lookup_matrix(const ViewUnits& from) const {
  Mat4 to_unit = Mat4::Identity(), rebased = Mat4::Identity();
  to_unit.diagonal() << 0.5, 0.5, 0.5, 1;
  to_unit.block<3, 1>(0, 3).setConstant(0.5);
  rebased.diagonal().head<3>().setConstant(from.length / units_.length);
  rebased.block<3, 1>(0, 3) = (from.origin - units_.origin) / units_.length;
  return to_unit * matrix_ * rebased;
}

} // namespace flyball
