#include "app/ui/widgets/wide_characters.hpp"

#include <imgui.h>

#include <algorithm>

namespace flyball {

namespace {

constexpr std::size_t most = 0x1000; // from U+E000 on; icons begin at U+F000

std::string stand_in(std::size_t index) {
  const auto tail = [](std::size_t bits) { return static_cast<char>(0x80 | (bits & 0x3F)); };
  const std::size_t code = 0xE000 + index;
  return {static_cast<char>(0xE0 | (code >> 12)), tail(code >> 6), tail(code)};
}

} // namespace

void put_stand_ins(std::string& text, WideCharacters& characters) {
  if (sizeof(ImWchar) > 2) return;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (static_cast<unsigned char>(text[at]) < 0xF0) continue; // not the first byte of four
    const std::string character = text.substr(at, 4);
    auto known = std::ranges::find(characters, character);
    if (known == characters.end()) {
      if (characters.size() == most) continue;
      known = characters.insert(known, character);
    }
    text.replace(at, character.size(), stand_in(static_cast<std::size_t>(known - characters.begin())));
  }
}

void take_stand_ins(std::string& text, const WideCharacters& characters) {
  if (characters.empty()) return;
  for (std::size_t at = 0; at + 2 < text.size(); ++at) {
    if (static_cast<unsigned char>(text[at]) != 0xEE) continue; // of U+E000 to U+EFFF
    const auto bits = [&](std::size_t i) { return static_cast<unsigned char>(text[at + i]) & 0x3Fu; };
    const std::size_t index = (bits(1) << 6) | bits(2);
    if (index < characters.size()) text.replace(at, 3, characters[index]);
  }
}

} // namespace flyball
