#include "engine/kkt/body_stiffness.hpp"

#include "engine/system/air_force.hpp"

namespace flyball {
namespace {

// Of a force of the air: its point from the link's origin, and how it changes with the flow there.
struct AirSlope {
  Mat3 armx, slope;
};
AirSlope air_slope(const BodyForceElement& e, const BodyForceParameters& f, const Kinematics<double>& k) {
  const Vec3 point = k.point(e.link, f.at);
  return {skew<double>(point - k.at(e.link).o),
          air_force_slope(f, k.at(e.link).R, f.wind - k.velocity(e.link, point))};
}

} // namespace

void set_body_inertia(const Parameters& p, std::size_t l, const Kinematics<double>& k, BodyInertia& n) {
  const LinkParameters& lp = p.links[l];
  const Mat3& r = k.links[l].R;
  n.mass = lp.mass;
  n.turning = lp.mass * p.length * p.length / 4;
  const Vec3 c = r * lp.com;
  n.first_moment = lp.mass * c;
  n.inertia = -lp.mass * skew_product(c, c);
  if (lp.has_inertia) n.inertia += r * lp.inertia * r.transpose();
}

// The acceleration of the body's frame is a field that stands still while the body moves in it: at r from the
// origin dv + T r. A particle at r feels it by its mass, moved it feels T (shift + turn x r) more, and its
// wrench is r x that. Summed over the body with S the sum of r r^T by mass, since [r][b] = b r^T - r.b and
// [r][w w^T][r] = [w] r r^T [w]; less the turn of the whole wrench.
void set_body_stiffness(const Parameters& p, std::size_t l, const Kinematics<double>& k, BodyInertia& n,
                        Mat6& own) {
  set_body_inertia(p, l, k, n);
  const LinkState<double>& x = k.links[l];
  const Vec3& h = n.first_moment;
  own.setZero();
  if (n.massless()) return;
  own.topLeftCorner<3, 3>() = skew_product(h, x.dv);
  if (!p.moving) {
    own.bottomLeftCorner<3, 3>() = n.mass * skew(x.dv);
    return;
  }
  const Mat3 t = skew(x.dw) + skew_product(x.w, x.w);
  Mat3 s = -n.inertia;
  s.diagonal().array() += n.inertia.trace() / 2;
  const Mat3 ts = t * s;
  own.topLeftCorner<3, 3>() +=
      ts - skew_times(x.w, times_skew(s, x.w)) - x.w.squaredNorm() * n.inertia + skew<double>(s * x.dw);
  own.topLeftCorner<3, 3>().diagonal().array() -= ts.trace();
  own.topRightCorner<3, 3>() = skew_times(h, t);
  own.bottomLeftCorner<3, 3>() = skew<double>(n.mass * x.dv + t * h) - times_skew(t, h);
  own.bottomRightCorner<3, 3>() = n.mass * t;
}

void add_body_force(const BodyForceElement& e, const BodyForceParameters& f, const Kinematics<double>& k,
                    Mat6& own) {
  // A force fixed in the body turns with it, as F_b does by itself.
  const bool air = is_of_air(f.type);
  if (!air && f.frame == ForceFrame::body) return;
  const LinkState<double>& x = k.links[static_cast<std::size_t>(e.link)];
  if (!air) {
    const AppliedForce<double> a = applied_force(e, f, k);
    const Mat3 fx = skew(a.force);
    own.topLeftCorner<3, 3>() -= skew<double>(a.point - x.o) * fx + skew(a.torque);
    own.bottomLeftCorner<3, 3>() -= fx;
    return;
  }
  const auto& [armx, j] = air_slope(e, f, k);
  // Velocity at the point of V x X, whose parts are w x theta and v x theta + w x x.
  const Mat3 wx = skew(x.w);
  const Mat3 by_turn = j * (skew(x.v) - armx * wx), by_shift = j * wx;
  own.topLeftCorner<3, 3>() += armx * by_turn;
  own.topRightCorner<3, 3>() += armx * by_shift;
  own.bottomLeftCorner<3, 3>() += by_turn;
  own.bottomRightCorner<3, 3>() += by_shift;
  add_wind(e, f, k, own);
}

void add_wind(const BodyForceElement& e, const BodyForceParameters& f, const Kinematics<double>& k,
              Mat6& own) {
  if (f.wind.isZero(0)) return;
  const auto& [armx, j] = air_slope(e, f, k);
  const Mat3 by_turn = -j * skew(f.wind);
  own.topLeftCorner<3, 3>() += armx * by_turn;
  own.bottomLeftCorner<3, 3>() += by_turn;
}

// A particle at r with the velocity v + w' x r in the frame feels 2 w x that by its mass, and its wrench is r
// x that; summed up with S as above, since [r][w][r] = -(r.w) [r].
Mat6 coriolis_matrix(const BodyInertia& n, const Vec3& w) {
  const Vec3& h = n.first_moment;
  Mat3 s = -n.inertia;
  s.diagonal().array() += n.inertia.trace() / 2;
  Mat6 d;
  d.topLeftCorner<3, 3>() = skew<double>(2 * s * w);
  d.topRightCorner<3, 3>() = 2 * skew_product(h, w);
  d.bottomLeftCorner<3, 3>() = -2 * skew_product(w, h);
  d.bottomRightCorner<3, 3>() = skew<double>(2 * n.mass * w);
  return d;
}

void add_air_damping(const BodyForceElement& e, const BodyForceParameters& f, const Kinematics<double>& k,
                     Mat6& damping) {
  const auto& [armx, j] = air_slope(e, f, k);
  damping.topLeftCorner<3, 3>() -= armx * j * armx;
  damping.topRightCorner<3, 3>() += armx * j;
  damping.bottomLeftCorner<3, 3>() -= j * armx;
  damping.bottomRightCorner<3, 3>() += j;
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
