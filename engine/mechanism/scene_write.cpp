#include "engine/mechanism/file.hpp"
#include "engine/mechanism/json_text.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/scene_keys.hpp"

#include <algorithm>

namespace flyball {
namespace {

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Json to_json(const std::array<Vec3, 2>& points) {
  return {to_json(points[0]), to_json(points[1])};
}

// An object that leaves out what is at its default.
class ObjectWriter {
 public:
  template <class Value>
  void put(std::string_view key, const Value& value) {
    json_[std::string(key)] = value;
  }
  template <class Value>
  void put(std::string_view key, const Value& value, const Value& standard) {
    if (value != standard) put(key, value);
  }
  void put(std::string_view key, const Vec3& value) { json_[std::string(key)] = to_json(value); }
  void put(std::string_view key, const std::array<Vec3, 2>& value) {
    json_[std::string(key)] = to_json(value);
  }
  template <class Value>
  void put(std::string_view key, const std::optional<Value>& value) {
    if (value) put(key, *value);
  }
  template <class Item>
  void put_list(std::string_view key, const std::vector<Item>& items, Json (*write)(const Item&)) {
    Json list = Json::array();
    for (const Item& item : items)
      list.push_back(write(item));
    json_[std::string(key)] = std::move(list);
  }
  void describe(const std::string& description) { put("description", description, {}); }
  Json take() { return std::move(json_); }

 private:
  Json json_ = Json::object();
};

Json write_shape(const Shape& shape) {
  ObjectWriter object;
  object.put("type", type_name(shape.type));
  object.describe(shape.description);
  const bool rod = shape.type == ShapeType::cylinder || shape.type == ShapeType::capsule;
  if (shape.type == ShapeType::box)
    object.put("size", shape.size);
  else
    object.put("radius", shape.radius);
  if (rod) {
    object.put("from", shape.from);
    object.put("to", shape.to);
  } else {
    object.put("at", shape.at);
  }
  object.put("color", shape.color);
  return object.take();
}

Json write_body(const Body& body) {
  ObjectWriter object;
  object.put("name", body.name);
  object.describe(body.description);
  object.put("mass", body.mass);
  object.put("position", body.position);
  const auto products = body.inertia.begin() + 3;
  if (std::any_of(products, body.inertia.end(), [](double i) { return i != 0; }))
    object.put("inertia", body.inertia);
  else if (std::any_of(body.inertia.begin(), products, [](double i) { return i != 0; }))
    object.put("inertia", std::vector<double>(body.inertia.begin(), products));
  const Quat& q = body.rotation;
  object.put("rotation", std::array{q.w(), q.x(), q.y(), q.z()}, std::array{1.0, 0.0, 0.0, 0.0});
  if (!body.shapes.empty()) object.put_list("shapes", body.shapes, write_shape);
  return object.take();
}

Json write_drawn(const Coordinate& c) {
  return c.drawn == 0 ? Json() : Json(c.drawn);
}

Json write_damping(const Coordinate& c) {
  return c.damping == 0 ? Json() : Json(c.damping);
}

Json write_spring(const Coordinate& c) {
  if (!c.spring) return {};
  ObjectWriter object;
  object.describe(c.spring->description);
  object.put("stiffness", c.spring->stiffness);
  object.put("free", c.spring->free, 0.0);
  return object.take();
}

Json write_stop(const Coordinate& c) {
  if (!c.stop) return {};
  ObjectWriter object;
  object.describe(c.stop->description);
  object.put("lower", c.stop->lower);
  object.put("upper", c.stop->upper);
  object.put("stiffness", c.stop->stiffness);
  return object.take();
}

Json write_drive(const Coordinate& c) {
  if (!c.drive) return {};
  ObjectWriter object;
  object.describe(c.drive->description);
  object.put("speed", c.drive->speed);
  return object.take();
}

// One value for a single coordinate, an array with null for several; nothing where all are null.
void put_coordinates(ObjectWriter& object, std::string_view key, const std::vector<Coordinate>& coordinates,
                     Json (*write)(const Coordinate&)) {
  Json all = Json::array();
  for (const Coordinate& coordinate : coordinates)
    all.push_back(write(coordinate));
  if (std::all_of(all.begin(), all.end(), [](const Json& one) { return one.is_null(); })) return;
  object.put(key, all.size() == 1 ? Json(all[0]) : all);
}

Json write_joint(const Joint& joint) {
  ObjectWriter object;
  object.put("name", joint.name);
  object.describe(joint.description);
  object.put("type", type_name(joint.type));
  if (joint.type == JointType::gear) {
    object.put("joints", joint.joints);
    object.put("ratio", joint.ratio);
    object.put("offset", joint.offset);
  } else {
    object.put("bodies", joint.bodies);
  }
  if (joint.type == JointType::distance) {
    object.put("points", joint.points);
    object.put("length", joint.length);
  }
  if (has_at(joint.type)) object.put("at", joint.at);
  if (joint.type == JointType::universal) {
    object.put("axes", std::array{joint.axis, joint.axis2});
  } else {
    if (has_axis(joint.type)) object.put("axis", joint.axis);
    if (has_axis2(joint.type)) object.put("x_axis", joint.axis2);
  }
  put_coordinates(object, "coordinate", joint.coordinates, write_drawn);
  put_coordinates(object, "spring", joint.coordinates, write_spring);
  put_coordinates(object, "damping", joint.coordinates, write_damping);
  put_coordinates(object, "stop", joint.coordinates, write_stop);
  put_coordinates(object, "drive", joint.coordinates, write_drive);
  object.put("cut", joint.cut);
  return object.take();
}

Json write_force(const Force& force) {
  ObjectWriter object;
  object.put("name", force.name);
  object.describe(force.description);
  object.put("type", type_name(force.type));
  if (force.type == ForceType::spring) {
    object.put("bodies", force.bodies);
    object.put("points", force.points);
    object.put("stiffness", force.stiffness);
    object.put("free_length", force.free_length);
    object.put("damping", force.damping, 0.0);
    return object.take();
  }
  object.put("body", force.body);
  object.put("at", force.at);
  if (force.type == ForceType::drag) {
    object.put("linear", force.linear, 0.0);
    object.put("quadratic", force.quadratic, 0.0);
  } else {
    object.put("vector", force.vector);
    if (force.frame != ForceFrame::world) object.put("frame", type_name(force.frame));
  }
  return object.take();
}

Json write_slider(const Slider& slider) {
  ObjectWriter object;
  object.put("parameter", slider.parameter);
  object.describe(slider.description);
  object.put("range", std::array{slider.from, slider.to});
  if (slider.scale != SliderScale::linear) object.put("scale", type_name(slider.scale));
  return object.take();
}

Json write_simulation(const Simulation& simulation) {
  const Simulation standard;
  ObjectWriter object;
  object.describe(simulation.description);
  object.put("duration", simulation.duration, standard.duration);
  object.put("damped", simulation.damped, standard.damped);
  return object.take();
}

Json write_camera(const Camera& camera) {
  const Camera standard;
  ObjectWriter object;
  object.describe(camera.description);
  if (camera.target != standard.target) object.put("target", camera.target);
  object.put("distance", camera.distance);
  object.put("azimuth", camera.azimuth, standard.azimuth);
  object.put("elevation", camera.elevation, standard.elevation);
  return object.take();
}

Json write_mechanism(const Mechanism& mechanism) {
  ObjectWriter object;
  object.put("flyball", scene_keys::version);
  object.put("name", mechanism.name);
  object.describe(mechanism.description);
  if (mechanism.gravity != Vec3::Zero()) object.put("gravity", mechanism.gravity);
  object.put_list("bodies", mechanism.bodies, write_body);
  object.put_list("joints", mechanism.joints, write_joint);
  if (!mechanism.forces.empty()) object.put_list("forces", mechanism.forces, write_force);
  if (!mechanism.sliders.empty()) object.put_list("sliders", mechanism.sliders, write_slider);
  if (mechanism.simulation != Simulation()) object.put("simulation", write_simulation(mechanism.simulation));
  if (mechanism.camera || !mechanism.view_description.empty()) {
    ObjectWriter view;
    view.describe(mechanism.view_description);
    if (mechanism.camera) view.put("camera", write_camera(*mechanism.camera));
    object.put("view", view.take());
  }
  return object.take();
}

} // namespace

std::string write_scene(const Mechanism& mechanism) {
  return print_json(write_mechanism(mechanism));
}

void save_scene(const Mechanism& mechanism, const std::filesystem::path& file) {
  write_bytes(file, write_scene(mechanism));
}

} // namespace flyball
