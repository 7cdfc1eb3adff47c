#include "engine/study/design.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
      if (!c.driven) out += fmt::format(" {} = {:.12g} {} ", shown_label(c), c.value, c.angle ? "rad" : "m");
    for (const MeasureSolution& measure : s.at.measures)
      if (measure.value) out += fmt::format(" {} = {:.12g} {} ", measure.name, *measure.value, measure.unit);
    out += fmt::format("\n    {} iterations, scaled residual {:.1e}\n", s.iterations, s.residual);
  }
  return out + fmt::format("  {:.1f} ms\n", a.run_time_s * 1e3);
}

} // namespace

void add_design(CLI::App& app, Ending& ending) {
  struct Options {
    SceneArgument scene;
    std::string vary, want;
    bool connected = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "design", "Find the value of a parameter at which a coordinate or measure is as wanted");
  options->scene.add_to(*command);
  command->add_option("--vary", options->vary, "The parameter to solve for: address=from:to")->required();
  command
      ->add_option(
          "--want", options->want,
          "What is wanted: joint=value or joint.index=value (rad, m), or measure=value (in its unit)")
      ->required();
  command->add_flag("--connected", options->connected,
                    "Only on branches connected with the drawn pose's (quicker)");
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer(
      "Example: flyball design governor.json --vary joints.spin.drive.speed=0:30 --want slide=0.12");
  command->callback([options, &ending] {
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    const Range range = parse_range("--vary", options->vary);
    if (range.from == range.to) throw SceneError("--vary " + range.address, "expected two different ends");
    const auto [coordinate, value] = parse_assignment("--want", options->want);
    DesignAnswer answer;
    try {
      DesignOptions ask;
      ask.all = !options->connected;
      ask.progress = progress->reporter();
      answer = design(mechanism, range.address, range.from, range.to, coordinate, value, ask);
    } catch (const SceneError& error) {
      throw SceneError(options->scene.file.string() + ": " + error.where(), error.expected());
    }
    progress.reset();
    if (options->json)
      print_json(with_warnings(answer_json(range.address, coordinate, answer), mechanism));
    else
      print_text(answer_text(mechanism, range.address, answer));
    ending = end_with(answer.status == Status::converged, options->scene.file, answer.message);
  });
}

} // namespace flyball::cli
