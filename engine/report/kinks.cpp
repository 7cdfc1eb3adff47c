#include "engine/report/kinks.hpp"

#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/residual.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace flyball {
namespace {

// Slopes before and after a jump within some 1e-8 of `size` beside x.
std::optional<std::array<double, 2>> jump_at(const BoundLaw& law, double x, double size) {
  if (!law) return {};
  const auto slopes = [&](double h) { return std::array{law.slope(x - h), law.slope(x + h)}; };
  const auto difference = [](const std::array<double, 2>& s) { return std::abs(s[1] - s[0]); };
  constexpr double far = 1e-6, near = far / 64;
  const auto wide = slopes(far * size), close = slopes(near * size);
  const double largest = std::max(std::abs(close[0]), std::abs(close[1]));
  // A smooth slope differs by 1/64 as much.
  if (!(difference(close) > 1e-6 * largest) || difference(close) < 0.5 * difference(wide)) return {};
  return close;
}

std::string jump_text(const std::array<double, 2>& slopes, std::string_view unit) {
  return " from " + rounded_text(slopes[0], 4) + " to " + rounded_text(slopes[1], 4) + " " +
         std::string(unit);
}

void say(const std::optional<std::array<double, 2>>& jump, const std::string& whose, bool damper,
         std::string_view unit, Kinks& out) {
  if (!jump) return;
  (damper ? out.damper : out.spring) = true;
  out.message +=
      std::string(out.message.empty() ? "" : " ") + "The " + (damper ? "damper" : "spring") + " of " + whose +
      " stands on a kink of its law, where its " + (damper ? "damping" : "stiffness") + " jumps" +
      jump_text(*jump, unit) + ": " +
      (damper ? "eigenvalues hold on one side of it."
              : "rates and eigenvalues hold on one side of it, and whether it is stable stays open.");
}

} // namespace

Kinks find_kinks(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& q, Workspace& w) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  Kinks out;
  for (const ForceLawElement& e : system.coordinate_laws) {
    const auto l = static_cast<std::size_t>(e.at);
    const Link& link = system.links[l];
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    const BasicForceLaws<double>& laws = *p.links[l].force[static_cast<std::size_t>(e.component)].laws;
    const int i = link.coordinate + e.component;
    const bool angle = is_angle(joint.type, i);
    const double size = angle ? 1 : p.length;
    const std::string name = coordinate_name(mechanism.joints[static_cast<std::size_t>(joint.joint)], i);
    if (e.has_spring && link.v >= 0 && link.drive < 0) {
      const double value =
          link.type == LinkType::spherical ? rotation_vector(link, p.links[l], q)[e.component] : q[link.q];
      say(jump_at(laws.spring, value - laws.free, size), name, false, fields::stiffness_unit(angle), out);
    }
    if (e.has_damper && (link.v >= 0 || finds_speed(link)))
      say(jump_at(laws.damper, finds_speed(link) ? q[link.q] : 0, size), name, true,
          fields::damping_unit(angle), out);
  }
  if (system.spring_laws.empty()) return out;
  forward<double>(system, p, q, 0, w.kinematics);
  for (const ForceLawElement& e : system.spring_laws) {
    const auto i = static_cast<std::size_t>(e.at);
    const SpringState<double> s = spring_state(system.springs[i], p.springs[i], w.kinematics);
    const std::string& name = mechanism.forces[static_cast<std::size_t>(system.springs[i].force)].name;
    if (e.has_spring)
      say(jump_at(p.springs[i].laws->spring, s.length - p.springs[i].free_length, p.length), name, false,
          "N/m", out);
    if (e.has_damper)
      say(jump_at(p.springs[i].laws->damper, stretching(system.springs[i], s, w.kinematics), p.length), name,
          true, "N s/m", out);
  }
  return out;
}

} // namespace flyball
