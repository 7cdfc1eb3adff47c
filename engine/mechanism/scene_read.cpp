#include "engine/mechanism/error.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/object_reader.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/scene_keys.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"

#include <algorithm>

namespace flyball {
namespace {

namespace keys = scene_keys;

// What messages call an object before its type is known, and with it.
std::string noun(const Shape*) {
  return "a shape";
}
std::string noun(const Joint*) {
  return "a joint";
}
std::string noun(const Force*) {
  return "a force";
}
std::string noun(const Shape& shape) {
  return "a " + std::string(type_name(shape.type));
}
std::string noun(const Joint& joint) {
  if (joint.type == JointType::gear && joint.kind != GearKind::gear)
    return "a " + std::string(type_name(joint.kind));
  return "a " + std::string(type_name(joint.type)) + " joint";
}
std::string noun(const Force& force) {
  return "a " + std::string(type_name(force.type));
}
std::string noun(const Mechanism&) {
  return "a scene";
}
std::string noun(const Body&) {
  return "a body";
}
std::string noun(const NamedParameter&) {
  return "a parameter";
}
std::string noun(const NamedMeasure&) {
  return "a measure";
}
std::string noun(const CoordinateSpring&) {
  return "a spring";
}
std::string noun(const Stop&) {
  return "a stop";
}
std::string noun(const Friction&) {
  return "a friction";
}
std::string noun(const Drive&) {
  return "a drive";
}
std::string noun(const Air&) {
  return "the air";
}
std::string noun(const Slider&) {
  return "a slider";
}
std::string noun(const Simulation&) {
  return "a simulation";
}
std::string noun(const View&) {
  return "a view";
}
std::string noun(const Camera&) {
  return "a camera";
}

// Mistakes of an object as a whole.
void check(const ValueReader&, const auto&) {}
// What a body weighs is given, or follows from its density.
void check(const ValueReader& value, const Body& body) {
  for (const Field& field : {fields::mass, fields::position, fields::inertia}) {
    const bool there = value.json().contains(field.key);
    const bool needed = field.key != fields::inertia.key;
    if (there && body.density)
      throw SceneError(key_path(value.path(), field.key),
                       "expected none, since it follows from the density and the shapes");
    if (!there && !body.density && needed)
      throw SceneError(key_path(value.path(), field.key),
                       "missing; a body needs it, or a density: " + std::string(field.expected));
  }
  if (!body.density) return;
  for (std::size_t i = 0; i < body.shapes.size(); ++i)
    if (const Shape& shape = body.shapes[i];
        !shape.at && (shape.type == ShapeType::sphere || shape.type == ShapeType::box))
      throw SceneError(value.path() + ".shapes[" + std::to_string(i) + "].at",
                       "missing; the mass centre, where it would stand, follows from the density");
}
void check(const ValueReader& value, const Stop& stop) {
  if (!stop.lower && !stop.upper) throw SceneError(value.path(), "expected lower, upper or both");
}

// A spring pulls by its stiffness, or by a force in its place.
void check_spring(const ValueReader& value, bool by_force, std::string_view noun) {
  const bool stiffness = value.json().contains(fields::stiffness.key);
  const std::string where = key_path(value.path(), fields::stiffness.key);
  if (by_force && stiffness)
    throw SceneError(where, "expected none beside `force`, which stands in its place");
  if (!by_force && !stiffness)
    throw SceneError(where, "missing; " + std::string(noun) +
                                " needs it, or a `force` in its place: " + std::string(expected::number));
}
void check(const ValueReader& value, const CoordinateSpring& spring) {
  check_spring(value, spring.force.has_value(), noun(spring));
}
void check(const ValueReader& value, const Force& force) {
  if (force.type == ForceType::spring) check_spring(value, force.force.has_value(), noun(force));
  if (!has_polar(force)) return;
  for (const std::string_view key : {"cn", "cd"})
    if (value.json().contains(key))
      throw SceneError(key_path(value.path(), key),
                       "expected none beside `lift` and `drag`, which stand in its place");
}

template <class Part>
Part read_object(const ValueReader& value);

template <class Value>
void read(const ValueReader& value, Value& to) {
  if constexpr (std::is_enum_v<Value>)
    to = static_cast<Value>(value.word(keys::words_of(to)));
  else
    to = read_object<Value>(value);
}
void read(const ValueReader& value, double& to) {
  to = value.number();
}
void read(const ValueReader& value, bool& to) {
  to = value.boolean();
}
void read(const ValueReader& value, std::string& to) {
  to = value.text();
}
void read(const ValueReader& value, Vec3& to) {
  to = value.vec3();
}
void read(const ValueReader& value, Quat& to) {
  const auto [w, x, y, z] = value.numbers<4>();
  to = Quat(w, x, y, z);
}
void read(const ValueReader& value, std::array<Vec3, 2>& to) {
  to = value.two_vec3();
}
void read(const ValueReader& value, std::array<std::string, 2>& to) {
  to = value.two_texts();
}
void read(const ValueReader& value, std::array<double, 2>& to) {
  to = value.plain().numbers<2>();
}
void read(const ValueReader& value, std::array<double, 3>& to) {
  to = value.plain().numbers<3>();
}
// An inertia tensor, maybe without its products.
void read(const ValueReader& value, std::array<double, 6>& to) {
  const std::vector<ValueReader> entries = value.elements(3, 6, expected::number);
  if (entries.size() != 3 && entries.size() != 6) value.fail();
  for (std::size_t i = 0; i < entries.size(); ++i)
    to[i] = entries[i].number();
}
void read(const ValueReader& value, BearingMatrix& to) {
  const std::vector<ValueReader> rows = value.elements(2, 6, expected::matrix);
  const std::size_t size = rows.size();
  if (size != 2 && size != 6) value.fail();
  for (const ValueReader& row : rows)
    for (const ValueReader& entry : row.elements(size, size, expected::number))
      to.push_back(entry.number());
}
template <class Value>
void read(const ValueReader& value, std::optional<Value>& to) {
  read(value, to.emplace());
}
template <class Part>
void read(const ValueReader& value, std::vector<Part>& to) {
  for (const ValueReader& element : value.elements())
    to.push_back(read_object<Part>(element));
}

// By name, in the file's order.
template <class Named, class Read>
void read_named(const ValueReader& value, std::vector<Named>& to, const Read& read_one) {
  if (!value.json().is_object()) value.fail();
  for (const auto& [name, json] : value.json().items()) {
    const std::string path = key_path(value.path(), name);
    if (!is_expression_name(name))
      throw SceneError(path, "expected a name of letters, figures and _ that is no function's");
    to.push_back(read_one(path, json));
    to.back().name = name;
  }
}
void read(const ValueReader& value, std::vector<NamedParameter>& to) {
  read_named(value, to, [](const std::string& path, const Json& json) {
    return read_object<NamedParameter>(ValueReader(json, path, expected::object));
  });
}
void read(const ValueReader& value, std::vector<NamedMeasure>& to) {
  read_named(value, to, [](const std::string& path, const Json& json) {
    return read_object<NamedMeasure>(ValueReader(json, path, expected::object));
  });
}
void read(const ValueReader& value, std::vector<NamedPoint>& to) {
  read_named(value, to, [](const std::string& path, const Json& json) {
    NamedPoint point;
    point.at =
        Vec3(ValueReader(json, path, expected::point, {&point.formulas, path.size()}).numbers<3>().data());
    return point;
  });
}

// The fields of one coordinate out of a joint's keys: one value, or with several coordinates an element each.
class CoordinateFields {
 public:
  CoordinateFields(const ObjectReader& object, const Joint& joint, std::size_t i)
      : object_(object), joint_(joint), i_(i) {}

  template <class Value>
  void field(const Field& field, Value& to) {
    if (!object_.has(field.key)) return;
    const std::size_t count = joint_.coordinates.size();
    const ValueReader value = object_.value(field);
    if (count == 1) return read(value, to);
    if (!value.json().is_array() || value.json().size() != count)
      value.fail("an array of " + std::to_string(count) + " elements, one for each coordinate of a " +
                 std::string(type_name(joint_.type)) + " joint (null where nothing acts)");
    const std::vector<ValueReader> elements = value.elements(count, count, field.expected);
    if (!elements[i_].json().is_null()) read(elements[i_], to);
  }
  template <class Value>
  void field(const Field& field, Value& to, const Standard<Value>&) {
    this->field(field, to);
  }

 private:
  const ObjectReader& object_;
  const Joint& joint_;
  std::size_t i_;
};

// Reads the fields that are there as they are visited.
class PresentFields {
 public:
  explicit PresentFields(const ObjectReader& object) : object_(object) {}

  void describe(std::string& to) { to = object_.description(); }
  void version(const Field&) {}           // see check_version
  void type(const Field&, const auto&) {} // known before the keys are
  void expression(const Field& field, std::string& to) {
    const ValueReader value = object_.value(field);
    if (!value.json().is_string() || !value.text().starts_with("=")) value.fail();
    to = value.text().substr(1);
  }
  template <class Value>
  void field(const Field& field, Value& to) {
    if (object_.has(field.key)) read(object_.value(field), to);
  }
  template <class Value>
  void field(const Field& field, Value& to, const Standard<Value>&) {
    this->field(field, to);
  }
  void field(const Field& field, std::optional<double>& to, double) { this->field(field, to); }
  void field(const Field& field, std::optional<Vec3>& to, const Vec3&) { this->field(field, to); }
  void pair(const Field& field, Vec3& a, Vec3& b) {
    const std::array<Vec3, 2> both = object_.value(field).two_vec3();
    a = both[0];
    b = both[1];
  }
  void pair(const Field& field, double& a, double& b) {
    const auto [first, second] = object_.value(field).numbers<2>();
    a = first;
    b = second;
  }
  void coordinates(Joint& joint) {
    joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(joint.type)));
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      CoordinateFields fields(object_, joint, i);
      visit_fields(fields, joint.coordinates[i]);
    }
  }

 private:
  const ObjectReader& object_;
};

template <class Part>
Part read_object(const ValueReader& value) {
  Part part;
  std::span<const keys::Keys> relatives;
  if constexpr (requires { part.type; }) {
    part.type = static_cast<decltype(part.type)>(read_type(value, keys::words_of(part.type), noun(&part)));
    relatives = keys::of_all_types(part);
  }
  if constexpr (std::is_same_v<Part, Joint>) // on which the other keys of a gear depend
    if (part.type == JointType::gear && value.json().contains(fields::kind.key))
      read(ValueReader(value.json().at(fields::kind.key), key_path(value.path(), fields::kind.key), ""),
           part.kind);
  FormulaSink sink = value.sink();
  if constexpr (requires { part.formulas; }) sink = {&part.formulas, value.path().size()};
  if constexpr (std::is_same_v<Part, Slider> || std::is_same_v<Part, Camera>) sink = {};
  const ObjectReader object(value, sink, keys::of(part), noun(part), relatives);
  PresentFields fields(object);
  visit_fields(fields, part);
  if constexpr (requires { part.formulas; }) std::ranges::sort(part.formulas, {}, &Formula::key);
  check(value, part);
  return part;
}

// Before all else, since the keys of another version may be right in their own way.
void check_version(const Json& json) {
  constexpr std::string_view key = "flyball";
  if (!json.is_object() || !json.contains(key)) return;
  const ValueReader version(json.at(key), std::string(key), "a number");
  if (!version.json().is_number() || (version.number() != 1 && version.number() != keys::newest_version))
    version.fail("1 or 2, the versions of the format that this program reads");
}

} // namespace

Mechanism parse_scene(std::string_view text) {
  const Json json = parse_json(text);
  check_version(json);
  Mechanism mechanism = read_object<Mechanism>(ValueReader(json, "", expected::object));
  try {
    evaluate_formulas(mechanism);
  } catch (const SceneError&) { // a mistake like others, see find_mistakes
  }
  return mechanism;
}

Mechanism read_scene(std::string_view text) {
  Mechanism mechanism = parse_scene(text);
  validate(mechanism);
  return mechanism;
}

Mechanism load_scene(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  try {
    return read_scene(text);
  } catch (const SceneError& error) {
    throw SceneError(file.string() + (error.where().empty() ? "" : ": " + error.where()), error.expected());
  }
}

} // namespace flyball
