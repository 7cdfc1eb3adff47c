#include "engine/system/linearization.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/system/air_force.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/kept_momentum.hpp"
#include "engine/system/pair_stiffness.hpp"
#include "engine/system/rotation_vector.hpp"

#include <limits>
#include <optional>

namespace flyball {
namespace {

using Columns = std::vector<Column<double>>;

int column_count(const Link& link) {
  return link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
}

void fill_screws(const System& system, const Parameters& p, const Kinematics<double>& k,
                 std::vector<ScrewRates>& out) {
  out.resize(static_cast<std::size_t>(system.nv));
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    for (int v = link.v; v < link.v + column_count(link); ++v)
      out[static_cast<std::size_t>(v)] = screw_rates(system, p, k, static_cast<int>(i), v);
  }
}

void fill_composites(const System& system, const Parameters& p, const Kinematics<double>& k,
                     std::vector<CompositeBody>& out) {
  out.resize(system.links.size());
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    CompositeBody& b = out[i];
    const LinkParameters& lp = p.links[i];
    const LinkState<double>& x = k.links[i];
    if (!system.links[i].mobile) continue; // which no coordinate moves
    b.mass = lp.mass;
    if (lp.mass == 0 && !lp.has_inertia) {
      b = {0, Vec3::Zero(), Mat3::Zero(), Mat3::Zero(), Vec3::Zero()};
      continue;
    }
    const Vec3 c = x.R * lp.com;
    const Mat3 inertia = lp.has_inertia ? Mat3(x.R * lp.inertia * x.R.transpose()) : Mat3(Mat3::Zero());
    b.first_moment = lp.mass * c;
    b.inertia = inertia - lp.mass * skew_product(c, c);
    if (!p.moving) {
      b.b.setZero();
      b.momentum.setZero();
      continue;
    }
    b.momentum = lp.mass * (x.v + x.w.cross(c));
    b.b = -2 * skew_product(c, b.momentum);
    if (!lp.has_inertia) continue;
    const Mat3 swept = skew(x.w) * inertia;
    b.b += swept + swept.transpose() - skew<double>(inertia * x.w);
  }
  for (std::size_t i = system.links.size(); i-- > 0;) {
    const int parent = system.links[i].parent;
    if (parent < 0 || !system.links[static_cast<std::size_t>(parent)].mobile) continue;
    const CompositeBody& b = out[i];
    CompositeBody& a = out[static_cast<std::size_t>(parent)];
    const Vec3 r = k.links[i].o - k.at(parent).o;
    const Vec3 first_moment = b.first_moment + b.mass * r;
    a.mass += b.mass;
    a.first_moment += first_moment;
    a.inertia += b.inertia - skew_product(r, b.first_moment) - skew_product(first_moment, r);
    a.momentum += b.momentum;
    if (p.moving) a.b += b.b - 2 * skew_product(r, b.momentum);
  }
}

// The nearest link with coordinates of its own from here to the root, itself included; -1: none.
int nearest_free(const System& system, int link) {
  while (link >= 0 && system.links[static_cast<std::size_t>(link)].v < 0)
    link = system.links[static_cast<std::size_t>(link)].parent;
  return link;
}

// Adds, for every pair of coordinates on a common path, wrench(j) projected on i (j at or beyond i), and
// row(i) applied to j (j strictly before i), where the column j is one of the links that `wants` says.
template <class Wants, class WrenchOf, class RowOf, class Apply>
void fill_tree(const System& system, const Kinematics<double>& k, const std::vector<ScrewRates>& screws,
               Eigen::MatrixXd& out, Wants wants, WrenchOf wrench_of, RowOf row_of, Apply apply) {
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    interruption_point();
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    const int nearest = nearest_free(system, link.parent);
    for (int j = link.v; j < link.v + column_count(link); ++j) {
      const ScrewRates& own = screws[static_cast<std::size_t>(j)];
      LinearizedWrench u{};
      if (wants(link)) {
        u = wrench_of(l, own);
        for (int i = link.v; i < link.v + column_count(link); ++i) {
          const ScrewRates& s = screws[static_cast<std::size_t>(i)];
          out(i, j) += s.sw.dot(u.moment) + s.sv.dot(u.force);
        }
      }
      std::optional<decltype(row_of(l, own))> row;
      for (int a = nearest; a >= 0;
           a = nearest_free(system, system.links[static_cast<std::size_t>(a)].parent)) {
        const Link& other = system.links[static_cast<std::size_t>(a)];
        const Vec3 arm = k.links[l].o - k.at(a).o;
        if (wants(other) && !row) row = row_of(l, own);
        for (int i = other.v; i < other.v + column_count(other); ++i) {
          const ScrewRates& s = screws[static_cast<std::size_t>(i)];
          if (wants(link)) out(i, j) += s.sw.dot(u.moment + arm.cross(u.force)) + s.sv.dot(u.force);
          if (wants(other)) out(j, i) += apply(*row, s, arm);
        }
      }
    }
  }
}

constexpr auto all_columns = [](const Link&) { return true; };

// The covectors S^T I and S^T B of a link's coordinate, about its own origin; B acts on angular rates alone.
struct LinearizedRow {
  LinearizedWrench inertia;
  Vec3 b;
};

double apply_inertia(const LinearizedRow& row, const Vec3& w, const Vec3& v, const Vec3& arm) {
  return w.dot(row.inertia.moment + arm.cross(row.inertia.force)) + v.dot(row.inertia.force);
}

// Calls visit(v) for every free coordinate from the link to the root.
template <class Visit>
void for_coordinates_of(const System& system, int link, Visit visit) {
  for (int l = link; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
    const Link& x = system.links[static_cast<std::size_t>(l)];
    for (int c = 0; c < column_count(x); ++c)
      visit(x.v + c);
  }
}

void add_body_forces(const System& system, const Parameters& p, const Kinematics<double>& k,
                     const std::vector<ScrewRates>& screws, Eigen::MatrixXd& out) {
  for (std::size_t n = 0; n < system.body_forces.size(); ++n) {
    interruption_point();
    const BodyForceElement& e = system.body_forces[n];
    const BodyForceParameters& f = p.body_forces[n];
    // A force fixed in the body turns with it, which is what the subtree sums assume.
    const bool air = is_of_air(f.type);
    if (e.link < 0 || (!air && f.frame == ForceFrame::body)) continue;
    const AppliedForce<double> a = applied_force(e, f, k);
    const Mat3 slope =
        air ? air_force_slope(f, k.at(e.link).R, f.wind - k.velocity(e.link, a.point)) : Mat3(Mat3::Zero());
    for_coordinates_of(system, e.link, [&](int vj) {
      const Column<double>& j = k.columns[static_cast<std::size_t>(vj)];
      Vec3 force = j.turn().cross(a.force);
      const Vec3 torque = j.turn().cross(a.torque);
      if (air) { // turned with the body, which the wind is not
        const ScrewRates& s = screws[static_cast<std::size_t>(vj)];
        force = slope * (s.dv + s.dw.cross(a.point - j.o) + j.turn().cross(f.wind));
      }
      for_coordinates_of(system, e.link, [&](int vi) {
        const Column<double>& i = k.columns[static_cast<std::size_t>(vi)];
        out(vi, vj) += i.at(a.point).dot(force) + i.turn().dot(torque);
      });
    });
  }
}

} // namespace

LinearizedWrench times_inertia(const CompositeBody& b, const Vec3& w, const Vec3& v) {
  return {b.inertia * w + b.first_moment.cross(v), b.mass * v - b.first_moment.cross(w)};
}

Mat3 rotation_stiffness(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q) {
  const Vec3 r = rotation_vector(link, p, q);
  const Mat3 j = inverse_left_jacobian(r), r0 = p.drawn_rotation.toRotationMatrix();
  Vec3 g, curvature;
  for (int i = 0; i < 3; ++i) {
    g[i] = p.force[static_cast<std::size_t>(i)].gradient(r[i]);
    curvature[i] = p.force[static_cast<std::size_t>(i)].curvature(r[i]);
  }
  Mat3 out;
  for (int i = 0; i < 3; ++i) {
    const Vec3 dr = link.reversed ? Vec3(-j.transpose() * r0.row(i).transpose()) : Vec3(j.col(i));
    const Mat3 dj = inverse_left_jacobian_derivative(r, dr);
    const Vec3 dg = curvature.cwiseProduct(dr);
    out.col(i) =
        link.reversed ? Vec3(-r0 * (dj * g + j * dg)) : Vec3(dj.transpose() * g + j.transpose() * dg);
  }
  return out;
}

Mat3 rotation_damping(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q) {
  const Mat3 rate = rotation_vector_rate(link, p, q);
  const Vec3 c(p.force[0].damping, p.force[1].damping, p.force[2].damping);
  return rate.transpose() * c.asDiagonal() * rate;
}

namespace {

LinearizedRow inertia_row(const CompositeBody& b, const ScrewRates& s) {
  return {times_inertia(b, s.sw, s.sv), b.b.transpose() * s.sw - 2 * s.sv.cross(b.momentum)};
}

LinearizedWrench velocity_wrench(const CompositeBody& b, const ScrewRates& s) {
  LinearizedWrench u = times_inertia(b, 2 * s.dw, 2 * s.dv);
  u.moment += b.b * s.sw;
  u.force -= 2 * b.momentum.cross(s.sw);
  return u;
}

double apply_velocity(const LinearizedRow& row, const ScrewRates& s, const Vec3& arm) {
  return 2 * apply_inertia(row, s.dw, s.dv, arm) + s.sw.dot(row.b);
}

// The entries of `velocity` in the column of a speed that is among the unknowns, without dampers.
void fill_speed_column(const System& system, const Kinematics<double>& k, int turning, Linearization& out) {
  const int v = system.links[static_cast<std::size_t>(turning)].v;
  const ScrewRates& own = out.screws[static_cast<std::size_t>(v)];
  const LinearizedWrench u = velocity_wrench(out.composites[static_cast<std::size_t>(turning)], own);
  const Vec3& origin = k.at(turning).o;
  for (int a = turning; a >= 0; a = nearest_free(system, system.links[static_cast<std::size_t>(a)].parent)) {
    const Link& other = system.links[static_cast<std::size_t>(a)];
    const Vec3 moment = u.moment + (origin - k.at(a).o).cross(u.force);
    for (int i = other.v; i < other.v + column_count(other); ++i) {
      const ScrewRates& s = out.screws[static_cast<std::size_t>(i)];
      out.velocity(i, v) += s.sw.dot(moment) + s.sv.dot(u.force);
    }
  }
  for (std::size_t l = static_cast<std::size_t>(turning) + 1; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0 || !hangs_from(system, static_cast<int>(l), turning)) continue;
    for (int i = link.v; i < link.v + column_count(link); ++i)
      out.velocity(i, v) +=
          apply_velocity(inertia_row(out.composites[l], out.screws[static_cast<std::size_t>(i)]), own,
                         k.links[l].o - origin);
  }
}

// What has no inertia about its own axis, as a thin rod that turns about itself, has rounding of what it has
// about others.
void clear_rounding_of_mass(const System& system, Linearization& out) {
  constexpr double negligible = 32 * std::numeric_limits<double>::epsilon();
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const int v = system.links[l].v;
    if (v < 0 || system.links[l].type != LinkType::revolute ||
        out.mass(v, v) > negligible * out.composites[l].inertia.norm())
      continue;
    out.mass.row(v).setZero();
    out.mass.col(v).setZero();
  }
}

// Of a system whose linearize() has filled screws and composites.
void fill_velocity(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                   const Kinematics<double>& k, Linearization& out) {
  out.velocity.setZero(system.nv, system.nv);
  if (p.moving)
    fill_tree(
        system, k, out.screws, out.velocity, all_columns,
        [&](std::size_t l, const ScrewRates& s) { return velocity_wrench(out.composites[l], s); },
        [&](std::size_t l, const ScrewRates& s) { return inertia_row(out.composites[l], s); },
        apply_velocity);
  add_damping(system, p, q, k, out.velocity);
  add_drive_torque_damping(system, p, q, k, out.velocity);
}

// Calls act(v) for every speed that is among the unknowns.
template <class Act>
void for_speeds(const System& system, const Act& act) {
  for (const DriveTorqueElement& drive : system.torques)
    if (const Link& link = system.links[static_cast<std::size_t>(drive.link)]; finds_speed(link)) act(link.v);
}

} // namespace

ScrewRates screw_rates(const System& system, const Parameters& p, const Kinematics<double>& k, int l, int v) {
  const Link& link = system.links[static_cast<std::size_t>(l)];
  const Column<double>& column = k.columns[static_cast<std::size_t>(v)];
  const Vec3& a = column.axis;
  ScrewRates s;
  s.sw = column.angular ? a : Vec3(Vec3::Zero());
  s.sv = column.angular ? Vec3(Vec3::Zero()) : a;
  // Own motion about or along a single axis changes nothing here; about three it does.
  const LinkState<double>& parent = k.at(link.type == LinkType::spherical ? l : link.parent);
  if (!p.moving) {
    s.dw.setZero();
    s.dv.setZero();
    s.ddw.setZero();
    s.ddv = column.angular ? Vec3(k.ground.dv.cross(a)) : Vec3(Vec3::Zero());
    return s;
  }
  // The parent's motion as a field, at this link's origin.
  const Vec3 arm = column.o - parent.o;
  const Vec3 v_here = parent.v + parent.w.cross(arm);
  const Vec3 acceleration = parent.dv + parent.dw.cross(arm) + parent.w.cross(parent.w.cross(arm));
  const Vec3 spatial = acceleration - parent.w.cross(v_here);
  if (column.angular) {
    s.dw = parent.w.cross(a);
    s.dv = v_here.cross(a);
    s.ddw = parent.dw.cross(a);
    s.ddv = spatial.cross(a);
  } else {
    s.dw.setZero();
    s.dv = parent.w.cross(a);
    s.ddw.setZero();
    s.ddv = parent.dw.cross(a);
  }
  s.ddw += parent.w.cross(s.dw);
  s.ddv += parent.w.cross(s.dv) + v_here.cross(s.dw);
  return s;
}

void linearize_constraints(const System& system, const Parameters& p, const Kinematics<double>& k,
                           Linearization& out) {
  out.constraint.setZero(system.rows, system.nv);
  for (std::size_t c = 0; c < system.cuts.size(); ++c)
    for (std::size_t r = 0; r < system.cuts[c].rows.size(); ++r)
      row_gradient(system.cuts[c], p.cuts[c], system.cuts[c].rows[r], k, [&](int v, double g) {
        out.constraint(system.cuts[c].first_row + static_cast<int>(r), v) += g;
      });
  for (const CutJoint& cut : system.cuts) // other loops are closed at any speed
    if (!cut.by_rates)
      for_speeds(system, [&](int v) {
        out.constraint.block(cut.first_row, v, static_cast<Eigen::Index>(cut.rows.size()), 1).setZero();
      });
}

void linearize(const System& system, const Parameters& p, const Eigen::VectorXd& q,
               const Eigen::VectorXd& lambda, const Kinematics<double>& k, const Residual<double>& residual,
               Linearization& out) {
  out.stiffness.setZero(system.nv, system.nv);
  fill_screws(system, p, k, out.screws);
  fill_composites(system, p, k, out.composites);
  fill_tree(
      system, k, out.screws, out.stiffness,
      [](const Link& link) { return !finds_speed(link); }, // whose columns are of `velocity`, below
      [&](std::size_t l, const ScrewRates& s) {
        const CompositeBody& b = out.composites[l];
        LinearizedWrench u = times_inertia(b, s.ddw, s.ddv);
        u.moment += s.sw.cross(residual.moment[l]) + s.sv.cross(residual.force[l]) + b.b * s.dw;
        u.force += s.sw.cross(residual.force[l]) - 2 * b.momentum.cross(s.dw);
        return u;
      },
      [&](std::size_t l, const ScrewRates& s) {
        const CompositeBody& b = out.composites[l];
        return LinearizedRow{times_inertia(b, s.sw, s.sv),
                             b.b.transpose() * s.sw - 2 * s.sv.cross(b.momentum)};
      },
      [](const LinearizedRow& row, const ScrewRates& s, const Vec3& arm) {
        return apply_inertia(row, s.ddw, s.ddv, arm) + s.dw.dot(row.b);
      });
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    interruption_point();
    const Link& link = system.links[l];
    if (link.v < 0 || !p.links[l].elastic) continue;
    if (link.type == LinkType::spherical)
      out.stiffness.block<3, 3>(link.v, link.v) += rotation_stiffness(link, p.links[l], q);
    else
      out.stiffness(link.v, link.v) += p.links[l].force[0].curvature(q[link.q]);
  }
  add_body_forces(system, p, k, out.screws, out.stiffness);
  add_pair_stiffness(system, p, lambda, k, out.screws, out.stiffness);
  linearize_constraints(system, p, k, out);
  if (system.torques.empty()) return;
  add_drive_torque_stiffness(system, p, q, k, out.stiffness);
  if (system.drives.empty()) return; // of the motion
  out.velocity.setZero(system.nv, system.nv);
  add_damping(system, p, q, k, out.velocity);
  add_drive_torque_damping(system, p, q, k, out.velocity);
  for (const DriveTorqueElement& drive : system.torques)
    if (finds_speed(system.links[static_cast<std::size_t>(drive.link)]))
      fill_speed_column(system, k, drive.link, out);
  for_speeds(system, [&](int v) { out.stiffness.col(v) = out.velocity.col(v); });
  set_kept_momentum_stiffness(system, p, k, out);
}

void linearize_motion(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                      const Kinematics<double>& k, Linearization& out) {
  out.mass.setZero(system.nv, system.nv);
  fill_tree(
      system, k, out.screws, out.mass, all_columns,
      [&](std::size_t l, const ScrewRates& s) { return times_inertia(out.composites[l], s.sw, s.sv); },
      [&](std::size_t l, const ScrewRates& s) { return inertia_row(out.composites[l], s); },
      [](const LinearizedRow& row, const ScrewRates& s, const Vec3& arm) {
        return apply_inertia(row, s.sw, s.sv, arm);
      });
  clear_rounding_of_mass(system, out);
  fill_velocity(system, p, q, k, out);
}

double coordinate_damping(const System& system, const Parameters& p, int link, const Kinematics<double>& k) {
  const CoordinateForce& f = p.links[static_cast<std::size_t>(link)].force[0];
  return f.laws ? f.resistance_slope(turning_rate(system, link, k)) : f.damping;
}

void add_damping(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                 const Kinematics<double>& k, Eigen::MatrixXd& velocity) {
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    interruption_point();
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical)
      velocity.block<3, 3>(link.v, link.v) += rotation_damping(link, p.links[l], q);
    else
      velocity(link.v, link.v) += coordinate_damping(system, p, static_cast<int>(l), k);
  }
  for (std::size_t n = 0; n < system.body_forces.size(); ++n) {
    interruption_point();
    const BodyForceElement& e = system.body_forces[n];
    const BodyForceParameters& f = p.body_forces[n];
    if (e.link < 0 || !is_of_air(f.type)) continue;
    const Vec3 point = k.point(e.link, f.at);
    const Mat3 slope = air_force_slope(f, k.at(e.link).R, f.wind - k.velocity(e.link, point));
    for_coordinates_of(system, e.link, [&](int vj) {
      const Vec3 force = slope * k.columns[static_cast<std::size_t>(vj)].at(point);
      for_coordinates_of(system, e.link, [&](int vi) {
        velocity(vi, vj) += k.columns[static_cast<std::size_t>(vi)].at(point).dot(force);
      });
    });
  }
  add_pair_damping(system, p, k, velocity);
}

} // namespace flyball
