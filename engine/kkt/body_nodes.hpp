// The moving bodies of a mechanism as nodes of a graph: what each hangs from, and the directions that the
// tree joint between them leaves free and fixed.
//
// Motions are (turn, shift of the link's origin), wrenches (moment about that origin, force), world axes.
// Both are scaled to units of energy: turns in radians, shifts in the mechanism's reach.
#pragma once

#include "engine/kkt/body_stiffness.hpp"

#include <array>
#include <utility>
#include <vector>

namespace flyball {

// At most six directions of a body's motion, and what acts among them.
using BodyColumns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;

// A link with the massless ones of its tree joint before it. Scaled but where units are given.
struct BodyNode : BodyInertia {
  int parent = -1; // node; -1: stands still
  int link = -1;
  int columns = 0;
  int multipliers = 0;             // first of those of its joint among the unknowns (body_equations.hpp)
  std::array<int, 6> v{}, stage{}; // coordinates, the root's first, and the link of each
  bool bears = false;              // other nodes hang from it
  Vec3 arm, lever;                 // from the parent's origin to this one's: m; scaled
  // Motion by a unit of each coordinate; D^T S = I: what of a motion between parent and body is in
  // coordinates. Zero beyond their columns.
  Mat6 s, d;
  Vec6 weight; // metric of the coordinates themselves, zero beyond them
};

// What a joint forbids, orthonormal: N^T S = 0.
BodyColumns forbidden_motions(const BodyNode& node);

class BodyNodes {
 public:
  // Numbers the nodes, and what is joined to what.
  void lay_out(const Problem& problem);

  // Where a node is and moves; its parent first. Kinematics at the problem's state.
  void place_node(int i, const Problem& problem, const Kinematics<double>& kinematics);

  // The first node of each part of the system, and the count of all.
  const std::vector<int>& first_of_part() const { return first_of_part_; }

  // Calls work(i) for every node, parents before children, parts of the system side by side.
  template <class Work>
  void for_each(const Work& work) const {
    side_by_side(first_of_part_.size() - 1, [&](std::size_t part) {
      for (int i = first_of_part_[part]; i < first_of_part_[part + 1]; ++i)
        work(i);
    });
  }

  int size() const { return static_cast<int>(nodes_.size()); }
  BodyNode& operator[](int i) { return nodes_[static_cast<std::size_t>(i)]; }
  const BodyNode& operator[](int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  auto begin() { return nodes_.begin(); } // parents before children
  auto end() { return nodes_.end(); }
  auto begin() const { return nodes_.begin(); }
  auto end() const { return nodes_.end(); }

  // The node of a link that carries a body. -1: it stands still.
  int at(int link) const { return link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(link)]; }

  // The node and the column of a coordinate.
  std::pair<int, int> place(int coordinate) const { return place_[static_cast<std::size_t>(coordinate)]; }

  double length() const { return length_; } // m, the mechanism's reach

  // A map of motions (rad, m) to wrenches (N m, N) in units of energy, and back.
  Mat6 scaled(const Mat6& m) const { return in_units(m, length_); }
  Mat6 unscaled(const Mat6& m) const { return in_units(m, 1 / length_); }

 private:
  static Mat6 in_units(const Mat6& m, double length) {
    Mat6 x = m;
    x.rightCols<3>() *= length;
    x.bottomRows<3>() *= length;
    return x;
  }
  void join_links(const System& system);
  double length_ = 1;
  std::vector<BodyNode> nodes_;
  std::vector<int> first_of_part_;
  std::vector<int> node_of_link_; // -1: stands still, or part of a later link's node
  std::vector<int> next_;         // by link: what it is part of a node with
  std::vector<int> children_;
  std::vector<std::pair<int, int>> place_;
};

} // namespace flyball
