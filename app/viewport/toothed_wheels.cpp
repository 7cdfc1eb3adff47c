#include "app/viewport/toothed_wheels.hpp"

#include "app/viewport/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace flyball {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// What turns about one coordinate of a gear (m, drawn pose).
struct Turning {
  int body = -1;
  Vec3 at, axis; // unit length, right-handed for the body's turn
};

std::optional<Turning> turning_by(const Assembly& assembly, const std::string& name) {
  const auto [j, i] = find_coordinate(assembly.mechanism, name);
  if (j < 0) return {};
  const Joint& joint = assembly.joint(j);
  const CoordinateAxis along = coordinate_axis(joint, static_cast<std::size_t>(i));
  const auto [parent, child] = assembly.joint_bodies[static_cast<std::size_t>(j)];
  if (!along.angle || (parent < 0 && child < 0)) return {};
  return Turning{child >= 0 ? child : parent, joint.at, child >= 0 ? along.axis : Vec3(-along.axis)};
}

// How far the body's shapes reach along an axis; without shapes, below everything.
double front_of(const Assembly& assembly, int body, const Vec3& at, const Vec3& axis) {
  const Bounds bounds = shape_bounds(assembly.mechanism.bodies[static_cast<std::size_t>(body)]);
  if (bounds.empty) return -std::numeric_limits<double>::infinity();
  return axis.dot(bounds.center() - at) + axis.cwiseAbs().dot(0.5 * (bounds.upper - bounds.lower));
}

// Turned by the angle of `steps` teeth.
Vec3 turned(const ToothedWheel& wheel, const Vec3& direction, double steps) {
  const double angle = two_pi * steps / wheel.teeth;
  return std::cos(angle) * direction + std::sin(angle) * wheel.axis.cross(direction);
}

// By how many teeth (less than one) a tooth of the wheel stands beyond the direction.
double teeth_beyond(const ToothedWheel& wheel, const Vec3& direction) {
  const double angle =
      std::atan2(wheel.axis.dot(direction.cross(wheel.to_tooth)), direction.dot(wheel.to_tooth));
  const double teeth = angle / two_pi * wheel.teeth;
  return teeth - std::floor(teeth);
}

class Meshing {
 public:
  explicit Meshing(const Assembly& assembly) : assembly_(assembly) {
    wheels_.resize(assembly.mechanism.joints.size());
    for (std::size_t j = 0; j < wheels_.size(); ++j)
      mesh(j);
  }
  std::vector<std::array<ToothedWheel, 2>> take() { return std::move(wheels_); }

 private:
  void mesh(std::size_t index) {
    const Joint& gear = assembly_.mechanism.joints[index];
    if (gear.type != JointType::gear || gear.kind != GearKind::gear) return;
    const auto a = turning_by(assembly_, gear.joints[0]), b = turning_by(assembly_, gear.joints[1]);
    const double q = std::abs(gear.ratio);
    if (!a || !b || !(q > 0) || !std::isfinite(q)) return;
    const Vec3 line = b->at - a->at, across = line - a->axis * a->axis.dot(line);
    const double distance = across.stableNorm(), parallel = a->axis.dot(b->axis);
    if (!(std::abs(parallel) > 0.999) || !(distance > 0.5 * assembly_.scale.unit)) return;
    const bool outside = gear.ratio * parallel < 0;
    const double sum = outside ? 1 + q : std::abs(1 - q);
    const double most = 20 * assembly_.scale.bounds.radius(); // a ring that big is no wheel
    if (!(distance * std::max(1.0, q) < most * sum)) return;
    const Vec3 out = across / distance;

    std::array<ToothedWheel, 2>& pair = wheels_[index];
    pair[0] = wheel(*a, a->axis, distance * q / sum, !outside && q > 1);
    pair[1] = wheel(*b, a->axis, distance / sum, !outside && q < 1);
    const std::array known{find(pair[0]), find(pair[1])};
    const double u = assembly_.scale.unit;
    const double front =
        std::max(front_of(assembly_, a->body, a->at, a->axis), front_of(assembly_, b->body, a->at, a->axis));
    double height = std::isfinite(front) ? front + 0.3 * u : 1.7 * u;
    for (const ToothedWheel* wheel : known)
      if (wheel) height = a->axis.dot(wheel->center - a->at);
    pair[0].center += height * a->axis;
    pair[1].center += a->axis * a->axis.dot(pair[0].center - b->at);
    take_teeth(pair, known, out, outside);
    for (const ToothedWheel& w : pair)
      if (w.is_first) known_.push_back(w);
  }

  ToothedWheel wheel(const Turning& turning, const Vec3& axis, double radius, bool inside) const {
    ToothedWheel wheel;
    wheel.body = turning.body;
    wheel.center = turning.at;
    wheel.axis = axis;
    wheel.radius = radius;
    wheel.inside = inside;
    return wheel;
  }

  // One that an earlier gear has, whatever turns with it.
  const ToothedWheel* find(const ToothedWheel& wheel) const {
    const auto same = [&](const ToothedWheel& other) {
      const Vec3 apart = other.center - wheel.center;
      return std::abs(other.radius - wheel.radius) < 1e-6 * wheel.radius && other.inside == wheel.inside &&
             std::abs(other.axis.dot(wheel.axis)) > 0.999 &&
             (apart - wheel.axis * wheel.axis.dot(apart)).norm() < 1e-3 * wheel.radius;
    };
    const auto found = std::ranges::find_if(known_, same);
    return found == known_.end() ? nullptr : &*found;
  }

  // The smaller wheel has the number, and from one of them the other takes where its teeth stand.
  void take_teeth(std::array<ToothedWheel, 2>& pair, const std::array<const ToothedWheel*, 2>& known,
                  const Vec3& out, bool outside) const {
    constexpr int fewest = 8, most = 160;
    const double pitch = 1.5 * assembly_.scale.unit;
    const auto teeth_of = [&](double count) {
      return static_cast<int>(std::lround(std::clamp<double>(count, fewest, most)));
    };
    const std::size_t first = known[0] ? 0 : known[1] ? 1 : pair[0].radius <= pair[1].radius ? 0 : 1;
    const std::size_t second = 1 - first;
    // Where they touch, seen from the centres: inside a ring both look from its centre to the pinion's.
    const Vec3 to_second = first == 0 ? out : Vec3(-out);
    const Vec3 contact = !outside && pair[second].inside ? Vec3(-to_second) : to_second;
    const Vec3 contact_second = outside ? Vec3(-contact) : contact;
    if (known[first]) {
      const double height = pair[first].axis.dot(pair[first].center - known[first]->center);
      pair[first] = *known[first];
      pair[first].center += height * pair[first].axis;
      pair[first].is_first = false;
    } else {
      pair[first].teeth = teeth_of(two_pi * pair[first].radius / pitch);
      pair[first].to_tooth = contact;
    }
    if (known[second]) {
      pair[second] = *known[second];
      pair[second].is_first = false;
      return;
    }
    pair[second].teeth = teeth_of(pair[first].teeth * pair[second].radius / pair[first].radius);
    // Beyond the contact by as many teeth as the first, which go round the other way outside; then half on.
    const double beyond = teeth_beyond(pair[first], contact);
    const double sense = (outside ? -1 : 1) * (pair[first].axis.dot(pair[second].axis) > 0 ? 1 : -1);
    pair[second].to_tooth = turned(pair[second], contact_second, sense * (beyond + 0.5));
  }

  const Assembly& assembly_;
  std::vector<std::array<ToothedWheel, 2>> wheels_;
  std::vector<ToothedWheel> known_;
};

} // namespace

std::vector<std::array<ToothedWheel, 2>> toothed_wheels(const Assembly& assembly) {
  return Meshing(assembly).take();
}

} // namespace flyball
