// Pictures that are kept in expected/, and what the program draws now.
#pragma once

#include "app/render/compare.hpp"
#include "app/ui/app.hpp"
#include "app/ui/snapshot.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace flyball::test {

// An app that shows the same on every computer: solves at once, keeps quiet about run times and does not
// tell round-off.
AppOptions steady_options(Theme theme = Theme::light);
inline constexpr PixelSize view_size{480, 300}, interface_size{960, 600};

// Compares with expected/<name>.png, or writes it where FLYBALL_UPDATE_SCREENSHOTS is set. What differs is
// kept in the build tree. Where fonts or Dear ImGui are not those of expected/drawn_with.txt, pictures with
// text are compared at an eighth of their size.
ImageComparison compare_with_stored(const std::string& name, const Image& image);
Image stored_picture(const std::string& name);

// Where text is drawn with other fonts or another Dear ImGui: whether everything else is as it was, and text
// where it was.
ImageComparison compare_but_for_letters(const Image& a, const Image& b);

} // namespace flyball::test
