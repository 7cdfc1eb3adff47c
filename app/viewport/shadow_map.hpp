// The scene's depth as the key light sees it, whatever the camera.
#pragma once

#include "app/render/gl.hpp"
#include "app/viewport/level_of_detail.hpp"
#include "app/viewport/solid_meshes.hpp"

namespace flyball {

class ShadowMap {
 public:
  static constexpr int size = 1536; // pixels a side

  ShadowMap();
  // Everything within `bounds` is lit from the direction `key`. Binds and clears; what is drawn then is in
  // units().
  void begin(const Bounds& bounds, const Vec3& key);
  const ViewUnits& units() const { return units_; }
  const Mat4& matrix() const { return matrix_; }   // from units() to the light's clip space
  Sight sight() const;                             // the light's
  Mat4 lookup_matrix(const ViewUnits& from) const; // to the map's unit cube
  double texel() const;                            // m
  GLuint texture() const { return depth_.get(); }

 private:
  GlTexture depth_;
  GlFramebuffer framebuffer_;
  ViewUnits units_;
  Vec3 key_ = Vec3::UnitZ(), across_ = Vec3::UnitX();
  Mat4 matrix_ = Mat4::Identity();
};

} // namespace flyball
