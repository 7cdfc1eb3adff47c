#include "app/platform/font_folders.hpp"

namespace flyball {

std::vector<std::filesystem::path> font_folders() {
  return {};
}

} // namespace flyball
