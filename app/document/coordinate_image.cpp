#include "app/document/coordinate_image.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flyball {
namespace {

// How the components along the world's axes of a translation or a rotation vector change.
Mat3 change_of_components(JointType type, std::size_t first, const Isometry& isometry) {
  return is_angle(type, static_cast<int>(first)) ? Mat3(isometry.sense() * isometry.linear) : isometry.linear;
}

// The first coordinates of each triple of components.
std::vector<std::size_t> triples(JointType type) {
  if (type == JointType::spherical) return {0};
  if (type == JointType::free) return {0, 3};
  return {};
}

void add_triple(std::vector<CoordinateImage>& all, const Mat3& change) {
  // By the sine of the angle between: what is off by a little is mixed by as little.
  constexpr double along = 1e-11;
  const std::size_t first = all.size();
  std::array<bool, 3> taken{};
  std::array<int, 3> targets{-1, -1, -1};
  for (int from = 0; from < 3; ++from)
    for (int to = 0; to < 3; ++to)
      if ((change.col(from).cwiseAbs() - Vec3::Unit(to)).norm() < along &&
          !taken[static_cast<std::size_t>(to)]) {
        targets[static_cast<std::size_t>(from)] = to;
        taken[static_cast<std::size_t>(to)] = true;
      }
  for (std::size_t from = 0; from < 3; ++from) {
    if (const int to = targets[from]; to >= 0) {
      all.push_back(
          {first + static_cast<std::size_t>(to), change(to, static_cast<int>(from)) < 0 ? -1.0 : 1.0, false});
      continue;
    }
    const auto free = static_cast<std::size_t>(std::ranges::find(taken, false) - taken.begin());
    taken[free] = true;
    all.push_back({first + free, 1, true});
  }
}

Coordinate with_sign(Coordinate c, double sign) {
  if (sign > 0) return c;
  c.drawn = 0.0 - c.drawn;
  if (c.spring) c.spring->free = 0.0 - c.spring->free;
  if (c.spring && c.spring->force) c.spring->force = 0.0 - *c.spring->force;
  if (c.friction) c.friction->share = 0.0 - c.friction->share;
  if (c.drive) {
    c.drive->speed = 0.0 - c.drive->speed;
    if (c.drive->torque) c.drive->torque = 0.0 - *c.drive->torque;
    if (c.drive->load) c.drive->load = 0.0 - *c.drive->load;
  }
  if (c.stop) {
    std::swap(c.stop->lower, c.stop->upper);
    for (std::optional<double>* bound : {&c.stop->lower, &c.stop->upper})
      if (*bound) *bound = 0.0 - **bound;
  }
  return c;
}

// The mixed coordinates of one triple, old and new.
class Mixture {
 public:
  Mixture(const std::vector<Coordinate>& before, std::vector<Coordinate>& after,
          const std::vector<CoordinateImage>& images, std::size_t first, const Mat3& change)
      : before_(before), after_(after), first_(first), change_(change) {
    for (std::size_t i = first; i < first + 3; ++i)
      if (images[i].mixed) {
        from_.push_back(i);
        to_.push_back(images[i].index);
      }
  }

  void mix() {
    if (from_.empty()) return;
    change([](Coordinate& c) { return &c.drawn; });
    const bool alike = std::ranges::all_of(from_, [&](std::size_t i) {
      const auto &spring = before_[i].spring, &other = before_[from_[0]].spring;
      return spring && other && spring->stiffness == other->stiffness && !spring->force && !other->force;
    });
    if (alike) change([](Coordinate& c) { return &c.spring->free; });
    for (std::size_t k = 0; k < from_.size(); ++k)
      keep_distance(after_[to_[k]], after_[to_[k]].drawn - before_[from_[k]].drawn, !alike);
    if (std::ranges::all_of(from_, [&](std::size_t i) { return before_[i].drive.has_value(); }))
      change([](Coordinate& c) { return &c.drive->speed; });
  }

 private:
  template <class Number>
  void change(Number number) {
    for (const std::size_t to : to_) {
      double sum = 0;
      for (const std::size_t from : from_) {
        Coordinate old = before_[from];
        sum += change_(static_cast<int>(to - first_), static_cast<int>(from - first_)) * *number(old);
      }
      *number(after_[to]) = sum + 0.0;
    }
  }

  static void keep_distance(Coordinate& c, double label_moved, bool spring_too) {
    if (spring_too && c.spring) c.spring->free += label_moved;
    if (!c.stop) return;
    for (std::optional<double>* bound : {&c.stop->lower, &c.stop->upper})
      if (*bound) **bound += label_moved;
  }

  const std::vector<Coordinate>& before_;
  std::vector<Coordinate>& after_;
  std::size_t first_;
  const Mat3& change_;
  std::vector<std::size_t> from_, to_;
};

} // namespace

std::vector<CoordinateImage> images_of_coordinates(JointType type, const Isometry& isometry) {
  std::vector<CoordinateImage> all;
  for (const std::size_t first : triples(type))
    add_triple(all, change_of_components(type, first, isometry));
  const auto count = static_cast<std::size_t>(coordinate_count(type));
  for (std::size_t i = all.size(); i < count; ++i)
    all.push_back({i, type == JointType::cylindrical && i == 0 ? isometry.sense() : 1, false});
  return all;
}

std::vector<Coordinate> image_of(const std::vector<Coordinate>& coordinates, JointType type,
                                 const Isometry& isometry) {
  const std::vector<CoordinateImage> images = images_of_coordinates(type, isometry);
  if (coordinates.size() != images.size()) return coordinates;
  std::vector<Coordinate> after(coordinates.size());
  for (std::size_t i = 0; i < images.size(); ++i)
    after[images[i].index] = with_sign(coordinates[i], images[i].sign);
  for (const std::size_t first : triples(type)) {
    const Mat3 change = change_of_components(type, first, isometry);
    Mixture(coordinates, after, images, first, change).mix();
  }
  return after;
}

} // namespace flyball
