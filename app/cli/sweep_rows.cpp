#include "app/cli/sweep_rows.hpp"

#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>

namespace flyball::cli {
namespace {

// As csv_number(), without a text of its own.
void append_number(std::string& out, double value) {
  if (value == 0 || !std::isfinite(value)) {
    out += csv_number(value);
    return;
  }
  std::array<char, 32> buffer{};
  out.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
}

double value_of(const SweepPoint& p, const ValueColumn& value) {
  return value_at(p.solution.coordinates, p.solution.measures, value);
}

nlohmann::ordered_json json_of(const SweepColumns& columns, const SweepPoint& p) {
  nlohmann::ordered_json row;
  for (std::size_t v = 0; v < columns.variations.size(); ++v)
    row["parameters"][columns.variations[v].address] = p.parameters[v];
  row["status"] = word(p.solution.status);
  row["message"] = p.solution.message;
  if (columns.all) {
    row["equilibria"] = p.equilibria;
    row["equilibrium"] =
        p.equilibria > 0 ? nlohmann::ordered_json(p.equilibrium) : nlohmann::ordered_json(nullptr);
  }
  row["coordinates"] = nlohmann::ordered_json::object();
  for (const CoordinateSolution& c : p.solution.coordinates) {
    if (c.speed)
      row["coordinates"][coordinate_label(c) + ".speed"] = *c.speed;
    else if (!c.driven)
      row["coordinates"][coordinate_label(c)] = c.value;
  }
  if (!p.solution.measures.empty()) row["measures"] = measures_json(p.solution.measures);
  row["stable"] =
      p.solution.stable ? nlohmann::ordered_json(*p.solution.stable) : nlohmann::ordered_json(nullptr);
  row["stability_reason"] = p.solution.stability_reason
                                ? nlohmann::ordered_json(word(*p.solution.stability_reason))
                                : nlohmann::ordered_json(nullptr);
  if (p.solution.floquet) row["floquet"] = floquet_json(*p.solution.floquet);
  row["residual"] = number_json(p.solution.residual);
  if (columns.times) row["run_time_s"] = p.solution.run_time_s;
  return row;
}

} // namespace

std::vector<Column> SweepColumns::columns() const {
  std::vector<Column> out;
  for (const Variation& variation : variations)
    out.push_back({variation.address});
  out.push_back({"status", CellKind::word});
  if (all) out.insert(out.end(), {{"equilibria"}, {"equilibrium"}});
  for (const ValueColumn& value : values)
    out.push_back({value.name});
  out.insert(out.end(), {{"stable", CellKind::verdict}, {"residual"}});
  if (times) out.push_back({"run_time_s"});
  return out;
}

std::string csv_rows(const SweepColumns& columns, std::span<const SweepPoint> points) {
  std::string out;
  for (const SweepPoint& p : points) {
    for (const double value : p.parameters) {
      append_number(out, value);
      out += ',';
    }
    out += word(p.solution.status);
    if (columns.all) {
      out += ',' + std::to_string(p.equilibria) + ',';
      if (p.equilibria > 0) out += std::to_string(p.equilibrium);
    }
    for (const ValueColumn& value : columns.values) {
      out += ',';
      append_number(out, value_of(p, value));
    }
    out += p.solution.stable ? (*p.solution.stable ? ",true," : ",false,") : ",,";
    append_number(out, p.solution.residual);
    if (columns.times) {
      out += ',';
      append_number(out, p.solution.run_time_s);
    }
    out += '\n';
  }
  return out;
}

std::string npz_rows(const SweepColumns& columns, std::span<const SweepPoint> points) {
  std::string out;
  const auto numbers = [&](const auto& of) {
    for (const SweepPoint& p : points)
      append_item(out, of(p));
  };
  for (std::size_t v = 0; v < columns.variations.size(); ++v)
    numbers([v](const SweepPoint& p) { return p.parameters[v]; });
  for (const SweepPoint& p : points)
    append_word(out, word(p.solution.status));
  for (const ValueColumn& value : columns.values)
    numbers([&](const SweepPoint& p) { return value_of(p, value); });
  for (const SweepPoint& p : points)
    out += static_cast<char>(npz_verdict(p.solution.stable));
  numbers([](const SweepPoint& p) { return p.solution.residual; });
  if (columns.times) numbers([](const SweepPoint& p) { return p.solution.run_time_s; });
  return out;
}

std::string json_rows(const SweepColumns& columns, std::span<const SweepPoint> points) {
  std::string out;
  for (const SweepPoint& p : points)
    out += json_row(json_of(columns, p).dump(2));
  return out;
}

std::vector<std::string> table_head(const SweepColumns& columns, const Mechanism& mechanism) {
  std::vector<std::string> head;
  for (const Variation& v : columns.variations)
    head.push_back(named_with_unit(v.address, parameter_unit(mechanism, v.address)));
  head.emplace_back("status");
  if (columns.all) head.insert(head.end(), {"equilibria", "equilibrium"});
  for (const ValueColumn& value : columns.values)
    head.push_back(named_with_unit(value.name, value.unit));
  head.insert(head.end(), {"stable", "residual"});
  if (columns.times) head.emplace_back("time [µs]");
  return head;
}

std::string table_rows(const SweepColumns& columns, std::span<const SweepPoint> points) {
  std::string out;
  for (const SweepPoint& p : points) {
    for (const double value : p.parameters)
      out += fmt::format("{:.8g}\t", value);
    out += word(p.solution.status);
    if (columns.all)
      out += fmt::format("\t{}\t{}", p.equilibria, p.equilibria > 0 ? std::to_string(p.equilibrium) : "-");
    for (const ValueColumn& value : columns.values) {
      const double number = value_of(p, value);
      if (std::isfinite(number))
        out += value.measure ? fmt::format("\t{:.10g}", number) : fmt::format("\t{:.10f}", number);
      else
        out += value.measure ? "\t-" : "\t";
    }
    out += p.solution.stable ? (*p.solution.stable ? "\tyes" : "\tno") : "\t-";
    out += std::isfinite(p.solution.residual) ? fmt::format("\t{:.1e}", p.solution.residual) : "\t-";
    if (columns.times) out += fmt::format("\t{:.1f}", p.solution.run_time_s * 1e6);
    out += '\n';
  }
  return out;
}

} // namespace flyball::cli
