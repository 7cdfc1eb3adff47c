// The files in shaders/, built into the binary (the table is written by embed_shaders.cmake).
#pragma once

#include <span>
#include <string_view>

namespace flyball {

struct ShaderText {
  std::string_view name, text;
};

std::span<const ShaderText> shader_table();

} // namespace flyball
