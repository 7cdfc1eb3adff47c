#include "engine/dynamics/newton_elimination.hpp"

namespace flyball {
namespace {

// V x S of twists about one point.
Vec6 swept(const Vec3& w, const Vec3& v, const Vec6& s) {
  Vec6 x;
  x << w.cross(s.head<3>()), w.cross(s.tail<3>()) + v.cross(s.head<3>());
  return x;
}

} // namespace

NewtonElimination::NewtonElimination(const System& released, int free)
    : system_(released), nodes_(released.links.size()), joints_(released, free) {
  for (std::size_t l = 0; l < nodes_.size(); ++l)
    nodes_[l].parent = released.links[l].parent;
}

// B of a body and its inertia.
void NewtonElimination::set_body(const MotionPoint& point, std::size_t l) {
  const LinkParameters& lp = point.parameters.links[l];
  const LinkState<double>& x = point.kinematics.links[l];
  Mat618& own = nodes_[l].own;
  own.setZero();
  BodyInertia body;
  set_body_inertia(point.parameters, l, point.kinematics, body);
  if (body.massless()) return;
  body.turning = 0;
  own.rightCols<6>() = inertia_matrix(body);
  const Vec3 c = x.R * lp.com, momentum = lp.mass * (x.v + x.w.cross(c));
  Mat3 b = -2 * skew_product(c, momentum);
  if (lp.has_inertia) {
    const Mat3 inertia = x.R * lp.inertia * x.R.transpose(), turning = skew(x.w) * inertia;
    b += turning + turning.transpose() - skew<double>(inertia * x.w);
  }
  own.block<3, 3>(0, 6) = b;
  own.block<3, 3>(3, 6) = -2 * skew(momentum);
}

template <int N>
void NewtonElimination::set_joint(const MotionPoint& point, std::size_t l, int v, Joint<N>& j) {
  const Link& link = system_.links[l];
  const LinkParameters& lp = point.parameters.links[l];
  const LinkState<double>& x = point.kinematics.links[l];
  const Node& n = nodes_[l];
  const LinkState<double>& parent = point.kinematics.at(n.parent);
  const Vec3 acceleration = x.dv - x.w.cross(x.v); // of the field at the origin
  const Vec3 turning = x.w + parent.w, moving = x.v + parent.v + parent.w.cross(n.arm);
  j.place.setZero();
  j.rate.setZero();
  for (int i = 0; i < N; ++i) {
    const Column<double>& column = point.kinematics.columns[static_cast<std::size_t>(v + i)];
    Vec6 s = Vec6::Zero();
    s.segment<3>(column.angular ? 0 : 3) = column.axis;
    const Vec6 carried = swept(x.w, x.v, s);
    j.s.col(i) = s;
    j.load.col(i) = turned(s, loads_[l].head<3>(), loads_[l].tail<3>());
    j.place.col(i) << s, carried, swept(x.dw, acceleration, s) + swept(x.w, x.v, carried);
    j.rate.col(i) << Vec6::Zero(), s, swept(turning, moving, s);
  }
  if constexpr (N == 1) {
    j.stiffness(0, 0) = lp.elastic ? lp.force[0].curvature(point.q[link.q]) : 0;
    j.damping(0, 0) = lp.force[0].resistance_slope(point.u[v]);
  } else {
    j.damping = rotation_damping(link, lp, point.q);
    j.stiffness.setZero();
    if (lp.elastic) j.stiffness += rotation_stiffness(link, lp, point.q);
    if (!j.damping.isZero(0))
      j.stiffness += rotation_damping_stiffness(link, lp, point.q, point.u.segment<3>(v));
  }
}

bool NewtonElimination::linearise(const MotionPoint& point) {
  const Kinematics<double>& k = point.kinematics;
  set_body_wrenches(system_, point.parameters, k, loads_);
  for (std::size_t l = nodes_.size(); l-- > 0;) {
    Node& n = nodes_[l];
    n.arm = k.links[l].o - k.at(n.parent).o;
    if (n.parent >= 0) loads_[static_cast<std::size_t>(n.parent)] += about(loads_[l], n.arm);
  }
  bool finite = true;
  for (std::size_t l = 0; l < nodes_.size(); ++l) {
    set_body(point, l);
    joints_.visit(l, [&](int v, auto& joint) {
      set_joint(point, l, v, joint);
      finite = finite && joint.place.allFinite() && joint.load.allFinite() && joint.stiffness.allFinite();
    });
  }
  Mat6 change;
  for (std::size_t i = 0; i < system_.body_forces.size(); ++i) {
    const BodyForceElement& e = system_.body_forces[i];
    const BodyForceParameters& f = point.parameters.body_forces[i];
    if (e.link < 0) continue;
    change.setZero();
    Mat618& own = nodes_[static_cast<std::size_t>(e.link)].own;
    if (is_of_air(f.type)) {
      add_air_damping(e, f, k, change);
      own.middleCols<6>(6) += change;
      change.setZero();
      add_wind(e, f, k, change);
    } else {
      add_body_force(e, f, k, change);
    }
    own.leftCols<6>() += change;
  }
  return finite;
}

template <int N>
bool NewtonElimination::eliminate(Node& n, const Eigen::Matrix<double, N, N>& turn, Joint<N>& j) {
  j.sigma = gamma_ * (gamma_ * j.place * turn + j.rate);
  j.sigma.template bottomRows<6>() += j.s;
  j.by_place.noalias() = n.h * j.place;
  j.by_place = gamma_ * (j.by_place + j.load);
  j.by_rate.noalias() = n.h.rightCols<6>() * j.s;
  j.u.noalias() = n.h * j.sigma;
  j.u += gamma_ * gamma_ * j.load * turn;
  const Eigen::Matrix<double, N, N> pivot =
      j.s.transpose() * j.u + gamma_ * (gamma_ * j.stiffness * turn + j.damping);
  j.inverse = pivot.inverse();
  j.row.noalias() = j.inverse * (j.s.transpose() * n.h);
  n.h.noalias() -= j.u * j.row;
  return j.inverse.allFinite();
}

bool NewtonElimination::factor(double gamma, const std::vector<Mat3>& turns) {
  gamma_ = gamma;
  for (Node& n : nodes_)
    n.h = n.own;
  bool regular = true;
  for (std::size_t l = nodes_.size(); l-- > 0 && regular;) {
    Node& n = nodes_[l];
    joints_.visit(l, [&]<int N>(int, Joint<N>& joint) {
      if constexpr (N == 1)
        regular = eliminate(n, Eigen::Matrix<double, 1, 1>(1.), joint);
      else
        regular = eliminate(n, turns[joints_.ball(l)], joint);
    });
    if (n.parent < 0) continue;
    const Mat3 arm = skew(n.arm);
    Mat618& h = n.h;
    h.topRows<3>() += arm * h.bottomRows<3>();
    for (const int i : {0, 6, 12})
      h.middleCols<3>(i) -= h.middleCols<3>(i + 3) * arm;
    nodes_[static_cast<std::size_t>(n.parent)].h += h;
  }
  return regular;
}

void NewtonElimination::solve(const Eigen::VectorXd& b_q, Eigen::VectorXd& s) {
  for (Node& n : nodes_)
    n.g.setZero();
  for (std::size_t l = nodes_.size(); l-- > 0;) {
    Node& n = nodes_[l];
    joints_.visit(l, [&]<int N>(int v, Joint<N>& j) {
      const Eigen::Matrix<double, N, 1> place = b_q.segment<N>(v);
      n.g += j.by_place * place - j.by_rate * s.segment<N>(v);
      j.e = -(j.inverse * (j.s.transpose() * n.g + gamma_ * (j.stiffness * place)));
      n.g += j.u * j.e;
    });
    if (n.parent >= 0) nodes_[static_cast<std::size_t>(n.parent)].g += about(n.g, n.arm);
  }
  for (std::size_t l = 0; l < nodes_.size(); ++l) {
    Node& n = nodes_[l];
    n.motion.setZero();
    if (n.parent >= 0) {
      n.motion = nodes_[static_cast<std::size_t>(n.parent)].motion;
      for (const int i : {0, 6, 12})
        n.motion.segment<3>(i + 3) += n.motion.segment<3>(i).cross(n.arm);
    }
    joints_.visit(l, [&]<int N>(int v, const Joint<N>& j) {
      const Eigen::Matrix<double, N, 1> change = j.e - j.row * n.motion;
      n.motion += j.sigma * change + gamma_ * (j.place * b_q.segment<N>(v));
      n.motion.tail<6>() -= j.s * s.segment<N>(v);
      s.segment<N>(v) = change;
    });
  }
}

} // namespace flyball
