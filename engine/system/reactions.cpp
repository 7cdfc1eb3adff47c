#include "engine/system/reactions.hpp"

#include "engine/system/air_force.hpp"
#include "engine/system/bearing.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/drive_torque.hpp"

#include <algorithm>
#include <span>

namespace flyball {
namespace {

struct Wrench {
  Vec3 moment = Vec3::Zero(), force = Vec3::Zero(); // about the link's origin
};

void add_gears(const System& system, const Parameters& p, const Eigen::VectorXd& lambda,
               const std::vector<double>& loads, std::vector<GearForces>& out) {
  std::vector<int> link_of; // by coordinate of q_R
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    if (cut.type != JointType::gear) continue;
    const double multiplier = lambda[cut.first_row]; // of q_b - ratio q_a - offset
    GearForces g{cut.joint, {-1, p.cuts[c].ratio * multiplier}, {-1, -multiplier}};
    if (link_of.empty()) {
      link_of.resize(static_cast<std::size_t>(system.nv), -1);
      for (std::size_t l = 0; l < system.links.size(); ++l)
        if (const int v = system.links[l].v; v >= 0)
          link_of[static_cast<std::size_t>(v)] = static_cast<int>(l);
    }
    g.a.link = link_of[static_cast<std::size_t>(cut.gear_va)];
    g.b.link = link_of[static_cast<std::size_t>(cut.gear_vb)];
    out.push_back(g);
  }
  for (const int joint : system.dropped_gears) {
    GearForces g{joint, {}, {}};
    // What lies beyond the gear, as it is felt at its farther end.
    const DrivenCoordinate *far = nullptr, *near = nullptr;
    for (const DrivenCoordinate& d : system.drives)
      if (!d.gears.empty() && d.gears.back() == joint) far = &d;
    if (far) {
      const std::span<const int> before(far->gears.data(), far->gears.size() - 1);
      for (const DrivenCoordinate& d : system.drives)
        if (d.motor == far->motor && std::ranges::equal(d.gears, before)) near = &d;
    }
    if (far && near) {
      const auto ratio = [&](const DrivenCoordinate& d) {
        return p.links[static_cast<std::size_t>(d.link)].gear_ratio;
      };
      g.a.link = near->link;
      g.b.link = far->link;
      for (std::size_t i = 0; i < system.drives.size(); ++i)
        if (const DrivenCoordinate& d = system.drives[i]; std::ranges::find(d.gears, joint) != d.gears.end())
          g.b.value += loads[i] * ratio(d) / ratio(*far);
      g.a.value = -g.b.value * ratio(*far) / ratio(*near);
    }
    out.push_back(g);
  }
}

} // namespace

TransmittedForces transmitted_forces(const System& system, const Parameters& p, const Eigen::VectorXd& lambda,
                                     const Kinematics<double>& k, const Residual<double>& residual) {
  const std::size_t n = system.links.size();
  // What each link's joint must supply: first by the link's own elements, then with its subtree's.
  std::vector<Wrench> needed(n);
  const auto add = [&](int link, const Vec3& point, const Vec3& force, const Vec3& torque) {
    if (link < 0) return;
    Wrench& w = needed[static_cast<std::size_t>(link)];
    w.force += force;
    w.moment += torque + (point - k.at(link).o).cross(force);
  };
  TransmittedForces out;
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const PairEnds& ends = system.springs[i].ends;
    const SpringState<double> s = spring_state(system.springs[i], p.springs[i], k);
    add(ends.b, s.b, s.tension * s.direction, Vec3::Zero());
    add(ends.a, s.a, -s.tension * s.direction, Vec3::Zero());
  }
  for (std::size_t i = 0; i < system.cut_dampers.size(); ++i) {
    const CutDamperElement& e = system.cut_dampers[i];
    const CutDamperState<double> s = cut_damper_state<double>(e, p.cut_dampers[i], k);
    const Vec3 resistance = s.resistance * s.axis;
    const Vec3 force = e.angular ? Vec3::Zero() : resistance, torque = e.angular ? resistance : Vec3::Zero();
    add(e.ends.b, s.b, force, torque);
    add(e.ends.a, s.b, -force, -torque);
  }
  for (std::size_t i = 0; i < system.bearings.size(); ++i) {
    const PairEnds& ends = system.bearings[i].ends;
    const BearingState<double> s = bearing_state<double>(system.bearings[i], p.bearings[i], k);
    add(ends.b, s.point, s.force, s.moment);
    add(ends.a, s.point, -s.force, -s.moment);
    out.bearings.push_back({-s.force, -s.moment, s.point});
  }
  for (std::size_t i = 0; i < system.turning_air.size(); ++i) {
    const TurningAirElement& e = system.turning_air[i];
    const TurningAirForce<double> air = turning_air_force<double>(e, p.turning_air[i], k);
    add(e.ends.b, air.point, -air.force, Vec3::Zero());
    add(e.ends.a, air.point, air.force, Vec3::Zero());
  }
  out.cuts.resize(system.cuts.size());
  std::size_t damper = 0;
  for (std::size_t i = 0; i < system.cuts.size(); ++i) {
    const CutJoint& cut = system.cuts[i];
    if (cut.type == JointType::gear) continue;
    const CutParameters& f = p.cuts[i];
    JointWrench& w = out.cuts[i];
    w.point = k.point(cut.ends.b, f.b);
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const double multiplier = lambda[cut.first_row + static_cast<int>(r)];
      const ConstraintRow& row = cut.rows[r];
      const Vec3 u = k.at(cut.ends.a).R * f.frame[static_cast<std::size_t>(row.u)];
      switch (row.type) {
      case RowType::distance:
        w.force -= multiplier * (w.point - k.point(cut.ends.a, f.a)).normalized();
        break;
      case RowType::point: w.force -= multiplier * u; break;
      case RowType::direction:
        w.torque -= multiplier * (k.at(cut.ends.b).R * f.frame[static_cast<std::size_t>(row.w)]).cross(u);
        break;
      case RowType::gear: break;
      }
    }
    add(cut.ends.b, w.point, -w.force, -w.torque);
    add(cut.ends.a, w.point, w.force, w.torque);
    // Damping in a cut joint is part of what the joint transmits. Dampers are in the order of their joints.
    for (; damper < system.cut_dampers.size() && system.cut_dampers[damper].joint == cut.joint; ++damper) {
      const CutDamperElement& e = system.cut_dampers[damper];
      const CutDamperState<double> s = cut_damper_state<double>(e, p.cut_dampers[damper], k);
      (e.angular ? w.torque : w.force) -= s.resistance * s.axis;
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    const int parent = system.links[i].parent;
    if (parent >= 0) add(parent, k.links[i].o, needed[i].force, needed[i].moment);
  }
  for (std::size_t i = 0; i < n; ++i) {
    needed[i].force += residual.force[i];
    needed[i].moment += residual.moment[i];
  }
  out.tree.resize(system.tree_joints.size());
  for (std::size_t t = 0; t < system.tree_joints.size(); ++t) {
    const TreeJoint& joint = system.tree_joints[t];
    const int last = joint.first_link + joint.link_count - 1;
    const Wrench& w = needed[static_cast<std::size_t>(last)];
    JointWrench& o = out.tree[t];
    if (joint.joint < 0) continue;
    // `at` as the joint's own child carries it; the tree may run the other way.
    if (joint.closes_loop || !joint.reversed) {
      o.point = k.at(last).o;
    } else {
      const Link& first = system.links[static_cast<std::size_t>(joint.first_link)];
      o.point = k.point(first.parent, p.links[static_cast<std::size_t>(joint.first_link)].offset);
    }
    const double sign = joint.reversed ? -1 : 1;
    o.force = sign * w.force;
    o.torque = sign * (w.moment + (k.at(last).o - o.point).cross(w.force));
  }
  std::vector<double> loads; // of the driven coordinates
  out.drives.assign(system.drives.size(), 0);
  for (const DrivenCoordinate& d : system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const LinkState<double>& x = k.links[l];
    const CoordinateForce& own = p.links[l].force[0];
    const bool found = finds_speed(system.links[l]);
    const double rubbed = found ? 0 : own.friction; // of a speed that is found the balance has it
    const double carried =
        x.axis.dot(system.links[l].type == LinkType::revolute ? needed[l].moment : needed[l].force) +
        own.resistance(found ? turning_rate(system, d.link, k) : p.links[l].speed) - rubbed;
    loads.push_back(carried);
    out.drives[static_cast<std::size_t>(d.motor)] += carried * p.links[l].gear_ratio;
  }
  for (std::size_t c = 0; c < system.cuts.size(); ++c) // gears between speeds that are found
    if (const CutJoint& cut = system.cuts[c]; cut.by_rates && cut.type == JointType::gear)
      row_gradient(cut, p.cuts[c], cut.rows[0], k, [&](int v, double g) {
        for (std::size_t d = 0; d < system.drives.size(); ++d)
          if (system.links[static_cast<std::size_t>(system.drives[d].link)].v == v)
            out.drives[d] += g * lambda[cut.first_row];
      });
  add_gears(system, p, lambda, loads, out.gears);
  return out;
}

} // namespace flyball
