// Text from anywhere, made safe to be printed on a terminal and opened as a table.
#pragma once

#include <string>
#include <string_view>

namespace flyball {

// UTF-8 in which nothing steers a terminal or hides in a line: control characters (C0, DEL, C1), characters
// that turn the direction of writing, line and paragraph separators and bytes that are not UTF-8 come as \n,
// \t, \r, \x1b or \u202e, but for those in `spared`. For names and messages that are to stay in one line.
std::string printable(std::string_view text, std::string_view spared = {});
// The same for text of several lines.
std::string printable_lines(std::string_view text);
// The same for JSON text, where these characters only stand in strings: escaped as JSON does, so that it
// means the same.
std::string printable_json(std::string_view json);

// A number in a CSV table: reads back exactly; empty where it is not finite.
std::string csv_number(double value);

} // namespace flyball
