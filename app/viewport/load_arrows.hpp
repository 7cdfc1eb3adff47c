// Loads as arrows, forces with one head and moments with two, and how long an arrow is. No OpenGL.
#pragma once

#include "app/viewport/loads.hpp"
#include "app/viewport/sketch.hpp"

#include <array>

namespace flyball {

// How lengths of arrows tell sizes.
//   Of a mechanism: each kind has a scale of its own, and lengths grow with the cube root, as the loads of
//   a mechanism often differ by orders of magnitude (a shaft's weight in its bearing, a ball's inertial
//   load). Of one body: in proportion and all to one scale, so that the arrows of its free-body diagram add
//   up.
class LoadScales {
 public:
  LoadScales() = default;
  LoadScales(const std::vector<Load>& loads, bool in_proportion, double longest);

  // m; zero for what is rounding beside the other loads.
  double length(LoadKind kind, bool moment, double size) const;
  double length(const Load& load) const { return length(load.kind, load.moment, load.vector.stableNorm()); }
  // The size (N, N m) of the kind that an arrow as long as that (m) stands for.
  double size(LoadKind kind, bool moment, double length) const;
  // The largest of its kind; zero where there is none, or it is rounding.
  double largest(LoadKind kind, bool moment) const { return of(largest_, kind, moment); }
  bool in_proportion() const { return in_proportion_; }

 private:
  using Sizes = std::array<std::array<double, 2>, load_kinds>;
  static double of(const Sizes& sizes, LoadKind kind, bool moment) {
    return sizes[static_cast<std::size_t>(kind)][moment ? 1 : 0];
  }
  Sizes largest_{}, full_{}; // full: what the longest arrow stands for
  bool in_proportion_ = false;
  double longest_ = 0; // m
};

LoadScales load_scales(const Assembly& assembly, const std::vector<Load>& loads, bool in_proportion);

struct LoadArrow {
  std::size_t load = 0; // in the list of loads
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};
struct LoadArrows {
  LoadScales scales;
  std::vector<LoadArrow> arrows;
  std::vector<Instance> solids;
  std::vector<std::size_t> arrow_of; // by solid
};
// An arrow shorter than its head is drawn as the head. Moments stand beside their point, clear of forces; of
// a mechanism (not in proportion) so do forces along links and slides, clear of these.
LoadArrows load_arrows(const Assembly& assembly, const std::vector<Load>& loads, const LoadScales& scales,
                       const Palette& colors);

Color load_color(LoadKind kind, const Palette& colors);

} // namespace flyball
