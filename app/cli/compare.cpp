#include "engine/study/compare.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/time_limit.hpp"
#include "app/plot/comparison_plot.hpp"
#include "app/plot/svg.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

// By name, where there are measures.
void add_measure_errors(Json& mark, const Comparison& c, const std::vector<double>& errors) {
  for (std::size_t i = 0; i < c.measures.size(); ++i)
    mark["measure_errors"][c.measures[i].name] = i < errors.size() ? number_json(errors[i]) : Json(nullptr);
}

Json mark_json(const Comparison& c, const DirectMark& m) {
  Json out = {{"iterations", m.iterations}, {"error", m.error}, {"run_time_s", m.run_time_s}};
  add_measure_errors(out, c, m.measure_errors);
  return out;
}

Json comparison_json(const Comparison& c) {
  Json out = {{"status", word(c.status)}, {"message", c.message}};
  Json reference = Json::array();
  for (const CoordinateSolution& q : c.reference)
    if (!q.driven)
      reference.push_back({{"joint", q.joint}, {"index", q.index}, {"value", q.value}, {"error", q.error}});
  out["reference"] = {{"coordinates", std::move(reference)},
                      {"error", c.reference_error},
                      {"residual", c.reference_residual}};
  for (const MeasureSolution& m : c.measures)
    out["reference"]["measures"][m.name] = {{"value", m.value ? Json(*m.value) : Json(nullptr)},
                                            {"unit", m.unit}};
  out["direct"] = Json::array();
  for (const DirectMark& m : c.direct)
    out["direct"].push_back(mark_json(c, m));
  out["answer"] = mark_json(c, c.answer);
  out["motion"] = Json::array();
  for (const MotionCurve& curve : c.motion) {
    Json points = Json::array();
    for (const MotionMark& p : curve.points) {
      points.push_back({{"tolerance", p.tolerance},
                        {"error", number_json(p.error)},
                        {"run_time_s", p.run_time_s},
                        {"steps", p.steps},
                        {"evaluations", p.evaluations},
                        {"status", word(p.status)}});
      add_measure_errors(points.back(), c, p.measure_errors);
    }
    out["motion"].push_back(
        {{"method", word(curve.method)}, {"duration", curve.duration}, {"points", std::move(points)}});
  }
  out["best"] = nullptr;
  if (c.best)
    out["best"] = {{"method", word(c.best->method)}, {"duration", c.best->duration},
                   {"tolerance", c.best->tolerance}, {"error", c.best->error},
                   {"motion_s", c.best->motion_s},   {"direct_s", c.best->direct_s},
                   {"ratio", c.best->ratio()}};
  return out;
}

std::string time_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.2f} µs", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.3f} ms", seconds * 1e3);
  return fmt::format("{:.3f} s", seconds);
}

// Why a run has no error, in at most eight letters.
std::string short_word(RunStatus status) {
  return status == RunStatus::time_limit ? "too long" : std::string(word(status));
}

// The runs of one integrator: tolerances down, simulated durations across.
std::string table(const Comparison& c, Integrator method) {
  std::vector<const MotionCurve*> curves;
  for (const MotionCurve& curve : c.motion)
    if (curve.method == method) curves.push_back(&curve);
  std::string out = "  tolerance";
  for (const MotionCurve* curve : curves)
    out += fmt::format("  {:>19}", fmt::format("{:.3g} s simulated", curve->duration));
  out += "\n";
  const auto longest =
      *std::ranges::max_element(curves, {}, [](const MotionCurve* curve) { return curve->points.size(); });
  for (std::size_t p = 0; p < longest->points.size(); ++p) {
    out += fmt::format("  {:9.0e}", longest->points[p].tolerance);
    for (const MotionCurve* curve : curves) {
      if (p >= curve->points.size()) { // given up before
        out += fmt::format("  {:>19}", "-");
        continue;
      }
      const MotionMark& point = curve->points[p];
      const std::string error =
          std::isfinite(point.error) ? fmt::format("{:.1e}", point.error) : short_word(point.status);
      out += fmt::format("  {:>8} {:>10}", error, time_text(point.run_time_s));
    }
    out += "\n";
  }
  return out;
}

std::string to_text(const Mechanism& mechanism, const Comparison& c) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(c.message));
  if (c.reference.empty()) return out;
  out += fmt::format("reference verified in extended precision: last correction {:.1e}, residual {:.1e}\n",
                     c.reference_error, c.reference_residual);
  out += "\ndirect solution           error      run time\n";
  for (const DirectMark& m : c.direct)
    out += fmt::format("  {:2} iterations         {:8.1e}  {:>12}\n", m.iterations, m.error,
                       time_text(m.run_time_s));
  out += fmt::format("  with all checks       {:8.1e}  {:>12}\n", c.answer.error,
                     time_text(c.answer.run_time_s));
  if (c.motion.empty()) return out;
  for (const Integrator method : {Integrator::bdf, Integrator::adams, Integrator::runge_kutta})
    if (std::ranges::find(c.motion, method, &MotionCurve::method) != c.motion.end())
      out += fmt::format("\ndamped motion with {}: error and run time\n", word(method)) + table(c, method);
  if (c.best)
    out += fmt::format(
        "\nThe motion comes nearest with {} at tolerance {:.0e} over {:.4g} s: error {:.1e} after {}.\n"
        "The direct solution is as near after {}: {:.0f} times {}.\n",
        word(c.best->method), c.best->tolerance, c.best->duration, c.best->error, time_text(c.best->motion_s),
        time_text(c.best->direct_s), std::max(c.best->ratio(), 1 / c.best->ratio()),
        c.best->ratio() < 1 ? "later" : "sooner");
  return out;
}

struct CompareCommand {
  SceneArgument scene;
  std::string csv, svg, plot;
  int repeats = 5;
  std::vector<double> durations;
  double time_limit = usual_time_limit;
  bool json = false;
};

// The measure of that name; none for "". Throws SceneError naming those there are.
std::optional<std::size_t> plotted_measure(const Mechanism& m, const std::string& name) {
  if (name.empty()) return {};
  const auto found = std::ranges::find(m.measures, name, &NamedMeasure::name);
  if (found != m.measures.end()) return static_cast<std::size_t>(found - m.measures.begin());
  std::vector<std::string_view> names;
  for (const NamedMeasure& measure : m.measures)
    names.push_back(measure.name);
  throw SceneError("--plot " + name,
                   names.empty() ? "the scene has no measures" : "expected one of " + word_list(names));
}

Ending run_compare(const CompareCommand& options) {
  check_outputs(options.scene.file, {{"--csv", options.csv}, {"--svg", options.svg}});
  std::optional<ProgressBar> progress(std::in_place, "reading");
  const Mechanism mechanism = options.scene.load();
  const std::optional<std::size_t> plotted = plotted_measure(mechanism, options.plot);
  Comparison comparison;
  try {
    progress->show({"solving"});
    // What looks at no clock of its own is cancelled, a moment later than what does.
    const TimeLimit limit(options.time_limit + 0.2);
    CompareOptions wanted;
    wanted.time_limit = options.time_limit;
    wanted.cancel = &limit.over();
    wanted.repeats = options.repeats;
    wanted.durations = options.durations;
    wanted.progress = [&](std::size_t done, std::size_t all) {
      progress->show("measuring motions", done, all);
    };
    comparison = compare(mechanism, wanted);
  } catch (const SceneError& error) {
    throw options.scene.in_file(error);
  }
  progress.reset();
  // Files of earlier runs are not replaced by empty ones.
  const bool any = !comparison.reference.empty();
  if (any && !options.svg.empty())
    write_bytes(options.svg, to_svg(comparison_plot(mechanism.name, comparison, plotted)));
  if (any && !options.csv.empty()) write_bytes(options.csv, comparison_csv(comparison));
  if (options.json)
    print_json(with_warnings(comparison_json(comparison), mechanism));
  else if (options.csv != "-" && options.svg != "-") // else standard output is theirs
    print_text(to_text(mechanism, comparison));
  return end_with(comparison.status == Status::converged && comparison.complete, options.scene.file,
                  comparison.message);
}

} // namespace

void add_compare(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<CompareCommand>();
  CLI::App* command =
      app.add_subcommand("compare", "Measure error against run time: direct solution and damped motion");
  options->scene.add_to(*command);
  command->add_option("--csv", options->csv, "Write all measurements to a file (-: standard output)");
  CLI::Option* svg =
      command->add_option("--svg", options->svg, "Draw them, on logarithmic axes (-: standard output)");
  command
      ->add_option("--plot", options->plot,
                   "The measure whose error --svg draws (default: the largest error of the coordinates)")
      ->needs(svg);
  command->add_option("--repeats", options->repeats, "Runs of which the median time is told")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--duration", options->durations,
                   "Seconds to simulate; may be given several times (default: by the slowest motion)")
      ->check(above_zero());
  add_time_limit(*command, options->time_limit);
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer("Example: flyball compare governor.json --csv compare.csv --svg compare.svg");
  command->callback([options, &ending] { ending = run_compare(*options); });
}

} // namespace flyball::cli
