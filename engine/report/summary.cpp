#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report.hpp"
#include "engine/system/dampers.hpp"

#include <algorithm>

namespace flyball {

SystemSummary summarize(const Mechanism& mechanism, const System& system, const Parameters& p) {
  SystemSummary out;
  out.notes = notes(system, mechanism);
  out.bodies = static_cast<int>(mechanism.bodies.size());
  out.free_coordinates = system.nv - static_cast<int>(system.torques.size());
  out.driven_coordinates = static_cast<int>(system.drives.size());
  out.constraint_equations = system.rows;
  Eigen::VectorXd drawn;
  drawn_configuration(system, p, drawn);
  std::vector<CoordinateSolution> at_drawn; // where joints that close loops turn
  if (std::ranges::any_of(system.cuts, &CutJoint::turns)) {
    Kinematics<double> k;
    forward<double>(system, p, drawn, 0, k);
    at_drawn = coordinate_solutions(system, p, drawn, Eigen::VectorXd::Zero(system.nv), k);
  }
  for (std::size_t i = 0; i < system.reported.size(); ++i) {
    const ReportedCoordinate& r = system.reported[i];
    CoordinateSolution x;
    x.joint = r.joint;
    x.index = r.index;
    x.count = r.count;
    x.angle = r.angle;
    x.scale = r.angle ? 1 : p.length;
    x.dependent = r.cut >= 0;
    if (x.dependent) {
      x.value = p.cuts[static_cast<std::size_t>(r.cut)].drawn[static_cast<std::size_t>(r.index)];
      if (!at_drawn.empty()) {
        x.driven = at_drawn[i].driven;
        x.speed = at_drawn[i].speed;
      }
    } else {
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(r.coordinate)];
      x.driven = system.links[static_cast<std::size_t>(c.link)].drive >= 0;
      x.value = coordinate_value(system, p, drawn, c);
      if (const Link& link = system.links[static_cast<std::size_t>(c.link)]; finds_speed(link)) {
        x.speed = drawn[link.q];
        x.speed_scale = found_scale(system, p, c);
      }
    }
    out.coordinates.push_back(std::move(x));
  }
  for (const TreeJoint& t : system.tree_joints)
    (t.joint < 0 ? out.implicit_joints : out.tree_joints).push_back(t.name);
  for (const CutJoint& c : system.cuts)
    out.cut_joints.push_back(mechanism.joints[static_cast<std::size_t>(c.joint)].name);
  const auto say = [&](bool in, std::string_view pass) { (in ? out.in : out.left_out).emplace_back(pass); };
  say(system.rows > 0, "loops: multipliers and constraint rows");
  say(p.moving, "motion of the drives: centrifugal and gyroscopic forces");
  if (!system.torques.empty()) out.in.emplace_back("torques of drives: their speeds are among the unknowns");
  say(!p.gravity.isZero(0), "gravity");
  const auto has_elastic = [](const LinkParameters& l) {
    return std::ranges::any_of(l.force, [](const CoordinateForce& f) { return f.elastic(); });
  };
  say(std::ranges::any_of(p.links, has_elastic), "springs and stops in joints");
  if (has_friction(mechanism))
    out.in.emplace_back("dry friction in joints: the steady state is a band");
  else if (rubs_anywhere(mechanism))
    out.in.emplace_back("dry friction at given speeds: it loads the drives");
  say(!system.springs.empty(), "springs between points");
  if (!system.bearings.empty())
    out.in.emplace_back(system.conservative
                            ? "bearings: stiffness and damping matrices"
                            : "bearings: matrices that feed whirl, or dampers between drives");
  say(!system.body_forces.empty() || !system.turning_air.empty(), "forces, torques and the air");
  say(has_dampers(p), "dampers: in the eigenvalues, and in the balance where parts turn against each other");
  say(std::ranges::any_of(system.links,
                          [](const Link& l) { return l.type == LinkType::spherical && l.v >= 0; }),
      "rotations as quaternions");
  say(!(system.conservative && system.single_drives),
      system.conservative && system.single_drives
          ? "general matrices: the forces are conservative, a symmetric one serves"
          : "general matrices");
  if (system.nv > 0)
    out.in.emplace_back(system.kkt_form == KktForm::tree
                            ? "elimination along the tree: cost in proportion to the bodies"
                        : system.kkt_form == KktForm::sparse
                            ? "sparse equations of all bodies: each feels its neighbours alone"
                            : "dense equations: the fastest for few coordinates");
  say(!p.phase_free, p.phase_free
                         ? "checks at other phases of the drives: the mechanism's shape makes all alike"
                         : "checks at other phases of the drives");
  return out;
}

} // namespace flyball
