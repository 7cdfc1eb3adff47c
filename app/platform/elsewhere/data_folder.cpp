#include "app/platform/data_folder.hpp"

namespace flyball {

std::filesystem::path data_folder() {
  return std::filesystem::path("share") / "flyball";
}

} // namespace flyball
