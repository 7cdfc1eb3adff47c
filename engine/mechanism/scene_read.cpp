#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/object_reader.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/scene_keys.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"

namespace flyball {
namespace {

namespace keys = scene_keys;

// "a revolute joint".
std::string noun_of(std::string_view type, std::string_view kind) {
  return "a " + std::string(type) + (kind.empty() ? "" : " ") + std::string(kind);
}

template <class Type>
std::vector<keys::Keys> keys_of_all(std::size_t count, keys::Keys (*of)(Type)) {
  std::vector<keys::Keys> all;
  for (std::size_t i = 0; i < count; ++i)
    all.push_back(of(static_cast<Type>(i)));
  return all;
}

template <class Item>
std::vector<Item> read_list(const ObjectReader& parent, std::string_view key,
                            Item (*read)(const ValueReader&)) {
  std::vector<Item> items;
  if (!parent.has(key)) return items;
  for (const ValueReader& element : parent[key].elements())
    items.push_back(read(element));
  return items;
}

Shape read_shape(const ValueReader& value) {
  Shape shape;
  shape.type = static_cast<ShapeType>(read_type(value, keys::shape_types(), "a shape"));
  const std::vector<keys::Keys> relatives = keys_of_all(keys::shape_types().size(), keys::shape);
  const ObjectReader object(value, keys::shape(shape.type), noun_of(type_name(shape.type), ""), relatives);
  shape.description = object.description();
  shape.radius = object.number("radius", shape.radius);
  if (object.has("size")) shape.size = object["size"].vec3();
  if (object.has("from")) shape.from = object["from"].vec3();
  if (object.has("to")) shape.to = object["to"].vec3();
  if (object.has("at")) shape.at = object["at"].vec3();
  if (object.has("color")) shape.color = object["color"].numbers<3>();
  return shape;
}

Body read_body(const ValueReader& value) {
  const ObjectReader object(value, keys::body(), "a body");
  Body body;
  body.name = object["name"].text();
  body.description = object.description();
  body.mass = object["mass"].number();
  body.position = object["position"].vec3();
  if (object.has("inertia")) {
    const ValueReader inertia = object["inertia"];
    const std::vector<ValueReader> entries = inertia.elements(3, 6, "a number");
    if (entries.size() != 3 && entries.size() != 6) inertia.fail();
    for (std::size_t i = 0; i < entries.size(); ++i)
      body.inertia[i] = entries[i].number();
  }
  if (object.has("rotation")) {
    const auto [w, x, y, z] = object["rotation"].numbers<4>();
    body.rotation = Quat(w, x, y, z);
  }
  body.shapes = read_list(object, "shapes", read_shape);
  return body;
}

void read_damping(Coordinate& coordinate, const ValueReader& value) {
  coordinate.damping = value.number();
}

void read_drawn(Coordinate& coordinate, const ValueReader& value) {
  coordinate.drawn = value.number();
}

void read_spring(Coordinate& coordinate, const ValueReader& value) {
  const ObjectReader object(value, keys::spring(), "a spring");
  coordinate.spring = {object["stiffness"].number(), object.number("free", 0), object.description()};
}

void read_stop(Coordinate& coordinate, const ValueReader& value) {
  const ObjectReader object(value, keys::stop(), "a stop");
  Stop stop;
  if (object.has("lower")) stop.lower = object["lower"].number();
  if (object.has("upper")) stop.upper = object["upper"].number();
  if (!stop.lower && !stop.upper) throw SceneError(value.path(), "expected lower, upper or both");
  stop.stiffness = object["stiffness"].number();
  stop.description = object.description();
  coordinate.stop = std::move(stop);
}

void read_drive(Coordinate& coordinate, const ValueReader& value) {
  const ObjectReader object(value, keys::drive(), "a drive");
  coordinate.drive = {object["speed"].number(), object.description()};
}

struct CoordinateKey {
  std::string_view name, expected;
  void (*read)(Coordinate&, const ValueReader&);
};

constexpr std::array coordinate_keys{
    CoordinateKey{"coordinate", "a number", read_drawn}, CoordinateKey{"spring", "an object", read_spring},
    CoordinateKey{"damping", "a number", read_damping},  CoordinateKey{"stop", "an object", read_stop},
    CoordinateKey{"drive", "an object", read_drive},
};

void read_coordinates(const ObjectReader& object, Joint& joint) {
  const std::size_t count = joint.coordinates.size();
  for (const CoordinateKey& key : coordinate_keys) {
    if (!object.has(key.name)) continue;
    const ValueReader value = object[key.name];
    if (count == 1) {
      key.read(joint.coordinates[0], {value.json(), value.path(), key.expected});
      continue;
    }
    if (!value.json().is_array() || value.json().size() != count)
      value.fail("an array of " + std::to_string(count) + " elements, one for each coordinate of a " +
                 std::string(type_name(joint.type)) + " joint (null where nothing acts)");
    const std::vector<ValueReader> elements = value.elements(count, count, key.expected);
    for (std::size_t i = 0; i < count; ++i)
      if (!elements[i].json().is_null()) key.read(joint.coordinates[i], elements[i]);
  }
}

Joint read_joint(const ValueReader& value) {
  Joint joint;
  joint.type = static_cast<JointType>(read_type(value, keys::joint_types(), "a joint"));
  const std::vector<keys::Keys> relatives = keys_of_all(keys::joint_types().size(), keys::joint);
  const ObjectReader object(value, keys::joint(joint.type), noun_of(type_name(joint.type), "joint"),
                            relatives);
  joint.name = object["name"].text();
  joint.description = object.description();
  if (object.has("bodies")) joint.bodies = object["bodies"].two_texts();
  if (object.has("at")) joint.at = object["at"].vec3();
  if (object.has("axis")) joint.axis = object["axis"].vec3();
  if (object.has("x_axis")) joint.axis2 = object["x_axis"].vec3();
  if (object.has("axes")) {
    const std::array<Vec3, 2> axes = object["axes"].two_vec3();
    joint.axis = axes[0];
    joint.axis2 = axes[1];
  }
  joint.coordinates.resize(static_cast<std::size_t>(coordinate_count(joint.type)));
  read_coordinates(object, joint);
  if (object.has("cut")) joint.cut = object["cut"].boolean();
  if (object.has("points")) joint.points = object["points"].two_vec3();
  if (object.has("length")) joint.length = object["length"].number();
  if (object.has("joints")) joint.joints = object["joints"].two_texts();
  joint.ratio = object.number("ratio", joint.ratio);
  if (object.has("offset")) joint.offset = object["offset"].number();
  return joint;
}

Force read_force(const ValueReader& value) {
  Force force;
  force.type = static_cast<ForceType>(read_type(value, keys::force_types(), "a force"));
  const std::vector<keys::Keys> relatives = keys_of_all(keys::force_types().size(), keys::force);
  const ObjectReader object(value, keys::force(force.type), noun_of(type_name(force.type), ""), relatives);
  force.name = object["name"].text();
  force.description = object.description();
  if (object.has("bodies")) force.bodies = object["bodies"].two_texts();
  if (object.has("points")) force.points = object["points"].two_vec3();
  force.stiffness = object.number("stiffness", force.stiffness);
  if (object.has("free_length")) force.free_length = object["free_length"].number();
  force.damping = object.number("damping", force.damping);
  if (object.has("body")) force.body = object["body"].text();
  if (object.has("at")) force.at = object["at"].vec3();
  if (object.has("vector")) force.vector = object["vector"].vec3();
  if (object.has("frame")) force.frame = static_cast<ForceFrame>(object["frame"].word(keys::force_frames()));
  force.linear = object.number("linear", force.linear);
  force.quadratic = object.number("quadratic", force.quadratic);
  return force;
}

Slider read_slider(const ValueReader& value) {
  const ObjectReader object(value, keys::slider(), "a slider");
  Slider slider;
  slider.parameter = object["parameter"].text();
  const auto [from, to] = object["range"].numbers<2>();
  slider.from = from;
  slider.to = to;
  if (object.has("scale"))
    slider.scale = static_cast<SliderScale>(object["scale"].word(keys::slider_scales()));
  slider.description = object.description();
  return slider;
}

Simulation read_simulation(const ValueReader& value) {
  const ObjectReader object(value, keys::simulation(), "a simulation");
  Simulation simulation;
  simulation.duration = object.number("duration", simulation.duration);
  if (object.has("damped")) simulation.damped = object["damped"].boolean();
  simulation.description = object.description();
  return simulation;
}

Camera read_camera(const ValueReader& value) {
  const ObjectReader object(value, keys::camera(), "a camera");
  Camera camera;
  if (object.has("target")) camera.target = object["target"].vec3();
  camera.distance = object["distance"].number();
  camera.azimuth = object.number("azimuth", camera.azimuth);
  camera.elevation = object.number("elevation", camera.elevation);
  camera.description = object.description();
  return camera;
}

// Before all else, since the keys of another version may be right in their own way.
void check_version(const Json& json) {
  constexpr std::string_view key = "flyball";
  if (!json.is_object() || !json.contains(key)) return;
  const ValueReader version(json.at(key), std::string(key), "a number");
  if (!version.json().is_number() || version.number() != keys::version)
    version.fail(std::to_string(keys::version) + ", the version of the format this program reads");
}

} // namespace

Mechanism parse_scene(std::string_view text) {
  const Json json = parse_json(text);
  check_version(json);
  const ValueReader value(json, "", "an object");
  const ObjectReader object(value, keys::scene(), "a scene");
  Mechanism mechanism;
  mechanism.name = object["name"].text();
  mechanism.description = object.description();
  if (object.has("gravity")) mechanism.gravity = object["gravity"].vec3();
  mechanism.bodies = read_list(object, "bodies", read_body);
  mechanism.joints = read_list(object, "joints", read_joint);
  mechanism.forces = read_list(object, "forces", read_force);
  mechanism.sliders = read_list(object, "sliders", read_slider);
  if (object.has("simulation")) mechanism.simulation = read_simulation(object["simulation"]);
  if (object.has("view")) {
    const ValueReader view_value = object["view"];
    const ObjectReader view(view_value, keys::view(), "a view");
    if (view.has("camera")) mechanism.camera = read_camera(view["camera"]);
    mechanism.view_description = view.description();
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
