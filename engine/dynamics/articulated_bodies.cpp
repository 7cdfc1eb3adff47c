#include "engine/dynamics/articulated_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

ArticulatedBodies::ArticulatedBodies(const System& released, int free)
    : nodes_(released.links.size()), joints_(released, free) {
  for (std::size_t l = 0; l < nodes_.size(); ++l) {
    const int parent = released.links[l].parent;
    nodes_[l].parent = parent;
    if (parent < 0) continue;
    const auto p = static_cast<std::size_t>(parent);
    nodes_[l].holder = joints_.gives_way(p) ? parent : nodes_[p].holder;
  }
}

// What the node is felt as beyond its joint, about its own origin. Adds what that has taken off to the joint
// next to the root.
template <int N>
bool ArticulatedBodies::eliminate(const Node& n, Joint<N>& j, Mat6& left) {
  j.u.noalias() = n.inertia * j.s;
  const Eigen::Matrix<double, N, N> pivot = j.s.transpose() * j.u;
  double least = pivot(0, 0);
  if constexpr (N == 1) {
    j.inverse(0, 0) = 1 / least;
  } else {
    const Eigen::LLT<Eigen::Matrix<double, N, N>> factors(pivot);
    least = factors.matrixLLT().diagonal().cwiseAbs2().minCoeff();
    if (factors.info() != Eigen::Success) least = std::min(least, 0.);
    j.inverse = factors.solve(Eigen::Matrix<double, N, N>::Identity());
  }
  const bool angular = !j.s.col(0).template head<3>().isZero(0);
  const double size = angular ? n.inertia.topLeftCorner<3, 3>().trace() + n.turned
                              : n.inertia.bottomRightCorner<3, 3>().trace() + n.shifted;
  overflowed_ |= !std::isfinite(size);
  if (!(least > 0) || !std::isfinite(size)) return false;
  lightest_ = std::min(lightest_, least / size);
  const Eigen::Matrix<double, 6, N> answer = j.u * j.inverse;
  left.noalias() -= answer * j.u.transpose();
  if (n.holder < 0) return true;
  Node& holder = nodes_[static_cast<std::size_t>(n.holder)];
  for (int c = 0; c < N; ++c) {
    const Vec6 u = about(j.u.col(c), n.reach), x = about(answer.col(c), n.reach);
    holder.turned += u.head<3>().dot(x.head<3>());
    holder.shifted += u.tail<3>().dot(x.tail<3>());
  }
  return true;
}

bool ArticulatedBodies::factor(const Parameters& p, const Kinematics<double>& k) {
  for (std::size_t l = 0; l < nodes_.size(); ++l) {
    Node& n = nodes_[l];
    BodyInertia body;
    set_body_inertia(p, l, k, body);
    body.turning = 0;
    n.inertia = inertia_matrix(body);
    n.turned = n.shifted = 0;
    n.arm = k.links[l].o - k.at(n.parent).o;
    n.reach = k.links[l].o - k.at(n.holder).o;
    joints_.visit(l, [&]<int N>(int v, Joint<N>& j) {
      for (int c = 0; c < N; ++c) {
        const Column<double>& column = k.columns[static_cast<std::size_t>(v + c)];
        j.s.col(c).setZero();
        j.s.col(c).template segment<3>(column.angular ? 0 : 3) = column.axis;
      }
    });
  }
  lightest_ = std::numeric_limits<double>::infinity();
  overflowed_ = false;
  bool positive = true;
  for (std::size_t l = nodes_.size(); l-- > 0 && positive;) {
    Node& n = nodes_[l];
    Mat6 left = n.inertia;
    joints_.visit(l, [&](int, auto& joint) { positive = eliminate(n, joint, left); });
    if (n.parent < 0) continue;
    const Mat3 arm = skew(n.arm);
    left.topRows<3>() += arm * left.bottomRows<3>();
    left.leftCols<3>() -= left.rightCols<3>() * arm;
    nodes_[static_cast<std::size_t>(n.parent)].inertia += left;
  }
  return positive;
}

void ArticulatedBodies::solve(std::vector<Vec6>& wrenches, const Eigen::VectorXd& force, Eigen::VectorXd& a) {
  for (std::size_t l = nodes_.size(); l-- > 0;) {
    Node& n = nodes_[l];
    Vec6 felt = wrenches[l];
    joints_.visit(l, [&]<int N>(int v, Joint<N>& j) {
      j.e = -(j.inverse * (force.segment<N>(v) + j.s.transpose() * felt));
      felt += j.u * j.e;
    });
    if (n.parent >= 0) wrenches[static_cast<std::size_t>(n.parent)] += about(felt, n.arm);
  }
  for (std::size_t l = 0; l < nodes_.size(); ++l) {
    Node& n = nodes_[l];
    n.motion.setZero();
    if (n.parent >= 0) n.motion = carried(nodes_[static_cast<std::size_t>(n.parent)].motion, n.arm);
    joints_.visit(l, [&]<int N>(int v, const Joint<N>& j) {
      const Eigen::Matrix<double, N, 1> own = j.e - j.inverse * (j.u.transpose() * n.motion);
      a.segment<N>(v) = own;
      n.motion += j.s * own;
    });
  }
}

Vec6 ArticulatedBodies::transmitted(std::size_t link, const std::vector<Vec6>& wrenches) const {
  return nodes_[link].inertia * nodes_[link].motion + wrenches[link];
}

} // namespace flyball
