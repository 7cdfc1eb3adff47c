#include "app/viewport/level_of_detail.hpp"

#include "app/viewport/primitives.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

// Radius in pixels up to which each detail but the finest will do: a polygon of n sides round a circle is at
// most r (1 - cos(pi / n)) from it, and that of the circle's area half of it.
constexpr std::array enough_up_to{0.5, 1.3, 2.6, 5.0, 9.0, 36.0};
constexpr double least = 0.5;   // pixels, radius of the smallest thing drawn
constexpr double most_thin = 8; // at least one of 2 to this power of bodies is drawn

int detail_for(double pixels) {
  const auto found = std::ranges::lower_bound(enough_up_to, pixels);
  return static_cast<int>(found - enough_up_to.begin());
}

// The radius (m) of what is round about an instance.
double round_part(const Instance& instance) {
  switch (instance.primitive) {
  case Primitive::sphere:
  case Primitive::capsule:
  case Primitive::box: return instance.round; // a box has round edges only
  default: return instance.extent.x() + instance.round;
  }
}

bool is_coil(Primitive primitive) {
  return primitive == Primitive::coil || primitive == Primitive::open_coil;
}

// Turns are told apart from a radius of 1.5 pixels on; wire is straight up to 2.6.
int detail_of_coil(double pixels, double flat) {
  if (pixels < 1.5) return 0;
  if (pixels > flat) return std::max(detail_for(pixels), last_flat_detail + 1);
  return pixels < 2.6 ? 1 : 2;
}

// Half the width of the line that takes as much of the picture as a coil's wire, m.
double strip_of_coil(const Instance& coil) {
  const double radius = coil.extent.x(), length = coil.extent.z();
  const double wire = 2 * coil_turns * std::hypot(2 * radius, length / (2 * coil_turns));
  return std::min(0.65 * radius + coil.round, coil.round * wire / length);
}

// About its axis to the eye; nothing where it is seen end on.
std::optional<Quat> turned_to(const Quat& rotation, const Vec3& to_eye) {
  const Vec3 z = rotation * Vec3::UnitZ();
  const double along = z.dot(to_eye), square = to_eye.squaredNorm();
  if (along * along > 0.9 * square) return std::nullopt;
  Mat3 frame;
  frame.col(2) = z;
  frame.col(1) = (to_eye - along * z).normalized();
  frame.col(0) = frame.col(1).cross(z);
  return Quat(frame);
}

bool is_detail(Role role) {
  return role != Role::body && role != Role::link;
}

} // namespace

Quat Sight::facing() const {
  Mat3 frame;
  frame << right, up, backward;
  return Quat(frame);
}

Sight sight_of(const ViewCamera& camera, ViewSize view) {
  Sight sight;
  sight.eye = camera.eye();
  sight.right = camera.right();
  sight.up = camera.screen_up();
  sight.backward = camera.backward();
  sight.parallel = camera.orthographic;
  sight.pixel = camera.pixel_size(view) / (camera.orthographic ? 1 : camera.distance);
  sight.half_width = 0.5 * sight.pixel * view.width;
  sight.half_height = 0.5 * sight.pixel * view.height;
  sight.nearest = 0.005 * camera.distance;
  return sight;
}

std::optional<SeenSolid> see(const Instance& instance, const Sight& sight, const Quat& facing, bool thinned) {
  const Vec3 away = instance.position - sight.eye;
  const double reach = instance.extent.norm() + instance.round;
  const double ahead = -away.dot(sight.backward);
  double metres = 1; // the scale of the view where the instance is, at its largest
  double slant_x = 1, slant_y = 1;
  if (!sight.parallel) {
    if (ahead + reach < sight.nearest) return std::nullopt;
    metres = std::max(ahead - reach, sight.nearest);
    slant_x = std::hypot(1, sight.half_width);
    slant_y = std::hypot(1, sight.half_height);
  }
  const double deep = sight.parallel ? 1 : ahead;
  if (std::abs(away.dot(sight.right)) > sight.half_width * deep + reach * slant_x ||
      std::abs(away.dot(sight.up)) > sight.half_height * deep + reach * slant_y)
    return std::nullopt;

  const double pixel = sight.pixel * metres;
  const double size = reach / pixel;
  SeenSolid seen{instance.primitive, 0, 1, instance.round, instance.rotation};
  if (size < least) {
    if (thinned && is_detail(instance.role)) return std::nullopt;
    // A link may be two rods, so that those kept are half as far apart as they are large.
    const double every =
        std::exp2(std::clamp(std::floor(std::log2(0.5 * least / std::max(size, 1e-9))), 0.0, most_thin));
    if (thinned && (instance.part.index & (static_cast<int>(every) - 1)) != 0) return std::nullopt;
    seen.grow = least / std::max(size, 1e-9);
  } else {
    const double radius = round_part(instance) / pixel;
    seen.detail = is_coil(instance.primitive) ? detail_of_coil(radius, sight.flat_coil) : detail_for(radius);
  }
  // Of what is flat or sharp the size tells.
  if (instance.primitive == Primitive::box)
    seen.detail = std::max(seen.detail, size < 3 ? 1 : last_flat_detail + 1);
  if (!is_detail(instance.role) && instance.primitive == Primitive::capsule)
    seen.round = std::max(seen.round, sight.thinnest * pixel / seen.grow);
  if (!thinned) seen.detail = std::max(seen.detail, last_flat_detail + 1);
  if (!is_flat(instance.primitive, seen.detail)) return seen;
  seen.rotation = facing;
  if (instance.primitive == Primitive::sphere) return seen;
  const bool coil = is_coil(instance.primitive);
  const auto turned = turned_to(instance.rotation, sight.parallel ? sight.backward : Vec3(-away));
  if (turned) {
    seen.rotation = *turned;
    if (coil && seen.detail == 0) seen.round = std::max(strip_of_coil(instance), sight.thinnest * pixel);
  } else if (coil) { // a disc, seen along its axis
    seen.primitive = Primitive::sphere;
    seen.round = round_part(instance);
  } else {
    seen = {instance.primitive, last_flat_detail + 1, seen.grow, seen.round, instance.rotation};
  }
  return seen;
}

} // namespace flyball
