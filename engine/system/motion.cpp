#include "engine/system/motion.hpp"

#include "engine/system/pair_stiffness.hpp"
#include "engine/system/rotation_vector.hpp"

namespace flyball {
namespace {

Quat displacement(const Link& link, const Eigen::VectorXd& q) {
  return Quat(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]).normalized();
}

// What the joint of a link adds to the rates of its parent. `rate` is the joint's own velocity in the field,
// `acceleration` its change.
void add_joint(const Link& link, const Mat3& parent, const Vec3& axis, const Vec3& turning,
               const Eigen::VectorXd& velocity, const Eigen::VectorXd* a, LinkRates& x) {
  if (link.v < 0) return;
  if (link.type == LinkType::spherical) {
    const Vec3 rate = parent * velocity.segment<3>(link.v);
    x.w += rate;
    x.dw += turning.cross(rate);
    if (a) x.dw += parent * a->segment<3>(link.v);
    return;
  }
  const double rate = velocity[link.v];
  const Vec3 change = turning.cross(axis) * rate + (a ? Vec3(axis * (*a)[link.v]) : Vec3(Vec3::Zero()));
  if (link.type == LinkType::revolute) {
    x.w += axis * rate;
    x.dw += change;
  } else {
    x.v += axis * rate;
    x.dv += change;
  }
}

} // namespace

void move(const System& system, const Parameters& p, const CoordinateMotion& state, Kinematics<double>& out,
          std::vector<LinkRates>& carried) {
  const std::size_t n = system.links.size();
  const bool split = state.s && state.s != &state.u;
  out.links.resize(n);
  out.columns.resize(static_cast<std::size_t>(system.nv));
  carried.resize(split ? n : 0);
  out.ground = {Mat3::Identity(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                Vec3::Zero(),     Vec3::Zero(), -p.gravity};
  const LinkRates still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), -p.gravity};
  for (std::size_t i = 0; i < n; ++i) {
    const Link& link = system.links[i];
    const LinkParameters& lp = p.links[i];
    const LinkState<double>& parent = out.at(link.parent);
    LinkState<double>& x = out.links[i];
    x.o = parent.o + parent.R * lp.offset;
    x.axis.setZero();
    switch (link.type) {
    case LinkType::fixed: x.R = parent.R; break;
    case LinkType::revolute:
      x.axis = parent.R * lp.axis;
      x.R = parent.R * rotation_about<double>(lp.axis, state.q[link.q] - lp.drawn);
      break;
    case LinkType::prismatic:
      x.axis = parent.R * lp.axis;
      x.R = parent.R;
      x.o += x.axis * (state.q[link.q] - lp.drawn);
      break;
    case LinkType::spherical: x.R = parent.R * displacement(link, state.q).toRotationMatrix(); break;
    }
    if (link.v >= 0) {
      Column<double>* column = &out.columns[static_cast<std::size_t>(link.v)];
      if (link.type == LinkType::spherical)
        for (int k = 0; k < 3; ++k)
          column[k] = {parent.R.col(k), x.o, true};
      else
        *column = {x.axis, x.o, link.type == LinkType::revolute};
    }
    const Vec3 arm = x.o - parent.o;
    LinkRates motion{parent.w, parent.v + parent.w.cross(arm), Vec3::Zero(), Vec3::Zero()};
    if (!split) {
      motion.dw = parent.dw;
      add_joint(link, parent.R, x.axis, parent.w, state.u, state.a, motion);
      motion.dv += parent.dv + parent.dw.cross(arm) + parent.w.cross(motion.v - parent.v);
      x.w = motion.w;
      x.v = motion.v;
      x.dw = motion.dw;
      x.dv = motion.dv;
      continue;
    }
    add_joint(link, parent.R, x.axis, parent.w, state.u, nullptr, motion);
    x.w = motion.w;
    x.v = motion.v;
    const LinkRates& from = link.parent < 0 ? still : carried[static_cast<std::size_t>(link.parent)];
    LinkRates& c = carried[i];
    c = {from.w, from.v + from.w.cross(arm), from.dw, Vec3::Zero()};
    add_joint(link, parent.R, x.axis, parent.w, *state.s, state.a, c);
    c.dv += from.dv + from.dw.cross(arm) + from.w.cross(motion.v - parent.v);
    // With v_Y = v - v_s of what has mass zero, and w_Y spinning it without inertia, the momenta's rates are
    // m dv and I dw + w x I w for these:
    x.dw = c.dw - x.w.cross(c.w);
    x.dv = c.dv + x.w.cross(x.v - c.v);
  }
}

namespace {

LinkRates rates_of(const Kinematics<double>& k, const std::vector<LinkRates>& carried, int link) {
  if (link < 0) return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), k.ground.dv};
  if (!carried.empty()) return carried[static_cast<std::size_t>(link)];
  const LinkState<double>& x = k.links[static_cast<std::size_t>(link)];
  return {x.w, x.v, x.dw, x.dv};
}

// A cut joint's row with the parts its rates are made of. d = b - a, u fixed in end a, w in end b.
struct MovingRow {
  const LinkState<double>&a, &b; // the motion of the configuration
  LinkRates sa, sb;              // the field
  Vec3 pa, pb, u, w;

  Vec3 d() const { return pb - pa; }
  static Vec3 at(const LinkRates& s, const Vec3& arm) { return s.v + s.w.cross(arm); }
  static Vec3 acceleration(const LinkRates& s, const Vec3& turning, const Vec3& arm) {
    return s.dv + s.dw.cross(arm) + s.w.cross(turning.cross(arm));
  }
  Vec3 velocity() const { return at(sb, pb - b.o) - at(sa, pa - a.o); } // of d, in the field
  Vec3 motion() const { return b.v + b.w.cross(pb - b.o) - a.v - a.w.cross(pa - a.o); }
  Vec3 acceleration() const { return acceleration(sb, b.w, pb - b.o) - acceleration(sa, a.w, pa - a.o); }
  // Second derivative of a direction fixed in a link.
  static Vec3 turned(const LinkRates& s, const Vec3& turning, const Vec3& x) {
    return s.dw.cross(x) + s.w.cross(turning.cross(x));
  }
};

MovingRow row_of(const CutJoint& cut, const CutParameters& f, const ConstraintRow& row,
                 const Kinematics<double>& k, const std::vector<LinkRates>& carried) {
  const LinkState<double>&a = k.at(cut.ends.a), &b = k.at(cut.ends.b);
  return {a,
          b,
          rates_of(k, carried, cut.ends.a),
          rates_of(k, carried, cut.ends.b),
          k.point(cut.ends.a, f.a),
          k.point(cut.ends.b, f.b),
          a.R * f.frame[static_cast<std::size_t>(row.u)],
          b.R * f.frame[static_cast<std::size_t>(row.w)]};
}

double rate(const MovingRow& r, RowType type) {
  switch (type) {
  case RowType::distance: return r.d().normalized().dot(r.velocity());
  case RowType::point: return r.u.dot(r.velocity()) + r.sa.w.cross(r.u).dot(r.d());
  case RowType::direction: return r.sa.w.cross(r.u).dot(r.w) + r.u.dot(r.sb.w.cross(r.w));
  case RowType::gear: break;
  }
  return 0;
}

double acceleration(const MovingRow& r, RowType type) {
  switch (type) {
  case RowType::distance: {
    const double length = r.d().norm();
    const Vec3 n = r.d() / length, motion = r.motion();
    return n.dot(r.acceleration()) + (motion - n * n.dot(motion)).dot(r.velocity()) / length;
  }
  case RowType::point:
    return r.a.w.cross(r.u).dot(r.velocity()) + r.u.dot(r.acceleration()) +
           MovingRow::turned(r.sa, r.a.w, r.u).dot(r.d()) + r.sa.w.cross(r.u).dot(r.motion());
  case RowType::direction:
    return MovingRow::turned(r.sa, r.a.w, r.u).dot(r.w) + r.sa.w.cross(r.u).dot(r.b.w.cross(r.w)) +
           r.a.w.cross(r.u).dot(r.sb.w.cross(r.w)) + r.u.dot(MovingRow::turned(r.sb, r.b.w, r.w));
  case RowType::gear: break;
  }
  return 0;
}

template <class Value>
void for_rows(const System& system, const Parameters& p, const Kinematics<double>& k,
              const std::vector<LinkRates>& carried, const Eigen::VectorXd* gear, Eigen::VectorXd& out,
              Value value) {
  out.resize(system.rows);
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      double& x = out[cut.first_row + static_cast<int>(r)];
      if (cut.type == JointType::gear)
        x = gear ? (*gear)[cut.gear_vb] - p.cuts[c].ratio * (*gear)[cut.gear_va] : 0;
      else
        x = value(row_of(cut, p.cuts[c], cut.rows[r], k, carried), cut.rows[r].type);
    }
  }
}

} // namespace

void constraint_rates(const System& system, const Parameters& p, const Eigen::VectorXd& s,
                      const Kinematics<double>& k, const std::vector<LinkRates>& carried,
                      Eigen::VectorXd& out) {
  for_rows(system, p, k, carried, &s, out, rate);
}

void constraint_accelerations(const System& system, const Parameters& p, const Kinematics<double>& k,
                              const std::vector<LinkRates>& carried, Eigen::VectorXd& out) {
  for_rows(system, p, k, carried, nullptr, out, acceleration);
}

void evaluate_mass(const System& system, const Parameters& p, const Kinematics<double>& k, MassMatrix& out) {
  const std::size_t n = system.links.size();
  out.composites.resize(n);
  out.mass.setZero(system.nv, system.nv);
  out.size.setZero(system.nv);
  for (std::size_t i = 0; i < n; ++i) {
    CompositeBody& b = out.composites[i];
    const LinkParameters& lp = p.links[i];
    b.mass = lp.mass;
    b.first_moment.setZero();
    b.inertia.setZero();
    if (lp.mass == 0 && !lp.has_inertia) continue;
    const Mat3& R = k.links[i].R;
    const Vec3 c = R * lp.com;
    b.first_moment = lp.mass * c;
    b.inertia = lp.mass * (c.squaredNorm() * Mat3::Identity() - c * c.transpose());
    if (lp.has_inertia) b.inertia += R * lp.inertia * R.transpose();
  }
  for (std::size_t i = n; i-- > 0;) {
    const Link& link = system.links[i];
    const CompositeBody& b = out.composites[i];
    const bool empty = b.mass == 0 && b.inertia.isZero(0);
    for (int c = 0; link.v >= 0 && !empty && c < (link.type == LinkType::spherical ? 3 : 1); ++c) {
      const int j = link.v + c;
      const Column<double>& column = k.columns[static_cast<std::size_t>(j)];
      out.size[j] = column.angular ? b.inertia.trace() : b.mass;
      // Momentum of the subtree at unit speed, about this link's origin.
      const Vec3 linear =
          column.angular ? Vec3(column.axis.cross(b.first_moment)) : Vec3(b.mass * column.axis);
      const Vec3 angular =
          column.angular ? Vec3(b.inertia * column.axis) : Vec3(b.first_moment.cross(column.axis));
      for (int l = static_cast<int>(i); l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
        const Link& other = system.links[static_cast<std::size_t>(l)];
        if (other.v < 0) continue;
        const Vec3 arm = k.links[i].o - k.links[static_cast<std::size_t>(l)].o;
        for (int d = 0; d < (other.type == LinkType::spherical ? 3 : 1); ++d) {
          const int e = other.v + d;
          const Column<double>& s = k.columns[static_cast<std::size_t>(e)];
          const double m = s.axis.dot(s.angular ? Vec3(angular + arm.cross(linear)) : linear);
          out.mass(e, j) = m;
          out.mass(j, e) = m;
        }
      }
    }
    if (link.parent < 0 || empty) continue;
    CompositeBody& a = out.composites[static_cast<std::size_t>(link.parent)];
    const Vec3 r = k.links[i].o - k.at(link.parent).o, h = b.first_moment + b.mass * r;
    // About the parent's origin: -[r][h_i] - [h_i][r] - m [r][r], symmetric by itself.
    const double trace = 2 * r.dot(b.first_moment) + b.mass * r.squaredNorm();
    a.inertia += b.inertia + trace * Mat3::Identity() - r * h.transpose() - b.first_moment * r.transpose();
    a.first_moment += h;
    a.mass += b.mass;
  }
}

} // namespace flyball
