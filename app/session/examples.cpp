#include "app/session/examples.hpp"

#include "app/session/fuzzy_match.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

namespace flyball {

namespace {

namespace fs = std::filesystem;

constexpr const char *groups_file = "groups.txt", *no_group = "Others";

struct Place {
  std::size_t rank = 0;
  std::string group;
};

// By the names of the scenes; none where there is no such file.
std::map<std::string, Place> read_places(const fs::path& folder) {
  std::map<std::string, Place> places;
  std::error_code ignored;
  if (!fs::is_regular_file(folder / groups_file, ignored)) return places;
  std::string bytes;
  try {
    bytes = read_bytes(folder / groups_file);
  } catch (const SceneError&) { // unreadable
  }
  std::istringstream lines(bytes);
  std::string group;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line[begin] == '#') continue;
    if (begin == 0)
      group = line;
    else
      places.try_emplace(line.substr(begin), Place{places.size(), group});
  }
  return places;
}

// What a person may call it.
const char* words_for(const Joint& joint) {
  switch (joint.type) {
  case JointType::revolute: return "revolute joints, hinges";
  case JointType::prismatic: return "prismatic joints, slides, sliders";
  case JointType::cylindrical: return "cylindrical joints";
  case JointType::universal: return "universal joints, Cardan, Hooke";
  case JointType::spherical: return "spherical joints, ball";
  case JointType::planar: return "planar joints";
  case JointType::free: return "free joints";
  case JointType::fixed: return "fixed joints, welds";
  case JointType::distance: return "distance joints, links, strings";
  case JointType::gear: break;
  }
  switch (joint.kind) {
  case GearKind::gear: return "gears, wheels";
  case GearKind::belt: return "belts, pulleys, chains";
  case GearKind::rack: return "racks, pinions, gears";
  case GearKind::screw: return "screws, threads";
  }
  return "";
}

const char* words_for(ForceType type) {
  switch (type) {
  case ForceType::spring: return "springs";
  case ForceType::force: return "forces, loads";
  case ForceType::torque: return "torques, loads";
  case ForceType::drag: return "drag, air";
  case ForceType::vane: return "vanes, air, wind, blades";
  case ForceType::bearing: return "bearings";
  }
  return "";
}

std::string words_for(const Coordinate& coordinate) {
  std::string words;
  if (coordinate.spring) words += " springs";
  if (coordinate.damping != 0 || coordinate.damping_force) words += " dampers";
  if (coordinate.stop) words += " stops";
  if (coordinate.friction) words += " friction";
  if (coordinate.drive) words += " drives";
  if (coordinate.drive && coordinate.drive->torque) words += " torques, engines, motors";
  if (coordinate.drive && coordinate.drive->keeps == DriveKeeps::momentum) words += " momentum";
  return words;
}

std::string words_for(const Mechanism& mechanism) {
  std::string words;
  for (const Joint& joint : mechanism.joints) {
    words += std::string(" ") + words_for(joint);
    for (const Coordinate& coordinate : joint.coordinates)
      words += words_for(coordinate);
  }
  for (const Force& force : mechanism.forces)
    words += std::string(" ") + words_for(force.type);
  if (!mechanism.parameters.empty()) words += " named parameters";
  if (!mechanism.measures.empty()) words += " measures";
  return words;
}

} // namespace

std::vector<Example> read_examples(const fs::path& folder) {
  const std::map<std::string, Place> places = read_places(folder);
  const Place last{places.size(), places.empty() ? "" : no_group};
  std::vector<std::pair<std::size_t, Example>> found;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() != ".json") continue;
    const auto named = places.find(it->path().stem().string());
    const Place place = named == places.end() ? last : named->second;
    try {
      found.push_back({place.rank, {it->path(), load_scene(it->path()), place.group}});
    } catch (const SceneError&) { // an example that cannot be opened is none
    }
  }
  std::ranges::sort(found, {}, [](const auto& each) {
    return std::pair<std::size_t, const std::string&>(each.first, each.second.mechanism.name);
  });
  std::vector<Example> examples;
  for (auto& [rank, example] : found)
    examples.push_back(std::move(example));
  return examples;
}

std::optional<int> found_rank(const Example& example, std::string_view typed) {
  std::string text = example.mechanism.name;
  if (words_begin(typed, text)) return 0;
  text += " " + example.group + " " + example.mechanism.description;
  if (words_begin(typed, text)) return 1;
  if (words_begin(typed, text + words_for(example.mechanism))) return 2;
  return std::nullopt;
}

} // namespace flyball
