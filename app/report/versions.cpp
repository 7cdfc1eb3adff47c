#include "app/report/versions.hpp"

#include "engine/mechanism/scene_keys.hpp"

#include <Eigen/Core>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace flyball {

std::vector<std::pair<std::string, std::string>> program_versions() {
  return {
      {"Flyball", FLYBALL_VERSION},
      {"Scene file format", std::to_string(scene_keys::newest_version)},
      {"Eigen (linear algebra)",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"{fmt} (numbers as text)",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"nlohmann/json (scene files)", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                                  NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)}};
}

} // namespace flyball
