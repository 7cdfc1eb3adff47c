# Writes OUTPUT: the tutorial of README, without its pictures, a paragraph or step each line.
file(READ ${README} text)
set(title "## A governor from nothing\n")
string(FIND "${text}" "${title}" begin)
if(begin EQUAL -1)
  message(FATAL_ERROR "${README} has no tutorial")
endif()
string(SUBSTRING "${text}" ${begin} -1 text)
string(REPLACE "${title}" "" text "${text}")
string(FIND "${text}" "\n## " end)
string(SUBSTRING "${text}" 0 ${end} text)
string(REGEX REPLACE "A test builds it[^\n]*\n" "" text "${text}")
string(REGEX REPLACE " *![^\n]*\n" "" text "${text}")
string(REPLACE "**" "" text "${text}")
string(REGEX REPLACE "\\*([A-Z][^*]*)\\*" "\\1" text "${text}")
string(REPLACE "`" "" text "${text}")
string(REGEX REPLACE "([^\n])\n +([^\n])" "\\1 \\2" text "${text}")  # lines that were broken
string(REGEX REPLACE "([^\n])\n([^\n])" "\\1 \\2" text "${text}")
string(REGEX REPLACE "\n\n+" "\n" text "${text}")
string(STRIP "${text}" text)
file(WRITE ${OUTPUT} "#include \"app/ui/panels/tutorial_panel.hpp\"\n
namespace flyball {\n
std::string_view tutorial_text() {
  return R\"tutorial(${text})tutorial\";
}\n
} // namespace flyball\n")
