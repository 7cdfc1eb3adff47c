#include "tests/fuzz/mutate_scene.hpp"

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

namespace flyball::fuzz {
namespace {

constexpr double numbers[] = {0,
                              -0.,
                              1,
                              -1,
                              2,
                              0.5,
                              1e-9,
                              1e-12,
                              1e-300,
                              5e-324,
                              1e6,
                              1e9,
                              1e12,
                              1e15,
                              1e100,
                              1e155,
                              1e300,
                              -1e300,
                              1e308,
                              1.5707963267948966,
                              3.141592653589793,
                              6.283185307179586,
                              2147483648.,
                              9007199254740993.,
                              0.1,
                              -9.80665};
constexpr const char* words[] = {"revolute",    "prismatic",
                                 "cylindrical", "universal",
                                 "spherical",   "planar",
                                 "free",        "fixed",
                                 "distance",    "gear",
                                 "spring",      "force",
                                 "torque",      "drag",
                                 "world",       "body",
                                 "ground",      "linear",
                                 "log",         "sphere",
                                 "box",         "cylinder",
                                 "capsule",     "",
                                 "a.b",         "joints.spin.drive.speed",
                                 "gravity.1",   "bodies.hub.mass",
                                 "\n",          "\xc3\xa9",
                                 "=L",          "=2*L*cos(a) + 1 mm",
                                 "=A.x",        "A",
                                 "=1/0",        "=L^L",
                                 "=((((",       "=sqrt(-L)",
                                 "=300 rpm",    "parameters.L",
                                 "points.A.0",  "=",
                                 "=x(hub@A)",   "=torque(spin) / reaction(spin)",
                                 "=x(",         "=clearance('hub', \"hub\")"};
constexpr const char* parts[] = {
    R"("drive": {"speed": 5})",
    R"("density": 7850)",
    R"("parameters": {"L": {"value": 0.1, "unit": "m"}, "a": {"value": "=L / 2 m"}})",
    R"("points": {"A": [0, "=L", "=A.y + L"]})",
    R"-("measures": {"a": {"value": "=speed(hub) + b", "unit": "m/s"}, "b": {"value": "=1 / 0"}})-",
    R"-("measures": {"m": {"value": "=power(spin) + moment_x(spin) * 1 rad/s", "unit": "W"}})-",
    R"("spring": {"stiffness": 100, "free": 0.1})",
    R"("damping": 2)",
    R"("stop": {"lower": -0.1, "upper": 0.2, "stiffness": 1000})",
    R"("coordinate": 0.3)",
    R"("cut": true)",
    R"("cut": false)",
    R"("axis": [0, 1, 0])",
    R"("axis": [0, 0, 1])",
    R"("axes": [[1, 0, 0], [0, 0, 1]])",
    R"("x_axis": [1, 0, 0])",
    R"("inertia": [1, 1, 1])",
    R"("inertia": [1, 2, 1.5, 0.1, 0, -0.1])",
    R"("rotation": [0.6, 0, 0.8, 0])",
    R"("length": 0.5)",
    R"("ratio": -2)",
    R"("offset": 0.1)",
    R"("gravity": [0, -9.80665, 0])",
    R"("quadratic": 3)",
    R"("linear": 2)",
    R"("frame": "body")",
    R"("at": [0.1, 0, 0])",
    R"("free_length": 0)",
    R"("description": "x")",
    R"("drive": [{"speed": 3}, null])",
    R"("spring": [null, {"stiffness": 50}])",
    R"("drive": [null, null, {"speed": 3}])",
    R"("spring": [{"stiffness": 9}, {"stiffness": 9}, {"stiffness": 9}])",
    R"("damping": [1, 2])",
    R"("coordinate": [0.1, 0.2, 0.3])"};

using Random = std::mt19937;

std::size_t below(std::size_t count, Random& random) {
  return count == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

template <class List>
const auto& one_of(const List& list, Random& random) {
  return list[below(std::size(list), random)];
}

// Every part of a scene, with the key it stands under; elements of a list stand under the list's.
struct Place {
  Json* value;
  std::string key;
};

void collect(Json& json, const std::string& key, std::vector<Place>& places) {
  places.push_back({&json, key});
  if (json.is_object())
    for (auto& [name, value] : json.items())
      collect(value, name, places);
  else if (json.is_array())
    for (Json& value : json)
      collect(value, key, places);
}

std::vector<Place> places_of(Json& json) {
  std::vector<Place> places;
  collect(json, "", places);
  return places;
}

Json another_kind(Random& random) {
  switch (below(6, random)) {
  case 0: return nullptr;
  case 1: return true;
  case 2: return Json::array();
  case 3: return Json::object();
  case 4: return one_of(words, random);
  default: return one_of(numbers, random);
  }
}

void change_number(Json& value, const std::vector<Place>& places, Random& random) {
  const double old = value.get<double>();
  switch (below(6, random)) {
  case 0: value = one_of(numbers, random); break;
  case 1: value = -old; break;
  case 2: value = old * one_of(numbers, random); break;
  case 3: value = old * (1 + std::normal_distribution<double>(0, 0.3)(random)); break;
  case 4: value = old + std::normal_distribution<double>(0, 1)(random); break;
  default: {
    const Json& other = *one_of(places, random).value;
    if (other.is_number()) value = Json(other);
  }
  }
  if (!std::isfinite(value.get<double>())) value = 1e308;
}

void change_text(Json& value, const std::vector<Place>& places, Random& random) {
  if (below(3, random) == 0) {
    value = one_of(words, random);
    return;
  }
  std::vector<const Json*> texts;
  for (const Place& place : places)
    if (place.value->is_string()) texts.push_back(place.value);
  value = Json(*one_of(texts, random));
}

void change_list(Json& list, Random& random) {
  if (list.empty()) {
    list.push_back(another_kind(random));
    return;
  }
  const std::size_t i = below(list.size(), random), j = below(list.size(), random);
  switch (below(3, random)) {
  case 0: { // doubled, under a name of its own if it has one
    Json copy = list[i];
    if (copy.is_object() && copy.contains("name") && copy["name"].is_string() && below(4, random) != 0)
      copy["name"] = copy["name"].get<std::string>() + "'";
    list.push_back(std::move(copy));
    break;
  }
  case 1: list.erase(i); break;
  default: std::swap(list[i], list[j]);
  }
}

void change_object(Json& object, Random& random) {
  if (!object.empty() && below(3, random) == 0) {
    object.erase(std::next(object.begin(), static_cast<std::ptrdiff_t>(below(object.size(), random))));
    return;
  }
  const Json part = Json::parse(std::string("{") + one_of(parts, random) + "}");
  object[part.begin().key()] = part.begin().value();
}

} // namespace

void mutate(Json& scene, std::mt19937& random) {
  const std::vector<Place> places = places_of(scene);
  const Place& place = one_of(places, random);
  Json& value = *place.value;
  switch (below(16, random)) {
  case 0: value = another_kind(random); return;
  case 1:
  case 2: { // copied from a part under the same key
    std::vector<const Json*> alike;
    for (const Place& other : places)
      if (other.key == place.key && other.value != place.value) alike.push_back(other.value);
    if (!alike.empty()) {
      Json copy = *one_of(alike, random);
      value = std::move(copy);
      return;
    }
    break;
  }
  default: break;
  }
  if (value.is_number())
    change_number(value, places, random);
  else if (value.is_string())
    change_text(value, places, random);
  else if (value.is_array())
    change_list(value, random);
  else if (value.is_object())
    change_object(value, random);
  else
    value = another_kind(random);
}

void cross(Json& scene, Json other, std::mt19937& random) {
  const std::vector<Place> here = places_of(scene), there = places_of(other);
  const Place& place = one_of(here, random);
  std::vector<const Json*> alike;
  for (const Place& candidate : there)
    if (candidate.key == place.key) alike.push_back(candidate.value);
  if (!alike.empty()) *place.value = Json(*one_of(alike, random));
}

} // namespace flyball::fuzz
