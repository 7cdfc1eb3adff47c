#include "tests/support/scenes.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <filesystem>

namespace flyball::test {

std::string shipped_file(const std::string& name) {
  return FLYBALL_ASSETS "/scenes/" + name + ".json";
}

Mechanism shipped(const std::string& name) {
  return load_scene(shipped_file(name));
}

Mechanism shipped(const std::string& name, const std::vector<std::pair<std::string, double>>& changes) {
  Mechanism m = shipped(name);
  for (const auto& [address, value] : changes)
    set_parameter(m, address, value);
  return m;
}

std::vector<std::string> shipped_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(FLYBALL_ASSETS "/scenes"))
    if (entry.path().extension() == ".json") files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

Mechanism stored_case(const std::string& name) {
  return load_scene(FLYBALL_CASES "/" + name + ".json");
}

} // namespace flyball::test
