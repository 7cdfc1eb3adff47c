// A linked shader program, from the GLSL files in shaders/ that are built into the binary.
#pragma once

#include "app/render/gl.hpp"

#include <span>
#include <string>
#include <string_view>

namespace flyball {

// The text of shaders/<name>; throws GlError where there is none.
std::string_view shader_source(std::string_view name);

class ShaderProgram {
 public:
  // File names in shaders/, such as "lit.vert". Lines `#include "common.glsl"` are replaced by that file,
  // and the #version line is put before. Throws GlError with the file's name and the compiler's words.
  ShaderProgram(std::string_view vertex, std::string_view fragment);

  void use() const { glUseProgram(program_.get()); }
  // Uniforms the compiler dropped are ignored. Matrices column by column.
  void set(const char* name, int value) const;
  void set(const char* name, float value) const;
  void set(const char* name, float x, float y) const;
  void set(const char* name, float x, float y, float z) const;
  void set(const char* name, float x, float y, float z, float w) const;
  void set_matrix(const char* name, std::span<const float, 16> value) const;

 private:
  GlProgram program_;
};

} // namespace flyball
