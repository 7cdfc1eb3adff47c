#include "engine/mechanism/numbers.hpp"

namespace flyball {
namespace {

class Collector {
 public:
  void add(std::string key, std::string unit, double& place) {
    all_.push_back({std::move(key), std::move(unit), place, [&place](double v) { place = v; }});
  }
  void add(std::string key, std::string unit, std::optional<double>& place, double standard) {
    all_.push_back(
        {std::move(key), std::move(unit), place.value_or(standard), [&place](double v) { place = v; }});
  }
  void add(const std::string& key, const std::string& unit, Vec3& place) {
    for (int i = 0; i < 3; ++i)
      add(key + "." + std::to_string(i), unit, place[i]);
  }
  void add(const std::string& key, const std::string& unit, std::optional<Vec3>& place,
           const Vec3& standard) {
    for (int i = 0; i < 3; ++i)
      all_.push_back(
          {key + "." + std::to_string(i), unit, place.value_or(standard)[i], [&place, standard, i](double v) {
             if (!place) place = standard;
             (*place)[i] = v;
           }});
  }
  void add(const std::string& key, const std::string& unit, std::array<Vec3, 2>& places) {
    for (std::size_t k = 0; k < 2; ++k)
      add(key + "." + std::to_string(k), unit, places[k]);
  }
  std::vector<Number> take() { return std::move(all_); }

 private:
  std::vector<Number> all_;
};

void add_coordinate(Collector& all, Joint& joint, int i) {
  Coordinate& coordinate = joint.coordinates[static_cast<std::size_t>(i)];
  const bool angle = is_angle(joint.type, i);
  const std::string index = joint.coordinates.size() > 1 ? "." + std::to_string(i) : "";
  const std::string stiffness = angle ? "N m/rad" : "N/m";
  const std::string value = angle ? "rad" : "m";
  all.add("coordinate" + index, value, coordinate.drawn);
  if (coordinate.spring) {
    all.add("spring" + index + ".stiffness", stiffness, coordinate.spring->stiffness);
    all.add("spring" + index + ".free", value, coordinate.spring->free);
  }
  all.add("damping" + index, angle ? "N m s/rad" : "N s/m", coordinate.damping);
  if (coordinate.stop) {
    // An absent limit is no limit, which no number says.
    if (coordinate.stop->lower) all.add("stop" + index + ".lower", value, *coordinate.stop->lower);
    if (coordinate.stop->upper) all.add("stop" + index + ".upper", value, *coordinate.stop->upper);
    all.add("stop" + index + ".stiffness", stiffness, coordinate.stop->stiffness);
  }
  if (coordinate.drive) all.add("drive" + index + ".speed", angle ? "rad/s" : "m/s", coordinate.drive->speed);
}

void add_gear(Collector& all, const Mechanism& mechanism, Joint& gear) {
  std::array<std::string, 2> units;
  for (std::size_t end = 0; end < 2; ++end) {
    const auto [joint, i] = find_coordinate(mechanism, gear.joints[end]);
    if (joint < 0) continue;
    units[end] = is_angle(mechanism.joints[static_cast<std::size_t>(joint)].type, i) ? "rad" : "m";
  }
  all.add("ratio", units[0] == units[1] ? "" : units[1] + "/" + units[0], gear.ratio);
  all.add("offset", units[1], gear.offset, drawn_offset(mechanism, gear));
}

} // namespace

std::vector<Number> numbers_of(Body& body) {
  Collector all;
  all.add("mass", "kg", body.mass);
  all.add("position", "m", body.position);
  for (std::size_t i = 0; i < body.inertia.size(); ++i)
    all.add("inertia." + std::to_string(i), "kg m^2", body.inertia[i]);
  return all.take();
}

std::vector<Number> numbers_of(const Mechanism& mechanism, Joint& joint) {
  Collector all;
  if (joint.type == JointType::gear) add_gear(all, mechanism, joint);
  if (joint.type == JointType::distance) {
    all.add("points", "m", joint.points);
    all.add("length", "m", joint.length, drawn_distance(joint.points));
  }
  if (has_at(joint.type)) all.add("at", "m", joint.at);
  if (joint.type == JointType::universal) {
    all.add("axes.0", "", joint.axis);
    all.add("axes.1", "", joint.axis2);
  } else {
    if (has_axis(joint.type)) all.add("axis", "", joint.axis);
    if (has_axis2(joint.type)) all.add("x_axis", "", joint.axis2);
  }
  if (joint.coordinates.size() == static_cast<std::size_t>(coordinate_count(joint.type)))
    for (int i = 0; i < coordinate_count(joint.type); ++i)
      add_coordinate(all, joint, i);
  return all.take();
}

std::vector<Number> numbers_of(const Mechanism& mechanism, Force& force) {
  Collector all;
  if (force.type == ForceType::spring) {
    all.add("points", "m", force.points);
    all.add("stiffness", "N/m", force.stiffness);
    all.add("free_length", "m", force.free_length, drawn_distance(force.points));
    all.add("damping", "N s/m", force.damping);
    return all.take();
  }
  const int body = body_index(mechanism, force.body);
  all.add("at", "m", force.at,
          body < 0 ? Vec3::Zero() : mechanism.bodies[static_cast<std::size_t>(body)].position);
  if (force.type == ForceType::drag) {
    all.add("linear", "N s/m", force.linear);
    all.add("quadratic", "N s^2/m^2", force.quadratic);
  } else {
    all.add("vector", force.type == ForceType::torque ? "N m" : "N", force.vector);
  }
  return all.take();
}

std::vector<Number> numbers_of_gravity(Vec3& gravity) {
  Collector all;
  all.add("gravity", "m/s^2", gravity);
  return all.take();
}

std::vector<Number> numbers_of(Simulation& simulation) {
  Collector all;
  all.add("simulation.duration", "s", simulation.duration);
  return all.take();
}

} // namespace flyball
