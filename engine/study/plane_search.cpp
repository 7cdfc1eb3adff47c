#include "engine/study/plane_search.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/solution_difference.hpp"
#include "engine/study/friction_branches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace flyball {

std::string_view word(PlaneCurveType type) {
  switch (type) {
  case PlaneCurveType::fold: return "fold";
  case PlaneCurveType::branch_point: return "branch_point";
  case PlaneCurveType::value: return "value";
  case PlaneCurveType::hopf: return "hopf";
  }
  return "";
}

PlaneSearch::PlaneSearch(const Mechanism& mechanism, const PlaneAxis& x, const PlaneAxis& y,
                         const PlaneOptions& options)
    : mechanism_(mechanism), x_(x), y_(y), options_(options), begin_(std::chrono::steady_clock::now()),
      system_(compile_for_drives(inside_ranges(mechanism, std::array{NumberRange{x.address, x.from, x.to},
                                                                     NumberRange{y.address, y.from, y.to}})
                                     .value_or(at_corner()))) {
  if (!options.at.empty()) {
    for (const double value : options.at)
      lines_.push_back({0, value});
    return;
  }
  const double present = std::clamp(get_parameter(mechanism, y.address), y.from, y.to);
  for (const double value : {present, y.from, y.to})
    if (std::ranges::find(lines_, value, &Line::value) == lines_.end()) lines_.push_back({0, value});
  lines_.push_back({1, x.from});
  lines_.push_back({1, x.to});
}

Mechanism PlaneSearch::on(const Line& line) const {
  return with_parameter(mechanism_, line.varied == 0 ? y_.address : x_.address, line.value);
}

void PlaneSearch::for_lines(const std::function<void(const Line&)>& search) {
  const Interruptible scope(options_.cancel);
  try {
    for (std::size_t i = 0; i < lines_.size() && !cancelled() && refusal_.empty(); ++i) {
      line_ = i;
      report_progress(options_.progress, "following", part_before());
      search(lines_[i]);
    }
  } catch (const Interrupted&) {
  }
}

ReportProgress PlaneSearch::along_line() const {
  return [this](const Progress& now) {
    const double share = std::clamp(now.part, 0., 1.) / static_cast<double>(lines_.size());
    report_progress(options_.progress, now.phase, part_before() + share);
  };
}

ResponseDiagram PlaneSearch::branches(const Line& line, bool eigenvalues) {
  const PlaneAxis& along = moving(line);
  BranchOptions follow;
  follow.largest_step = options_.largest_step;
  follow.eigenvalues = eigenvalues;
  follow.all = options_.all;
  follow.cancel = options_.cancel;
  follow.progress = along_line();
  ResponseDiagram out = follow_branches(on(line), along.address, along.from, along.to, follow);
  if (!out.turned) add_present(line, follow, out);
  heard(out.status, out.message);
  return out;
}

// The branch of what solving answers with at the present values, on the line that goes through these: at the
// beginning of the line it may answer with a state of another.
void PlaneSearch::add_present(const Line& line, const BranchOptions& follow, ResponseDiagram& diagram) const {
  const double x = get_parameter(mechanism_, x_.address);
  if (line.varied != 0 || line.value != get_parameter(mechanism_, y_.address) ||
      !(x >= x_.from && x <= x_.to))
    return;
  SolveOptions solve;
  solve.friction = solve.explain = false;
  solve.cancel = options_.cancel;
  const Solution now = Analysis(mechanism_).solve(solve);
  if (now.status != Status::converged || now.turned) return;
  const ResponsePoint present = response_point(now, x);
  const auto is_beside = [&](const ResponsePoint& point) {
    return std::abs(point.parameter - x) <= 2 * follow.largest_step * (x_.to - x_.from) &&
           scaled_distance(point.coordinates, present.coordinates) <= 2 * follow.largest_step;
  };
  for (const ResponseBranch& branch : diagram.branches)
    if (std::ranges::any_of(branch.points, is_beside)) return;
  auto through = follow_branches_through(mechanism_, x_.address, x_.from, x_.to, present, follow);
  if (!through) return;
  const int before = static_cast<int>(diagram.branches.size());
  diagram.status = Status::converged;
  std::ranges::move(through->branches, std::back_inserter(diagram.branches));
  for (SpecialPoint& special : through->special) {
    special.branch += before;
    diagram.special.push_back(std::move(special));
  }
}

ExtendedBalance PlaneSearch::balance(std::vector<Condition> conditions, bool unfolded,
                                     std::optional<AngleTies> ties) const {
  return {system_,
          at_corner(),
          {x_.address, y_.address},
          Eigen::Vector2d(x_.to - x_.from, y_.to - y_.from),
          std::move(conditions),
          unfolded,
          std::move(ties)};
}

std::optional<AngleTies> PlaneSearch::ties() const {
  std::optional<AngleTies> out;
  if (system_.torques.empty()) return out;
  Workspace w;
  for (const double x : {x_.from, x_.to})
    for (const double y : {y_.from, y_.to})
      try {
        const Mechanism there = with_parameter(with_parameter(mechanism_, x_.address, x), y_.address, y);
        Parameters parameters;
        Scaling scaling;
        Eigen::VectorXd drawn;
        bind(system_, there, parameters);
        set_scaling(system_, parameters, scaling);
        drawn_configuration(system_, parameters, drawn);
        const auto ties = find_angle_ties({system_, parameters, scaling, options_.cancel}, drawn, w);
        if (!ties || (out && !tie_alike(*out, *ties))) return {};
        out = ties;
      } catch (const SceneError&) { // no mechanism can be made there
      }
  return out;
}

bool PlaneSearch::stands_turned(const Line& line, double varied,
                                const std::vector<CoordinateSolution>& coordinates) const {
  if (system_.torques.empty()) return false;
  Parameters parameters;
  Scaling scaling;
  bind(system_, with_parameter(on(line), moving(line).address, varied), parameters);
  set_scaling(system_, parameters, scaling);
  const Eigen::VectorXd starts = starts_of({system_, parameters, scaling}, coordinates);
  return std::ranges::any_of(system_.torques, [&](const DriveTorqueElement& torque) {
    const bool angle = system_.links[static_cast<std::size_t>(torque.link)].type == LinkType::revolute;
    const double start = starts[torque.link];
    return std::abs(angle ? std::remainder(start, 2 * std::numbers::pi) : start) > 1e-12;
  });
}

std::optional<PlaneSearch::Added> PlaneSearch::add(ExtendedBalance& balance, PlaneCurveType type,
                                                   const Line& line, double varied,
                                                   const std::vector<CoordinateSolution>& coordinates,
                                                   double pair) {
  if (static_cast<int>(out_.curves.size()) >= options_.max_curves || cancelled()) return {};
  PlaneTracer tracer(balance, x_, y_, type, options_);
  ExtendedState state;
  state.parameters =
      line.varied == 0 ? Eigen::Vector2d(varied, line.value) : Eigen::Vector2d(line.value, varied);
  state.pair = pair;
  state.starts = Eigen::VectorXd::Zero(balance.ties() ? static_cast<Eigen::Index>(system_.links.size()) : 0);
  balance.set(state);
  if (balance.ties()) {
    state.starts = starts_of(balance.problem(), coordinates);
    balance.set(state);
  }
  state.z.q = configuration_of(balance.problem(), coordinates);
  if (!tracer.start(state, 1 - line.varied)) {
    ++not_followed_;
    return {};
  }
  for (std::size_t i = 0; i < traced_.size(); ++i)
    if (out_.curves[i].type == type && tracer.lies_on(state, traced_[i])) return {};
  PlaneCurve curve;
  curve.type = type;
  TracedCurve traced = tracer.both_ways(state, 1 - line.varied, curve.begin);
  if (traced.states.empty()) return {};
  curve.closed = traced.closed;
  curve.end = traced.end;
  for (const ExtendedState& s : traced.states)
    curve.points.push_back(point(balance, type, s));
  for (const ExtendedState& s : traced.cusps)
    curve.cusps.push_back(point(balance, type, s));
  for (const ExtendedState& s : traced.takens)
    curve.takens.push_back(point(balance, type, s));
  traced_.push_back(std::move(traced));
  out_.curves.push_back(std::move(curve));
  return Added{traced_.back(), out_.curves.back()};
}

void PlaneSearch::heard(Status status, const std::string& message) {
  if (out_.status == Status::converged) return;
  out_.status = status;
  out_.message = message;
}

void PlaneSearch::refuse_turned() {
  refusal_ = "The steady state stands turned against the drawn pose, and the two numbers change which angles "
             "are tied to each other: its curves are not followed.";
}

PlaneCurves PlaneSearch::finish(const std::string& what, const std::string& left_out) {
  if (!refusal_.empty()) {
    out_ = {};
    out_.message = refusal_;
    return std::move(out_);
  }
  if (out_.status == Status::converged) {
    const std::size_t n = out_.curves.size();
    out_.message = (n == 0 ? "No " + what + " curve"
                           : std::to_string(n) + " " + what + (n == 1 ? " curve" : " curves")) +
                   " through the " + std::to_string(lines_.size()) +
                   " lines searched; there may be others between.";
    if (left_out_ > 0) out_.message += " " + left_out + " at " + std::to_string(left_out_) + " more points.";
    if (not_followed_ > 0)
      out_.message += " From " + std::to_string(not_followed_) +
                      (not_followed_ == 1 ? " point on them no curve could be followed."
                                          : " points on them no curve could be followed.");
    if (cancelled()) out_.message = "Cancelled. " + out_.message;
  } else if (out_.message.empty()) { // before anything was found
    out_.message = "Cancelled.";
  } else if (std::string why = asked_of_friction(
                 at_corner(), "Curves in the plane of two numbers are followed", options_.cancel);
             !why.empty() && !cancelled()) {
    out_.message = std::move(why);
  }
  out_.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  return std::move(out_);
}

Mechanism PlaneSearch::at_corner() const {
  return with_parameter(with_parameter(mechanism_, x_.address, x_.from), y_.address,
                        std::clamp(get_parameter(mechanism_, y_.address), y_.from, y_.to));
}

ResponsePoint PlaneSearch::response(ExtendedBalance& balance, const ExtendedState& s, bool eigenvalues) {
  balance.set(s);
  return response_point(balance.mechanism(), balance.judged(), s.z, {}, {eigenvalues, false},
                        balance.workspace());
}

PlanePoint PlaneSearch::point(ExtendedBalance& balance, PlaneCurveType type, const ExtendedState& s) {
  ResponsePoint p = response(balance, s, false);
  PlanePoint out{s.parameters[0], s.parameters[1], std::move(p.coordinates), {}};
  if (type == PlaneCurveType::value) out.stable = p.stable;
  return out;
}

} // namespace flyball
