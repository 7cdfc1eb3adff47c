#include "app/render/framebuffer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace flyball {

namespace {

// So many samples of all pixels together are as much as a display of 7680 x 4320 needs, four a pixel: a
// gigabyte with their depth.
constexpr double most_samples = 7680. * 4320 * 4;

bool is_complete() {
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR;
}

void renderbuffer_storage(GLuint id, GLenum format, int width, int height, int samples) {
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  if (samples > 1)
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  else
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
}

Image read_bound(int width, int height) {
  Image image(width, height);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
  check_gl("reading the picture");
  // OpenGL's first row is the lowest.
  const auto row = static_cast<std::ptrdiff_t>(4) * width;
  for (int y = 0; y < height / 2; ++y)
    std::swap_ranges(image.pixels.begin() + y * row, image.pixels.begin() + (y + 1) * row,
                     image.pixels.begin() + (height - 1 - y) * row);
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    image.pixels[i] = 255;
  return image;
}

} // namespace

Framebuffer::Framebuffer(int width, int height, int samples) : width_(width), height_(height) {
  GLint most = 1, largest = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw GlError("a picture must have from 1 to " + std::to_string(largest) + " pixels a side, not " +
                  std::to_string(width) + " x " + std::to_string(height));
  check_gl("before making a framebuffer");
  const int wanted = samples_ = std::clamp(samples, 1, std::max(most, 1));
  while (samples_ > 1 && 1. * width * height * samples_ > most_samples)
    samples_ /= 2;
  while (!make()) {
    if (samples_ == 1)
      throw GlError("OpenGL cannot make a picture of " + std::to_string(width) + " x " +
                    std::to_string(height) + " pixels");
    samples_ /= 2;
  }
  short_of_samples_ = samples_ < wanted;
}

bool Framebuffer::make() {
  many_ = {};
  many_color_ = {};
  color_ = make_texture();
  plain_ = make_framebuffer();
  depth_ = make_renderbuffer();
  glBindTexture(GL_TEXTURE_2D, color_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  renderbuffer_storage(depth_.get(), GL_DEPTH_COMPONENT24, width_, height_, samples_);

  glBindFramebuffer(GL_FRAMEBUFFER, plain_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.get(), 0);
  if (samples_ == 1)
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  if (!is_complete()) return false;
  if (samples_ == 1) return true;
  many_color_ = make_renderbuffer();
  many_ = make_framebuffer();
  renderbuffer_storage(many_color_.get(), GL_RGBA8, width_, height_, samples_);
  glBindFramebuffer(GL_FRAMEBUFFER, many_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, many_color_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  return is_complete();
}

Framebuffer largest_framebuffer(int width, int height, int samples) {
  constexpr double smallest = 64; // pixels a side, or it is not the size
  GLint most = 1;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  double share = std::min({1., most / static_cast<double>(std::max({width, height, 1})),
                           std::sqrt(most_samples / std::max(1. * width * height, 1.))});
  for (;; share /= 2) {
    const auto part = [&](int pixels) { return std::max(1, static_cast<int>(pixels * share)); };
    try {
      return Framebuffer(part(width), part(height), samples);
    } catch (const GlError&) {
      if (share * std::max(width, height) < smallest) throw;
    }
  }
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, samples_ > 1 ? many_.get() : plain_.get());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::resolve() const {
  if (samples_ == 1) return;
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, many_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, plain_.get());
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, plain_.get());
}

Image Framebuffer::read() const {
  resolve();
  glBindFramebuffer(GL_FRAMEBUFFER, plain_.get());
  return read_bound(width_, height_);
}

void bind_window_framebuffer(int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
}

} // namespace flyball
