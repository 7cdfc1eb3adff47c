#include "engine/kkt/pair_blocks.hpp"

#include "engine/system/cut_damper.hpp"

namespace flyball {
namespace {

using Mat36 = Eigen::Matrix<double, 3, 6>;

// Motion of a point `r` from the origin: x + theta x r. Its transpose takes a force there to its wrench.
Mat36 point_motion(const Vec3& r) {
  Mat36 m;
  m.leftCols<3>() = -skew(r);
  m.rightCols<3>().setIdentity();
  return m;
}

// v x theta, as a matrix on motions.
Mat36 turns(const Vec3& v) {
  Mat36 m;
  m.leftCols<3>() = skew(v);
  m.rightCols<3>().setZero();
  return m;
}

Vec6 couple(const Vec3& torque) {
  Vec6 w;
  w << torque, Vec3::Zero();
  return w;
}

// The force `f` on b at its point, -f on a at its own, with its change by either motion. Turning along is
// taken off: d f - theta x f on each.
PairBlocks force_between(const Vec3& f, const Mat36& pa, const Mat36& pb, const Mat36& by_a,
                         const Mat36& by_b) {
  PairBlocks x;
  x.bb = pb.transpose() * (by_b + turns(f));
  x.ba = pb.transpose() * by_a;
  x.ab = -pa.transpose() * by_b;
  x.aa = -pa.transpose() * (by_a + turns(f));
  x.on_b = pb.transpose() * f;
  x.on_a = -pa.transpose() * f;
  return x;
}

// The same where both feel it at b's point, as a's frame carries it along: -f on a moves on a as b does.
PairBlocks force_at_b(const Vec3& f, const Mat36& pa, const Mat36& pb, const Mat36& by_a, const Mat36& by_b) {
  PairBlocks x = force_between(f, pa, pb, by_a, by_b);
  const Mat3 arm = skew(f); // moment of -f by the shift of its point: shift x -f = [f] shift
  x.aa.topRows<3>() -= arm * pa;
  x.ab.topRows<3>() += arm * pb;
  return x;
}

struct Ends {
  Vec3 a, b;     // m, the points
  Mat36 pa, pb;  // of a and b at their own points
  Mat36 pa_at_b; // of a at b's point
};

Ends ends_of(const PairEnds& ends, const Vec3& a, const Vec3& b, const Kinematics<double>& k) {
  const Vec3 &oa = k.at(ends.a).o, &ob = k.at(ends.b).o;
  return {a, b, point_motion(a - oa), point_motion(b - ob), point_motion(b - oa)};
}

// Tension along the line between two points, which also changes by `along` per stretch: force_between() with
// by_a = -K P_a and by_b = K P_b, written out for P = [-[r], 1].
PairBlocks line_blocks(const Vec3& ra, const Vec3& rb, const Vec3& direction, double length, double along,
                       double tension, Lines lines) {
  const double across = (lines == Lines::convex ? std::max(tension, 0.) : tension) / length;
  Mat3 k = (along - across) * direction * direction.transpose();
  k.diagonal().array() += across;
  const Vec3 f = tension * direction;
  const Mat3 fx = skew(f), a = times_skew(k, ra), b = times_skew(k, rb);
  const Mat3 by_own_a = -a - fx, by_own_b = fx - b;
  PairBlocks x;
  x.aa << skew_times(ra, by_own_a), -a.transpose(), by_own_a, k;
  x.ab << skew_times(ra, b), a.transpose(), b, -k;
  x.ba << skew_times(rb, a), b.transpose(), a, -k;
  x.bb << skew_times(rb, by_own_b), -b.transpose(), by_own_b, k;
  x.on_a << -ra.cross(f), -f;
  x.on_b << rb.cross(f), f;
  x.compressed = tension < 0;
  return x;
}

} // namespace

void PairBlocks::set_zero() {
  aa.setZero();
  ab.setZero();
  ba.setZero();
  bb.setZero();
  on_a.setZero();
  on_b.setZero();
  compressed = false;
}

PairBlocks& PairBlocks::operator+=(const PairBlocks& other) {
  aa += other.aa;
  ab += other.ab;
  ba += other.ba;
  bb += other.bb;
  on_a += other.on_a;
  on_b += other.on_b;
  compressed |= other.compressed;
  return *this;
}

PairBlocks spring_blocks(const PointSpringElement& e, const PointSpringParameters& p,
                         const Kinematics<double>& k, bool moving, Lines lines) {
  const SpringState<double> s = spring_state(e, p, k);
  if (p.without_length()) { // needs no direction: the points may meet
    const Ends at = ends_of(e.ends, s.a, s.b, k);
    return force_between(p.stiffness * (s.b - s.a), at.pa, at.pb, -p.stiffness * at.pa, p.stiffness * at.pb);
  }
  PairBlocks x = line_blocks(s.a - k.at(e.ends.a).o, s.b - k.at(e.ends.b).o, s.direction, s.length,
                             p.pull_slope(s.length), s.tension, lines);
  if (!p.damped() || !moving) return x;
  const double damping = p.resistance_slope(stretching(e, s, k));
  const Ends at = ends_of(e.ends, s.a, s.b, k);
  // Points are carried by frames that turn with w: a point's velocity changes by w x its shift.
  const Mat3 across = (Mat3::Identity() - s.direction * s.direction.transpose()) / s.length;
  const Vec3 rate = k.velocity(e.ends.b, s.b) - k.velocity(e.ends.a, s.a);
  const auto change = [&](int link, const Mat36& motion) {
    return Mat36(damping * s.direction *
                 (rate.transpose() * across + s.direction.transpose() * skew(k.at(link).w)) * motion);
  };
  const Mat36 by_a = -change(e.ends.a, at.pa), by_b = change(e.ends.b, at.pb);
  x.bb += at.pb.transpose() * by_b;
  x.ba += at.pb.transpose() * by_a;
  x.ab -= at.pa.transpose() * by_b;
  x.aa -= at.pa.transpose() * by_a;
  return x;
}

PairBlocks damper_blocks(const CutDamperElement& e, const CutDamperParameters& p,
                         const Kinematics<double>& k) {
  const LinkState<double>&la = k.at(e.ends.a), &lb = k.at(e.ends.b);
  const CutDamperState<double> s = cut_damper_state<double>(e, p, k);
  const Vec3& axis = s.axis;
  const double damping = p.resistance_slope(s.rate);
  if (e.angular) {
    const Vec3 slip = lb.w - la.w, torque = s.resistance * axis;
    // The rate changes as the axis turns with a, and the torque with it.
    const Mat3 by_a = -damping * axis * slip.transpose() * skew(axis) - skew(torque);
    PairBlocks x;
    x.set_zero();
    x.bb.topLeftCorner<3, 3>() = skew(torque);
    x.ba.topLeftCorner<3, 3>() = by_a;
    x.aa.topLeftCorner<3, 3>() = -by_a - skew(torque);
    x.on_b = couple(torque);
    x.on_a = -x.on_b;
    return x;
  }
  const Ends at = ends_of(e.ends, s.b, s.b, k);
  const Vec3 slip = k.velocity(e.ends.b, s.b) - k.velocity(e.ends.a, s.b);
  const Vec3 force = s.resistance * axis;
  const Mat36 by_a = -damping * axis * slip.transpose() * turns(axis) - turns(force);
  const Mat36 by_b = damping * axis * axis.transpose() * skew<double>(lb.w - la.w) * at.pb;
  return force_at_b(force, at.pa, at.pb, by_a, by_b);
}

PairBlocks row_blocks(const CutJoint& cut, const CutParameters& p, const ConstraintRow& row,
                      double multiplier, const Kinematics<double>& k, Lines lines) {
  const Vec3 a = k.point(cut.ends.a, p.a), b = k.point(cut.ends.b, p.b);
  if (row.type == RowType::distance) {
    const Vec3 d = b - a;
    const double length = d.norm();
    return line_blocks(a - k.at(cut.ends.a).o, b - k.at(cut.ends.b).o, d / length, length, 0, multiplier,
                       lines);
  }
  const Vec3 u = k.at(cut.ends.a).R * p.frame[static_cast<std::size_t>(row.u)];
  if (row.type == RowType::point) {
    const Ends at = ends_of(cut.ends, a, b, k);
    const Vec3 force = multiplier * u;
    return force_at_b(force, at.pa_at_b, at.pb, -turns(force), Mat36::Zero());
  }
  const Vec3 w = k.at(cut.ends.b).R * p.frame[static_cast<std::size_t>(row.w)];
  const Mat3 wu = multiplier * skew(w) * skew(u);
  PairBlocks x;
  x.set_zero();
  x.bb.topLeftCorner<3, 3>() = wu;
  x.ba.topLeftCorner<3, 3>() = -wu;
  x.ab.topLeftCorner<3, 3>() = -wu.transpose();
  x.aa.topLeftCorner<3, 3>() = wu.transpose();
  x.on_b = couple(multiplier * w.cross(u));
  x.on_a = -x.on_b;
  return x;
}

RowGradient body_row_gradient(const CutJoint& cut, const CutParameters& p, const ConstraintRow& row,
                              const Kinematics<double>& k) {
  const LinkState<double>&on_a = k.at(cut.ends.a), &on_b = k.at(cut.ends.b);
  RowGradient g;
  if (row.type == RowType::direction) {
    const Vec3 u = on_a.R * p.frame[static_cast<std::size_t>(row.u)];
    const Vec3 w = on_b.R * p.frame[static_cast<std::size_t>(row.w)];
    g.b = couple(w.cross(u));
    g.a = -g.b;
    return g;
  }
  const Vec3 a = k.point(cut.ends.a, p.a), b = k.point(cut.ends.b, p.b);
  const bool line = row.type == RowType::distance;
  const Vec3 u = line ? Vec3((b - a).normalized()) : Vec3(on_a.R * p.frame[static_cast<std::size_t>(row.u)]);
  const Vec3 at_a = line ? a : b; // a row of points is of b's in a's frame
  g.a << -(at_a - on_a.o).cross(u), -u;
  g.b << (b - on_b.o).cross(u), u;
  return g;
}

PairDamping spring_damping(const PointSpringElement& e, const PointSpringParameters& p,
                           const Kinematics<double>& k) {
  const SpringState<double> s = spring_state(e, p, k);
  PairDamping out;
  out.damping = p.resistance_slope(stretching(e, s, k));
  out.rate.a << -(s.a - k.at(e.ends.a).o).cross(s.direction), -s.direction;
  out.rate.b << (s.b - k.at(e.ends.b).o).cross(s.direction), s.direction;
  return out;
}

PairDamping damper_damping(const CutDamperElement& e, const CutDamperParameters& p,
                           const Kinematics<double>& k) {
  const CutDamperState<double> s = cut_damper_state<double>(e, p, k);
  PairDamping out;
  out.damping = p.resistance_slope(s.rate);
  if (e.angular) {
    out.rate.a << -s.axis, Vec3::Zero();
    out.rate.b << s.axis, Vec3::Zero();
    return out;
  }
  out.rate.a << -(s.b - k.at(e.ends.a).o).cross(s.axis), -s.axis;
  out.rate.b << (s.b - k.at(e.ends.b).o).cross(s.axis), s.axis;
  return out;
}

} // namespace flyball
