#include "engine/system/pair_stiffness.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/system/air_force.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/pair_hessian.hpp"

namespace flyball {
namespace {

// Second derivative of tension x length between points a and b: the geometric stiffness of a stretched link.
// `along` is the stiffness along the line (N/m), `tension` in N; `direction` is the unit vector a to b.
struct Line {
  Vec3 a, b, direction;
  double length, along, tension;
};

double line_hessian(const Line& line, const PairPart& i, const PairPart& j) {
  const Vec3& pi = i.second ? line.b : line.a;
  const Vec3& pj = j.second ? line.b : line.a;
  const Vec3 ji = i.column.at(pi) * (i.second ? 1. : -1.), jj = j.column.at(pj) * (j.second ? 1. : -1.);
  const double si = line.direction.dot(ji), sj = line.direction.dot(jj);
  double h = line.along * si * sj;
  if (line.tension != 0) {
    h += line.tension / line.length * (ji.dot(jj) - si * sj);
    if (i.second == j.second)
      h += line.tension * (i.second ? 1. : -1.) * line.direction.dot(moved_motion(i, j, pi));
  }
  return h;
}

// Second derivative of u_A . w_B.
double direction_hessian(const Vec3& u, const Vec3& w, const PairPart& i, const PairPart& j) {
  const Vec3 ti = i.column.turn(), tj = j.column.turn();
  if (i.second != j.second) return ti.cross(i.second ? w : u).dot(tj.cross(j.second ? w : u));
  const Vec3& moved = i.second ? w : u;
  const Vec3& other = i.second ? u : w;
  return carries(j, i) ? other.dot(tj.cross(ti.cross(moved))) : other.dot(ti.cross(tj.cross(moved)));
}

template <class Entry>
void for_pairs(const Support& support, const Kinematics<double>& k, Eigen::MatrixXd& out, Entry entry) {
  for (const SupportColumn& si : support)
    for (const SupportColumn& sj : support)
      out(si.v, sj.v) += entry(pair_part(si, k), pair_part(sj, k));
}

void add_springs(const System& system, const Parameters& p, const Kinematics<double>& k,
                 const std::vector<ScrewRates>& screws, Eigen::MatrixXd& out) {
  for (std::size_t n = 0; n < system.springs.size(); ++n) {
    interruption_point();
    const PointSpringElement& e = system.springs[n];
    const PointSpringParameters& f = p.springs[n];
    const SpringState<double> s = spring_state(e, f, k);
    if (f.without_length()) { // k d: no direction needed, points may meet
      for_pairs(e.ends.support, k, out, [&](const PairPart& i, const PairPart& j) {
        const Vec3& pi = i.second ? s.b : s.a;
        const Vec3& pj = j.second ? s.b : s.a;
        double h = i.column.at(pi).dot(j.column.at(pj)) * (i.second == j.second ? 1. : -1.);
        if (i.second == j.second) h += (i.second ? 1. : -1.) * (s.b - s.a).dot(moved_motion(i, j, pi));
        return f.stiffness * h;
      });
      continue;
    }
    const Line line{s.a, s.b, s.direction, s.length, f.pull_slope(s.length), s.tension};
    for_pairs(e.ends.support, k, out,
              [&](const PairPart& i, const PairPart& j) { return line_hessian(line, i, j); });
    if (!f.damped() || !p.moving) continue;
    const double damping = f.resistance_slope(stretching(e, s, k));
    const Vec3 va = k.velocity(e.ends.a, s.a), vb = k.velocity(e.ends.b, s.b);
    for_pairs(e.ends.support, k, out, [&](const PairPart& i, const PairPart& j) {
      const Vec3 motion = j.column.at(j.second ? s.b : s.a) * (j.second ? 1. : -1.);
      const Vec3 turned = (motion - s.direction * s.direction.dot(motion)) / s.length;
      const Vec3 change =
          velocity_change(j, screws[static_cast<std::size_t>(j.v)], j.second ? s.b : s.a, j.second ? vb : va);
      const double rate = turned.dot(vb - va) + (j.second ? 1. : -1.) * s.direction.dot(change);
      return damping * rate * s.direction.dot(i.column.at(i.second ? s.b : s.a)) * (i.second ? 1. : -1.);
    });
  }
}

// Generalised direction of a damper in a cut joint: the rate is the sum of this times q'.
double damper_gradient(const CutDamperElement& e, const Vec3& axis, const Vec3& b, const PairPart& i) {
  return (i.second ? 1. : -1.) * axis.dot(e.angular ? i.column.turn() : i.column.at(b));
}

void add_cut_dampers(const System& system, const Parameters& p, const Kinematics<double>& k,
                     const std::vector<ScrewRates>& screws, Eigen::MatrixXd& out) {
  if (!p.moving) return;
  for (std::size_t n = 0; n < system.cut_dampers.size(); ++n) {
    interruption_point();
    const CutDamperElement& e = system.cut_dampers[n];
    const LinkState<double>&la = k.at(e.ends.a), &lb = k.at(e.ends.b);
    const CutDamperState<double> damper = cut_damper_state<double>(e, p.cut_dampers[n], k);
    const Vec3 &axis = damper.axis, &b = damper.b;
    const Vec3 va = k.velocity(e.ends.a, b), vb = k.velocity(e.ends.b, b);
    const double slope = p.cut_dampers[n].resistance_slope(damper.rate);
    for_pairs(e.ends.support, k, out, [&](const PairPart& i, const PairPart& j) {
      const ScrewRates& s = screws[static_cast<std::size_t>(j.v)];
      const Vec3 turn = j.column.turn();
      double drate = 0;
      if (e.angular) {
        drate = axis.dot(s.dw + turn.cross(j.second ? lb.w : la.w)) * (j.second ? 1. : -1.);
        if (!j.second) drate += turn.cross(axis).dot(lb.w - la.w);
      } else if (j.second) {
        drate = axis.dot(velocity_change(j, s, b, vb) - la.w.cross(j.column.at(b)));
      } else {
        drate = turn.cross(axis).dot(vb - va) -
                axis.dot(velocity_change(j, s, b, va) - la.w.cross(j.column.at(b)));
      }
      double turned = 0; // d/dq_j of i's direction
      if (!e.angular)
        turned = point_hessian(axis, b, i, j);
      else if (i.second && !j.second)
        turned = turn.cross(axis).dot(i.column.turn());
      else if (i.second && j.second && carries(j, i))
        turned = axis.dot(turn.cross(i.column.turn()));
      else if (!i.second && !j.second && !carries(j, i))
        turned = -turn.cross(axis).dot(i.column.turn());
      return slope * drate * damper_gradient(e, axis, b, i) + damper.resistance * turned;
    });
  }
}

void add_turning_air(const System& system, const Parameters& p, const Kinematics<double>& k,
                     const std::vector<ScrewRates>& screws, Eigen::MatrixXd& out) {
  for (std::size_t n = 0; n < system.turning_air.size(); ++n) {
    interruption_point();
    const TurningAirElement& e = system.turning_air[n];
    const TurningAirForce<double> air = turning_air_force<double>(e, p.turning_air[n], k);
    const Mat3 slope = air_force_slope(p.turning_air[n], k.at(e.ends.b).R, air.flow);
    const Vec3 va = k.velocity(e.ends.a, air.point), vb = k.velocity(e.ends.b, air.point);
    for_pairs(e.ends.support, k, out, [&](const PairPart& i, const PairPart& j) {
      const ScrewRates& s = screws[static_cast<std::size_t>(j.v)];
      const Vec3 turn = j.column.turn(), passing = k.at(e.ends.a).w.cross(j.column.at(air.point));
      // As a carries it: the force turns with b, and point_hessian() has it turn with a.
      Vec3 change;
      if (j.second)
        change = turn.cross(air.force) +
                 slope * (passing - velocity_change(j, s, air.point, vb) - turn.cross(air.flow));
      else
        change = slope * (velocity_change(j, s, air.point, va) - passing) - turn.cross(air.force);
      return (i.second ? -1. : 1.) * change.dot(i.column.at(air.point)) -
             point_hessian(air.force, air.point, i, j);
    });
  }
}

void add_constraint_forces(const System& system, const Parameters& p, const Eigen::VectorXd& lambda,
                           const Kinematics<double>& k, Eigen::MatrixXd& out) {
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    interruption_point();
    const CutJoint& cut = system.cuts[c];
    if (cut.type == JointType::gear) continue;
    const CutParameters& f = p.cuts[c];
    const Vec3 a = k.point(cut.ends.a, f.a), b = k.point(cut.ends.b, f.b);
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const double multiplier = lambda[cut.first_row + static_cast<int>(r)];
      if (multiplier == 0) continue;
      const ConstraintRow& row = cut.rows[r];
      const Vec3 u = k.at(cut.ends.a).R * f.frame[static_cast<std::size_t>(row.u)];
      const Vec3 w = k.at(cut.ends.b).R * f.frame[static_cast<std::size_t>(row.w)];
      const double length = (b - a).norm();
      const Line line{a, b, (b - a) / length, length, 0, multiplier};
      for_pairs(cut.ends.support, k, out, [&](const PairPart& i, const PairPart& j) {
        switch (row.type) {
        case RowType::distance: return line_hessian(line, i, j);
        case RowType::point: return multiplier * point_hessian(u, b, i, j);
        case RowType::direction: return multiplier * direction_hessian(u, w, i, j);
        case RowType::gear: break;
        }
        return 0.;
      });
    }
  }
}

} // namespace

void add_pair_stiffness(const System& system, const Parameters& parameters, const Eigen::VectorXd& lambda,
                        const Kinematics<double>& kinematics, const std::vector<ScrewRates>& screws,
                        Eigen::MatrixXd& stiffness) {
  add_springs(system, parameters, kinematics, screws, stiffness);
  add_cut_dampers(system, parameters, kinematics, screws, stiffness);
  add_turning_air(system, parameters, kinematics, screws, stiffness);
  add_bearing_stiffness(system, parameters, kinematics, screws, stiffness);
  add_constraint_forces(system, parameters, lambda, kinematics, stiffness);
}

void add_pair_damping(const System& system, const Parameters& p, const Kinematics<double>& k,
                      Eigen::MatrixXd& velocity) {
  for (std::size_t n = 0; n < system.springs.size(); ++n) {
    interruption_point();
    if (!p.springs[n].damped()) continue;
    const PointSpringElement& e = system.springs[n];
    const SpringState<double> s = spring_state(e, p.springs[n], k);
    const double damping = p.springs[n].resistance_slope(stretching(e, s, k));
    const auto along = [&](const PairPart& i) {
      return (i.second ? 1. : -1.) * s.direction.dot(i.column.at(i.second ? s.b : s.a));
    };
    for_pairs(e.ends.support, k, velocity,
              [&](const PairPart& i, const PairPart& j) { return damping * along(i) * along(j); });
  }
  for (std::size_t n = 0; n < system.cut_dampers.size(); ++n) {
    interruption_point();
    const CutDamperElement& e = system.cut_dampers[n];
    const CutDamperState<double> s = cut_damper_state<double>(e, p.cut_dampers[n], k);
    const double damping = p.cut_dampers[n].resistance_slope(s.rate);
    for_pairs(e.ends.support, k, velocity, [&](const PairPart& i, const PairPart& j) {
      return damping * damper_gradient(e, s.axis, s.b, i) * damper_gradient(e, s.axis, s.b, j);
    });
  }
  for (std::size_t n = 0; n < system.turning_air.size(); ++n) {
    interruption_point();
    const TurningAirElement& e = system.turning_air[n];
    const TurningAirForce<double> air = turning_air_force<double>(e, p.turning_air[n], k);
    const Mat3 slope = air_force_slope(p.turning_air[n], k.at(e.ends.b).R, air.flow);
    for_pairs(e.ends.support, k, velocity, [&](const PairPart& i, const PairPart& j) {
      return (i.second == j.second ? 1. : -1.) * i.column.at(air.point).dot(slope * j.column.at(air.point));
    });
  }
  add_bearing_damping(system, p, k, velocity);
}

} // namespace flyball
