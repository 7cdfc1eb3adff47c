#include "engine/study/design.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/goals.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json answer_json(const std::string& address, const std::string& coordinate, const DesignAnswer& a) {
  Json out = {{"status", word(a.status)},  {"message", a.message}, {"parameter", address},
              {"coordinate", coordinate},  {"value", a.value},     {"unit", a.unit},
              {"solutions", Json::array()}};
  for (const DesignSolution& s : a.solutions) {
    Json entry = {
        {"parameter", s.parameter},
        {"error_estimate", s.parameter_error},
        {"coordinates", coordinates_json(s.at.coordinates)},
        {"speeds", speeds_json(s.at.coordinates)},
        {"measures", measures_json(s.at.measures)},
        {"residual", s.residual},
        {"iterations", s.iterations},
        {"rate", s.rate ? Json(*s.rate) : Json(nullptr)},
        {"connected", s.connected},
        {"stable", s.at.stable ? Json(*s.at.stable) : Json(nullptr)},
        {"stability_reason", s.at.stability_reason ? Json(word(*s.at.stability_reason)) : Json(nullptr)},
        {"eigenvalues", Json::array()}};
    for (const auto& e : s.at.eigenvalues)
      entry["eigenvalues"].push_back({e.real(), e.imag()});
    out["solutions"].push_back(std::move(entry));
  }
  const bool covered = a.lowest < a.highest;
  out["covered"] = covered ? Json({a.lowest, a.highest}) : Json(nullptr);
  out["run_time_s"] = a.run_time_s;
  return out;
}

std::string answer_text(const Mechanism& m, const std::string& address, const DesignAnswer& a) {
  const std::string unit = parameter_unit(m, address);
  std::string out = fmt::format("{}: {}\n", printable(m.name), printable(a.message));
  for (const DesignSolution& s : a.solutions) {
    out += fmt::format("  {} = {} {} (± {:.1e}), {}{}\n", printable(address), number_text(s.parameter), unit,
                       s.parameter_error,
                       s.at.stable ? (*s.at.stable ? "stable" : "unstable") : "stability open",
                       s.connected ? "" : ", on a branch that nothing connects with the drawn pose's");
    out += "   ";
    for (const CoordinateSolution& c : s.at.coordinates)
      if (const auto found = found_number(c))
        out += fmt::format(" {} = {:.12g} {} ", printable(found->name), found->value, found->unit);
    for (const MeasureSolution& measure : s.at.measures)
      if (measure.value) out += fmt::format(" {} = {:.12g} {} ", measure.name, *measure.value, measure.unit);
    out += fmt::format("\n    {} iterations, scaled residual {:.1e}\n", s.iterations, s.residual);
  }
  return out + fmt::format("  {:.1f} ms\n", a.run_time_s * 1e3);
}

Json reached_json(const GoalAnswer::Reached& goal, const char* other) {
  return {{"name", goal.wanted}, {"value", goal.value}, {other, goal.goal}, {"unit", goal.unit}};
}

Json answer_json(const Mechanism& m, const GoalAnswer& a) {
  Json out = {{"status", word(a.status)},
              {"reached", a.reached},
              {"message", a.message},
              {"parameters", Json::array()},
              {"goals", Json::array()}};
  for (const GoalAnswer::Number& number : a.numbers)
    out["parameters"].push_back({{"address", number.address},
                                 {"value", number.value},
                                 {"unit", parameter_unit(m, number.address)},
                                 {"at_limit", number.at_limit}});
  for (const GoalAnswer::Reached& goal : a.goals)
    out["goals"].push_back(reached_json(goal, "wanted"));
  out["minimized"] = a.least ? reached_json(*a.least, "before") : Json(nullptr);
  out["solution"] = to_json(m, a.solution);
  out["iterations"] = a.iterations;
  out["run_time_s"] = a.run_time_s;
  return out;
}

std::string answer_text(const Mechanism& m, const GoalAnswer& a) {
  const auto with_unit = [](const std::string& unit) { return unit.empty() ? "" : " " + unit; };
  std::string out = fmt::format("{}: {}\n", printable(m.name), printable(a.message));
  for (const GoalAnswer::Number& number : a.numbers)
    out += fmt::format("  {} = {}{}{}\n", printable(number.address), number_text(number.value),
                       with_unit(parameter_unit(m, number.address)),
                       number.at_limit ? ", at the end of its range" : "");
  if (a.least)
    out += fmt::format("  least: {} = {:.12g}{}\n", printable(a.least->wanted), a.least->value,
                       with_unit(a.least->unit));
  out += "   ";
  for (const CoordinateSolution& c : a.solution.coordinates)
    if (const auto found = found_number(c))
      out += fmt::format(" {} = {:.12g} {} (± {:.0e}) ", printable(found->name), found->value, found->unit,
                         found->error);
  for (const MeasureSolution& measure : a.solution.measures)
    if (measure.value)
      out += fmt::format(" {} = {:.12g}{} ", measure.name, *measure.value, with_unit(measure.unit));
  const char* stability = !a.solution.stable ? "stability open" : *a.solution.stable ? "stable" : "unstable";
  return out + fmt::format("\n    {}, scaled residual {:.1e}, {} iterations, {:.1f} ms\n", stability,
                           a.solution.residual, a.iterations, a.run_time_s * 1e3);
}

struct DesignArguments {
  SceneArgument scene;
  std::vector<std::string> vary, want;
  std::string minimized;
  bool connected = false, json = false;
};

// Of one parameter and one wish: every branch over the range is followed.
Ending find_one(const DesignArguments& arguments, const Mechanism& mechanism, const Range& range,
                const std::pair<std::string, double>& want, std::optional<ProgressBar>& progress) {
  DesignOptions ask;
  ask.all = !arguments.connected;
  ask.progress = progress->reporter();
  const DesignAnswer answer =
      design(mechanism, range.address, range.from, range.to, want.first, want.second, ask);
  progress.reset();
  if (arguments.json)
    print_json(with_warnings(answer_json(range.address, want.first, answer), mechanism));
  else
    print_text(answer_text(mechanism, range.address, answer));
  return end_with(answer.status == Status::converged, arguments.scene.file, answer.message);
}

// Of several: from the steady state of the drawn pose, along its branch.
Ending find_several(const DesignArguments& arguments, const Mechanism& mechanism,
                    const std::vector<Range>& ranges,
                    const std::vector<std::pair<std::string, double>>& wants,
                    std::optional<ProgressBar>& progress) {
  if (arguments.connected)
    throw SceneError("--connected",
                     "expected with one --vary and one --want: several follow one branch anyway");
  std::vector<FreeNumber> free;
  for (const Range& range : ranges)
    free.push_back({range.address, std::min(range.from, range.to), std::max(range.from, range.to)});
  std::vector<Goal> goals;
  for (const auto& [wanted, value] : wants)
    goals.push_back({wanted, value});
  const GoalAnswer answer = arguments.minimized.empty()
                                ? seek_goals(mechanism, free, goals)
                                : minimize(mechanism, free, arguments.minimized, goals);
  progress.reset();
  if (arguments.json)
    print_json(with_warnings(answer_json(mechanism, answer), mechanism));
  else
    print_text(answer_text(mechanism, answer));
  return end_with(answer.reached, arguments.scene.file, answer.message);
}

} // namespace

void add_design(CLI::App& app, Ending& ending) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand(
      "design", "Find the values of parameters at which coordinates or measures are as wanted");
  arguments->scene.add_to(*command);
  command
      ->add_option("--vary", arguments->vary,
                   "A parameter to solve for: address=from:to; given again, several move by the least change")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  CLI::Option* want = command
                          ->add_option("--want", arguments->want,
                                       "What is wanted: joint=value or joint.index=value (rad, m), or "
                                       "measure=value (in its unit); given "
                                       "again, several")
                          ->take_all()
                          ->allow_extra_args(false);
  CLI::Option* least =
      command->add_option("--minimize", arguments->minimized,
                          "A coordinate or measure to be made least, what is wanted being kept");
  command->add_flag("--connected", arguments->connected,
                    "Only on branches connected with the drawn pose's (quicker)");
  command->add_flag("--json", arguments->json, "Print a JSON object");
  command->footer(
      "Example: flyball design governor.json --vary joints.spin.drive.speed=0:30 --want slide=0.12");
  command->callback([arguments, want, least, &ending] {
    if (want->empty() && least->empty()) throw SceneError("design", "expected --want or --minimize");
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = arguments->scene.load();
    std::vector<Range> ranges;
    for (const std::string& text : arguments->vary)
      ranges.push_back(parse_range(mechanism, "--vary", text));
    std::vector<std::pair<std::string, double>> wants;
    for (const std::string& text : arguments->want)
      wants.push_back(parse_assignment("--want", text));
    try {
      ending = ranges.size() == 1 && wants.size() == 1 && least->empty()
                   ? find_one(*arguments, mechanism, ranges[0], wants[0], progress)
                   : find_several(*arguments, mechanism, ranges, wants, progress);
    } catch (const SceneError& error) {
      throw arguments->scene.in_file(error);
    }
  });
}

} // namespace flyball::cli
