// The scene's depth as the key light sees it.
#pragma once

#include "app/render/gl.hpp"
#include "app/viewport/camera.hpp"

namespace flyball {

class ShadowMap {
 public:
  static constexpr int size = 1536; // pixels a side

  ShadowMap();
  // Everything within `radius` of `center` (view units) is lit from the direction `key`. Binds and clears.
  void begin(const Vec3& center, double radius, const Vec3& key);
  const Mat4& matrix() const { return matrix_; } // to the light's clip space
  Mat4 lookup_matrix() const;                    // to the map's unit cube
  double texel() const { return texel_; }        // view units
  GLuint texture() const { return depth_.get(); }

 private:
  GlTexture depth_;
  GlFramebuffer framebuffer_;
  Mat4 matrix_ = Mat4::Identity();
  double texel_ = 0;
};

} // namespace flyball
