#include "app/platform/font_folders.hpp"

namespace flyball {

// Of the distributions' packages.
std::vector<std::filesystem::path> font_folders() {
  return {"/usr/share/fonts/opentype/inter",
          "/usr/share/fonts/truetype/inter",
          "/usr/share/fonts/inter",
          "/usr/share/fonts/truetype/jetbrains-mono",
          "/usr/share/fonts/jetbrains-mono",
          "/usr/share/fonts/truetype/font-awesome",
          "/usr/share/fonts-font-awesome/fonts",
          "/usr/share/fonts/truetype/dejavu",
          "/usr/share/fonts/dejavu",
          "/usr/share/fonts/TTF"};
}

} // namespace flyball
