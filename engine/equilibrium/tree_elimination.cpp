#include "engine/equilibrium/tree_elimination.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace flyball {
namespace {

// Adds a stiffness about the child's origin to one about the parent's, `r` away.
void add_shifted(const Mat6& h, const Vec3& r, bool symmetric, Mat6& out) {
  const Mat3 rx = skew(r), e = h.bottomRightCorner<3, 3>();
  const Mat3 b = h.topRightCorner<3, 3>() + rx * e;
  const Mat3 c = symmetric ? Mat3(b.transpose()) : Mat3(h.bottomLeftCorner<3, 3>() - e * rx);
  out.topLeftCorner<3, 3>() += h.topLeftCorner<3, 3>() - h.topRightCorner<3, 3>() * rx + rx * c;
  out.topRightCorner<3, 3>() += b;
  out.bottomLeftCorner<3, 3>() += c;
  out.bottomRightCorner<3, 3>() += e;
}

Eliminator::Flat way(int v, const Vec3& direction) {
  return {{v, direction[0]}, {v + 1, direction[1]}, {v + 2, direction[2]}};
}

} // namespace

void TreeElimination::set_joint(const Problem& problem, std::size_t l, const Eigen::VectorXd& q,
                                const Kinematics<double>& k, const Magnitudes& magnitudes) {
  const Link& link = problem.system.links[l];
  const LinkParameters& lp = problem.parameters.links[l];
  Node& n = nodes_[static_cast<std::size_t>(node_of_link_[l])];
  for (int c = 0; c < n.columns; ++c) {
    const Column<double>& column = k.columns[static_cast<std::size_t>(n.v + c)];
    const double unit = problem.scaling.column[n.v + c];
    n.s.col(c).setZero();
    if (column.angular)
      n.s.col(c).head<3>() = unit * column.axis;
    else
      n.s.col(c).tail<3>() = unit * column.axis;
    const double size = column.angular ? n.size_m : n.size_f * unit * unit;
    n.noise[c] = std::max(zero * size, rounding * magnitudes.force[n.v + c] * unit);
    n.metric[c] = own_share * (column.angular ? n.heavy_m : n.heavy_f * unit * unit);
  }
  if (n.columns == 1)
    n.joint(0, 0) = lp.elastic ? lp.force[0].curvature(q[link.q]) * problem.scaling.column[n.v] *
                                     problem.scaling.column[n.v]
                               : 0;
  else if (n.columns == 3)
    n.joint = lp.elastic ? rotation_stiffness(link, lp, q) : Mat3(Mat3::Zero());
}

void TreeElimination::linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                const Residual<double>& residual, const Magnitudes& magnitudes) {
  const System& system = problem.system;
  symmetric_ = problem.symmetric();
  size_ = system.nv;
  node_of_link_.resize(system.links.size());
  std::size_t count = 0;
  for (std::size_t l = 0; l < system.links.size(); ++l)
    node_of_link_[l] = system.links[l].mobile ? static_cast<int>(count++) : -1;
  nodes_.resize(count);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    if (node_of_link_[l] < 0) continue;
    const Link& link = system.links[l];
    Node& n = nodes_[static_cast<std::size_t>(node_of_link_[l])];
    n.parent = link.parent < 0 ? -1 : node_of_link_[static_cast<std::size_t>(link.parent)];
    n.v = link.v;
    n.columns = link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
    n.arm = k.links[l].o - k.at(link.parent).o;
    n.force = residual.force[l];
    n.moment = residual.moment[l];
    set_body_stiffness(problem.parameters, l, k, n);
    n.heavy_m = n.inertia.norm() + n.turning;
    n.heavy_mf = n.first_moment.norm();
    n.heavy_f = n.mass;
  }
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceElement& e = system.body_forces[i];
    const int at = e.link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(e.link)];
    if (at >= 0)
      add_body_force(e, problem.parameters.body_forces[i], k, nodes_[static_cast<std::size_t>(at)].own);
  }
  mass_ = 0;
  for (Node& n : nodes_) {
    if (symmetric_) n.own = 0.5 * (n.own + n.own.transpose()).eval();
    n.size_m = n.own.topLeftCorner<3, 3>().norm();
    n.size_mf = n.own.topRightCorner<3, 3>().norm() + n.own.bottomLeftCorner<3, 3>().norm();
    n.size_f = n.own.bottomRightCorner<3, 3>().norm();
    mass_ += n.mass;
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    if (n.parent < 0) continue;
    Node& p = nodes_[static_cast<std::size_t>(n.parent)];
    const double r = n.arm.norm();
    p.size_m += n.size_m + r * n.size_mf + r * r * n.size_f;
    p.size_mf += n.size_mf + 2 * r * n.size_f;
    p.size_f += n.size_f;
    p.heavy_m += n.heavy_m + 2 * r * n.heavy_mf + r * r * n.heavy_f;
    p.heavy_mf += n.heavy_mf + r * n.heavy_f;
    p.heavy_f += n.heavy_f;
  }
  const double least =
      own_share * own_share * std::max(mass_, 1e-300) * problem.parameters.length * problem.parameters.length;
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    if (node_of_link_[l] < 0) continue;
    set_joint(problem, l, z.q, k, magnitudes);
    // What has no mass of its own to speak of would be free to go anywhere.
    Node& n = nodes_[static_cast<std::size_t>(node_of_link_[l])];
    for (int c = 0; c < n.columns; ++c)
      if (n.metric[c] == 0) n.metric[c] = least;
  }
}

void TreeElimination::eliminate_one(Node& n, double shift) {
  const Vec6 s = n.s.col(0);
  Vec6 u = n.h * s;
  const double pivot = s.dot(u) + n.joint(0, 0) + shift * n.metric[0];
  const Vec6 turn = turned(s, n.moment, n.force);
  if (symmetric_)
    u += 0.5 * turn;
  else {
    n.r.col(0) = n.h.transpose() * s;
    u += turn;
  }
  n.u.col(0) = u;
  if (!(std::abs(pivot) > n.noise[0])) {
    n.inverse(0, 0) = 0;
    flat_.push_back({{n.v, 1.}});
    return;
  }
  n.inverse(0, 0) = 1 / pivot;
  if (pivot < 0) ++negative_;
  const Vec6 scaled = u / pivot;
  n.h.noalias() -= scaled * (symmetric_ ? u : Vec6(n.r.col(0))).transpose();
}

void TreeElimination::eliminate_three(Node& n, double shift) {
  n.u = n.h * n.s;
  Mat3 pivot = n.s.transpose() * n.u + n.joint;
  pivot.diagonal() += shift * n.metric;
  for (int c = 0; c < 3; ++c) {
    const Vec6 turn = turned(n.s.col(c), n.moment, n.force);
    if (symmetric_) {
      n.u.col(c) += 0.5 * turn;
      continue;
    }
    n.u.col(c) += turn;
    for (int d = 0; d < 3; ++d)
      pivot(d, c) += n.s.col(d).dot(turn);
  }
  if (!symmetric_) n.r = n.h.transpose() * n.s;
  const double noise = n.noise.maxCoeff();
  if (symmetric_) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(Mat3(0.5 * (pivot + pivot.transpose())));
    Vec3 inverse;
    for (int c = 0; c < 3; ++c) {
      const double value = eigen.eigenvalues()[c];
      const bool flat = !(std::abs(value) > noise);
      inverse[c] = flat ? 0 : 1 / value;
      if (flat) flat_.push_back(way(n.v, eigen.eigenvectors().col(c)));
      if (!flat && value < 0) ++negative_;
    }
    n.inverse = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
    n.h.noalias() -= n.u * n.inverse * n.u.transpose();
    return;
  }
  const Eigen::JacobiSVD<Mat3> svd(pivot, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 inverse;
  for (int c = 0; c < 3; ++c) {
    const bool flat = !(svd.singularValues()[c] > noise);
    inverse[c] = flat ? 0 : 1 / svd.singularValues()[c];
    if (flat) flat_.push_back(way(n.v, svd.matrixV().col(c)));
  }
  n.inverse = svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose();
  n.h.noalias() -= n.u * n.inverse * n.r.transpose();
}

void TreeElimination::factor(double shift) {
  shift_ = shift;
  flat_.clear();
  negative_ = 0;
  for (Node& n : nodes_) {
    n.h = n.own;
    if (shift != 0 && !n.massless()) n.h += shift * inertia_matrix(n);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    if (n.columns == 1)
      eliminate_one(n, shift);
    else if (n.columns == 3)
      eliminate_three(n, shift);
    if (n.parent >= 0) add_shifted(n.h, n.arm, symmetric_, nodes_[static_cast<std::size_t>(n.parent)].h);
  }
}

void TreeElimination::solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd&, Eigen::VectorXd& x,
                            Eigen::VectorXd& lambda) {
  lambda.resize(0);
  x.resize(rhs.size());
  for (Node& n : nodes_)
    n.g.setZero();
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    if (n.columns == 1) {
      n.e[0] = n.inverse(0, 0) * (rhs[n.v] - n.s.col(0).dot(n.g));
      n.g += n.u.col(0) * n.e[0];
    } else if (n.columns == 3) {
      n.e = n.inverse * (rhs.segment<3>(n.v) - n.s.transpose() * n.g);
      n.g += n.u * n.e;
    }
    if (n.parent >= 0) add_wrench(n.g, n.arm, nodes_[static_cast<std::size_t>(n.parent)].g);
  }
  outwards(x);
}

// From n.e, what each coordinate would do were its parent held, to the motion of all.
void TreeElimination::outwards(Eigen::VectorXd& x) {
  for (Node& n : nodes_) {
    if (n.parent >= 0) {
      n.motion = carried(nodes_[static_cast<std::size_t>(n.parent)].motion, n.arm);
      const Mat63& r = symmetric_ ? n.u : n.r;
      if (n.columns == 1)
        n.e[0] -= n.inverse(0, 0) * r.col(0).dot(n.motion);
      else if (n.columns == 3)
        n.e -= n.inverse * (r.transpose() * n.motion);
    } else {
      n.motion.setZero();
    }
    if (n.columns == 1) {
      x[n.v] = n.e[0];
      n.motion += n.s.col(0) * n.e[0];
    } else if (n.columns == 3) {
      x.segment<3>(n.v) = n.e;
      n.motion += n.s * n.e;
    }
  }
}

void TreeElimination::direction_of(const Flat& flat, Eigen::VectorXd& x) {
  x.setZero(size_);
  for (Node& n : nodes_) {
    n.e.setZero();
    for (const auto& [v, share] : flat)
      if (n.columns > 0 && v >= n.v && v < n.v + n.columns) n.e[v - n.v] = share;
  }
  outwards(x);
}

double TreeElimination::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  product.resize(x.size());
  double square = 0;
  for (Node& n : nodes_) {
    n.motion.setZero();
    if (n.parent >= 0) n.motion = carried(nodes_[static_cast<std::size_t>(n.parent)].motion, n.arm);
    for (int c = 0; c < n.columns; ++c) {
      n.motion += n.s.col(c) * x[n.v + c];
      product[n.v + c] = n.metric[c] * x[n.v + c];
      square += product[n.v + c] * x[n.v + c];
    }
    n.g = times_inertia(n, n.motion);
    square += n.motion.dot(n.g);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    for (int c = 0; c < n.columns; ++c)
      product[n.v + c] += n.s.col(c).dot(n.g);
    if (n.parent >= 0) add_wrench(n.g, n.arm, nodes_[static_cast<std::size_t>(n.parent)].g);
  }
  return square;
}

} // namespace flyball
