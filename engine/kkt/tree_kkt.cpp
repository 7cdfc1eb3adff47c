#include "engine/kkt/tree_kkt.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

// A stiffness about the child's origin as one about the parent's, `r` away.
void shift_origin(const Vec3& r, bool symmetric, Mat6& h) {
  const Mat3 rx = skew(r), e = h.bottomRightCorner<3, 3>(), top = h.topRightCorner<3, 3>();
  const Mat3 b = top + rx * e;
  const Mat3 c = symmetric ? Mat3(b.transpose()) : Mat3(h.bottomLeftCorner<3, 3>() - e * rx);
  h.topLeftCorner<3, 3>() += rx * c - top * rx;
  h.topRightCorner<3, 3>() = b;
  h.bottomLeftCorner<3, 3>() = c;
}

void shift_origin(const Vec3& r, bool, Vec6& wrench) {
  wrench = about(wrench, r);
}

void shift_origin(const Vec3& arm, bool, SubtreeSizes& s) {
  const double r = arm.norm();
  s.m += r * s.mf + r * r * s.f;
  s.mf += 2 * r * s.f;
  s.heavy_m += 2 * r * s.heavy_mf + r * r * s.heavy_f;
  s.heavy_mf += r * s.heavy_f;
}

KktSystem::NullDirection null_direction(int v, const Vec3& direction) {
  return {{v, direction[0]}, {v + 1, direction[1]}, {v + 2, direction[2]}};
}

} // namespace

// Visits the nodes from the tips to the root with the sum of what their children handed on, which the visit
// turns into what they hand on themselves, both about the node's origin. What goes to the next node is never
// stored.
template <class Sum, class Visit>
void TreeKkt::inwards(std::vector<Sum>& branches, Visit visit) {
  branches.resize(static_cast<std::size_t>(branching_));
  Sum sum;
  bool handed = false; // `sum` is for this node
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    if (n.branches >= 0) {
      const Sum& others = branches[static_cast<std::size_t>(n.branches)];
      sum = handed ? Sum(sum + others) : others;
    } else if (!handed) {
      sum = Sum::Zero();
    }
    visit(n, sum);
    if (n.parent < 0) {
      handed = false;
      continue;
    }
    shift_origin(n.arm, symmetric_, sum);
    handed = static_cast<std::size_t>(n.parent) + 1 == i;
    if (handed) continue;
    const Node& p = nodes_[static_cast<std::size_t>(n.parent)];
    Sum& others = branches[static_cast<std::size_t>(p.branches)];
    others = p.last == static_cast<int>(i) ? sum : Sum(others + sum);
  }
}

// Sets what is known of node i before its children.
void TreeKkt::place(int i, const Link& link) {
  Node& n = nodes_[static_cast<std::size_t>(i)];
  n.parent = link.parent < 0 ? -1 : node_of_link_[static_cast<std::size_t>(link.parent)];
  n.v = finds_speed(link) ? -1 : link.v;
  if (finds_speed(link)) left_out_.push_back(link.v);
  n.ball = -1;
  if (link.v >= 0 && link.type == LinkType::spherical) {
    n.ball = static_cast<int>(balls_.size());
    balls_.emplace_back();
  }
  n.branches = n.last = -1;
  if (n.parent < 0 || n.parent + 1 == i) return;
  Node& p = nodes_[static_cast<std::size_t>(n.parent)];
  if (p.branches < 0) p.branches = branching_++;
  p.last = i;
}

void TreeKkt::set_joint(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                        const Magnitudes& magnitudes, const SubtreeSizes& sizes, double least, Node& n) {
  const auto l = static_cast<std::size_t>(n.link);
  const Link& link = problem.system.links[l];
  const LinkParameters& lp = problem.parameters.links[l];
  const auto measure = [&](int v, bool angular, double& noise, double& metric) {
    const double unit = problem.scaling.column[v];
    noise =
        std::max(zero * (angular ? sizes.m : sizes.f * unit * unit), rounding * magnitudes.force[v] * unit);
    metric = own_share * (angular ? sizes.heavy_m : sizes.heavy_f * unit * unit);
    // What has no mass of its own to speak of would be free to go anywhere.
    if (metric == 0) metric = least;
  };
  if (n.ball >= 0) {
    Ball& ball = balls_[static_cast<std::size_t>(n.ball)];
    ball.s.setZero();
    for (int c = 0; c < 3; ++c) {
      ball.s.col(c).head<3>() =
          problem.scaling.column[n.v + c] * k.columns[static_cast<std::size_t>(n.v + c)].axis;
      measure(n.v + c, true, ball.noise[c], ball.metric[c]);
    }
    ball.joint = lp.elastic ? rotation_stiffness(link, lp, q) : Mat3(Mat3::Zero());
    if (with_velocities_) ball.joint += rate_ * rotation_damping(link, lp, q);
  } else if (n.v >= 0) {
    const Column<double>& column = k.columns[static_cast<std::size_t>(n.v)];
    const double unit = problem.scaling.column[n.v];
    n.axis = unit * column.axis;
    n.angular = column.angular;
    measure(n.v, n.angular, n.noise, n.metric);
    n.joint = lp.elastic ? lp.force[0].curvature(q[link.q]) * unit * unit : 0;
    if (with_velocities_)
      n.joint += rate_ * coordinate_damping(problem.system, problem.parameters, n.link, k) * unit * unit;
  }
}

// What the bodies' accelerations and velocities ask for.
void TreeKkt::add_motion(const Problem& problem, const Kinematics<double>& k) {
  for (Node& n : nodes_) {
    if (n.massless()) continue;
    BodyInertia body = n;
    body.turning = 0;
    n.own += rate_ * rate_ * inertia_matrix(body);
    if (with_velocities_ && problem.parameters.moving)
      n.own += rate_ * coriolis_matrix(body, k.links[static_cast<std::size_t>(n.link)].w);
  }
  for (std::size_t i = 0; i < problem.system.body_forces.size() && with_velocities_; ++i) {
    const BodyForceElement& e = problem.system.body_forces[i];
    const BodyForceParameters& f = problem.parameters.body_forces[i];
    const int at = e.link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(e.link)];
    if (at < 0 || !is_of_air(f.type)) continue;
    Mat6 damping = Mat6::Zero();
    add_air_damping(e, f, k, damping);
    nodes_[static_cast<std::size_t>(at)].own += rate_ * damping;
  }
}

void TreeKkt::linearize(const Problem& problem, const Unknowns& z, const Evaluation& at) {
  linearize_motion(problem, z, at, 0, false);
}

void TreeKkt::linearize_motion(const Problem& problem, const Unknowns& z, const Evaluation& at, double rate,
                               bool with_velocities) {
  const Kinematics<double>& k = at.kinematics;
  const Residual<double>& residual = at.residual;
  const System& system = problem.system;
  rate_ = rate;
  with_velocities_ = with_velocities;
  symmetric_ = (problem.symmetric() || problem.symmetric_at_speeds()) && !with_velocities;
  size_ = system.nv;
  mass_ = 0;
  balls_.clear();
  left_out_.clear();
  branching_ = 0;
  node_of_link_.resize(system.links.size());
  std::size_t count = 0;
  for (std::size_t l = 0; l < system.links.size(); ++l)
    node_of_link_[l] = system.links[l].mobile ? static_cast<int>(count++) : -1;
  nodes_.resize(count);
  rows_.resize(symmetric_ ? 0 : count);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    if (node_of_link_[l] < 0) continue;
    place(node_of_link_[l], system.links[l]);
    Node& n = nodes_[static_cast<std::size_t>(node_of_link_[l])];
    n.link = static_cast<int>(l);
    n.arm = k.links[l].o - k.at(system.links[l].parent).o;
    n.force = residual.force[l];
    n.moment = residual.moment[l];
    set_body_stiffness(problem.parameters, l, k, n, n.own);
    mass_ += n.mass;
  }
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceElement& e = system.body_forces[i];
    const int node = e.link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(e.link)];
    if (node >= 0)
      add_body_force(e, problem.parameters.body_forces[i], k, nodes_[static_cast<std::size_t>(node)].own);
  }
  if (rate != 0) add_motion(problem, k);
  const double least =
      own_share * own_share * std::max(mass_, 1e-300) * problem.parameters.length * problem.parameters.length;
  inwards(size_branches_, [&](Node& n, SubtreeSizes& sizes) {
    if (symmetric_) n.own = 0.5 * (n.own + n.own.transpose()).eval();
    sizes.m += n.own.topLeftCorner<3, 3>().norm();
    sizes.mf += n.own.topRightCorner<3, 3>().norm() + n.own.bottomLeftCorner<3, 3>().norm();
    sizes.f += n.own.bottomRightCorner<3, 3>().norm();
    sizes.heavy_m += n.inertia.norm() + n.turning;
    sizes.heavy_mf += n.first_moment.norm();
    sizes.heavy_f += n.mass;
    set_joint(problem, z.q, k, at.magnitudes, sizes, least, n);
  });
}

void TreeKkt::eliminate_one(Node& n, double shift, Mat6& h) {
  n.u.noalias() = h.middleCols<3>(n.at()) * n.axis;
  const double pivot = n.axis.dot(n.u.segment<3>(n.at())) + n.joint + shift * n.metric;
  Vec6 turn;
  if (n.angular)
    turn << n.axis.cross(n.moment), n.axis.cross(n.force);
  else
    turn << n.axis.cross(n.force), Vec3::Zero();
  Vec6& r = symmetric_ ? n.u : rows_[static_cast<std::size_t>(&n - nodes_.data())];
  if (symmetric_) {
    n.u += 0.5 * turn;
  } else {
    r.noalias() = h.middleRows<3>(n.at()).transpose() * n.axis;
    n.u += turn;
  }
  if (!(std::abs(pivot) > n.noise)) {
    n.inverse = 0;
    directions_.push_back({{n.v, 1.}});
    return;
  }
  n.inverse = 1 / pivot;
  if (pivot < 0) ++negative_;
  const Vec6 scaled = n.u / pivot;
  h.noalias() -= scaled * r.transpose();
}

void TreeKkt::eliminate_three(Node& n, double shift, Mat6& h) {
  Ball& b = balls_[static_cast<std::size_t>(n.ball)];
  b.u = h * b.s;
  Mat3 pivot = b.s.transpose() * b.u + b.joint;
  pivot.diagonal() += shift * b.metric;
  for (int c = 0; c < 3; ++c) {
    const Vec6 turn = turned(b.s.col(c), n.moment, n.force);
    if (symmetric_) {
      b.u.col(c) += 0.5 * turn;
      continue;
    }
    b.u.col(c) += turn;
    for (int d = 0; d < 3; ++d)
      pivot(d, c) += b.s.col(d).dot(turn);
  }
  if (symmetric_)
    b.r = b.u;
  else
    b.r = h.transpose() * b.s;
  const double noise = b.noise.maxCoeff();
  Vec3 inverse;
  if (symmetric_) {
    // What is not finite resists nothing, as in a pivot of one coordinate.
    const PrincipalAxes eigen = principal_axes(0.5 * (pivot + pivot.transpose()))
                                    .value_or(PrincipalAxes{Vec3::Zero(), Mat3::Identity()});
    for (int c = 0; c < 3; ++c) {
      const double value = eigen.values[c];
      const bool singular = !(std::abs(value) > noise);
      inverse[c] = singular ? 0 : 1 / value;
      if (singular) directions_.push_back(null_direction(n.v, eigen.vectors.col(c)));
      if (!singular && value < 0) ++negative_;
    }
    b.inverse = eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
  } else {
    const SingularVectors3 svd = singular_vectors_3(pivot).value_or(
        SingularVectors3{Vec3::Zero(), Mat3::Identity(), Mat3::Identity()});
    for (int c = 0; c < 3; ++c) {
      const bool singular = !(svd.values[c] > noise);
      inverse[c] = singular ? 0 : 1 / svd.values[c];
      if (singular) directions_.push_back(null_direction(n.v, svd.right.col(c)));
    }
    b.inverse = svd.right * inverse.asDiagonal() * svd.left.transpose();
  }
  h.noalias() -= b.u * b.inverse * b.r.transpose();
}

void TreeKkt::factor(double shift) {
  shift_ = shift;
  directions_.clear();
  negative_ = 0;
  inwards(stiffness_branches_, [&](Node& n, Mat6& h) {
    h += n.own;
    if (shift != 0 && !n.massless()) h += shift * inertia_matrix(n);
    if (n.one())
      eliminate_one(n, shift, h);
    else if (n.ball >= 0)
      eliminate_three(n, shift, h);
  });
  null_ = static_cast<int>(directions_.size());
}

void TreeKkt::solve_to(double, const Eigen::VectorXd& rhs, const Eigen::VectorXd&, Eigen::VectorXd& x,
                       Eigen::VectorXd& lambda) {
  lambda.resize(0);
  x.resize(rhs.size());
  inwards(wrench_branches_, [&](Node& n, Vec6& g) {
    if (n.one()) {
      n.e = n.inverse * (rhs[n.v] - n.axis.dot(g.segment<3>(n.at())));
      g += n.u * n.e;
    } else if (n.ball >= 0) {
      Ball& b = balls_[static_cast<std::size_t>(n.ball)];
      b.e = b.inverse * (rhs.segment<3>(n.v) - b.s.transpose() * g);
      g += b.u * b.e;
    }
  });
  outwards(std::numeric_limits<double>::infinity(), x);
}

void TreeKkt::clear_left_out(Eigen::VectorXd& x) const {
  for (const int v : left_out_)
    x[v] = 0;
}

// From e, what each coordinate would do were its parent held, to the motion of all, none turning further than
// `most`.
void TreeKkt::outwards(double most, Eigen::VectorXd& x) {
  clear_left_out(x);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& n = nodes_[i];
    if (n.parent >= 0)
      n.motion = carried(nodes_[static_cast<std::size_t>(n.parent)].motion, n.arm);
    else
      n.motion.setZero();
    if (n.one()) {
      double own = n.e - n.inverse * (symmetric_ ? n.u : rows_[i]).dot(n.motion);
      if (n.angular) {
        const double before = n.axis.dot(n.motion.head<3>());
        if (std::abs(before + own) > most) own = std::copysign(most, before + own) - before;
      }
      x[n.v] = own;
      n.motion.segment<3>(n.at()) += n.axis * own;
    } else if (n.ball >= 0) {
      const Ball& b = balls_[static_cast<std::size_t>(n.ball)];
      Vec3 own = b.e - b.inverse * (b.r.transpose() * n.motion);
      const Vec3 whole = n.motion.head<3>() + b.s.topRows<3>() * own;
      if (const double turn = whole.norm(); turn > most)
        own -= b.s.topRows<3>().transpose() * whole * (1 - most / turn);
      x.segment<3>(n.v) = own;
      n.motion += b.s * own;
    }
  }
}

bool TreeKkt::limit_turns(double most, Eigen::VectorXd& x) {
  const bool far = std::ranges::any_of(
      nodes_, [&](const Node& n) { return n.motion.head<3>().squaredNorm() > most * most; });
  if (far) outwards(most, x);
  return far;
}

void TreeKkt::direction_of(const NullDirection& direction, Eigen::VectorXd& x) {
  x.setZero(size_);
  for (const auto& [v, share] : direction)
    x[v] = share;
  for (Node& n : nodes_) {
    if (n.one())
      n.e = x[n.v];
    else if (n.ball >= 0)
      balls_[static_cast<std::size_t>(n.ball)].e = x.segment<3>(n.v);
  }
  outwards(std::numeric_limits<double>::infinity(), x);
}

double TreeKkt::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  for (Node& n : nodes_) {
    n.motion.setZero();
    if (n.parent >= 0) n.motion = carried(nodes_[static_cast<std::size_t>(n.parent)].motion, n.arm);
    if (n.one())
      n.motion.segment<3>(n.at()) += n.axis * x[n.v];
    else if (n.ball >= 0)
      n.motion += balls_[static_cast<std::size_t>(n.ball)].s * x.segment<3>(n.v);
  }
  return metric_of_solution(x, product);
}

// Everything moves as the solution says.
double TreeKkt::metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  product.resize(x.size());
  clear_left_out(product);
  double square = 0;
  inwards(wrench_branches_, [&](Node& n, Vec6& g) {
    const Vec6 own = times_inertia(n, n.motion);
    square += n.motion.dot(own);
    g += own;
    if (n.one()) {
      product[n.v] = n.metric * x[n.v];
      square += product[n.v] * x[n.v];
      product[n.v] += n.axis.dot(g.segment<3>(n.at()));
    } else if (n.ball >= 0) {
      const Ball& b = balls_[static_cast<std::size_t>(n.ball)];
      const Vec3 turn = x.segment<3>(n.v), alone = b.metric.cwiseProduct(turn);
      square += alone.dot(turn);
      product.segment<3>(n.v) = alone + b.s.transpose() * g;
    }
  });
  return square;
}

} // namespace flyball
