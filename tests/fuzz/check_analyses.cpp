#include "tests/fuzz/check_analyses.hpp"

#include "tests/fuzz/check_scene.hpp"
#include "tests/fuzz/not_finite.hpp"
#include "tests/fuzz/watch.hpp"

#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/fold_curve.hpp"
#include "engine/study/frequency_response.hpp"
#include "engine/study/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace flyball::fuzz {
namespace {

using Complaint = std::optional<std::string>;

struct Range {
  std::string address;
  double from = 0, to = 1;
};

// A drive's speed where there is one, half of the time; around the present value or through zero.
Range some_range(const Mechanism& m, unsigned seed) {
  const std::vector<std::string> all = parameter_addresses(m);
  Range out;
  out.address = all[seed % all.size()];
  for (std::size_t i = 0; i < all.size() && seed % 2 == 0; ++i)
    if (all[i].ends_with("drive.speed")) out.address = all[i];
  const double value = get_parameter(m, out.address);
  out.from = seed % 3 == 0 ? 0 : value / 2;
  out.to = value == 0 ? 10 : 2 * value;
  return out;
}

std::string a_coordinate(const Analysis& analysis) {
  for (const CoordinateSolution& c : analysis.summary().coordinates)
    if (!c.driven) return c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index);
  return "";
}

Complaint about(const std::string& message) {
  return message.empty() ? Complaint("no message") : std::nullopt;
}

Complaint about(const Solution& solution) {
  if (const auto field = not_finite(solution)) return "a number that is none: " + *field;
  return about(solution.message);
}

Complaint about(const ResponseDiagram& diagram) {
  for (const ResponseBranch& branch : diagram.branches) {
    if (branch.end.empty()) return "a branch that ends without a word";
    for (const ResponsePoint& point : branch.points)
      if (const auto field = not_finite(point)) return "a number that is none on a branch: " + *field;
  }
  for (const SpecialPoint& special : diagram.special)
    if (const auto field = not_finite(special.at))
      return "a number that is none at a special point: " + *field;
  return about(diagram.message);
}

Complaint about(const Run& run) {
  if (const auto field = not_finite(run)) return "a number that is none in a motion: " + *field;
  if (!run.time.empty())
    for (const Pose& pose : poses_at(run, run.time.back() / 2))
      if (!finite(pose)) return "a number that is none in a motion: pose";
  return about(run.message);
}

Complaint about(const PlaneCurves& curves) {
  for (const PlaneCurve& curve : curves.curves)
    for (const PlanePoint& point : curve.points)
      if (!std::isfinite(point.x) || !std::isfinite(point.y)) return "a number that is none on a map's curve";
  return about(curves.message);
}

Complaint all_equilibria(const Mechanism& m, const std::atomic<bool>* cancel) {
  SolveOptions options;
  options.cancel = cancel;
  const AllSolutions all = Analysis(m).solve_all(options);
  for (const Solution& solution : all.equilibria)
    if (const auto complaint = about(solution)) return complaint;
  return about(all.message);
}

Complaint modes(const Mechanism& m, const std::atomic<bool>* cancel) {
  Analysis analysis(m);
  SolveOptions options;
  options.cancel = cancel;
  options.modes = 3;
  if (const auto complaint = about(analysis.solve(options))) return complaint;
  for (const VibrationMode& mode : analysis.modes())
    for (const Pose& pose : analysis.mode_poses(mode, 0.1, 0.5, 0.2))
      if (!finite(pose)) return "a number that is none in a mode";
  analysis.stability_evidence();
  return std::nullopt;
}

Complaint branches(const Mechanism& m, const Range& range, bool all, const std::atomic<bool>* cancel) {
  BranchOptions options;
  options.all = all;
  options.reactions = !all;
  options.max_points = 200;
  options.largest_step = 0.05;
  options.cancel = cancel;
  return about(follow_branches(m, range.address, range.from, range.to, options));
}

Complaint designs(const Mechanism& m, const Range& range, const std::atomic<bool>* cancel) {
  const std::string coordinate = a_coordinate(Analysis(m));
  if (coordinate.empty()) return std::nullopt;
  DesignOptions options;
  options.largest_step = 0.05;
  options.cancel = cancel;
  const DesignAnswer answer = design(m, range.address, range.from, range.to, coordinate, 0.1, options);
  for (const DesignSolution& solution : answer.solutions)
    if (const auto field = not_finite(solution.at)) return "a number that is none in a design: " + *field;
  return about(answer.message);
}

Complaint motion(const Mechanism& m, unsigned seed, const std::atomic<bool>* cancel) {
  SimulationOptions options;
  options.duration = 0.2;
  options.rate = 50;
  options.reactions = true;
  options.tolerance = 1e-6;
  options.start = seed % 4 == 0 ? Start::drawn : Start::rest;
  options.damped = seed % 5 != 0;
  options.cancel = cancel;
  return about(simulate(m, options));
}

Complaint comparison(const Mechanism& m, const std::atomic<bool>* cancel) {
  CompareOptions options;
  options.tolerances = {1e-3, 1e-6};
  options.durations = {0.05};
  options.repeats = 1;
  options.max_steps = 20000;
  options.cancel = cancel;
  const Comparison answer = compare(m, options);
  if (std::isnan(answer.reference_error) || std::isnan(answer.answer.error)) return "an error that is none";
  return about(answer.message);
}

Complaint sweeps(const Mechanism& m, const Range& range, const std::atomic<bool>* cancel) {
  const std::vector<Variation> variations{{range.address, range.from, range.to, 4}};
  for (const SweepPoint& point : sweep(m, variations, 1, {}, cancel))
    if (const auto complaint = about(point.solution)) return complaint;
  return std::nullopt;
}

Complaint map_curves(const Mechanism& m, const Range& x, const Range& y, const std::atomic<bool>* cancel) {
  if (x.address == y.address) return std::nullopt;
  const auto axis = [](const Range& r) {
    return PlaneAxis{r.address, std::min(r.from, r.to), std::max(r.from, r.to)};
  };
  PlaneOptions options;
  options.largest_step = 0.1;
  options.max_points = 60;
  options.max_curves = 4;
  options.cancel = cancel;
  if (const auto complaint = about(fold_curves(m, axis(x), axis(y), options))) return complaint;
  const std::string coordinate = a_coordinate(Analysis(m));
  if (coordinate.empty()) return std::nullopt;
  return about(value_curves(m, axis(x), axis(y), coordinate, 0.1, options));
}

Complaint linear_models(const Mechanism& m, const Range& x, const std::atomic<bool>* cancel) {
  const std::string coordinate = a_coordinate(Analysis(m));
  std::vector<std::string> outputs{"mass()"};
  for (const NamedMeasure& measure : m.measures)
    outputs.push_back(measure.name);
  if (!coordinate.empty()) outputs.push_back(coordinate);
  LinearModelOptions options;
  options.cancel = cancel;
  const LinearModel model = linearize(m, std::vector{x.address}, outputs, options);
  if (!model.refusal.empty()) return std::nullopt;
  for (const StateSpace& form : {model.descriptor, best_form(model)})
    for (const Eigen::MatrixXd* matrix : {&form.e, &form.a, &form.b, &form.c, &form.d})
      if (!matrix->allFinite()) return "a number that is none in a linear model";
  if (model.gain && !model.gain->allFinite()) return "a number that is none in a static gain";
  for (const std::complex<double> pole : model.poles)
    if (!std::isfinite(pole.real()) || !std::isfinite(pole.imag())) return "a number that is none in a pole";
  for (const double frequency : telling_frequencies(model, 10))
    if (!(frequency > 0) || !std::isfinite(frequency)) return "a frequency that is none";
  frequency_response(model, telling_frequencies(model, 10));
  return std::nullopt;
}

} // namespace

std::optional<std::string> check_analysis(std::string_view bytes, int which, unsigned seed,
                                          std::chrono::milliseconds limit) {
  Mechanism m;
  try {
    m = parse_scene(bytes);
  } catch (const SceneError&) {
    return std::nullopt;
  }
  if (!find_mistakes(m).empty() || !small_enough(m)) return std::nullopt;
  const auto begin = std::chrono::steady_clock::now();
  Complaint complaint;
  try {
    const Watch watch(limit);
    const std::atomic<bool>* cancel = watch.expired();
    const Range x = some_range(m, seed), y = some_range(m, seed / 7 + 1);
    switch (which) {
    case 0: complaint = all_equilibria(m, cancel); break;
    case 1: complaint = modes(m, cancel); break;
    case 2: complaint = branches(m, x, false, cancel); break;
    case 3: complaint = branches(m, x, true, cancel); break;
    case 4: complaint = designs(m, x, cancel); break;
    case 5: complaint = motion(m, seed, cancel); break;
    case 6: complaint = comparison(m, cancel); break;
    case 7: complaint = sweeps(m, x, cancel); break;
    case 8: complaint = linear_models(m, x, cancel); break;
    default: complaint = map_curves(m, x, y, cancel);
    }
  } catch (const SceneError& error) {
    if (error.expected().empty()) complaint = "refused without a reason";
  }
  const std::chrono::duration<double> late = std::chrono::steady_clock::now() - begin - limit;
  if (!complaint && late > std::chrono::seconds(5))
    complaint = "went on for " + std::to_string(late.count()) + " s after it was cancelled";
  if (complaint) complaint = "analysis " + std::to_string(which) + ": " + *complaint;
  return complaint;
}

} // namespace flyball::fuzz
