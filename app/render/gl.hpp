// OpenGL 3.3 core, as loaded by the current context; and owning values for its names.
#pragma once

#include <glad/gl.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace flyball {

// A context, shader or framebuffer that cannot be had, with what the driver said.
class GlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Whether the current context draws on the processor, where every pixel counts.
bool draws_in_software();

// Throws GlError naming `during` if OpenGL has recorded an error since the last call.
void check_gl(const char* during);

// Owns one OpenGL name. The context it belongs to must be current when it dies.
template <void (*Delete)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint id) : id_(id) {}
  GlName(GlName&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlName() {
    if (id_) Delete(id_);
  }
  GLuint get() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

namespace gl_delete {
inline void buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void texture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void renderbuffer(GLuint id) {
  glDeleteRenderbuffers(1, &id);
}
inline void framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
inline void shader(GLuint id) {
  glDeleteShader(id);
}
inline void program(GLuint id) {
  glDeleteProgram(id);
}
} // namespace gl_delete

using GlBuffer = GlName<gl_delete::buffer>;
using GlVertexArray = GlName<gl_delete::vertex_array>;
using GlTexture = GlName<gl_delete::texture>;
using GlRenderbuffer = GlName<gl_delete::renderbuffer>;
using GlFramebuffer = GlName<gl_delete::framebuffer>;
using GlShader = GlName<gl_delete::shader>;
using GlProgram = GlName<gl_delete::program>;

GlBuffer make_buffer();
GlVertexArray make_vertex_array();
GlTexture make_texture();
GlRenderbuffer make_renderbuffer();
GlFramebuffer make_framebuffer();

} // namespace flyball
