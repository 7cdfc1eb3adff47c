#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/json_text.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/scene_keys.hpp"

#include <algorithm>

namespace flyball {
namespace {

bool same(const Quat& a, const Quat& b) {
  return a.coeffs() == b.coeffs();
}
template <class Value>
bool same(const Value& a, const Value& b) {
  return a == b;
}

// The expressions of a part, and where in it an object of its fields stands.
struct Place {
  const Formulas* formulas = nullptr;
  std::string prefix{}, suffix{}; // "spring.1." of a joint's spring, ".1" of its coordinates' fields

  std::string key(const Field& field) const { return prefix + std::string(field.key) + suffix; }
  const Formula* find(std::string_view key) const {
    const auto found = std::ranges::find(*formulas, key, &Formula::key);
    return found == formulas->end() ? nullptr : &*found;
  }
  // Whether an expression gives the number of this key, or one of those in it.
  bool gives(const std::string& key) const {
    return std::ranges::any_of(*formulas, [&](const Formula& formula) {
      return formula.key == key || formula.key.starts_with(key + ".");
    });
  }
};

// A named point where its coordinates are all that the numbers are, else empty.
std::string point_of(const Place& place, const std::string& key) {
  std::string point;
  for (const int i : {0, 1, 2}) {
    const Formula* formula = place.find(key + "." + std::to_string(i));
    if (!formula) return {};
    const std::string name = formula->text.substr(0, formula->text.find('.'));
    if (formula->text != point_coordinate(name, i) || (i > 0 && name != point)) return {};
    point = name;
  }
  return point;
}

// Numbers with expressions in their places.
Json with_formulas(Json value, const Place& place, const std::string& key) {
  if (place.formulas->empty() || !place.gives(key)) return value;
  if (const Formula* formula = place.find(key)) return "=" + formula->text;
  if (!value.is_array()) return value;
  const bool numbers =
      value.size() == 3 && std::ranges::all_of(value, [](const Json& e) { return e.is_number(); });
  if (const std::string point = numbers ? point_of(place, key) : ""; !point.empty()) return point;
  for (std::size_t i = 0; i < value.size(); ++i)
    value[i] = with_formulas(value[i], place, key + "." + std::to_string(i));
  return value;
}

template <class Part>
Json object_of(const Part& part, const Place& place = {});

Json json_of(const auto& value) {
  if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>)
    return type_name(value);
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

// An object as its fields are visited, without those at their standard.
class ObjectWriter {
 public:
  ObjectWriter(Place place, int version) : place_(std::move(place)), version_(version) {}

  void describe(const std::string& description) {
    if (!description.empty()) json_["description"] = description;
  }
  void version(const Field& field) { put(field, version_); }
  void type(const Field& field, const auto& type) { put(field, json_of(type)); }
  void expression(const Field& field, const std::string& text) { put(field, "=" + text); }
  void pair(const Field& field, const auto& a, const auto& b) {
    put(field, with_formulas(Json::array({json_of(a), json_of(b)}), place_, place_.key(field)));
  }
  template <class Value>
  void field(const Field& field, const Value& value) {
    put(field, value_of(field, value));
  }
  template <class Value>
  void field(const Field& field, const Value& value, const Standard<Value>& standard) {
    if (!same(value, standard) || place_.gives(place_.key(field))) put(field, value_of(field, value));
  }
  template <class Value>
  void field(const Field& field, const std::optional<Value>& value) {
    if (value) put(field, value_of(field, *value));
  }
  template <class Value>
  void field(const Field& field, const std::optional<Value>& value, const Standard<Value>&) {
    this->field(field, value);
  }
  // One value for a single coordinate, an array with null for several; nothing where all are null.
  void coordinates(const Joint& joint) {
    if (joint.coordinates.size() == 1) return visit_fields(*this, joint.coordinates[0]);
    std::vector<Json> each;
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      each.push_back(object_of(joint.coordinates[i], {place_.formulas, "", "." + std::to_string(i)}));
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

  template <class Value>
  Json value_of(const Field& field, const Value& value) const {
    if constexpr (requires(ObjectWriter & writer) { visit_fields(writer, value); })
      return object_of(value, {place_.formulas, place_.key(field) + "."});
    else
      return with_formulas(json_of(value), place_, place_.key(field));
  }
  // An inertia tensor, without its products where there are none.
  Json value_of(const Field& field, const std::array<double, 6>& inertia) const {
    const auto products = inertia.begin() + 3;
    bool all = std::any_of(products, inertia.end(), [](double i) { return i != 0; });
    for (const std::string_view product : {".3", ".4", ".5"})
      all = all || place_.gives(place_.key(field) + std::string(product));
    return with_formulas(all ? Json(inertia) : Json(std::vector<double>(inertia.begin(), products)), place_,
                         place_.key(field));
  }
  Json value_of(const Field& field, const BearingMatrix& matrix) const {
    const std::size_t size = matrix.size() > 4 ? 6 : 2;
    Json rows = Json::array();
    for (auto row = matrix.begin(); row != matrix.end(); row += static_cast<std::ptrdiff_t>(size))
      rows.push_back(std::vector<double>(row, row + static_cast<std::ptrdiff_t>(size)));
    return with_formulas(std::move(rows), place_, place_.key(field));
  }
  template <class Part>
  Json value_of(const Field&, const std::vector<Part>& parts) const {
    Json list = Json::array();
    for (const Part& part : parts)
      list.push_back(object_of(part));
    return list;
  }
  Json value_of(const Field&, const std::vector<NamedParameter>& all) const { return by_name(all); }
  Json value_of(const Field&, const std::vector<NamedMeasure>& all) const { return by_name(all); }
  Json value_of(const Field&, const std::vector<NamedPoint>& points) const {
    Json all = Json::object();
    for (const NamedPoint& point : points) {
      Json at = json_of(point.at);
      for (const Formula& formula : point.formulas)
        at.at(static_cast<std::size_t>(std::stoul(formula.key))) = "=" + formula.text;
      all[point.name] = std::move(at);
    }
    return all;
  }

  template <class Named>
  static Json by_name(const std::vector<Named>& parts) {
    Json all = Json::object();
    for (const Named& part : parts)
      all[part.name] = object_of(part);
    return all;
  }

  Json json_ = Json::object();
  Place place_;
  int version_;
};

template <class Part>
Json object_of(const Part& part, const Place& place) {
  static const Formulas none;
  Place its = place;
  int version = 0;
  if constexpr (requires { part.formulas; }) its = {&part.formulas};
  if constexpr (std::is_same_v<Part, Mechanism>) version = used_of_version_2(part).empty() ? 1 : 2;
  if (!its.formulas) its.formulas = &none;
  ObjectWriter object(its, version);
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
