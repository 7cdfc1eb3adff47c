#include "app/document/finite.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

bool finite(const CoordinateSpring& spring);
bool finite(const Stop& stop);
bool finite(const Drive& drive);
bool finite(const Camera& camera);

bool finite(double x) {
  return std::isfinite(x);
}
bool finite(const Vec3& v) {
  return v.allFinite();
}
template <class Value, std::size_t N>
bool finite(const std::array<Value, N>& values) {
  return std::ranges::all_of(values, [](const Value& value) { return finite(value); });
}
template <class Value>
bool finite(const std::optional<Value>& value) {
  return !value || finite(*value);
}
bool finite(const CoordinateSpring& spring) {
  return finite(spring.stiffness) && finite(spring.free);
}
bool finite(const Stop& stop) {
  return finite(stop.lower) && finite(stop.upper) && finite(stop.stiffness);
}
bool finite(const Drive& drive) {
  return finite(drive.speed);
}
bool finite(const Coordinate& c) {
  return finite(c.drawn) && finite(c.spring) && finite(c.damping) && finite(c.stop) && finite(c.drive);
}
bool finite(const Shape& s) {
  return finite(s.radius) && finite(s.size) && finite(s.from) && finite(s.to) && finite(s.at) &&
         finite(s.color);
}
template <class Value>
bool finite(const std::vector<Value>& values) {
  return std::ranges::all_of(values, [](const Value& value) { return finite(value); });
}
bool finite(const Body& b) {
  return finite(b.mass) && finite(b.position) && finite(b.inertia) && b.rotation.coeffs().allFinite() &&
         finite(b.shapes);
}
bool finite(const Joint& j) {
  return finite(j.at) && finite(j.axis) && finite(j.axis2) && finite(j.coordinates) && finite(j.points) &&
         finite(j.length) && finite(j.ratio) && finite(j.offset);
}
bool finite(const Force& f) {
  return finite(f.points) && finite(f.stiffness) && finite(f.free_length) && finite(f.damping) &&
         finite(f.at) && finite(f.vector) && finite(f.linear) && finite(f.quadratic);
}
bool finite(const Slider& slider) {
  return finite(slider.from) && finite(slider.to);
}
bool finite(const Camera& c) {
  return finite(c.target) && finite(c.distance) && finite(c.azimuth) && finite(c.elevation);
}

} // namespace

bool is_finite(const Mechanism& m) {
  const auto each = [](const auto& parts) {
    return std::ranges::all_of(parts, [](const auto& part) { return finite(part); });
  };
  return finite(m.gravity) && each(m.bodies) && each(m.joints) && each(m.forces) && each(m.sliders) &&
         finite(m.simulation.duration) && finite(m.camera);
}

} // namespace flyball
