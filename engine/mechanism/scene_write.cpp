#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/json_text.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/scene_keys.hpp"

#include <algorithm>

namespace flyball {
namespace {

template <class Part>
Json object_of(const Part& part);

template <class Value>
Json json_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>)
    return type_name(value);
  else if constexpr (std::is_class_v<Value> && !std::is_constructible_v<Json, Value>)
    return object_of(value);
  else
    return value;
}
Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Json json_of(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
Json json_of(const std::array<Vec3, 2>& points) {
  return {json_of(points[0]), json_of(points[1])};
}
// An inertia tensor, without its products where there are none.
Json json_of(const std::array<double, 6>& inertia) {
  const auto products = inertia.begin() + 3;
  if (std::any_of(products, inertia.end(), [](double i) { return i != 0; })) return inertia;
  return std::vector<double>(inertia.begin(), products);
}
template <class Part>
Json json_of(const std::vector<Part>& parts) {
  Json list = Json::array();
  for (const Part& part : parts)
    list.push_back(object_of(part));
  return list;
}

bool same(const Quat& a, const Quat& b) {
  return a.coeffs() == b.coeffs();
}
template <class Value>
bool same(const Value& a, const Value& b) {
  return a == b;
}

// An object as its fields are visited, without those at their standard.
class ObjectWriter {
 public:
  void describe(const std::string& description) {
    if (!description.empty()) json_["description"] = description;
  }
  void version(const Field& field) { put(field, scene_keys::version); }
  void type(const Field& field, const auto& type) { put(field, json_of(type)); }
  void pair(const Field& field, const auto& a, const auto& b) {
    put(field, Json::array({json_of(a), json_of(b)}));
  }
  template <class Value>
  void field(const Field& field, const Value& value) {
    put(field, json_of(value));
  }
  template <class Value>
  void field(const Field& field, const Value& value, const Standard<Value>& standard) {
    if (!same(value, standard)) put(field, json_of(value));
  }
  template <class Value>
  void field(const Field& field, const std::optional<Value>& value) {
    if (value) put(field, json_of(*value));
  }
  template <class Value>
  void field(const Field& field, const std::optional<Value>& value, const Standard<Value>&) {
    this->field(field, value);
  }
  // One value for a single coordinate, an array with null for several; nothing where all are null.
  void coordinates(const Joint& joint) {
    if (joint.coordinates.size() == 1) return visit_fields(*this, joint.coordinates[0]);
    std::vector<Json> each;
    for (const Coordinate& coordinate : joint.coordinates)
      each.push_back(object_of(coordinate));
    const scene_keys::Keys keys = scene_keys::of(Coordinate());
    for (const Field& field : keys) {
      const std::string key(field.key);
      if (std::ranges::none_of(each, [&](const Json& one) { return one.contains(key); })) continue;
      Json all = Json::array();
      for (const Json& one : each)
        all.push_back(one.contains(key) ? one[key] : Json());
      put(field, std::move(all));
    }
  }
  Json take() { return std::move(json_); }

 private:
  void put(const Field& field, Json value) { json_[std::string(field.key)] = std::move(value); }

  Json json_ = Json::object();
};

template <class Part>
Json object_of(const Part& part) {
  ObjectWriter object;
  visit_fields(object, part);
  return object.take();
}

} // namespace

std::string write_scene(const Mechanism& mechanism) {
  return print_json(object_of(mechanism));
}

void save_scene(const Mechanism& mechanism, const std::filesystem::path& file) {
  write_bytes(file, write_scene(mechanism));
}

} // namespace flyball
