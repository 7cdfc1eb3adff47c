#include "app/cli/spread_report.hpp"

#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/column_name.hpp"
#include "app/plot/spread_plot.hpp"
#include "engine/mechanism/decimal.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json statistics_json(const SpreadStatistics& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count},
          {"mean", s.mean},
          {"mean_error", s.mean_error},
          {"deviation", s.deviation},
          {"deviation_error", s.deviation_error},
          {"min", s.least},
          {"q025", s.lowest},
          {"q05", s.low},
          {"median", s.median},
          {"q95", s.high},
          {"q975", s.highest},
          {"max", s.most}};
}

Json shares_json(const std::vector<Tolerance>& tolerances, const std::vector<double>& shares) {
  if (shares.empty()) return nullptr;
  Json out = Json::object();
  for (std::size_t k = 0; k < tolerances.size(); ++k)
    out[tolerances[k].address] = number_json(shares[k]);
  return out;
}

} // namespace

Json to_json(const SpreadReport& report) {
  const SpreadAnswer& a = report.answer;
  const std::vector<Tolerance>& tolerances = report.tolerances;
  Json out = {
      {"status", word(a.status)}, {"message", a.message}, {"samples", a.samples}, {"seed", report.seed}};
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
  out["run_time_s"] = a.run_time_s > 0 ? Json(a.run_time_s) : Json(nullptr);
  out["warnings"] = report.warnings;
  return out;
}

std::string to_text(const SpreadReport& report) {
  const SpreadAnswer& a = report.answer;
  const std::vector<Tolerance>& tolerances = report.tolerances;
  std::string out = fmt::format("{}: {}\n\n", printable(report.name), printable(a.message));
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
  if (a.run_time_s > 0) out += fmt::format("\n{:.0f} ms\n", a.run_time_s * 1e3);
  return out;
}

StudyPart sample_part(const Mechanism& mechanism, const SpreadReport& report, std::size_t samples) {
  Json tolerances = Json::array(), outputs = Json::array();
  std::vector<Column> columns;
  for (const Tolerance& t : report.tolerances) {
    tolerances.push_back({t.address, word(t.distribution), t.width});
    columns.push_back({t.address});
  }
  columns.push_back({"fate", CellKind::word});
  for (const SpreadOutput& o : report.answer.outputs) {
    outputs.push_back({o.name, o.unit, o.nominal, o.linear_deviation, o.linear_shares});
    columns.push_back({column_name(o.name)});
  }
  StudyPart part =
      part_of("spread", mechanism, {{"tolerances", tolerances}, {"seed", report.seed}, {"samples", samples}},
              columns, samples);
  part.told = {{"name", report.name},
               {"warnings", report.warnings},
               {"nominal", report.answer.nominal},
               {"outputs", outputs}};
  return part;
}

std::string sample_row(const SpreadReport& report, std::size_t i, SampleFate fate,
                       std::span<const double> values) {
  return spread_row(report.answer, report.tolerances, report.seed, i, fate, values);
}

SpreadReport read_spread(const std::filesystem::path& file, const StudyPart& part) {
  try {
    SpreadReport report;
    part.told.at("name").get_to(report.name);
    report.warnings = part.told.at("warnings");
    part.request.at("seed").get_to(report.seed);
    for (const Json& t : part.request.at("tolerances")) {
      Tolerance tolerance{t.at(0), Distribution::normal, t.at(2)};
      for (const Distribution each : {Distribution::uniform, Distribution::triangular})
        if (t.at(1) == word(each)) tolerance.distribution = each;
      report.tolerances.push_back(std::move(tolerance));
    }
    part.told.at("nominal").get_to(report.answer.nominal);
    report.answer.status = Status::converged;
    for (const Json& o : part.told.at("outputs")) {
      SpreadOutput output;
      output.name = o.at(0);
      output.unit = o.at(1);
      output.nominal = o.at(2).is_null() ? std::nan("") : o.at(2).get<double>();
      output.linear_deviation = o.at(3);
      o.at(4).get_to(output.linear_shares);
      report.answer.outputs.push_back(std::move(output));
    }
    if (report.answer.nominal.size() != report.tolerances.size()) throw std::runtime_error("");
    return report;
  } catch (const std::exception&) {
    throw SceneError(file.string(), "expected a part of a spread; it is damaged");
  }
}

std::optional<SampleFate> read_sample(std::span<const std::string_view> cells, const SpreadReport& report,
                                      std::vector<double>& values) {
  const std::size_t before = report.tolerances.size();
  if (cells.size() != before + 1 + report.answer.outputs.size()) return {};
  int fate = 0;
  while (fate < fates && word(static_cast<SampleFate>(fate)) != cells[before])
    ++fate;
  if (fate == fates) return {};
  values.clear();
  for (const std::string_view text : cells.subspan(before + 1)) {
    double value = std::nan("");
    const char* end = text.data() + text.size();
    if (!text.empty() && read_decimal(text.data(), end, value).ptr != end) return {};
    values.push_back(value);
  }
  return static_cast<SampleFate>(fate);
}

} // namespace flyball::cli
