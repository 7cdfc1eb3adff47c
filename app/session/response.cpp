#include "app/session/response.hpp"

#include "app/session/resonance.hpp"
#include "app/session/response_design.hpp"
#include "app/session/session.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/friction_branches.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// A curve stays quick to follow and to draw; what is longer says that it ended there.
constexpr int most_points = 1500, most_branches = 16;
constexpr int many_coordinates = 60; // from which on steps are longer and eigenvalues left out

BranchOptions follow_options(const ResponseRequest& of, double present) {
  BranchOptions options;
  options.largest_step = response_step(of);
  options.max_points = most_points;
  options.max_branches = most_branches;
  options.all = of.all;
  if (of.all) options.all_at = {of.from, of.to};
  if (of.all && (present - of.from) * (present - of.to) < 0) options.all_at.push_back(present);
  options.reactions = of.reactions;
  std::size_t coordinates = 0;
  for (const Joint& joint : of.mechanism->joints)
    coordinates += joint.coordinates.size();
  if (coordinates > many_coordinates) {
    options.largest_step = 0.05;
    options.eigenvalues = false;
  }
  return options;
}

ResponseResult result_of(ResponseDiagram diagram, const std::string& address) {
  ResponseResult result{.diagram = std::move(diagram), .lines = {}};
  result.diagram.message = with_phrase(std::move(result.diagram.message), address);
  result.lines = response_lines(result.diagram);
  return result;
}

// What it is asked for beside the request: the present value and state, and whether nothing is shown over
// this range, so that a part is worth seeing.
struct CurveStart {
  double present = 0;
  std::optional<ResponsePoint> through;
  bool bare = false;
};

ResponseResult find_curve(const ResponseRequest& of, const CurveStart& start,
                          const TaskContext<ResponseResult>& context) {
  BranchOptions options = follow_options(of, start.present);
  options.cancel = &context.cancel;
  options.progress = context.progress;
  if (start.bare)
    options.publish = [&](const ResponseDiagram& so_far) { context.publish(result_of(so_far, of.address)); };
  std::optional<ResponseDiagram> diagram;
  if (start.through && !of.all && start.through->frictions.empty())
    diagram = follow_branches_through(*of.mechanism, of.address, of.from, of.to, *start.through, options);
  // Without a state to go through, as the command line: from the drawn pose at the range's beginning.
  if (!diagram) diagram = follow_branches(*of.mechanism, of.address, of.from, of.to, options);
  add_friction_branches(*of.mechanism, of.address, of.from, of.to, options, *diagram);
  return result_of(std::move(*diagram), of.address);
}

void follow(Session& session, const ResponseRequest& of) {
  ResponseState& state = session.study.response;
  // While a hand drags one slider every curve that was begun is worth seeing; another question is not.
  const auto same_range = [&](const ResponseRequest& other) {
    return other.address == of.address && other.from == of.from && other.to == of.to;
  };
  const auto& asked = state.curve.asked;
  const bool same = asked && same_range(*asked) && asked->all == of.all;
  CurveStart start{.present = get_parameter(session.mechanism(), of.address),
                   .through = {},
                   .bare = !state.curve.found || !same_range(state.curve.found->of)};
  if (converged(session)) start.through = present_point(session, of.address);
  state.through = session.answer.ticket;
  state.curve.ask(
      session.options, of,
      [start = std::move(start)](const ResponseRequest& request, const TaskContext<ResponseResult>& context) {
        return find_curve(request, start, context);
      },
      same ? ResponseCurve::Running::finished : ResponseCurve::Running::cancelled);
}

void take_curve(ResponseCurve& curve) {
  if (!curve.take()) return;
  if (curve.problem.empty() && curve.found && curve.found->result.diagram.status != Status::converged)
    curve.problem = curve.found->result.diagram.message;
  if (!curve.problem.empty()) curve.found.reset();
}

// First the parameter that is likely meant: a drive's speed.
void choose_first(Session& session) {
  if (response_control(session)) return;
  if (session.parameters.empty()) {
    const std::vector<std::string> all = variable_numbers(session, Dampers::with);
    if (all.empty())
      session.study.response.choice.address.clear();
    else
      choose_response(session, all.front());
    return;
  }
  const auto drive = std::ranges::find_if(session.parameters, [&](const ParameterControl& control) {
    return sets_speed(session.mechanism(), control.address);
  });
  choose_response(session, (drive == session.parameters.end() ? session.parameters.front() : *drive).address);
}

// At first a speed that is found, as of an engine under its load; else a length, as of a collar, for what
// moves it; else the first coordinate.
void choose_first_quantity(Session& session) {
  ResponseState& state = session.study.response;
  const std::vector<ResponseQuantity> all = offered_quantities(session);
  if (const auto found = std::ranges::find(all, state.choice.quantity, &ResponseQuantity::key);
      found != all.end()) {
    state.shown = *found;
    return;
  }
  // Without an answer not everything is offered that may be so again.
  if (all.empty() || (!state.choice.quantity.empty() && !converged(session) && !periodic_motion(session)))
    return;
  const auto first_in = [&](std::string_view unit) {
    return std::ranges::find_if(all, [&](const ResponseQuantity& each) {
      return each.unit == unit && each.key.starts_with("value ");
    });
  };
  const auto speed = first_in("rad/s"), length = first_in("m");
  const bool found = speed != all.end() && finds_speeds(session.mechanism());
  state.shown = found ? *speed : length != all.end() ? *length : all.front();
  state.choice.quantity = state.shown.key;
}

// Whether coordinates are the same but for the straight lines that join a curve's points.
bool near(const std::vector<CoordinateSolution>& a, const std::vector<CoordinateSolution>& b) {
  constexpr double tolerance = 2e-3; // scaled
  return scaled_distance(a, b) <= tolerance;
}

// Between two points of a line.
ResponsePoint between(const ResponsePoint& a, const ResponsePoint& b, double part) {
  ResponsePoint out = part < 0.5 ? a : b;
  out.parameter = a.parameter + part * (b.parameter - a.parameter);
  out.coordinates = coordinates_between(a.coordinates, b.coordinates, part);
  return out;
}

// Whether the present state has come to stand beside all branches that were followed: past a fold, or where a
// hand has put it.
bool left_curves(const Session& session) {
  const ResponseState& state = session.study.response;
  const auto& found = state.curve.found;
  if (!found || state.curve.running() || !converged(session) || solving(session)) return false;
  if (session.answer.ticket == state.through) return false;
  if (session.answer.mechanism != session.document.shared()) return false; // of a hand that pulls
  const ResponseRequest& of = found->of;
  const std::optional<ResponsePoint> now = present_point(session, of.address);
  if (!now || (now->parameter - of.from) * (now->parameter - of.to) > 0) return false;
  for (const ResponseLine& line : found->result.lines)
    for (std::size_t i = 1; i < line.points.size(); ++i) {
      const ResponsePoint &a = line.points[i - 1], &b = line.points[i];
      if ((now->parameter - a.parameter) * (now->parameter - b.parameter) > 0) continue;
      const double step = b.parameter - a.parameter;
      const double part = step == 0 ? 0.5 : (now->parameter - a.parameter) / step;
      if (near(between(a, b, part).coordinates, now->coordinates)) return false;
    }
  return true;
}

// The point of a line at `at` (an index with a fraction), at a parameter with no more digits than a hand can
// mean, where that lies on the line as well: beyond a fold there is nothing.
ResponsePoint rounded_point(const ResponseLine& line, double at, double step) {
  const auto last = static_cast<double>(line.points.size() - 1);
  at = std::clamp(at, 0.0, last);
  const auto i = static_cast<std::size_t>(std::min(std::floor(at), last - 1));
  const ResponsePoint exact = between(line.points[i], line.points[i + 1], at - static_cast<double>(i));
  const double wanted = std::round(exact.parameter / step) * step;
  const auto in = [&](std::size_t k) -> std::optional<ResponsePoint> {
    if (k + 1 >= line.points.size()) return std::nullopt;
    const double from = line.points[k].parameter, to = line.points[k + 1].parameter;
    if (from == to || !((wanted - from) * (wanted - to) <= 0)) return std::nullopt;
    return between(line.points[k], line.points[k + 1], (wanted - from) / (to - from));
  };
  for (const std::size_t k : {i, i + 1, std::max<std::size_t>(i, 1) - 1})
    if (auto found = in(k)) {
      found->parameter = wanted;
      return *found;
    }
  return exact;
}

} // namespace

std::optional<ResponseRequest> response_wanted(Session& session) {
  ResponseState& state = session.study.response;
  if (session.mechanism().bodies.empty() || !session.mistakes.empty() || !response_control(session))
    return std::nullopt;
  const ResponseChoice& choice = state.choice;
  return ResponseRequest{.mechanism =
                             state.varied.of(session.document.shared(), {{choice.address, choice.from}}),
                         .address = choice.address,
                         .from = choice.from,
                         .to = choice.to,
                         .logarithmic = choice.logarithmic,
                         .all = choice.all,
                         .reactions = needs_reactions(choice.quantity)};
}

double response_step(const ResponseRequest& of) {
  // Low on a logarithmic axis a small part of the range is a long way.
  return of.logarithmic ? 0.005 : 0.02;
}

std::optional<ResponsePoint> present_point(const Session& session, const std::string& address) {
  try {
    return response_point(session.answer.solution, get_parameter(*session.answer.mechanism, address));
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

namespace {

// Another kind of state takes the place of the one before only where an answer says so.
void choose_kind(Session& session) {
  ResponseState& state = session.study.response;
  if (!session.answer.ticket || session.answer.error) return;
  const Status status = session.answer.solution.status;
  if (status == Status::converged) state.resonates = session.answer.solution.varies;
  if (status == Status::no_steady_state) state.resonates = true;
}

} // namespace

void update_response(Session& session) {
  ResponseState& state = session.study.response;
  take_curve(state.curve);
  take_design(session);
  if (session.study.open != StudyKind::response || session.mode != Mode::explore) return;
  choose_kind(session);
  choose_first(session);
  choose_first_quantity(session);
  std::optional<ResponseRequest> wanted = response_wanted(session);
  if (state.resonates) {
    if (wanted) wanted->all = wanted->reactions = false; // it has no others, and reactions always
    state.curve = {};
    state.design.answer = {};
    return update_resonance(session, wanted);
  }
  if (state.resonance.asked) state.resonance = {};
  if (!wanted) {
    state.curve = {};
    return;
  }
  // Of a number that is there no more nothing can be taken up.
  if (state.curve.found && !has_number(session.mechanism(), state.curve.found->of.address))
    state.curve.found.reset();
  const bool asked = state.curve.asked == wanted;
  if (asked && !left_curves(session)) return;
  follow(session, *wanted);
  if (!asked && state.design.answer.asked) find_design(session);
  take_curve(state.curve); // in immediate mode it is there
}

void close_response(Session& session) {
  ResponseState& state = session.study.response;
  ResponseState fresh;
  fresh.choice = state.choice;
  fresh.design.coordinate = state.design.coordinate;
  fresh.design.value = state.design.value;
  state = std::move(fresh);
}

bool computing_response(const Session& session) {
  const ResponseState& state = session.study.response;
  return state.curve.running() || state.resonance.running() || state.design.answer.running();
}

std::optional<ParameterControl> response_control(const Session& session) {
  return control_of(session, session.study.response.choice.address);
}

void choose_response(Session& session, const std::string& address) {
  const std::optional<ParameterControl> control = control_of(session, address);
  if (!control) return;
  ResponseState& state = session.study.response;
  state.choice.address = address;
  state.choice.from = control->from;
  state.choice.to = control->to;
  state.choice.logarithmic = control->log;
  state.design.answer = {};
}

void choose_response_end(Session& session, double ResponseChoice::*end, double value) {
  ResponseState& state = session.study.response;
  if (value == (end == &ResponseChoice::from ? state.choice.to : state.choice.from)) return;
  state.choice.*end = value;
  const std::optional<ParameterControl> varied = response_control(session);
  state.choice.logarithmic = varied && varied->log && std::min(state.choice.from, state.choice.to) > 0;
}

std::string response_refusal(const Session& session) {
  return is_resonance(session) ? resonance_refusal(session) : session.study.response.curve.problem;
}

void choose_quantity(Session& session, const ResponseQuantity& quantity) {
  ResponseState& state = session.study.response;
  state.choice.quantity = quantity.key;
  state.shown = quantity;
}

std::vector<ResponseQuantity> offered_quantities(const Session& session) {
  if (is_resonance(session)) return resonance_quantities(session);
  std::vector<ResponseQuantity> out;
  if (converged(session)) out = response_quantities(response_point(session.answer.solution, 0));
  const auto& found = session.study.response.curve.found;
  if (!found) return out;
  for (const ResponseLine& line : found->result.lines) {
    if (line.points.empty()) continue;
    // What rests on friction tells rates of what stands elsewhere.
    if (out.empty() || !line.points.front().frictions.empty())
      add_quantities(out, response_quantities(line.points.front()));
  }
  return out;
}

void go_to_response(Session& session, std::size_t line_index, double at, double step, bool dragged) {
  const auto& found = session.study.response.curve.found;
  if (!found || line_index >= found->result.lines.size()) return;
  const ResponseLine& line = found->result.lines[line_index];
  if (line.points.size() < 2) return;
  const ResponsePoint point = rounded_point(line, at, step);
  const std::string& address = found->of.address;
  if (!has_number(session.mechanism(), address)) return; // gone in this frame, by an undo
  // A hand that rests on the marker asks for nothing new.
  const bool there = session.on_branch && point.parameter == get_parameter(session.mechanism(), address);
  if (dragged && there && (solving(session) || near(session.answer.solution.coordinates, point.coordinates)))
    return;
  // What rests on friction is found from the drawn pose: nothing leads to it from beside.
  if (point.frictions.empty())
    go_to_state(session, address, point.parameter, start_values(point.coordinates));
  else
    change_parameter(session, address, point.parameter);
}

} // namespace flyball
