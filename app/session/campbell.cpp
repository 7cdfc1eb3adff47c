// The Campbell diagram, followed in the background.
#include "app/session/campbell.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/session.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/friction_branches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

struct State {
  double speed = 0;
  std::vector<CoordinateSolution> coordinates;
};

// How far (scaled) the branch passes by the state at its speed between points i and i + 1.
double distance(const ResponseBranch& branch, std::size_t i, const State& state) {
  const ResponsePoint &a = branch.points[i], &b = branch.points[i + 1];
  const double span = b.parameter - a.parameter;
  const double part = span == 0 ? 0 : (state.speed - a.parameter) / span;
  if (part < -1e-6 || part > 1 + 1e-6) return std::numeric_limits<double>::infinity();
  return scaled_distance(coordinates_between(a.coordinates, b.coordinates, std::clamp(part, 0., 1.)),
                         state.coordinates);
}

// Where the state lies on one of them, between whose points it may be off by a little.
std::optional<CampbellPlace> place_on(const std::vector<ResponseBranch>& branches, const State& state) {
  constexpr double near = 0.03; // scaled
  std::optional<CampbellPlace> best;
  double least = near;
  for (std::size_t b = 0; b < branches.size(); ++b)
    for (std::size_t i = 0; i + 1 < branches[b].points.size(); ++i)
      if (const double apart = distance(branches[b], i, state); apart < least) {
        least = apart;
        best = {b, i};
      }
  return best;
}

CampbellDiagram follow(const Mechanism& mechanism, const CampbellRequest& request, const State& state,
                       const TaskContext<CampbellDiagram>& context) {
  const double from = request.from, to = request.to;
  BranchOptions options;
  options.largest_step = 0.007; // lines that are smooth where they are zoomed
  options.cancel = &context.cancel;
  options.progress = context.progress;
  ResponseDiagram response = follow_response(mechanism, request.drive, from, to, options);
  // Nothing may connect the state with what the drawn pose leads to.
  const bool inside = state.speed >= std::min(from, to) && state.speed <= std::max(from, to);
  if (inside && !state.coordinates.empty() && !place_on(response.branches, state) && !context.cancel) {
    options.all = true;
    options.all_at = {state.speed};
    response = follow_response(mechanism, request.drive, from, to, options);
  }
  return campbell_diagram(mechanism, request.drive, std::move(response), request.orders, &context.cancel);
}

// What is shown; without coordinates where that is no steady state, or of other numbers.
State present(const Session& session, const std::string& drive) {
  if (!converged(session) || solving(session)) return {};
  return {get_parameter(session.mechanism(), drive), session.answer.solution.coordinates};
}

CampbellRequest wanted_now(Session& session, const std::string& drive) {
  const std::array<double, 2> range = campbell_range(session, drive);
  return {drive, range[0], range[1], session.study.modes.campbell.orders,
          session.study.modes.campbell.varied.of(session.document.shared(), {{drive, 0}})};
}

} // namespace

std::vector<std::string> drive_speeds(const Mechanism& mechanism) {
  std::vector<std::string> speeds;
  for (const PrescribedSpeed& speed : prescribed_speeds(mechanism)) {
    std::vector<std::string> set_by{number_alone(mechanism, speed.address)};
    if (set_by.front().empty()) {
      set_by = sources_of(mechanism, *formula_at(mechanism, speed.address));
      std::stable_partition(set_by.begin(), set_by.end(), [&](const std::string& address) {
        return parameter_unit(mechanism, address) == "rad/s";
      });
    }
    for (std::string& address : set_by)
      if (std::ranges::find(speeds, address) == speeds.end()) speeds.push_back(std::move(address));
  }
  return speeds;
}

std::string campbell_drive(const Session& session, const std::vector<std::string>& speeds) {
  if (std::ranges::find(speeds, session.study.modes.campbell.drive) != speeds.end())
    return session.study.modes.campbell.drive;
  return speeds.empty() ? "" : speeds.front();
}

std::array<double, 2> campbell_range(const Session& session, const std::string& drive) {
  const CampbellState& campbell = session.study.modes.campbell;
  if (campbell.from != campbell.to) return {campbell.from, campbell.to};
  const std::optional<ParameterControl> control = control_of(session, drive);
  if (!control) return {0, 10};
  return {std::min(control->from, control->to), std::max(control->from, control->to)};
}

void follow_campbell(Session& session) {
  CampbellState& campbell = session.study.modes.campbell;
  const std::string drive = campbell_drive(session, drive_speeds(session.mechanism()));
  if (drive.empty() || !session.mistakes.empty() || !modes_refusal(session).empty()) return;
  campbell.asked_ticket = session.answer.ticket;
  campbell.diagram.ask(session.options, wanted_now(session, drive),
                       [mechanism = session.document.shared(), state = present(session, drive)](
                           const CampbellRequest& request, const TaskContext<CampbellDiagram>& context) {
                         return follow(*mechanism, request, state, context);
                       });
}

void update_campbell(Session& session) {
  CampbellState& campbell = session.study.modes.campbell;
  auto& diagram = campbell.diagram;
  if (diagram.take("Following the branches was stopped.") && diagram.found && diagram.problem.empty() &&
      diagram.found->result.response.branches.empty())
    diagram.problem = diagram.found->result.response.message;
  // The drive may have been taken away.
  const std::vector<std::string> speeds = drive_speeds(session.mechanism());
  if (diagram.found && std::ranges::find(speeds, diagram.found->of.drive) == speeds.end())
    diagram.found.reset();
  if (diagram.found && !solving(session) &&
      (campbell.judged != diagram.found || campbell.judged_ticket != session.answer.ticket)) {
    campbell.on_branch = campbell_place(session).has_value();
    campbell.judged = diagram.found;
    campbell.judged_ticket = session.answer.ticket;
  }
  if (session.mode != Mode::explore || speeds.empty() || !session.mistakes.empty()) return;
  // Whether there are too many coordinates is known once it was compiled.
  if (!session.answer.ticket) return;
  if (!modes_refusal(session).empty()) return diagram.stop();
  if (!diagram.asked) return follow_campbell(session);
  const CampbellRequest wanted = wanted_now(session, campbell_drive(session, speeds));
  campbell.current = diagram.is_of(wanted);
  const bool same_axis = diagram.asked->drive == wanted.drive && diagram.asked->from == wanted.from &&
                         diagram.asked->to == wanted.to;
  if (diagram.running()) { // over another axis it is of no use any more
    if (!same_axis) follow_campbell(session);
    return;
  }
  // The state was put on a branch that was not followed.
  if (campbell.current && !campbell.on_branch && campbell.asked_ticket != session.answer.ticket) {
    const State state = present(session, wanted.drive);
    const bool inside = state.speed >= wanted.from && state.speed <= wanted.to;
    if (inside && !state.coordinates.empty() && diagram.quick()) return follow_campbell(session);
  }
  if (campbell.current || diagram.asked == wanted) return;
  if (!same_axis || !diagram.found || diagram.quick()) follow_campbell(session);
}

std::optional<CampbellPlace> campbell_place(const Session& session) {
  const auto& found = session.study.modes.campbell.diagram.found;
  if (!found) return std::nullopt;
  return place_on(found->result.response.branches, present(session, found->of.drive));
}

std::vector<std::string> campbell_names(const Session& session, const CampbellPlace& place) {
  const auto& diagram = session.study.modes.campbell.diagram.found;
  const CampbellBranch& branch = diagram->result.branches[place.branch];
  std::vector<int> listed(branch.names.size(), -1);
  const auto& list = session.study.modes.list.found;
  if (list)
    listed = modes_on_lines(diagram->result.response.branches[place.branch], branch, place.after,
                            get_parameter(session.mechanism(), diagram->of.drive), list->result.modes);
  std::vector<std::string> names = branch.names;
  for (std::size_t l = 0; l < names.size(); ++l) {
    if (names[l].empty()) continue;
    if (listed[l] >= 0) { // as in the list: elsewhere on the line another coordinate may move most
      const auto mode = static_cast<std::size_t>(listed[l]);
      const ModeAmplitude* most = list->result.modes[mode].leading();
      names[l] = "mode " + std::to_string(mode + 1) + (most ? ", " + coordinate_words(*most) : "");
      continue;
    }
    names[l].replace(0, names[l].find(' '), "line");
    if (const std::size_t comma = names[l].find(", "); comma != std::string::npos)
      names[l].replace(comma + 2, std::string::npos,
                       label_words(session.mechanism(), names[l].substr(comma + 2)));
  }
  return names;
}

} // namespace flyball
