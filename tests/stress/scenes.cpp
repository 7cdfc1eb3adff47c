#include "tests/stress/scenes.hpp"

#include "tests/support/mechanisms.hpp"

#include "engine/mechanism/scene.hpp"

#include <algorithm>
#include <filesystem>

namespace flyball::stress {

const std::vector<NamedScene>& shipped_scenes() {
  static const std::vector<NamedScene> scenes = [] {
    std::vector<NamedScene> out;
    for (const auto& file : std::filesystem::directory_iterator(FLYBALL_ASSETS "/scenes"))
      if (file.path().extension() == ".json" &&
          file.path().stem() != "horizontal_rotor") // moves periodically: it has no steady state
        out.push_back({file.path().stem().string(), load_scene(file.path().string())});
    std::ranges::sort(out, {}, &NamedScene::name);
    return out;
  }();
  return scenes;
}

void each_stiffness(Mechanism& m, const std::function<void(double&)>& change) {
  for (Joint& j : m.joints)
    for (Coordinate& c : j.coordinates) {
      if (c.spring) change(c.spring->stiffness);
      if (c.stop) change(c.stop->stiffness);
    }
  for (Force& f : m.forces)
    if (f.type == ForceType::spring) change(f.stiffness);
}

void each_damping(Mechanism& m, const std::function<void(double&)>& change) {
  for (Joint& j : m.joints)
    for (Coordinate& c : j.coordinates)
      if (c.damping != 0) change(c.damping);
  for (Force& f : m.forces)
    if (f.damping != 0) change(f.damping);
}

void each_speed(Mechanism& m, const std::function<void(double&)>& change) {
  for (Joint& j : m.joints)
    for (Coordinate& c : j.coordinates)
      if (c.drive) change(c.drive->speed);
}

bool has_springs(const Mechanism& m) {
  Mechanism copy = m;
  bool any = false;
  each_stiffness(copy, [&](double&) { any = true; });
  return any;
}

bool has_dampers(const Mechanism& m) {
  Mechanism copy = m;
  bool any = false;
  each_damping(copy, [&](double&) { any = true; });
  return any;
}

bool finds_speeds(const Mechanism& m) {
  return std::ranges::any_of(m.joints, [](const Joint& j) {
    return std::ranges::any_of(j.coordinates,
                               [](const Coordinate& c) { return c.drive && finds_speed(*c.drive); });
  });
}

bool must_rest(const Mechanism& m) {
  if (finds_speeds(m)) return false;
  return m.joints.size() == m.bodies.size() &&
         std::ranges::all_of(m.joints, [](const Joint& j) { return j.type == JointType::revolute; });
}

Mechanism alike(Mechanism m, double length, double mass, double time) {
  m = test::heavier(test::resized(std::move(m), length), mass);
  const double force = mass * length / (time * time);
  m.gravity *= length / (time * time);
  m.air.wind *= length / time;
  m.air.density *= mass / (length * length * length);
  for (Joint& j : m.joints)
    for (std::size_t i = 0; i < j.coordinates.size(); ++i) {
      Coordinate& c = j.coordinates[i];
      const bool angle = is_angle(j.type, static_cast<int>(i));
      const double unit = angle ? force * length : force / length;
      if (c.spring) c.spring->stiffness *= unit;
      if (c.stop) {
        c.stop->stiffness *= unit;
        if (!angle && c.stop->lower) *c.stop->lower *= length;
        if (!angle && c.stop->upper) *c.stop->upper *= length;
      }
      c.damping *= unit * time;
      if (!c.drive) continue;
      c.drive->speed *= (angle ? 1 : length) / time;
      for (std::optional<double>* torque : {&c.drive->torque, &c.drive->load})
        if (*torque) **torque *= angle ? force * length : force;
    }
  for (Force& f : m.forces) {
    f.stiffness *= force / length;
    f.damping *= force / length * time;
    f.vector *= f.type == ForceType::torque ? force * length : force;
    f.linear *= force / length * time;
    f.quadratic *= force / (length * length) * time * time;
    // Rows of forces and torques, columns of shifts and turns.
    const auto rescale = [&](BearingMatrix& matrix, double times) {
      const std::size_t size = matrix.size() == 36 ? 6 : 2;
      for (std::size_t i = 0; i < matrix.size(); ++i)
        matrix[i] *= force * times * (i / size < 3 ? 1 : length) / (i % size < 3 ? length : 1);
    };
    rescale(f.bearing_stiffness, 1);
    rescale(f.bearing_damping, time);
  }
  return m;
}

} // namespace flyball::stress
