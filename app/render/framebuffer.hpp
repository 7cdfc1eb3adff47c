// A picture OpenGL draws into: colour and depth, with or without multisampling.
#pragma once

#include "app/render/gl.hpp"
#include "app/render/image.hpp"

namespace flyball {

class Framebuffer {
 public:
  // `samples` 1 draws without anti-aliasing; more than the driver has, or has memory for at this size, is
  // reduced to what it has. Throws GlError where the size cannot be had.
  Framebuffer(int width, int height, int samples = 4);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  // Whether this size left fewer samples than the driver has at smaller ones.
  bool short_of_samples() const { return short_of_samples_; }

  // Makes it the target of what is drawn next, over its whole size.
  void bind() const;
  // Brings what was drawn into texture(); needed before showing it or reading it.
  void resolve() const;
  // RGBA8, gamma already applied: for ImGui::Image or a blit. Its first row is the lowest.
  GLuint texture() const { return color_.get(); }
  // What was drawn, rows from the top; resolves first.
  Image read() const;

 private:
  bool make(); // of samples_; false where they cannot be had

  int width_, height_, samples_ = 1;
  bool short_of_samples_ = false;
  GlTexture color_;
  GlFramebuffer plain_;               // holds color_, and the depth where not multisampled
  GlRenderbuffer depth_, many_color_; // many_: multisampled
  GlFramebuffer many_;
};

// Of this size, or where that cannot be had of the same shape and fewer pixels, to be shown larger. Throws
// GlError where not even a small one can be had.
Framebuffer largest_framebuffer(int width, int height, int samples);

// The same for the window's own picture.
void bind_window_framebuffer(int width, int height);

} // namespace flyball
