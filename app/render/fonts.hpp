// The interface's fonts, loaded from where the system keeps them.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

namespace flyball {

// Icons are merged into all of them (see icons.hpp).
struct UiFonts {
  ImFont* text = nullptr;           // Inter
  ImFont* strong = nullptr;         // Inter, semibold: headings
  ImFont* digits = nullptr;         // JetBrains Mono: numbers that stand in columns
  std::vector<std::string> files;   // what was loaded
  std::vector<std::string> missing; // what was wished for and not found; a fallback stands in
};

// `size` is the text height in points (about 15), `scale` the pixels a point has: glyphs are drawn at
// size * scale, so text is crisp at any scale when DisplaySize is given in pixels. Clears the atlas first.
UiFonts load_fonts(ImFontAtlas& atlas, float size, float scale);

// Fonts that outlive a context, for others after it: to draw their glyphs takes as long as hundreds of
// frames.
struct KeptFonts {
  ImFontAtlas atlas;
  UiFonts fonts;
  float scale = 0; // for which they were drawn last; 0: not yet
};

} // namespace flyball
