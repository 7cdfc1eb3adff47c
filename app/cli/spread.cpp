#include "engine/study/spread.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/processes.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SpreadArguments {
  SceneArgument scene;
  std::vector<std::string> tolerance;
  std::size_t samples = 1000;
  std::uint64_t seed = 1;
  std::string csv;
  bool json = false;
};

// "address=normal:0.1 mm", "address=uniform:2%": of the nominal value.
Tolerance parse_tolerance(const Mechanism& mechanism, std::string_view text) {
  const auto fail = [&] {
    return SceneError("--tolerance",
                      "expected address=normal:WIDTH, uniform:WIDTH or triangular:WIDTH, not \"" +
                          std::string(text) + "\"");
  };
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (equals == std::string_view::npos || equals == 0 || colon == std::string_view::npos) throw fail();
  Tolerance tolerance;
  tolerance.address = text.substr(0, equals);
  const std::string_view kind = text.substr(equals + 1, colon - equals - 1);
  bool known = false;
  for (const Distribution each : {Distribution::normal, Distribution::uniform, Distribution::triangular})
    if (kind == word(each)) {
      tolerance.distribution = each;
      known = true;
    }
  if (!known) throw fail();
  const std::string where = "--tolerance " + tolerance.address;
  const double nominal = get_parameter(mechanism, tolerance.address);
  std::string_view width = text.substr(colon + 1);
  if (width.ends_with('%')) {
    width.remove_suffix(1);
    tolerance.width = std::abs(nominal) * parse_number(where, width) / 100;
  } else {
    tolerance.width =
        evaluate_expression(mechanism, width, parameter_unit(mechanism, tolerance.address), where);
  }
  if (!(tolerance.width > 0)) throw SceneError(where, "expected a width above zero");
  return tolerance;
}

Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json statistics_json(const SpreadStatistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count}, {"mean", s.mean}, {"deviation", s.deviation},
          {"min", s.least},   {"q05", s.low},   {"median", s.median},
          {"q95", s.high},    {"max", s.most}};
}

Json shares_json(const std::vector<Tolerance>& tolerances, const std::vector<double>& shares) {
  if (shares.empty()) return nullptr;
  Json out = Json::object();
  for (std::size_t k = 0; k < tolerances.size(); ++k)
    out[tolerances[k].address] = number_json(shares[k]);
  return out;
}

Json answer_json(const std::vector<Tolerance>& tolerances, std::uint64_t seed, const SpreadAnswer& a) {
  Json out = {{"status", word(a.status)}, {"message", a.message}, {"samples", a.samples}, {"seed", seed}};
  out["tolerances"] = Json::array();
  for (const Tolerance& t : tolerances)
    out["tolerances"].push_back({{"address", t.address},
                                 {"distribution", word(t.distribution)},
                                 {"width", t.width},
                                 {"deviation", t.deviation()}});
  out["fates"] = Json::object();
  for (int i = 0; i < fates; ++i)
    out["fates"][std::string(word(static_cast<SampleFate>(i)))] = a.counts[static_cast<std::size_t>(i)];
  out["outputs"] = Json::object();
  for (const SpreadOutput& o : a.outputs)
    out["outputs"][o.name] = {
        {"unit", o.unit},
        {"nominal", number_json(o.nominal)},
        {"followed", statistics_json(o.followed)},
        {"elsewhere", statistics_json(o.elsewhere)},
        {"linear_deviation", o.linear_shares.empty() ? Json(nullptr) : number_json(o.linear_deviation)},
        {"linear_shares", shares_json(tolerances, o.linear_shares)},
        {"sampled_shares", shares_json(tolerances, o.sampled_shares)}};
  out["run_time_s"] = a.run_time_s;
  return out;
}

std::string answer_text(const Mechanism& m, const std::vector<Tolerance>& tolerances, const SpreadAnswer& a) {
  std::string out = fmt::format("{}: {}\n\n", printable(m.name), printable(a.message));
  const auto named = [](const SpreadOutput& o) {
    return printable(o.name) + (o.unit.empty() ? "" : " [" + o.unit + "]");
  };
  std::vector<std::vector<std::string>> rows{
      {"", "nominal", "mean", "deviation", "by rates", "5 %", "median", "95 %"}};
  for (const SpreadOutput& o : a.outputs) {
    const SpreadStatistics& s = o.followed;
    const auto text = [&](double value) { return s.count ? fmt::format("{:.6g}", value) : std::string("-"); };
    rows.push_back({named(o), fmt::format("{:.8g}", o.nominal), text(s.mean), text(s.deviation),
                    o.linear_shares.empty() ? "-" : fmt::format("{:.6g}", o.linear_deviation), text(s.low),
                    text(s.median), text(s.high)});
  }
  out += aligned(rows, true) + "\nshares of the variance, by rates and by samples\n";
  rows = {{""}};
  for (const Tolerance& t : tolerances) {
    rows[0].push_back(printable(t.address));
    rows[0].emplace_back("");
  }
  for (const SpreadOutput& o : a.outputs) {
    std::vector<std::string> row{named(o)};
    const auto share = [&](const std::vector<double>& shares, std::size_t k) {
      return shares.empty() ? std::string("-") : fmt::format("{:.1f} %", 100 * shares[k]);
    };
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
      row.push_back(share(o.linear_shares, k));
      row.push_back(share(o.sampled_shares, k));
    }
    rows.push_back(std::move(row));
  }
  out += aligned(rows, true);
  const auto elsewhere = a.counts[static_cast<std::size_t>(SampleFate::elsewhere)];
  if (elsewhere > 0) {
    out += "\nof the samples in another steady state\n";
    rows = {{"", "mean", "deviation", "least", "most"}};
    for (const SpreadOutput& o : a.outputs)
      if (const SpreadStatistics& s = o.elsewhere; s.count)
        rows.push_back({named(o), fmt::format("{:.6g}", s.mean), fmt::format("{:.6g}", s.deviation),
                        fmt::format("{:.6g}", s.least), fmt::format("{:.6g}", s.most)});
    out += aligned(rows, true);
  }
  return out + fmt::format("\n{:.0f} ms\n", a.run_time_s * 1e3);
}

std::string to_csv(const Mechanism& m, const std::vector<Tolerance>& tolerances, std::uint64_t seed,
                   const SpreadAnswer& a) {
  std::vector<double> nominal;
  std::vector<std::string> names;
  for (const Tolerance& t : tolerances) {
    names.push_back(t.address);
    nominal.push_back(get_parameter(m, t.address));
  }
  names.emplace_back("fate");
  for (const SpreadOutput& o : a.outputs)
    names.push_back(o.name);
  std::string out = csv_head(names);
  for (std::size_t i = 0; i < a.samples; ++i) {
    for (const double number : sampled_numbers(nominal, tolerances, seed, i))
      out += csv_number(number) + ",";
    out += word(a.fate[i]);
    for (const std::vector<double>& values : a.values)
      out += "," + csv_number(values[i]);
    out += "\n";
  }
  return out;
}

void run(const SpreadArguments& arguments, Ending& ending) {
  check_outputs(arguments.scene.file, {{"--csv", arguments.csv}});
  const std::unique_ptr<WorkSharing> sharing = share_work();
  const Mechanism mechanism = arguments.scene.load();
  std::vector<Tolerance> tolerances;
  SpreadAnswer answer;
  try {
    for (const std::string& text : arguments.tolerance)
      tolerances.push_back(parse_tolerance(mechanism, text));
    SpreadOptions options;
    options.samples = arguments.samples;
    options.seed = arguments.seed;
    ProgressBar progress("solving");
    options.progress = [&](std::size_t done, std::size_t all) { progress.show("solving", done, all); };
    answer = spread(mechanism, tolerances, options, *sharing);
  } catch (const SceneError& error) {
    throw SceneError(arguments.scene.file.string() + ": " + error.where(), error.expected());
  }
  if (!sharing->takes()) return;
  ending = end_with(answer.status == Status::converged, arguments.scene.file, answer.message);
  if (!arguments.csv.empty() && answer.status == Status::converged)
    write_bytes(arguments.csv, to_csv(mechanism, tolerances, arguments.seed, answer));
  if (arguments.csv == "-") return;
  if (arguments.json)
    print_json(with_warnings(answer_json(tolerances, arguments.seed, answer), mechanism));
  else if (answer.status == Status::converged)
    print_text(answer_text(mechanism, tolerances, answer));
}

} // namespace

void add_spread(CLI::App& app, Ending& ending) {
  auto arguments = std::make_shared<SpreadArguments>();
  CLI::App* command =
      app.add_subcommand("spread", "Tell how the steady state scatters with tolerances of numbers");
  arguments->scene.add_to(*command);
  command
      ->add_option(
          "--tolerance", arguments->tolerance,
          "A number's tolerance: address=normal:DEVIATION, =uniform:HALF or =triangular:HALF, with a unit or "
          "in % of the number; given again, several")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--samples", arguments->samples, "How many samples")
      ->check(CLI::Range(1., 1e8))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Which samples: the same seed gives the same to the bit")
      ->capture_default_str();
  command->add_option("--csv", arguments->csv, "Write the samples to a file (-: standard output)");
  command->add_flag("--json", arguments->json, "Print a JSON object");
  command->footer("Example: flyball spread governor.json --tolerance joints.slide.spring.stiffness=normal:2% "
                  "--samples 10000");
  command->callback([arguments, &ending] { run(*arguments, ending); });
}

} // namespace flyball::cli
