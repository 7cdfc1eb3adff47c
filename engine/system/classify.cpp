#include "engine/system/classify.hpp"

#include <algorithm>

namespace flyball {
namespace {

// See BodyForceElement::constant, of what is no force of the air.
bool is_constant(const System& s, int body_link, const Force& f) {
  int turning = 0, sliding = 0;
  for (int l = body_link; l >= 0;) {
    const Link& x = s.links[static_cast<std::size_t>(l)];
    l = x.parent;
    if (x.v < 0) continue;
    if (x.drive >= 0 || x.type == LinkType::spherical) return false;
    ++(x.type == LinkType::revolute ? turning : sliding);
  }
  // About one axis what turns with the body does the same work as what does not; where it slides before it
  // turns, a force's direction matters.
  return turning == 0 || (turning == 1 && (f.type == ForceType::torque || sliding == 0));
}

} // namespace

void find_potential(const Mechanism& m, System& s) {
  const auto move_against_each_other = [&](const PairEnds& ends) {
    return moving_frame(s, ends.a) != moving_frame(s, ends.b);
  };
  for (const DrivenCoordinate& d : s.drives) {
    const int parent = s.links[static_cast<std::size_t>(d.link)].parent;
    if (moving_frame(s, parent) >= 0 || (parent >= 0 && s.links[static_cast<std::size_t>(parent)].mobile))
      s.single_drives = false;
  }
  for (BodyForceElement& e : s.body_forces) {
    const Force& f = m.forces[static_cast<std::size_t>(e.force)];
    if (f.type == ForceType::force && f.frame == ForceFrame::world) continue;
    e.constant = !is_of_air(f.type) && is_constant(s, e.link, f);
    if (!e.constant) s.conservative = false;
  }
  for (const PointSpringElement& e : s.springs)
    if (const Force& f = m.forces[static_cast<std::size_t>(e.force)];
        (f.damping != 0 || f.damping_force) && move_against_each_other(e.ends))
      s.conservative = false;
  for (const CutDamperElement& e : s.cut_dampers)
    if (move_against_each_other(e.ends)) s.conservative = false;
  for (const TurningAirElement& e : s.turning_air) // takes energy alone, as dampers do
    if (move_against_each_other(e.ends)) s.conservative = false;
  // A bearing's matrices may be symmetric, but the next number may change that.
  s.conservative = s.conservative && s.bearings.empty();
  s.conservative_at_speeds = s.conservative;
  s.conserves = s.conservative && std::ranges::all_of(s.torques, &DriveTorqueElement::keeps_momentum);
  s.conservative = s.conservative && s.torques.empty();
}

void choose_kkt_form(System& s) {
  // Below some coordinates the dense equations are faster (measured: `flyball_bench`, chains).
  // Without a potential stability asks for eigenvalues, and so for the matrices, as far as those are found.
  constexpr int few = 8, few_for_bodies = 60, few_without_potential = 200;
  const bool potential = s.conservative && s.single_drives;
  if (!s.torques.empty()) {
    if (s.nv > few + static_cast<int>(s.torques.size()) && speeds_can_border(s)) s.kkt_form = KktForm::tree;
    return;
  }
  if (!s.bearings.empty() || !s.turning_air.empty() || !no_drive_rides(s) ||
      s.nv <= (potential ? few : few_without_potential))
    return;
  if (is_plain_tree(s))
    s.kkt_form = KktForm::tree;
  else if (s.nv > few_for_bodies)
    s.kkt_form = KktForm::sparse;
}

bool no_drive_rides(const System& system) {
  return std::ranges::none_of(system.drives, [&](const DrivenCoordinate& d) {
    const int parent = system.links[static_cast<std::size_t>(d.link)].parent;
    return parent >= 0 && system.links[static_cast<std::size_t>(parent)].mobile;
  });
}

bool is_plain_tree(const System& system) {
  return system.rows == 0 && system.springs.empty() && system.cut_dampers.empty() &&
         system.bearings.empty() && system.turning_air.empty() && no_drive_rides(system);
}

bool speeds_can_border(const System& system) {
  const auto plain = [&](const DriveLaw& law) {
    return std::ranges::none_of(law.inputs, [&](const DriveLaw::Input& input) {
      if (input.coordinate < 0) return false;
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
      return system.links[static_cast<std::size_t>(c.link)].type == LinkType::spherical;
    });
  };
  return system.conservative_at_speeds && system.single_drives && is_plain_tree(system) &&
         std::ranges::all_of(system.torques, [&](const DriveTorqueElement& torque) {
           return !torque.keeps_momentum && !torque.implied && plain(torque.torque) && plain(torque.load);
         });
}

} // namespace flyball
