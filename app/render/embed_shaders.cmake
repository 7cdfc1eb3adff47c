# Writes OUTPUT: a table of the files in SHADERS, name and text.
set(entries "")
foreach(shader IN LISTS SHADERS)
  get_filename_component(name ${shader} NAME)
  file(READ ${shader} text)
  string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"app/render/shader_table.hpp\"\n
namespace flyball {\n
std::span<const ShaderText> shader_table() {
  static constexpr ShaderText table[] = {\n${entries}  };
  return table;
}\n
} // namespace flyball\n")
