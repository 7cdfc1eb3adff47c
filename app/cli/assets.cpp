#include "app/cli/assets.hpp"

namespace flyball::cli {

std::filesystem::path shipped_scenes() {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path here = failed ? fs::path() : program.parent_path();
  for (const fs::path& folder :
       {fs::path(FLYBALL_ASSETS), here / "../share/flyball", here / "../../assets"}) {
    const fs::path scenes = folder / "scenes";
    if (fs::is_directory(scenes, failed)) return scenes.lexically_normal();
  }
  return {};
}

} // namespace flyball::cli
