#include "engine/report/found_speeds.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/report.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/existence.hpp"
#include "engine/stability/sign_is_open.hpp"
#include "engine/system/drive_torque.hpp"

#include <algorithm>

namespace flyball {
namespace {

// The link of another system, in which other joints may be cut, that is this coordinate; -1: none.
int same_link(const System& system, const Link& link, const System& other) {
  const CoordinateReference at = reference_to(system, link);
  const auto found = std::ranges::find_if(other.links, [&](const Link& l) {
    return l.tree_joint >= 0 && l.type == link.type && reference_to(other, l) == at;
  });
  return found == other.links.end() ? -1 : static_cast<int>(found - other.links.begin());
}

std::string names_of_drives(std::span<const std::string> drives) {
  return word_list(std::vector<std::string_view>(drives.begin(), drives.end()), "and");
}

// Where what no drive moves stands, as a start: a speed that is found is none where it is given.
std::vector<std::pair<std::string, double>>
places_of_free(const std::vector<CoordinateSolution>& coordinates) {
  std::vector<std::pair<std::string, double>> out;
  for (const CoordinateSolution& c : coordinates)
    if (!c.driven && !c.dependent) out.emplace_back(coordinate_label(c), c.value);
  return out;
}

// The mechanism with every drive by torque turning at a prescribed speed: that of the configuration q.
Mechanism at_constant_speeds(const Mechanism& mechanism, const System& system, const Eigen::VectorXd& q) {
  Mechanism out = mechanism;
  out.sliders.clear();
  for (const DriveTorqueElement& torque : system.torques) {
    if (torque.implied) continue;
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    Drive& drive = *coordinate_of(out, reference_to(system, link)).drive;
    drive.torque.reset();
    drive.load.reset();
    drive.keeps = DriveKeeps::speed;
    drive.speed = q[link.q];
  }
  return out;
}

} // namespace

std::optional<AtConstantSpeed>
stability_at_constant_speed(const Mechanism& mechanism, const System& system, const Eigen::VectorXd& q,
                            const std::vector<CoordinateSolution>& coordinates) {
  if (std::ranges::all_of(system.torques, &DriveTorqueElement::implied)) return {};
  SolveOptions options;
  options.nearest = true;
  options.start = places_of_free(coordinates);
  Solution solution;
  try {
    solution = Analysis(at_constant_speeds(mechanism, system, q)).solve(options);
  } catch (const SceneError&) { // drives that loops or gears tie together contradict each other then
    return {};
  }
  if (solution.status != Status::converged) return {};
  return AtConstantSpeed{solution.stable, solution.stability_reason, solution.eigenvalues};
}

std::optional<AtConstantSpeed>
turned_stability_at_constant_speed(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                                   const std::vector<CoordinateSolution>& coordinates) {
  const System& found = problem.system;
  if (std::ranges::all_of(found.torques, &DriveTorqueElement::implied)) return {};
  try {
    const Mechanism driven = at_constant_speeds(mechanism, found, z.q);
    const System system = compile_for_drives(driven);
    Parameters parameters;
    bind(system, driven, parameters);
    Scaling scaling;
    set_scaling(system, parameters, scaling);
    Eigen::VectorXd q;
    drawn_configuration(system, parameters, q);
    set_start(system, parameters, places_of_free(coordinates), q);
    TurnedState beside;
    beside.starts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(system.links.size()));
    bool finds = false; // the rates that loops and gears give, still
    for (std::size_t l = 0; l < system.links.size(); ++l) {
      const Link& link = system.links[l];
      if (link.drive < 0) continue;
      const int of = same_link(system, link, found);
      if (of < 0 || found.links[static_cast<std::size_t>(of)].drive < 0) return {};
      const double start = problem.parameters.links[static_cast<std::size_t>(of)].start;
      beside.starts[static_cast<Eigen::Index>(l)] = start;
      if (!finds_speed(link)) {
        parameters.links[l].start = start;
        continue;
      }
      finds = true;
      q[link.q] = z.q[found.links[static_cast<std::size_t>(of)].q];
    }
    const Problem there{system, parameters, scaling, problem.cancel};
    Workspace w;
    Unknowns state{q, Eigen::VectorXd::Zero(system.rows)};
    if (finds) {
      beside.z = state;
      const auto turned = find_turned_state_beside(there, beside, w);
      if (!turned) return {};
      parameters = at_angles_of(parameters, *turned);
      state = turned->z;
    } else if (!newton(there, state, w, {}, nullptr).converged) {
      return {};
    }
    if (!check_existence(there, state.q, sample_phases(system, parameters, state.q), w).holds) return {};
    const FactoredState at = factor_at(there, state, w);
    Stability stability = find_stability(at, true);
    if (sign_is_open(at, stability)) leave_open(stability);
    return AtConstantSpeed{stability.stable, stability.reason, stability.eigenvalues};
  } catch (const SceneError&) { // as above
    return {};
  }
}

std::string missing_speed_message(const Mechanism& mechanism, const Problem& problem, Workspace& w) {
  const System& system = problem.system;
  // With all drives at constant speeds these are left, and it would be asked for again.
  if (std::ranges::all_of(system.torques, &DriveTorqueElement::implied)) return {};
  Eigen::VectorXd q;
  drawn_configuration(system, problem.parameters, q);
  const Solution there = Analysis(at_constant_speeds(mechanism, system, q)).solve();
  if (there.status != Status::converged)
    return there.status == Status::not_converged ? "" : "At the speed it begins with: " + there.message;
  if (there.stable == false) return {}; // what the torque is there tells nothing of where the motion goes
  set_start(system, problem.parameters, places_of_free(there.coordinates), q);
  forward<double>(system, problem.parameters, q, 0, w.kinematics);
  std::string text;
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    if (system.torques[i].keeps_momentum || system.torques[i].implied) continue;
    const Link& link = system.links[static_cast<std::size_t>(system.torques[i].link)];
    const std::string name = coordinate_label(system, link);
    const auto taken = std::ranges::find_if(
        there.drive_torques, [&](const DriveTorque& d) { return coordinate_label(d) == name; });
    if (taken == there.drive_torques.end()) continue;
    const bool turns = link.type == LinkType::revolute;
    const std::string unit = turns ? " N m" : " N";
    const double given = drive_torque(system, problem.parameters, i, q, w.kinematics);
    const double surplus = (given - taken->value) * (q[link.q] < 0 ? -1 : 1);
    text += (text.empty() ? "At " : " At ") + rounded_text(q[link.q], 6) + (turns ? " rad/s " : " m/s ") +
            name + " gives " + rounded_text(given, 6) + unit + " where turning takes " +
            rounded_text(std::abs(taken->value) < 1e-9 * std::abs(given) ? 0 : taken->value, 6) + unit +
            ": it " +
            (surplus > 0 ? "runs away, unless something resists it more as it goes faster."
                         : "slows down, unless something drives it more as it goes slower.");
  }
  return text;
}

std::string undetermined_speed_message(const Mechanism& mechanism, const System& system,
                                       std::span<const int> neutral) {
  std::vector<std::string> names;
  bool implied = false;
  for (const DriveTorqueElement& torque : system.torques) {
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    if (std::ranges::find(neutral, link.v) == neutral.end()) continue;
    names.push_back(coordinate_label(system, link));
    implied = implied || torque.implied;
  }
  if (names.empty()) return {};
  if (implied) {
    std::string cut;
    for (const Joint& joint : mechanism.joints)
      if (joint.cut) cut += (cut.empty() ? "\"" : ", \"") + joint.name + "\"";
    if (!cut.empty())
      return "The rate at which the loops make " + names_of_drives(names) +
             " turn does not follow where they are cut: at " + cut +
             ". Leave the choice of what to cut open.";
  }
  if (names.size() == 1)
    return "Nothing determines the speed of " + names[0] +
           ": what it gives and what turning takes are the same at every speed. Its torque or load has to "
           "change with the speed or a coordinate, or something has to resist it.";
  return "Nothing determines the speeds of " + names_of_drives(names) +
         " together: what they give and what turning takes are the same whichever they are. A torque or "
         "load has to change with a speed or a coordinate, or something has to resist them.";
}

} // namespace flyball
