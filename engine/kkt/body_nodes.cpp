#include "engine/kkt/body_nodes.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Of a free body's directions, as a rule three along axes and three about them.
Mat6 inverse_transposed(const Mat6& s) {
  const Mat6 gram = s.transpose() * s;
  const Eigen::Matrix<double, 6, 1> squares = gram.diagonal();
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < j; ++i)
      if (gram(i, j) * gram(i, j) > 1e-31 * squares[i] * squares[j]) return s.transpose().inverse();
  return s * squares.cwiseInverse().asDiagonal();
}

} // namespace

// Massless links of a joint belong to the one link that they carry.
void BodyNodes::join_links(const System& system) {
  const std::size_t count = system.links.size();
  children_.assign(count, 0);
  next_.assign(count, -1);
  for (const Link& link : system.links)
    if (link.parent >= 0) ++children_[static_cast<std::size_t>(link.parent)];
  for (std::size_t l = 0; l < count; ++l) {
    const int p = system.links[l].parent;
    if (p < 0) continue;
    const Link& parent = system.links[static_cast<std::size_t>(p)];
    if (parent.mobile && parent.body < 0 && parent.tree_joint == system.links[l].tree_joint &&
        children_[static_cast<std::size_t>(p)] == 1)
      next_[static_cast<std::size_t>(p)] = static_cast<int>(l);
  }
}

void BodyNodes::lay_out(const Problem& problem) {
  const System& system = problem.system;
  const std::size_t count = system.links.size();
  length_ = problem.parameters.length;
  join_links(system);
  node_of_link_.assign(count, -1);
  place_.resize(static_cast<std::size_t>(system.nv));
  std::size_t bodies = 0;
  for (std::size_t l = 0; l < count; ++l)
    bodies += system.links[l].mobile && next_[l] < 0;
  nodes_.resize(bodies);
  std::size_t n = 0;
  for (std::size_t l = 0; l < count; ++l) {
    if (!system.links[l].mobile || next_[l] >= 0) continue;
    BodyNode& x = nodes_[n];
    node_of_link_[l] = static_cast<int>(n++);
    x.link = static_cast<int>(l);
    int head = x.link;
    const auto parent_of = [&](int i) { return system.links[static_cast<std::size_t>(i)].parent; };
    while (parent_of(head) >= 0 && next_[static_cast<std::size_t>(parent_of(head))] == head)
      head = parent_of(head);
    x.parent = at(parent_of(head));
    if (x.parent >= 0) nodes_[static_cast<std::size_t>(x.parent)].bears = true;
    x.bears = false;
    x.columns = 0;
    for (int i = head; i >= 0; i = i == x.link ? -1 : next_[static_cast<std::size_t>(i)]) {
      const Link& link = system.links[static_cast<std::size_t>(i)];
      if (link.v < 0) continue;
      for (int c = 0; c < (link.type == LinkType::spherical ? 3 : 1); ++c) {
        const auto column = static_cast<std::size_t>(x.columns);
        x.v[column] = link.v + c;
        x.stage[column] = i;
        place_[static_cast<std::size_t>(link.v + c)] = {static_cast<int>(n) - 1, x.columns++};
      }
    }
  }
  first_of_part_.clear();
  for (const SystemPart& part : system.division.parts)
    first_of_part_.push_back(
        static_cast<int>(std::ranges::lower_bound(nodes_, static_cast<int>(part.first), {}, &BodyNode::link) -
                         nodes_.begin()));
  first_of_part_.push_back(size());
}

void BodyNodes::place_node(int i, const Problem& problem, const Kinematics<double>& k) {
  BodyNode& x = nodes_[static_cast<std::size_t>(i)];
  const Vec3& o = k.links[static_cast<std::size_t>(x.link)].o;
  x.arm.setZero();
  if (x.parent >= 0)
    x.arm = o - k.links[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(x.parent)].link)].o;
  x.lever = x.arm / length_;
  x.s.setZero();
  for (int c = 0; c < x.columns; ++c) {
    const int v = x.v[static_cast<std::size_t>(c)];
    const Column<double>& column = k.columns[static_cast<std::size_t>(v)];
    const double unit = problem.scaling.column[v];
    x.s.col(c) << unit * column.turn(), unit / length_ * column.at(o);
  }
  if (x.columns == 6) {
    x.d = inverse_transposed(x.s);
    return;
  }
  x.d.setZero();
  if (x.columns == 0) return;
  const BodyColumns s = x.s.leftCols(x.columns);
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> gram = s.transpose() * s;
  x.d.leftCols(x.columns) = s * gram.inverse();
}

BodyColumns forbidden_motions(const BodyNode& x) {
  if (x.columns == 0) return Mat6::Identity();
  if (x.columns == 6) return BodyColumns(6, 0);
  const BodyColumns s = x.s.leftCols(x.columns);
  const Mat6 q = spatial_completion(s);
  return q.rightCols(6 - x.columns);
}

} // namespace flyball
