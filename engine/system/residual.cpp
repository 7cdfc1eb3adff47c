#include "engine/system/residual.hpp"

#include "engine/system/air_force.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/extended.hpp"
#include "engine/system/kept_momentum.hpp"
#include "engine/system/law_sizes.hpp"
#include "engine/system/link_forces.hpp"

#include <algorithm>
#include <type_traits>

namespace flyball {
template <class S>
AppliedForce<S> applied_force(const BodyForceElement& e, const BodyForceParametersOf<S>& p,
                              const Kinematics<S>& k) {
  AppliedForce<S> a{k.point(e.link, p.at), Vec3T<S>::Zero(), Vec3T<S>::Zero()};
  if (is_of_air(p.type)) {
    const Vec3T<S> flow = p.wind.template cast<S>() - k.velocity(e.link, a.point);
    a.force = air_force<S>(p, k.at(e.link).R, flow);
    return a;
  }
  Vec3T<S> vector = p.vector.template cast<S>();
  if (p.frame == ForceFrame::body) vector = k.at(e.link).R * vector;
  (p.type == ForceType::torque ? a.torque : a.force) = vector;
  return a;
}

template <class S>
SpringState<S> spring_state(const PointSpringElement& e, const PointSpringParametersOf<S>& p,
                            const Kinematics<S>& k) {
  SpringState<S> s;
  s.a = k.point(e.ends.a, p.a);
  s.b = k.point(e.ends.b, p.b);
  const Vec3T<S> d = s.b - s.a;
  s.length = d.norm();
  s.direction = s.length > 0 ? Vec3T<S>(d / s.length) : Vec3T<S>(Vec3T<S>::Zero());
  s.tension = p.pull(s.length);
  if (p.damped())
    s.tension += p.resistance(S(s.direction.dot(k.velocity(e.ends.b, s.b) - k.velocity(e.ends.a, s.a))));
  return s;
}

namespace {

// Calls add(link, force) for those of a part that act on a link.
template <class S, class Add>
void for_applied_forces(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k,
                        const SystemPart& part, const Add& add) {
  for (const int n : part.body_forces) {
    const auto i = static_cast<std::size_t>(n);
    const BodyForceElement& e = system.body_forces[i];
    if (e.link >= 0) add(static_cast<std::size_t>(e.link), applied_force(e, p.body_forces[i], k));
  }
}

template <class T>
T nothing() {
  if constexpr (std::is_arithmetic_v<T>)
    return 0;
  else
    return T::Zero();
}

// Parts side by side, what each asks of the spine by itself; then the spine, and what is between the parts.
// A pass has sums by link, each with those of all parts on each link of the spine.
template <class Pass>
void add_in_parts(const System& system, const Pass& pass) {
  const Division& division = system.division;
  pass.for_sums([&]<class T>(std::vector<T>& by_link, std::vector<T>& by_part) {
    by_link.resize(system.links.size());
    by_part.assign(division.spine * division.parts.size(), nothing<T>());
  });
  const auto clear = [&](std::size_t first, std::size_t last) {
    pass.for_sums([&]<class T>(std::vector<T>& by_link, std::vector<T>&) {
      std::fill(by_link.data() + first, by_link.data() + last, nothing<T>());
    });
  };
  for_parts(division, [&](const SystemPart& part, std::size_t n) {
    clear(part.first, part.last);
    pass.add_body_forces(part);
    pass.add_links(part.first, part.last, n * division.spine);
    pass.add_elements(part);
  });
  if (division.parts.size() == 1) return;
  clear(0, division.spine);
  pass.for_sums([&]<class T>(std::vector<T>& by_link, const std::vector<T>& by_part) {
    for (std::size_t n = 0; n < by_part.size(); ++n)
      by_link[n % division.spine] += by_part[n];
  });
  pass.add_body_forces(division.between);
  pass.add_links(0, division.spine, 0);
  pass.add_elements(division.between);
}

template <class S>
void add_spring(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k, std::size_t i,
                Configuration<S>& f) {
  const PointSpringElement& e = system.springs[i];
  const SpringState<S> s = spring_state(e, p.springs[i], k);
  // With no free length the force is k d, well defined where the points meet.
  const Vec3T<S> pull = p.springs[i].without_length() ? Vec3T<S>(S(p.springs[i].stiffness) * (s.b - s.a))
                                                      : Vec3T<S>(s.tension * s.direction);
  for (const SupportColumn& c : e.ends.support) {
    const S g = pull.dot(k.columns[static_cast<std::size_t>(c.v)].at(c.second ? s.b : s.a));
    f[c.v] += c.second ? g : -g;
  }
}

template <class S>
void add_cut_damper(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k, std::size_t i,
                    Configuration<S>& f) {
  const CutDamperElement& e = system.cut_dampers[i];
  const CutDamperState<S> s = cut_damper_state<S>(e, p.cut_dampers[i], k);
  for (const SupportColumn& c : e.ends.support) {
    const Column<S>& column = k.columns[static_cast<std::size_t>(c.v)];
    const S g = s.resistance * (e.angular ? s.axis.dot(column.turn()) : s.axis.dot(column.at(s.b)));
    f[c.v] += c.second ? g : -g;
  }
}

template <class S>
void add_turning_air(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k, std::size_t i,
                     Configuration<S>& f) {
  const TurningAirElement& e = system.turning_air[i];
  const TurningAirForce<S> air = turning_air_force<S>(e, p.turning_air[i], k);
  for (const SupportColumn& c : e.ends.support) {
    const S g = air.force.dot(k.columns[static_cast<std::size_t>(c.v)].at(air.point));
    f[c.v] += c.second ? -g : g;
  }
}

// A pass over the mechanism that adds up what acts on it.
template <class S>
struct ResidualPass {
  const System& system;
  const ParametersOf<S>& p;
  const Configuration<S>&q, &lambda;
  const Kinematics<S>& k;
  Residual<S>& out;

  void add_body_forces(const SystemPart& part) const {
    for_applied_forces(system, p, k, part, [&](std::size_t l, const AppliedForce<S>& a) {
      out.force[l] -= a.force;
      out.moment[l] -= a.torque + (a.point - k.links[l].o).cross(a.force);
    });
  }

  // From the tips inwards. What links ask of those before the first goes to the spine's, from `spine` on.
  void add_links(std::size_t first, std::size_t last, std::size_t spine) const {
    for (std::size_t i = last; i-- > first;) {
      const Link& link = system.links[i];
      const LinkParametersOf<S>& lp = p.links[i];
      const LinkState<S>& x = k.links[i];
      Vec3T<S>&force = out.force[i], &moment = out.moment[i];
      add_inertia_force(lp, x, p.moving, force, moment);
      if (link.v >= 0) {
        if (link.type == LinkType::spherical)
          for (int j = 0; j < 3; ++j)
            out.f[link.v + j] = k.columns[static_cast<std::size_t>(link.v + j)].axis.dot(moment);
        else
          out.f[link.v] = x.axis.dot(link.type == LinkType::revolute ? moment : force);
        if (lp.elastic) coordinate_forces<S>(link, lp, q, [&](int v, S value) { out.f[v] += value; });
      }
      if (link.parent < 0) continue;
      const auto j = static_cast<std::size_t>(link.parent);
      const Vec3T<S> carried = moment + (x.o - k.links[j].o).cross(force);
      if (j >= first) {
        out.force[j] += force;
        out.moment[j] += carried;
      } else {
        out.spine_force[spine + j] += force;
        out.spine_moment[spine + j] += carried;
      }
    }
  }

  void add_cut(std::size_t i) const {
    const CutJoint& cut = system.cuts[i];
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      if (const S multiplier = lambda[cut.first_row + static_cast<int>(r)]; multiplier != S(0))
        row_gradient(cut, p.cuts[i], cut.rows[r], k, [&](int v, S g) { out.f[v] += multiplier * g; });
  }

  void add_elements(const SystemPart& part) const {
    for (const int i : part.springs)
      add_spring(system, p, k, static_cast<std::size_t>(i), out.f);
    for (const int i : part.cuts)
      add_cut(static_cast<std::size_t>(i));
  }

  template <class Act>
  void for_sums(const Act& act) const {
    act(out.force, out.spine_force);
    act(out.moment, out.spine_moment);
  }

  void run() const {
    out.f.resize(system.nv);
    add_in_parts(system, *this);
    for (std::size_t i = 0; i < system.cut_dampers.size(); ++i)
      add_cut_damper(system, p, k, i, out.f);
    for (std::size_t i = 0; i < system.turning_air.size(); ++i)
      add_turning_air(system, p, k, i, out.f);
    add_bearings<S>(system, p, k, out.f);
    add_drive_torques(system, p, q, k, out.f);
    set_kept_momenta<S>(system, p, k, out);
    evaluate_constraints(system, p, q, k, out.phi);
  }
};

} // namespace

void add_pair_forces(const System& system, const Parameters& p, const Kinematics<double>& k,
                     Eigen::VectorXd& f) {
  for (std::size_t i = 0; i < system.springs.size(); ++i)
    add_spring(system, p, k, i, f);
  for (std::size_t i = 0; i < system.cut_dampers.size(); ++i)
    add_cut_damper(system, p, k, i, f);
  for (std::size_t i = 0; i < system.turning_air.size(); ++i)
    add_turning_air(system, p, k, i, f);
  add_bearings<double>(system, p, k, f);
}

template <class S>
void evaluate_constraints(const System& system, const ParametersOf<S>& p, const Configuration<S>& q,
                          const Kinematics<S>& k, Configuration<S>& phi) {
  phi.resize(system.rows);
  if (system.rows == 0) return;
  for_runs(system.division, system.cuts.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const CutJoint& cut = system.cuts[i];
      for (std::size_t r = 0; r < cut.rows.size(); ++r)
        phi[cut.first_row + static_cast<int>(r)] = cut.by_rates
                                                       ? row_rate<S>(cut, p.cuts[i], cut.rows[r], q, k)
                                                       : row_value<S>(cut, p.cuts[i], cut.rows[r], q, k);
    }
  });
}

template <class S>
void evaluate_residual(const System& system, const ParametersOf<S>& p, const Configuration<S>& q,
                       const Configuration<S>& lambda, const Kinematics<S>& k, Residual<S>& out) {
  ResidualPass<S>{system, p, q, lambda, k, out}.run();
}

namespace {

// The same for the sizes of the terms.
struct MagnitudesPass {
  const System& system;
  const Parameters& p;
  const Eigen::VectorXd &q, &lambda;
  const Kinematics<double>& k;
  Magnitudes& out;

  void add_body_forces(const SystemPart& part) const {
    for_applied_forces(system, p, k, part, [&](std::size_t l, const AppliedForce<double>& a) {
      out.link_force[l] += a.force.norm();
      out.link_moment[l] += a.torque.norm() + (a.point - k.links[l].o).norm() * a.force.norm();
    });
  }

  void add_links(std::size_t first, std::size_t last, std::size_t spine) const {
    const double weight = p.gravity.norm();
    for (std::size_t i = last; i-- > first;) {
      const Link& link = system.links[i];
      const LinkParameters& lp = p.links[i];
      const LinkState<double>& x = k.links[i];
      if (lp.mass != 0 || lp.has_inertia) {
        const double c = lp.com.norm(), w2 = x.w.squaredNorm(), turn = x.dw.norm() + w2;
        const double force = lp.mass * (weight + (x.dv - k.ground.dv).norm() + turn * c);
        out.link_force[i] += force;
        out.link_moment[i] += c * force;
        if (lp.has_inertia && p.moving) out.link_moment[i] += lp.inertia.norm() * turn;
      }
      if (link.v >= 0) {
        if (link.type == LinkType::spherical)
          out.force.segment<3>(link.v).setConstant(out.link_moment[i]);
        else
          out.force[link.v] = link.type == LinkType::revolute ? out.link_moment[i] : out.link_force[i];
        if (lp.elastic && link.type != LinkType::spherical) {
          const CoordinateForce& c = lp.force[0];
          // Where it stands at zero, free of force, no more of it is known than this part of a radian or the
          // reach.
          const double least = 1e-6 * (link.type == LinkType::revolute ? 1 : p.length);
          out.force[link.v] +=
              std::abs(c.friction) +
              std::abs(c.stiffness) * std::max(std::abs(q[link.q]) + std::abs(c.free), least) +
              (c.touched(q[link.q]) ? c.stop_stiffness : 0) *
                  (std::abs(q[link.q]) + std::max(std::abs(c.lower), std::abs(c.upper)));
          if (c.laws)
            out.force[link.v] +=
                law_size(c.laws->spring, q[link.q] - c.laws->free, std::max(std::abs(q[link.q]), least));
        } else if (lp.elastic) {
          add_rotation_sizes(link, lp);
        }
      }
      if (link.parent < 0) continue;
      const auto j = static_cast<std::size_t>(link.parent);
      const bool here = j >= first;
      (here ? out.link_force[j] : out.spine_force[spine + j]) += out.link_force[i];
      (here ? out.link_moment[j] : out.spine_moment[spine + j]) +=
          out.link_moment[i] + (k.links[i].o - k.links[j].o).norm() * out.link_force[i];
    }
  }

  // Each component's rounding is that of a rotation of some radians, and the torque mixes all of them.
  void add_rotation_sizes(const Link& link, const LinkParameters& lp) const {
    constexpr double radians = 4;
    const Vec3 r = rotation_vector(link, lp, q);
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const CoordinateForce& c = lp.force[i];
      size += (std::abs(c.stiffness) + c.stop_stiffness) * (radians + std::abs(c.free));
      if (c.laws) size += law_size(c.laws->spring, r[static_cast<int>(i)] - c.laws->free, radians);
    }
    out.force.segment<3>(link.v).array() += size;
  }

  void add_elements(const SystemPart& part) const {
    for (const int n : part.springs) {
      const auto i = static_cast<std::size_t>(n);
      const PointSpringElement& e = system.springs[i];
      const SpringState<double> s = spring_state(e, p.springs[i], k);
      const double size = std::abs(p.springs[i].pull_slope(s.length)) *
                              (s.a.norm() + s.b.norm() + s.length + p.springs[i].free_length) +
                          std::abs(s.tension);
      // By the whole lever, which is rounded too where the axis points along it.
      for (const SupportColumn& c : e.ends.support) {
        const Column<double>& column = k.columns[static_cast<std::size_t>(c.v)];
        out.force[c.v] += column.angular ? size * ((c.second ? s.b : s.a) - column.o).norm() : size;
      }
    }
  }

  void add_cut_damper_size(std::size_t i) const {
    const CutDamperElement& e = system.cut_dampers[i];
    const CutDamperState<double> s = cut_damper_state<double>(e, p.cut_dampers[i], k);
    const double size = std::abs(s.resistance);
    for (const SupportColumn& c : e.ends.support) {
      const Column<double>& column = k.columns[static_cast<std::size_t>(c.v)];
      if (e.angular)
        out.force[c.v] += column.angular ? size : 0;
      else
        out.force[c.v] += size * (column.angular ? (s.b - column.o).norm() : 1.);
    }
  }

  void add_turning_air(std::size_t i) const {
    const TurningAirElement& e = system.turning_air[i];
    const TurningAirForce<double> air = turning_air_force<double>(e, p.turning_air[i], k);
    for (const SupportColumn& c : e.ends.support) {
      const Column<double>& column = k.columns[static_cast<std::size_t>(c.v)];
      out.force[c.v] += air.force.norm() * (column.angular ? (air.point - column.o).norm() : 1.);
    }
  }

  // Multipliers are solved for together, so each carries the rounding of the largest and of what they
  // balance: compared as forces, moments at the arm of the mechanism's reach.
  double coordinate_arm(int v) const {
    return k.columns[static_cast<std::size_t>(v)].angular ? p.length : 1.;
  }
  double arm(const CutJoint& cut, const ConstraintRow& row) const {
    if (row.type == RowType::gear) return coordinate_arm(cut.gear_vb);
    return row.type == RowType::direction ? p.length : 1.;
  }

  double largest_at(const std::vector<int>& cuts) const {
    double largest = 0;
    const auto count = [&](double force, double at) { largest = std::max(largest, std::abs(force) / at); };
    for (const int n : cuts) {
      const CutJoint& cut = system.cuts[static_cast<std::size_t>(n)];
      for (const SupportColumn& c : cut.ends.support)
        count(out.force[c.v], coordinate_arm(c.v));
      if (cut.type == JointType::gear) // ties coordinates that need not lie between two bodies
        for (int v : {cut.gear_va, cut.gear_vb})
          count(out.force[v], coordinate_arm(v));
      for (std::size_t r = 0; r < cut.rows.size(); ++r)
        count(lambda[cut.first_row + static_cast<int>(r)], arm(cut, cut.rows[r]));
    }
    return largest;
  }

  void add_cuts(const std::vector<int>& cuts, double largest) const {
    for (const int n : cuts) {
      const auto i = static_cast<std::size_t>(n);
      const CutJoint& cut = system.cuts[i];
      for (std::size_t r = 0; r < cut.rows.size(); ++r) {
        const double size = largest * arm(cut, cut.rows[r]);
        if (cut.rows[r].type == RowType::gear) {
          out.force[cut.gear_va] += size * std::abs(p.cuts[i].ratio);
          out.force[cut.gear_vb] += size;
          continue;
        }
        const Vec3 at = k.point(cut.ends.b, p.cuts[i].b);
        // By the whole lever, as for springs.
        for (const SupportColumn& s : cut.ends.support) {
          const Column<double>& c = k.columns[static_cast<std::size_t>(s.v)];
          if (cut.rows[r].type == RowType::direction)
            out.force[s.v] += c.angular ? size : 0;
          else
            out.force[s.v] += c.angular ? size * (at - c.o).norm() : size;
        }
      }
    }
  }

  void set_phi(std::size_t first, std::size_t last) const {
    for (std::size_t i = first; i < last; ++i) {
      const CutJoint& cut = system.cuts[i];
      const CutParameters& c = p.cuts[i];
      for (std::size_t r = 0; r < cut.rows.size(); ++r) {
        double& phi = out.phi[cut.first_row + static_cast<int>(r)];
        switch (cut.rows[r].type) {
        case RowType::point:
        case RowType::distance: // positions are subtracted that may be far from the drawn pose
          phi = std::max({p.length, k.point(cut.ends.a, c.a).norm(), k.point(cut.ends.b, c.b).norm()});
          break;
        case RowType::direction: phi = 1; break;
        case RowType::gear:
          phi = std::abs(q[cut.gear_b]) + std::abs(c.ratio * q[cut.gear_a]) + std::abs(c.offset) + 1;
          break;
        }
        if (cut.by_rates) phi *= 1 + k.at(cut.ends.a).w.norm() + k.at(cut.ends.b).w.norm();
      }
    }
  }

  template <class Act>
  void for_sums(const Act& act) const {
    act(out.link_force, out.spine_force);
    act(out.link_moment, out.spine_moment);
  }

  void run() const {
    const Division& division = system.division;
    out.force.resize(system.nv);
    out.phi.resize(system.rows);
    add_in_parts(system, *this);
    for (std::size_t i = 0; i < system.cut_dampers.size(); ++i)
      add_cut_damper_size(i);
    for (std::size_t i = 0; i < system.turning_air.size(); ++i)
      add_turning_air(i);
    if (system.rows == 0) return;
    out.largest.assign(division.parts.size(), 0);
    for_parts(division,
              [&](const SystemPart& part, std::size_t n) { out.largest[n] = largest_at(part.cuts); });
    const double largest =
        std::max(largest_at(division.between.cuts), *std::ranges::max_element(out.largest));
    for_parts(division, [&](const SystemPart& part, std::size_t) { add_cuts(part.cuts, largest); });
    add_cuts(division.between.cuts, largest);
    for_runs(division, system.cuts.size(),
             [&](std::size_t first, std::size_t last) { set_phi(first, last); });
  }
};

} // namespace

void evaluate_magnitudes(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& lambda, const Kinematics<double>& k, Magnitudes& out) {
  MagnitudesPass{system, p, q, lambda, k, out}.run();
  add_bearing_sizes(system, p, k, out.force);
  add_drive_torque_sizes(system, p, q, k, out.force);
  set_kept_momentum_sizes(system, p, k, out);
}

template AppliedForce<double> applied_force(const BodyForceElement&, const BodyForceParameters&,
                                            const Kinematics<double>&);
template SpringState<double> spring_state(const PointSpringElement&, const PointSpringParameters&,
                                          const Kinematics<double>&);
template SpringState<Extended> spring_state(const PointSpringElement&, const PointSpringParameters&,
                                            const Kinematics<Extended>&);
template SpringState<Dual> spring_state(const PointSpringElement&, const BasicPointSpringParameters<Dual>&,
                                        const Kinematics<Dual>&);
template void evaluate_constraints<double>(const System&, const Parameters&, const Configuration<double>&,
                                           const Kinematics<double>&, Configuration<double>&);
template void evaluate_residual<double>(const System&, const Parameters&, const Configuration<double>&,
                                        const Configuration<double>&, const Kinematics<double>&,
                                        Residual<double>&);
template void evaluate_residual<Extended>(const System&, const Parameters&, const Configuration<Extended>&,
                                          const Configuration<Extended>&, const Kinematics<Extended>&,
                                          Residual<Extended>&);
template void evaluate_residual<Dual>(const System&, const BasicParameters<Dual>&, const Configuration<Dual>&,
                                      const Configuration<Dual>&, const Kinematics<Dual>&, Residual<Dual>&);

} // namespace flyball
