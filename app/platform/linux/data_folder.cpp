#include "app/platform/data_folder.hpp"

namespace flyball {

std::filesystem::path data_folder() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  return failed ? "/usr/share/flyball" : program.parent_path().parent_path() / "share/flyball";
}

} // namespace flyball
