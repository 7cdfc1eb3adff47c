#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/report/linear_model_file.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/study/linear_model.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

namespace flyball::cli {
namespace {

struct LinearizeArguments {
  SceneArgument scene;
  std::vector<std::string> inputs, outputs, start;
  std::filesystem::path file;
  std::string frequencies, csv;
  bool nearest = false, phases = false, slipping = false, json = false;
};

// "from:to:count" in Hz.
std::vector<double> parse_frequencies(const std::string& text) {
  const auto fail = [&] {
    return SceneError("--frequencies " + text,
                      "expected FROM:TO:COUNT in Hz, 0 < FROM < TO, 2 to 100000 of them");
  };
  Range range;
  try {
    range = parse_range("--frequencies", "Hz=" + text, true);
  } catch (const SceneError&) { // in words of addresses
    throw fail();
  }
  if (!(range.from > 0) || !(range.to > range.from) || range.count < 2 || range.count > 100000) throw fail();
  return log_spaced(range.from, range.to, range.count);
}

std::string complex_text(std::complex<double> s) {
  return s.imag() == 0
             ? fmt::format("{:.9g}", s.real())
             : fmt::format("{:.9g} {} {:.9g} i", s.real(), s.imag() < 0 ? "-" : "+", std::abs(s.imag()));
}

std::string model_text(const Mechanism& mechanism, const LinearModel& model) {
  std::string out =
      fmt::format("{}: {} states, {} inputs, {} outputs{}\n", printable(mechanism.name), model.states.size(),
                  model.inputs.size(), model.outputs.size(),
                  model.explicit_form ? "" : "; bodies without mass, or with hardly any: E alone");
  const auto list = [&](const char* what, const auto& signals) {
    out += fmt::format("  {}:", what);
    for (const auto& signal : signals)
      out +=
          fmt::format("  {}{}", printable(signal.name), signal.unit.empty() ? "" : " (" + signal.unit + ")");
    out += "\n";
  };
  list("states", model.states);
  out += "  poles (1/s):";
  for (const std::complex<double> pole : model.poles)
    if (pole.imag() >= 0) out += "  " + complex_text(pole) + (pole.imag() > 0 ? " and conjugate" : "");
  out += "\n";
  if (model.gain) {
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < model.outputs.size(); ++i)
      for (std::size_t j = 0; j < model.inputs.size(); ++j) {
        const LinearSignal &y = model.outputs[i], &u = model.inputs[j];
        const double gain = (*model.gain)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        rows.push_back({printable(y.name) + " by " + printable(u.name), fmt::format("{:.12g}", gain),
                        transfer_unit(y, u)});
      }
    out += "  static gain:\n" + aligned(rows, true);
  } else {
    out += "  no static gain: something integrates\n";
  }
  if (const std::string text = friction_text(model); !text.empty()) out += "  " + printable(text) + "\n";
  const double error = model.output_error.size() > 0 ? model.output_error.maxCoeff() : 0;
  return out + fmt::format("  relative error of the outputs {:.1e}, {:.1f} ms\n", error,
                           (model.steady.run_time_s + model.run_time_s) * 1e3);
}

void run(const LinearizeArguments& arguments, Ending& ending) {
  check_outputs(arguments.scene.file, {{"--output", arguments.file.string()}, {"--csv", arguments.csv}});
  std::optional<LinearModelFormat> format;
  if (!arguments.file.empty()) {
    format = linear_model_format(arguments.file.extension().string());
    if (!format)
      throw SceneError("--output " + arguments.file.string(),
                       "expected a file that ends in .json, .npz, .m or .py");
  }
  std::vector<double> frequencies;
  if (!arguments.frequencies.empty()) frequencies = parse_frequencies(arguments.frequencies);
  std::optional<ProgressBar> progress(std::in_place, "solving");
  const Mechanism mechanism = arguments.scene.load();
  LinearModelOptions options;
  options.nearest = arguments.nearest;
  options.phases = arguments.phases;
  options.slipping = arguments.slipping;
  for (const std::string& text : arguments.start)
    options.start.push_back(parse_assignment("--start", text));
  LinearModel model;
  try {
    model = linearize(mechanism, arguments.inputs, arguments.outputs, options);
  } catch (const SceneError& error) {
    throw arguments.scene.in_file(error);
  }
  progress.reset();
  const bool any = model.refusal.empty();
  if (any && format) write_bytes(arguments.file, linear_model_file(mechanism, model, *format));
  const bool table = any && !frequencies.empty();
  const std::string csv = table && arguments.csv.empty() && !arguments.json ? "-" : arguments.csv;
  if (table && !csv.empty()) write_bytes(csv, bode_csv(model, frequencies));
  if (arguments.json) {
    nlohmann::ordered_json told = linear_model_json(mechanism, model);
    if (table) {
      told["frequencies_hz"] = frequencies;
      const auto curves = frequency_response(model, frequencies);
      for (std::size_t i = 0; i < model.outputs.size(); ++i)
        for (std::size_t j = 0; j < model.inputs.size(); ++j) {
          nlohmann::ordered_json magnitude = nlohmann::ordered_json::array(), phase = magnitude;
          for (const BodePoint& point : curves[i * model.inputs.size() + j]) {
            magnitude.push_back(number_json(point.magnitude));
            phase.push_back(number_json(point.phase));
          }
          told["response"][model.outputs[i].name][model.inputs[j].name] = {
              {"magnitude", std::move(magnitude)}, {"phase_deg", std::move(phase)}};
        }
    }
    print_json(with_warnings(std::move(told), mechanism));
  } else if (any && csv != "-") {
    print_text(model_text(mechanism, model));
  }
  ending = end_with(any, arguments.scene.file, model.refusal);
}

} // namespace

void add_linearize(CLI::App& app, Ending& ending) {
  auto arguments = std::make_shared<LinearizeArguments>();
  CLI::App* command =
      app.add_subcommand("linearize", "Make a linear model about the steady state: A, B, C, D by names");
  arguments->scene.add_to(*command);
  command
      ->add_option(
          "--inputs", arguments->inputs,
          "What acts: addresses of numbers, torque(JOINT), force_x(BODY) or force_x(BODY@POINT), _y, _z")
      ->required();
  command
      ->add_option("--outputs", arguments->outputs,
                   "What is looked at: measures, coordinates, or results such as rate(slide), torque(spin)")
      ->required();
  command->add_option(
      "-o,--output", arguments->file,
      "Write the model to a file that ends in .json, .npz (NumPy), .m (MATLAB) or .py (Python)");
  CLI::Option* frequencies =
      command->add_option("--frequencies", arguments->frequencies,
                          "Tell the frequency response at FROM:TO:COUNT (Hz, evenly on a logarithmic axis)");
  command->add_option("--csv", arguments->csv, "Write that to a file (-: standard output)")
      ->needs(frequencies);
  add_start(*command, arguments->start);
  command->add_flag("--nearest", arguments->nearest, "About the plain Newton-Raphson answer, stable or not");
  command->add_flag("--phases", arguments->phases,
                    "Angles of shafts that torques drive are states, too: they integrate");
  command->add_flag(
      "--slipping", arguments->slipping,
      "Of the motion once joints with dry friction slip: their hold is left out, and they are no "
      "longer rigid");
  command->add_flag("--json", arguments->json, "Print a JSON object");
  command->footer("Example: flyball linearize governor.json --inputs joints.spin.drive.speed --outputs slide "
                  "-o governor.m");
  command->callback([arguments, &ending] { run(*arguments, ending); });
}

} // namespace flyball::cli
