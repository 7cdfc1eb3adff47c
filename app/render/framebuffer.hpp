// A picture OpenGL draws into: colour and depth, with or without multisampling.
#pragma once

#include "app/render/gl.hpp"
#include "app/render/image.hpp"

namespace flyball {

class Framebuffer {
 public:
  // `samples` 1 draws without anti-aliasing; more than the driver has is reduced to what it has. Throws
  // GlError where the size cannot be had.
  Framebuffer(int width, int height, int samples = 4);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

  // Makes it the target of what is drawn next, over its whole size.
  void bind() const;
  // Brings what was drawn into texture(); needed before showing it or reading it.
  void resolve() const;
  // RGBA8, gamma already applied: for ImGui::Image or a blit. Its first row is the lowest.
  GLuint texture() const { return color_.get(); }
  // What was drawn, rows from the top; resolves first.
  Image read() const;

 private:
  int width_, height_, samples_;
  GlTexture color_;
  GlFramebuffer plain_;               // holds color_, and the depth where not multisampled
  GlRenderbuffer depth_, many_color_; // many_: multisampled
  GlFramebuffer many_;
};

// The same for the window's own picture.
void bind_window_framebuffer(int width, int height);
Image read_window_framebuffer(int width, int height);

} // namespace flyball
