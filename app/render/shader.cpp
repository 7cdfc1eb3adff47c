#include "app/render/shader.hpp"

#include "app/render/shader_table.hpp"

namespace flyball {

namespace {

constexpr std::string_view version_line = "#version 330 core\n";

std::string with_includes(std::string_view text) {
  constexpr std::string_view directive = "#include \"";
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    if (line.starts_with(directive)) {
      const std::size_t quote = line.find('"', directive.size());
      out += shader_source(line.substr(directive.size(), quote - directive.size()));
    } else {
      out += line;
    }
    text.remove_prefix(end);
  }
  return out;
}

GlShader compile(GLenum stage, std::string_view name) {
  const std::string text = std::string(version_line) + with_includes(shader_source(name));
  GlShader shader(glCreateShader(stage));
  const char* data = text.c_str();
  glShaderSource(shader.get(), 1, &data, nullptr);
  glCompileShader(shader.get());
  GLint done = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &done);
  if (!done) {
    char log[2048] = "";
    glGetShaderInfoLog(shader.get(), sizeof log, nullptr, log);
    throw GlError("shader " + std::string(name) + ": " + log);
  }
  return shader;
}

} // namespace

std::string_view shader_source(std::string_view name) {
  for (const ShaderText& entry : shader_table())
    if (entry.name == name) return entry.text;
  throw GlError("no shader named " + std::string(name));
}

ShaderProgram::ShaderProgram(std::string_view vertex, std::string_view fragment)
    : program_(glCreateProgram()) {
  const GlShader first = compile(GL_VERTEX_SHADER, vertex);
  const GlShader second = compile(GL_FRAGMENT_SHADER, fragment);
  glAttachShader(program_.get(), first.get());
  glAttachShader(program_.get(), second.get());
  glLinkProgram(program_.get());
  GLint done = 0;
  glGetProgramiv(program_.get(), GL_LINK_STATUS, &done);
  if (!done) {
    char log[2048] = "";
    glGetProgramInfoLog(program_.get(), sizeof log, nullptr, log);
    throw GlError("shaders " + std::string(vertex) + " and " + std::string(fragment) + ": " + log);
  }
}

void ShaderProgram::set(const char* name, int value) const {
  glUniform1i(glGetUniformLocation(program_.get(), name), value);
}
void ShaderProgram::set(const char* name, float value) const {
  glUniform1f(glGetUniformLocation(program_.get(), name), value);
}
void ShaderProgram::set(const char* name, float x, float y) const {
  glUniform2f(glGetUniformLocation(program_.get(), name), x, y);
}
void ShaderProgram::set(const char* name, float x, float y, float z) const {
  glUniform3f(glGetUniformLocation(program_.get(), name), x, y, z);
}
void ShaderProgram::set(const char* name, float x, float y, float z, float w) const {
  glUniform4f(glGetUniformLocation(program_.get(), name), x, y, z, w);
}
void ShaderProgram::set_matrix(const char* name, std::span<const float, 16> value) const {
  glUniformMatrix4fv(glGetUniformLocation(program_.get(), name), 1, GL_FALSE, value.data());
}

} // namespace flyball
