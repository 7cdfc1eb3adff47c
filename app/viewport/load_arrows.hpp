// Loads as arrows, forces with one head and moments with two, and how long an arrow is. No OpenGL.
#pragma once

#include "app/viewport/loads.hpp"
#include "app/viewport/sketch.hpp"

#include <array>
#include <optional>

namespace flyball {

enum class LoadLengths { in_proportion, by_cube_root };

// How lengths of arrows tell sizes: all forces to one scale, and all moments to one. In proportion polygons
// of forces can be read off; the cube root shows small ones beside large ones (a ball's inertial load beside
// a shaft's weight in its bearing).
class LoadScales {
 public:
  LoadScales() = default;
  LoadScales(const std::vector<Load>& loads, LoadLengths lengths, double longest);

  // Makes the longest arrow stand for at least that much (N, N m), as at other moments of a motion.
  void leave_room(bool moment, double size);

  // m; zero for what is rounding beside the other loads.
  double length(bool moment, double size) const;
  double length(const Load& load) const;
  // The size (N, N m) that an arrow as long as that (m) stands for; zero where there are none.
  double size(bool moment, double length) const;
  // The largest of its kind; zero where there is none, or it is rounding.
  double largest(LoadKind kind, bool moment) const {
    return largest_[static_cast<std::size_t>(kind)][moment ? 1 : 0];
  }
  LoadLengths lengths() const { return lengths_; }

 private:
  std::array<std::array<double, 2>, load_kinds> largest_{};
  std::array<double, 2> full_{}; // what the longest arrow stands for, a force and a moment
  LoadLengths lengths_ = LoadLengths::in_proportion;
  double longest_ = 0; // m
};

// Without a choice of lengths: in proportion where at least half of the arrows are long enough to be seen so,
// else by the cube root.
LoadScales load_scales(const Assembly& assembly, const std::vector<Load>& loads,
                       std::optional<LoadLengths> lengths);

struct LoadArrow {
  std::size_t load = 0; // in the list of loads
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};
struct LoadArrows {
  LoadScales scales;
  std::vector<LoadArrow> arrows;
  std::vector<Instance> solids;
  std::vector<std::size_t> arrow_of; // by solid
  // Forces and moments that would be too short to be seen, and what an arrow (N, N m) has to be to be drawn.
  std::array<int, 2> left_out{};
  std::array<double, 2> least{};
};
// Short arrows have smaller heads. Moments stand beside their point, clear of forces; of a mechanism so do
// forces along links and slides, clear of these. Of a body's diagram, and by the cube root, nothing is left
// out: what is too short to be seen is as long as can be seen.
LoadArrows load_arrows(const Assembly& assembly, const std::vector<Load>& loads, const LoadScales& scales,
                       const Palette& colors, bool diagram);

Color load_color(LoadKind kind, const Palette& colors);

} // namespace flyball
