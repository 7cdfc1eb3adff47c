#include "app/render/gl.hpp"

#include <string_view>

namespace flyball {

namespace {

const char* error_name(GLenum error) {
  switch (error) {
  case GL_INVALID_ENUM: return "invalid enum";
  case GL_INVALID_VALUE: return "invalid value";
  case GL_INVALID_OPERATION: return "invalid operation";
  case GL_INVALID_FRAMEBUFFER_OPERATION: return "invalid framebuffer operation";
  case GL_OUT_OF_MEMORY: return "out of memory";
  default: return "unknown error";
  }
}

GLuint generate(void(GLAD_API_PTR* function)(GLsizei, GLuint*)) {
  GLuint id = 0;
  function(1, &id);
  return id;
}

} // namespace

void check_gl(const char* during) {
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) throw GlError(std::string("OpenGL, ") + during + ": " + error_name(error));
}

bool draws_in_software() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name ? name : "";
  for (const std::string_view known : {"llvmpipe", "softpipe", "SWR", "Software"})
    if (renderer.find(known) != std::string_view::npos) return true;
  return false;
}

GlBuffer make_buffer() {
  return GlBuffer(generate(glGenBuffers));
}
GlVertexArray make_vertex_array() {
  return GlVertexArray(generate(glGenVertexArrays));
}
GlTexture make_texture() {
  return GlTexture(generate(glGenTextures));
}
GlRenderbuffer make_renderbuffer() {
  return GlRenderbuffer(generate(glGenRenderbuffers));
}
GlFramebuffer make_framebuffer() {
  return GlFramebuffer(generate(glGenFramebuffers));
}

} // namespace flyball
