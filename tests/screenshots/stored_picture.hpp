// Pictures that are kept in expected/, and what the program draws now.
#pragma once

#include "app/panels/app.hpp"
#include "app/panels/snapshot.hpp"
#include "app/render/compare.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace flyball::test {

// The shipped scenes, by name.
std::vector<std::filesystem::path> shipped_scenes();

// An app that shows the same on every computer: solves at once, keeps quiet about run times and does not
// tell round-off.
AppOptions steady_options(Theme theme = Theme::light);
inline constexpr PixelSize view_size{480, 300}, interface_size{960, 600};

// Compares with expected/<name>.png, or writes it where FLYBALL_UPDATE_SCREENSHOTS is set. What differs is
// kept in the build tree.
ImageComparison compare_with_stored(const std::string& name, const Image& image);
Image stored_picture(const std::string& name);

} // namespace flyball::test
