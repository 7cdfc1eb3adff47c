#include "engine/equilibrium/body_stiffness.hpp"

namespace flyball {

namespace {

// Returns the inertia about the mass centre.
Mat3 set_inertia(const Parameters& p, const LinkParameters& lp, const LinkState<double>& x,
                 BodyInertia& n) {
  n.mass = lp.mass;
  n.turning = lp.mass * p.length * p.length / 4;
  const Vec3 c = x.R * lp.com;
  n.first_moment = lp.mass * c;
  n.inertia = -lp.mass * skew_product(c, c);
  if (!lp.has_inertia) return Mat3::Zero();
  const Mat3 central = x.R * lp.inertia * x.R.transpose();
  n.inertia += central;
  return central;
}

} // namespace

void set_body_inertia(const Parameters& p, std::size_t l, const Kinematics<double>& k, BodyInertia& n) {
  set_inertia(p, p.links[l], k.links[l], n);
}

void set_body_stiffness(const Parameters& p, std::size_t l, const Kinematics<double>& k, BodyInertia& n,
                        Mat6& own) {
  const LinkParameters& lp = p.links[l];
  const LinkState<double>& x = k.links[l];
  const Mat3 central = set_inertia(p, lp, x, n);
  if (lp.mass == 0 && !lp.has_inertia) {
    own.setZero();
    return;
  }
  const Vec3& h = n.first_moment;
  if (!p.moving) {
    own.setZero();
    own.topLeftCorner<3, 3>() = skew_product(h, x.dv);
    own.bottomLeftCorner<3, 3>() = lp.mass * skew(x.dv);
    return;
  }
  // See linearization.hpp: Psi'' = A x X + V x (V x X), and B on Psi' = V x X.
  const Vec3 c = x.R * lp.com, momentum = lp.mass * (x.v + x.w.cross(c));
  const Mat3 swept = skew_times(x.w, central);
  const Mat3 b = swept + swept.transpose() - skew<double>(central * x.w) - 2 * skew_product(c, momentum);
  const Mat3 turn = skew(x.dw) + skew_product(x.w, x.w);
  const Mat3 shift = skew<double>(x.dv - x.w.cross(x.v)) + skew_product(x.w, x.v) + skew_product(x.v, x.w);
  const Mat3 moved = skew_times(h, turn);
  own.topLeftCorner<3, 3>().noalias() = n.inertia * turn;
  own.topLeftCorner<3, 3>() += skew_times(h, shift) + times_skew(b, x.w);
  own.topRightCorner<3, 3>() = moved;
  own.bottomLeftCorner<3, 3>() = lp.mass * shift - moved - 2 * skew_product(momentum, x.w);
  own.bottomRightCorner<3, 3>() = lp.mass * turn;
}

void add_body_force(const BodyForceElement& e, const BodyForceParameters& f, const Kinematics<double>& k,
                    Mat6& own) {
  // A force fixed in the body turns with it, as F_b does by itself.
  if (f.type != ForceType::drag && f.frame == ForceFrame::body) return;
  const LinkState<double>& x = k.links[static_cast<std::size_t>(e.link)];
  const AppliedForce<double> a = applied_force(e, f, k);
  const Vec3 arm = a.point - x.o;
  const Mat3 armx = skew(arm);
  if (f.type != ForceType::drag) {
    const Mat3 fx = skew(a.force);
    own.topLeftCorner<3, 3>() -= armx * fx + skew(a.torque);
    own.bottomLeftCorner<3, 3>() -= fx;
    return;
  }
  const Vec3 v = k.velocity(e.link, a.point);
  const double speed = v.norm();
  Mat3 j = (f.linear + f.quadratic * speed) * Mat3::Identity();
  if (speed > 0) j += f.quadratic / speed * v * v.transpose();
  // Velocity at the point of V x X, whose parts are w x theta and v x theta + w x x.
  const Mat3 wx = skew(x.w);
  const Mat3 by_turn = j * (skew(x.v) - armx * wx), by_shift = j * wx;
  own.topLeftCorner<3, 3>() += armx * by_turn;
  own.topRightCorner<3, 3>() += armx * by_shift;
  own.bottomLeftCorner<3, 3>() += by_turn;
  own.bottomRightCorner<3, 3>() += by_shift;
}

Mat6 inertia_matrix(const BodyInertia& b) {
  Mat6 m;
  const Mat3 hx = skew(b.first_moment);
  m.topLeftCorner<3, 3>() = b.inertia;
  m.topLeftCorner<3, 3>().diagonal().array() += b.turning;
  m.topRightCorner<3, 3>() = hx;
  m.bottomLeftCorner<3, 3>() = -hx;
  m.bottomRightCorner<3, 3>() = b.mass * Mat3::Identity();
  return m;
}

Vec6 times_inertia(const BodyInertia& b, const Vec6& x) {
  Vec6 y;
  y.head<3>() = b.inertia * x.head<3>() + b.turning * x.head<3>() + b.first_moment.cross(x.tail<3>());
  y.tail<3>() = b.mass * x.tail<3>() - b.first_moment.cross(x.head<3>());
  return y;
}

} // namespace flyball
