#include "engine/mechanism/safe_text.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

constexpr char32_t not_a_character = 0xFFFFFFFF; // a byte that is not UTF-8

// Calls visit(bytes, code) for every character; a byte that is not UTF-8 comes alone.
template <class Visit>
void for_each_character(std::string_view text, const Visit& visit) {
  std::size_t invalid = find_invalid_utf8(text);
  for (std::size_t i = 0; i < text.size();) {
    if (i == invalid) {
      visit(text.substr(i, 1), not_a_character);
      const std::size_t next = find_invalid_utf8(text.substr(++i));
      invalid = next == std::string_view::npos ? next : i + next;
      continue;
    }
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    char32_t code = length == 1 ? lead : lead & (0x7FU >> length);
    for (std::size_t k = 1; k < length; ++k)
      code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3FU);
    visit(text.substr(i, length), code);
    i += length;
  }
}

// Control characters, and those of Unicode that turn the direction of writing or end a line.
bool steers(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0x061C || code == 0x200E ||
         code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
         code == not_a_character;
}

std::string hexadecimal(char32_t code, std::size_t digits) {
  std::string out;
  for (std::size_t i = digits; i-- > 0;)
    out += "0123456789abcdef"[code >> 4 * i & 0xFU];
  return out;
}

std::string unicode_escape(char32_t code) {
  return "\\u" + hexadecimal(code, 4);
}

// Of a character that steers().
std::string escape_of(std::string_view character, char32_t code) {
  switch (code) {
  case '\n': return "\\n";
  case '\r': return "\\r";
  case '\t': return "\\t";
  default:
    if (code > 0xFF && code != not_a_character) return unicode_escape(code);
    return "\\x" +
           hexadecimal(code == not_a_character ? static_cast<unsigned char>(character.front()) : code, 2);
  }
}

} // namespace

std::string printable(std::string_view text, std::string_view spared) {
  std::string out;
  for_each_character(text, [&](std::string_view character, char32_t code) {
    const bool stays = !steers(code) || (code < 0x80 && spared.find(character) != std::string_view::npos);
    out += stays ? std::string(character) : escape_of(character, code);
  });
  return out;
}

std::string printable_lines(std::string_view text) {
  return printable(text, "\n");
}

std::string printable_json(std::string_view json) {
  if (std::ranges::all_of(json,
                          [](char c) { return c != 0x7F && (static_cast<unsigned char>(c) & 0x80U) == 0; }))
    return std::string(json);
  std::string out;
  for_each_character(json, [&](std::string_view character, char32_t code) {
    // JSON has no controls below 0x20 but those between its tokens.
    if (code < 0x20 || code == not_a_character || !steers(code))
      out += character;
    else
      out += unicode_escape(code);
  });
  return out;
}

std::string csv_number(double value) {
  return std::isfinite(value) ? number_text(value) : std::string();
}

} // namespace flyball
