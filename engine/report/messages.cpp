#include "engine/report/messages.hpp"

#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_parts.hpp"
#include "engine/report/turning_part.hpp"
#include "engine/search/most_turned.hpp"
#include "engine/solve/singular_loops.hpp"
#include "engine/solve/unbounded.hpp"
#include "engine/system/implied_rates.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

std::string cut_name(const ReportInput& in, int cut) {
  return in.mechanism
      .joints[static_cast<std::size_t>(in.problem.system.cuts[static_cast<std::size_t>(cut)].joint)]
      .name;
}

std::string floquet_message(const Floquet& f, std::optional<bool> stable) {
  std::string out =
      " The linearised motion turns with the drives: in a period of " + rounded_text(f.period, 4) + " s ";
  if (f.multipliers.front() == 0.)
    return out + "all of it dies out: less than " + rounded_text(f.error, 1) + " is left.";
  out += "its largest multiplier is " + rounded_text(std::abs(f.multipliers.front()), 7) + " in size.";
  if (stable == true && !f.growth.empty() && f.growth.front() > -1e-9 / f.period)
    out += " Motions beside the state neither grow nor die out.";
  else if (!stable)
    out += " That is too close to 1 to tell.";
  return out;
}

std::string floquet_message(FloquetFailure failure) {
  const std::string begin =
      " Whether it is stable is not known: the linearised motion turns with the drives, ";
  switch (failure) {
  case FloquetFailure::no_period:
    return begin + "and their speeds have no common period, or one of more than a thousand turns.";
  case FloquetFailure::singular:
    return begin +
           "and a direction in which it moves has neither mass nor damping nor stiffness at some phase.";
  case FloquetFailure::unresolved:
    return begin + "and is too large, too stiff or too slow in its period beside its own oscillations to "
                   "follow, or its loops turn too far.";
  case FloquetFailure::cancelled: return begin + "and looking for its multipliers was cancelled.";
  }
  return "";
}

// Of a drive left to itself.
std::string lost_momentum_message(const ReportInput& in, Workspace& w) {
  const System& system = in.problem.system;
  const auto i = static_cast<std::size_t>(in.existence.pushed);
  const Link& link = system.links[static_cast<std::size_t>(system.torques[i].link)];
  evaluate(in.problem, in.found.z, 0, w);
  const double taken = w.residual.taken[static_cast<Eigen::Index>(i)];
  return "No steady state: " + system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name +
         " is left to itself, but " + rounded_text(std::abs(taken), 6) +
         (link.type == LinkType::revolute ? " N m " : " N ") +
         (taken * in.found.z.q[link.q] > 0 ? "hold it back" : "drive it on") +
         ": its momentum does not stay as it is.";
}

std::string names_of(const Unbounded& found) {
  constexpr std::size_t most = 5;
  std::vector<std::string> names;
  for (const UnheldCoordinate& c : found.coordinates)
    if (std::ranges::find(names, c.joint) == names.end()) names.push_back(c.joint);
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

// Whether plates, blades or quadratic drag rest in the air.
bool is_in_still_air(const Problem& problem) {
  return !problem.parameters.moving &&
         std::ranges::any_of(problem.parameters.body_forces, [](const BodyForceParameters& f) {
           return is_of_air(f.type) && f.quadratic + f.normal_quadratic > 0 && f.wind.isZero(0);
         });
}

// Whether a spring by a law is among what acts on them: it gave way.
bool pulled_by_law(const System& system, const Unbounded& found) {
  return std::ranges::any_of(system.coordinate_laws, [&](const ForceLawElement& law) {
    const Link& link = system.links[static_cast<std::size_t>(law.at)];
    const std::string& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name;
    return law.has_spring &&
           std::ranges::find(found.coordinates, joint, &UnheldCoordinate::joint) != found.coordinates.end();
  });
}

// Of what runs away, beside an unstable state or where there is none. `rubs`: dry friction may hold it.
std::string goes_on(bool one, bool unstable, bool rubs) {
  return std::string(rubs ? (one ? "where it slips " : "where they slip ") : "") +
         (one ? "it goes" : "they go") + " on without end" +
         (rubs       ? ". "
          : unstable ? " from the drawn pose. "
                     : ", so there is no steady state to find. ");
}

// Of slides that springs hold, which the centrifugal force outgrows.
std::string softer_springs(const Unbounded& found, bool unstable, bool rubs) {
  constexpr double noticeable = 1e-4;
  const bool one = found.softened.size() == 1;
  const auto list = [&](double Softening::*which) {
    std::vector<std::string> all;
    for (const Softening& along : found.softened)
      all.push_back(rounded_text(along.*which, 4) + " N/m");
    if (!one && std::ranges::count(all, all.front()) == std::ssize(all)) return all.front() + " each";
    return word_list(std::vector<std::string_view>(all.begin(), all.end()), "and");
  };
  const auto softer = std::ranges::count_if(
      found.softened, [](const Softening& along) { return along.held < (1 - noticeable) * along.driven; });
  return "What holds " + names_of(found) + ", " + list(&Softening::held) + ", is " +
         (softer == std::ssize(found.softened) ? "softer"
          : softer == 0                        ? "hardly stiffer"
                                               : "softer or hardly stiffer") +
         " than the centrifugal force, which at this speed grows by " + list(&Softening::driven) + ": " +
         goes_on(one, unstable, rubs) +
         (one ? "It needs a stiffer spring, a stop" : "They need stiffer springs, stops") +
         " or a lower speed.";
}

bool any_has_stop(const Mechanism& mechanism, const std::vector<std::string>& joints) {
  return std::ranges::any_of(mechanism.joints, [&](const Joint& joint) {
    return std::ranges::any_of(joint.coordinates, [](const Coordinate& c) { return c.stop.has_value(); }) &&
           std::ranges::find(joints, joint.name) != joints.end();
  });
}

} // namespace

std::vector<std::string> notes(const System& system, const Mechanism& mechanism) {
  std::vector<std::string> all;
  for (const CutJoint& cut : system.cuts)
    if (cut.turns)
      all.push_back("The loop is cut at " + mechanism.joints[static_cast<std::size_t>(cut.joint)].name +
                    ", which turns at a constant rate in the steady state.");
  std::vector<std::string> implied;
  for (const DriveTorqueElement& torque : system.torques)
    if (torque.implied)
      implied.push_back(coordinate_label(system, system.links[static_cast<std::size_t>(torque.link)]));
  if (!implied.empty())
    all.push_back("Loops and gears make " +
                  word_list(std::vector<std::string_view>(implied.begin(), implied.end()), "and") +
                  (implied.size() == 1 ? " turn at a rate of its own, which is found."
                                       : " turn at rates of their own, which are found."));
  return all;
}

std::string message(const Found& found, const Problem& problem) {
  const std::string falls = " potential falls on, hundreds of times the mechanism's reach away";
  const auto methods = [&] {
    std::vector<std::string_view> tried{"Newton-Raphson", "its damped form"};
    if (problem.parameters.moving) tried.emplace_back("homotopy from rest");
    if (!problem.system.torques.empty()) tried.emplace_back("the slow motion from the start");
    if (found.descended) tried.emplace_back("descent of the potential");
    return word_list(tried, "and");
  };
  const auto searched = [&](const std::string& first) {
    return first + "; a search all over the coordinates' ranges found this steady state" +
           (found.candidates > 1 ? ", the nearest of " + std::to_string(found.candidates) + "." : ".");
  };
  const bool drives = problem.parameters.dampers_drive;
  const std::string below = drives ? "a minimum of the potential" : "a stable one";
  switch (found.remark) {
  case Remark::none: return "";
  case Remark::cancelled: return "The solve was cancelled.";
  case Remark::left_unstable_start:
    return "The start is an unstable equilibrium; stepped off it and went downhill to " + below + ".";
  case Remark::left_unstable_equilibrium:
    return "Newton-Raphson arrived at an unstable equilibrium; went downhill from the start to " + below +
           ".";
  case Remark::unstable: return "No stable state was found downhill from here.";
  case Remark::unstable_and_unbounded: return "The" + falls + "; no stable state was found.";
  case Remark::left_unstable_speeds:
    return "Newton-Raphson arrived at an unstable state; " +
           std::string(
               found.fallback == Fallback::search
                   ? "this is the nearest that a search all over the ranges found and that is not unstable."
                   : "the motion from the start, or from beside that state, leads to this one.");
  case Remark::basin_uncertain:
    return std::string(drives ? "A minimum of the potential" : "A stable state") +
           ", but the start may lie in the basin of another.";
  case Remark::first_does_not_hold:
    return searched("The equilibrium found first holds at one phase of the drives only");
  case Remark::first_not_found:
    return searched("Newton-Raphson and its fallbacks led nowhere from the start");
  case Remark::unbounded: return "The" + falls + ".";
  case Remark::exhausted: return methods() + " found no equilibrium from this start.";
  case Remark::exhausted_and_unbounded: return methods() + " found no equilibrium: the" + falls + ".";
  }
  return "";
}

std::string message(const OtherStates& others, Status first) {
  if (!others.searched)
    return std::string(first == Status::converged
                           ? "That is said of the equilibrium found from this start alone; "
                           : "No other start was tried; ") +
           "solve --all looks for others.";
  if (others.end == SearchEnd::cancelled) return "The search for others was cancelled.";
  std::string runs = std::to_string(others.starts) + " starts all over the coordinates' ranges";
  if (others.fastest > 0)
    runs +=
        " and speeds up to " + rounded_text(others.fastest, 4) + (others.fastest_turns ? " rad/s" : " m/s");
  const std::string more =
      others.end == SearchEnd::settled ? "" : " The search was short; solve --all looks for longer.";
  if (others.equilibria == 0) return "A search from " + runs + " found none either." + more;
  if (others.steady > 0)
    return "A search from " + runs + " found others, but too few of their digits are known." + more;
  if (others.equilibria == 1)
    return "A search from " + runs + " found no other pose that balances at the drawn phase." + more;
  return "None of the " + std::to_string(others.equilibria) +
         " poses that balance at the drawn phase, found from " + runs + ", holds at every phase." + more;
}

std::string rests_on_friction(const Solution& solution, std::string_view asked) {
  std::vector<std::string> all;
  for (const FrictionForce& friction : solution.frictions)
    all.push_back(coordinate_label(friction) + (friction.slips ? " slips" : " is held"));
  return "The steady state rests on dry friction: " +
         word_list(std::vector<std::string_view>(all.begin(), all.end()), "and") + ". " + std::string(asked) +
         " only of states that need none.";
}

std::string message(const AllSolutions& all) {
  const auto on_friction =
      std::ranges::count_if(all.equilibria, [](const Solution& s) { return !s.frictions.empty(); });
  const bool others = static_cast<std::size_t>(on_friction) < all.equilibria.size();
  std::string text = others                   ? "Found by a bounded search; there may be more."
                     : all.equilibria.empty() ? "No steady state was found in the range searched."
                                              : "No steady state without friction in it was found in the "
                                                "range searched.";
  if (on_friction > 0)
    text += on_friction == 1 ? " One rests on friction."
                             : " " + std::to_string(on_friction) + " rest on friction.";
  if (all.passing > 0)
    text += " " + std::to_string(all.passing) +
            (all.passing == 1 ? " equilibrium of the drawn phase is not listed: it does"
                              : " equilibria of the drawn phase are not listed: they do") +
            " not hold as the drives turn.";
  if (all.lost > 0)
    text +=
        " " + std::to_string(all.lost) + (all.lost == 1 ? " more is" : " more are") +
        " not listed: what acts there is lost in rounding beside the forces that it is the difference of.";
  switch (all.end) {
  case SearchEnd::settled: break;
  case SearchEnd::starts: text += " The search ended after the starts asked for."; break;
  case SearchEnd::budget: text += " The search spent its budget; a larger one may find more."; break;
  case SearchEnd::time: text += " The search took too long and was ended; the next may end elsewhere."; break;
  case SearchEnd::cancelled: text += " The search was cancelled."; break;
  }
  if (all.end != SearchEnd::settled && std::isfinite(all.unseen) && all.unseen >= 0.5)
    text += " By how often the same were found again, " + std::to_string(std::lround(all.unseen)) +
            (std::lround(all.unseen) == 1 ? " is" : " are") + " expected to be missing.";
  return text;
}

namespace {

std::string open_loop_message(const ReportInput& in) {
  const bool turns = loops_turn_with_drives(in.problem.system, in.problem.parameters);
  std::string text = turns ? "No steady state was found" : "No steady state";
  text += ": as the drives turn, \"" + cut_name(in, in.existence.worst_cut) +
          "\" cannot be held with all other coordinates constant, whichever joint of its loop is cut";
  if (std::ranges::any_of(in.mechanism.joints,
                          [](const Joint& j) { return j.cut.has_value() && coordinate_count(j.type) > 0; }))
    text += "; the joints marked with \"cut\" were left as marked";
  text += ".";
  if (turns)
    text += " Its loop could turn with the drives, what springs hold at rest in it twisted; " +
            (in.problem.system.nv > most_turned_coordinates
                 ? "with more than " + std::to_string(most_turned_coordinates) +
                       " coordinates such states are not looked for"
                 : std::string("no such state was found")) +
            ". A motion shows whether there is one.";
  return text;
}

std::string rubbing_message(const ReportInput& in) {
  const System& system = in.problem.system;
  const auto slipping = std::ranges::count_if(
      find_frictions(in.mechanism), [&](CoordinateReference at) { return may_slip(in.mechanism, at); });
  return "No steady state was found in which dry friction holds " +
         coordinate_label(system, system.links[static_cast<std::size_t>(in.existence.rubs)]) +
         ", which a torque turns, or slips at a constant rate." +
         (slipping > 3 ? " Of more than three joints that may slip not all ways in which they slip and "
                         "stick were tried."
                       : "");
}

// Empty where no loop is to blame for being drawn at a change point.
std::string change_point_message(const ReportInput& in) {
  const System& system = in.problem.system;
  std::vector<int> suspects; // cuts
  if (in.found.status == Status::not_converged && in.found.remark != Remark::cancelled) {
    for (std::size_t c = 0; c < system.cuts.size(); ++c)
      if (system.cuts[c].by_rates) suspects.push_back(static_cast<int>(c));
  } else if (in.found.status == Status::converged && in.existence.loops_open) {
    suspects = {in.existence.worst_cut};
  }
  const std::optional<int> flat = find_change_point(in.mechanism, system, suspects);
  if (!flat) return {};
  return "No steady state was found: the loop of \"" + cut_name(in, *flat) +
         "\" is drawn at a change point, where its linkage could part into branches and does not tell at "
         "which rates it turns. Drawn with the drives turned on a little it may have a steady state.";
}

std::string other_failure(const ReportInput& in, Workspace& w) {
  if (in.found.status == Status::infeasible)
    return "The loops cannot be closed: \"" + cut_name(in, in.found.open_cut) +
           "\" stays open however the other coordinates are chosen.";
  if (in.found.status == Status::not_converged) return message(in.found, in.problem);
  if (in.existence.loops_open) return open_loop_message(in);
  if (in.existence.pushed >= 0) return lost_momentum_message(in, w);
  if (in.existence.rubs >= 0) return rubbing_message(in);
  return "No steady state: " + turning_part(in.problem, in.mechanism, in.found.z.q, in.existence.phase, w) +
         " turns with the drives, so the balance holds at one moment only.";
}

} // namespace

FailureMessage failure_message(const ReportInput& in, Workspace& w) {
  std::string flat = change_point_message(in);
  const bool at_change_point = !flat.empty();
  return {at_change_point ? std::move(flat) : other_failure(in, w), at_change_point};
}

namespace {

// The one direction that nothing resists where it turns a ball alone; else how many there are, where they are
// fewer than what takes part in them. Empty where each coordinate is free by itself, or that is not known.
std::string directions_in_words(const ReportInput& in, std::size_t joints) {
  const System& system = in.problem.system;
  const Eigen::MatrixXd& directions = in.stability.neutral_directions;
  if (directions.size() == 0) return {};
  const std::vector<int>& parts = in.stability.neutral;
  const bool one = directions.cols() == 1;
  const auto ball = std::ranges::find_if(system.links, [&](const Link& link) {
    return link.type == LinkType::spherical && link.v >= 0 && parts.front() >= link.v &&
           parts.back() < link.v + 3;
  });
  if (one && ball != system.links.end()) {
    Kinematics<double> k;
    forward<double>(system, in.problem.parameters, in.found.z.q, 0, k);
    Vec3 axis = Vec3::Zero();
    for (int v = ball->v; v < ball->v + 3; ++v)
      axis += directions(v, 0) * in.problem.scaling.column[v] * k.columns[static_cast<std::size_t>(v)].axis;
    axis.normalize();
    Eigen::Index largest_entry = 0;
    axis.cwiseAbs().maxCoeff(&largest_entry);
    if (axis[largest_entry] < 0) axis = -axis;
    std::string text;
    for (const double x : axis)
      text += (text.empty() ? "" : ", ") + rounded_text(std::abs(x) < 1e-9 ? 0 : x, 4);
    return " turning about [" + text + "]; the angle of that turn is arbitrary";
  }
  if (static_cast<std::size_t>(directions.cols()) == parts.size()) return {};
  return (one ? " along one direction" : " along " + std::to_string(directions.cols()) + " directions") +
         std::string(joints > 1 ? " together; where they stand" : "; where it stands") +
         (one ? " along it" : " along these") + " is arbitrary";
}

// Of drives that stand: how friction and the drive share what both hold is open.
std::string friction_at_standstill(const ReportInput& in) {
  if (!rubs_anywhere(in.mechanism)) return {};
  const System& system = in.problem.system;
  const std::vector<CoordinateReference> holding = find_frictions(in.mechanism); // not at a given speed
  std::vector<double> limits(system.drives.size(), 0); // of what is geared together, as the drive sees it
  for (const DrivenCoordinate& d : system.drives) {
    const Link& link = system.links[static_cast<std::size_t>(d.link)];
    const LinkParameters& p = in.problem.parameters.links[static_cast<std::size_t>(d.link)];
    const int joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint;
    if (joint < 0 || p.speed != 0) continue;
    const CoordinateReference at{joint, link.coordinate};
    if (coordinate_of(in.mechanism, at).friction && !std::ranges::count(holding, at))
      limits[static_cast<std::size_t>(d.motor)] +=
          friction_limit(friction_at(in.mechanism, at)) * std::abs(p.gear_ratio);
  }
  std::string text;
  for (std::size_t d = 0; d < limits.size(); ++d) {
    const Link& link = system.links[static_cast<std::size_t>(system.drives[d].link)];
    const bool turns = link.type == LinkType::revolute;
    if (limits[d] > 0)
      text += " At speed zero dry friction may bear up to " + rounded_text(limits[d], 4) +
              (turns ? " N m of the torque" : " N of the force") + " told of " +
              coordinate_label(system, link) + ".";
  }
  return text;
}

} // namespace

std::string solution_message(const ReportInput& in, int rank, const Solution& out) {
  const System& system = in.problem.system;
  std::string text = message(in.found, in.problem);
  if (text.empty()) text = "Converged.";
  if (rank < system.rows)
    text += " The loops are redundant: " + std::to_string(rank) + " of " + std::to_string(system.rows) +
            " constraint equations are independent.";
  if (out.singular_loops) text += " " + std::string(singular_loops_message);
  if (!out.neutral.empty()) {
    constexpr std::size_t named = 20;
    text += " Nothing resists";
    for (std::size_t i = 0; i < std::min(named, out.neutral.size()); ++i)
      text += (i ? ", " : " ") + out.neutral[i];
    if (out.neutral.size() > named) text += " and " + std::to_string(out.neutral.size() - named) + " more";
    const std::string along = directions_in_words(in, out.neutral.size());
    if (!along.empty())
      text += along;
    else
      text += out.neutral.size() == 1 ? "; its value is arbitrary" : "; their values are arbitrary";
    text += any_has_stop(in.mechanism, out.neutral) ? " between stops." : ".";
  }
  if (in.stability.angles_leave_open)
    text += " Whether it is stable is not known: an angle matters of what turns at a speed that is found.";
  else if (!out.stability_reason && !out.eigenvalues && system.nv <= largest_for_eigenvalues)
    text += " Whether it is stable is not known: the eigenvalues were not found, the iteration for them does "
            "not converge.";
  else if (!out.stability_reason)
    text += " Whether it is stable was left out: that takes eigenvalues, and there are more than " +
            std::to_string(largest_for_eigenvalues) + " coordinates.";
  if (out.floquet) text += floquet_message(*out.floquet, out.stable);
  if (in.stability.floquet_failure) text += floquet_message(*in.stability.floquet_failure);
  if (out.stability_reason == StabilityReason::gyroscopic_only)
    text += " Rotation alone keeps this state, which is no minimum of the amended potential: any damping in "
            "what moves would make it unstable.";
  if (out.stability_reason == StabilityReason::marginal && !in.stability.kinks_leave_open &&
      is_in_still_air(in.problem))
    text += " The force of still air grows with the square of the speed and has no slope at rest: the linear "
            "motion does not show whether it dies out in it.";
  text += friction_at_standstill(in);
  if (out.stable == false && in.found.remark == Remark::none) text += " This state is unstable.";
  return text;
}

void explain_unbounded(const Problem& problem, const Mechanism& mechanism, const Eigen::VectorXd& start,
                       Workspace& w, Solution& out) {
  const bool unstable = out.status == Status::converged && out.stable == false;
  if ((out.status != Status::not_converged && !unstable) || problem.cancelled()) return;
  const Unbounded found = find_unbounded(problem, start, w);
  if (found.coordinates.empty() || problem.cancelled()) return;
  const bool one = found.coordinates.size() == 1;
  if (found.for_a_moment) {
    const std::string words =
        "Nothing holds " + names_of(found) +
        ", and what pushes there turns with the drives: " + (one ? "it stands" : "they stand") +
        " still nowhere" + (unstable ? " beside." : ", so there is no steady state to find.");
    out.message = unstable ? out.message + " " + words : words;
    return;
  }
  out.unheld = found.coordinates;
  out.unheld_by_weight = found.by_weight;
  // Beside an unstable state: where it is drawn, or further on, friction may hold it all the same.
  const bool rubs =
      unstable && std::ranges::any_of(find_frictions(mechanism), [&](CoordinateReference at) {
        return std::ranges::find(found.coordinates, mechanism.joints[static_cast<std::size_t>(at.joint)].name,
                                 &UnheldCoordinate::joint) != found.coordinates.end();
      });
  if (!found.softened.empty() && !pulled_by_law(problem.system, found)) {
    const std::string words = softer_springs(found, unstable, rubs);
    out.message = unstable ? out.message + " " + words : words;
    return;
  }
  const std::string words =
      (rubs ? "Nothing but dry friction holds " : "Nothing holds ") + names_of(found) + " against " +
      (found.by_weight    ? "the weight"
       : found.by_inertia ? "the centrifugal force"
                          : "the forces on it") +
      ": " + goes_on(one, unstable, rubs) + (one ? "It needs a spring" : "They need springs") +
      (pulled_by_law(problem.system, found) ? " whose force grows with its deflection," : "") +
      (one ? " or a stop" : " or stops") + (found.by_weight ? ", or no gravity." : ".");
  out.message = unstable ? out.message + " " + words : words;
}

} // namespace flyball
