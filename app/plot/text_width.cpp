#include "app/plot/layout.hpp"

namespace flyball {

namespace {

// Thousandths of an em of Helvetica's letters from the space to the tilde (its AFM file); Inter is a little
// wider.
constexpr std::array<int, 95> helvetica = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr double wider = 1.08, letter_height = 0.8125; // an em of a line's height

double em_of(PlotFont font, std::uint32_t letter) {
  if ((letter >= 0x2070 && letter <= 0x209C) || letter == 0xB2 || letter == 0xB3 || letter == 0xB9)
    return 0.45;
  if (font == PlotFont::digits && letter >= '0' && letter <= '9') return 0.64; // all alike
  const double em = letter >= 0x20 && letter < 0x7F ? helvetica[letter - 0x20] / 1000. : 0.6;
  return em * wider * (font == PlotFont::strong ? 1.06 : 1);
}

} // namespace

double PlotMetrics::width_of(PlotFont font, std::string_view text) const {
  if (width) return width(font, text);
  double em = 0;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
    std::uint32_t letter = length == 1 ? byte : byte & (0xFFu >> (length + 1));
    for (std::size_t k = 1; k < length && i + k < text.size(); ++k)
      letter = letter << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3Fu);
    em += em_of(font, letter);
    i += length;
  }
  return em * letter_height * height_of(font);
}

} // namespace flyball
