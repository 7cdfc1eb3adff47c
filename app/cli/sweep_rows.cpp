#include "app/cli/sweep_rows.hpp"

#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/periodic_told.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/column_name.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
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

const PeriodicState* motion_of(const SweepPoint& p) {
  return p.periodic && p.periodic->status == PeriodicStatus::found ? &*p.periodic : nullptr;
}

// Of a value of a periodic motion; null where there is none.
const PeriodicRange* range_of(const SweepPoint& p, const ValueColumn& value) {
  const PeriodicState* motion = motion_of(p);
  if (!motion) return nullptr;
  if (value.measure) {
    const auto m = std::ranges::find(motion->measures, value.name, &PeriodicMeasure::name);
    return m == motion->measures.end() ? nullptr : &m->range;
  }
  for (const PeriodicCoordinate& c : motion->coordinates) {
    const std::string label = coordinate_label(c);
    if (value.name == label) return &c.range;
    if (value.name == label + ".speed") return &c.rate;
  }
  return nullptr;
}

// Of a periodic motion its mean.
double value_of(const SweepPoint& p, const ValueColumn& value) {
  if (const PeriodicRange* range = range_of(p, value)) return range->mean;
  if (motion_of(p)) return std::nan("");
  return value_at(p.solution.coordinates, p.solution.measures, value);
}

std::array<double, 2> extremes_of(const SweepPoint& p, const ValueColumn& value) {
  if (const PeriodicRange* range = range_of(p, value)) return {range->least, range->most};
  const double steady = value_of(p, value);
  return {steady, steady};
}

// Calls add(number), with `periodic` also for the least and most.
template <class Add>
void add_value(const SweepColumns& columns, const SweepPoint& p, const ValueColumn& value, const Add& add) {
  add(value_of(p, value));
  if (columns.periodic)
    for (const double extreme : extremes_of(p, value))
      add(extreme);
}

std::string_view status_of(const SweepPoint& p) {
  return motion_of(p) ? "periodic" : word(p.solution.status);
}

std::optional<bool> is_stable(const SweepPoint& p) {
  return motion_of(p) ? motion_of(p)->stable : p.solution.stable;
}

std::string_view friction_of(const SweepPoint& p) {
  return motion_of(p) ? "" : friction_word(p.solution.frictions);
}

double residual_of(const SweepPoint& p) {
  return motion_of(p) ? motion_of(p)->residual : p.solution.residual;
}

double period_of(const SweepPoint& p) {
  return motion_of(p) ? motion_of(p)->period : std::nan("");
}

double run_time_of(const SweepPoint& p) {
  return p.solution.run_time_s + (p.periodic ? p.periodic->run_time_s : 0);
}

nlohmann::ordered_json json_of(const SweepColumns& columns, const SweepPoint& p) {
  nlohmann::ordered_json row;
  for (std::size_t v = 0; v < columns.variations.size(); ++v)
    row["parameters"][columns.variations[v].address] = p.parameters[v];
  row["status"] = status_of(p);
  row["message"] = p.periodic ? p.periodic->message : p.solution.message;
  if (columns.periodic)
    row["periodic"] = motion_of(p) ? to_json(*motion_of(p)) : nlohmann::ordered_json(nullptr);
  if (columns.all) {
    row["equilibria"] = p.equilibria;
    row["equilibrium"] =
        p.equilibria > 0 ? nlohmann::ordered_json(p.equilibrium) : nlohmann::ordered_json(nullptr);
  }
  row["coordinates"] = nlohmann::ordered_json::object();
  const bool steady = !motion_of(p); // else they are told with their ranges
  for (const CoordinateSolution& c : p.solution.coordinates) {
    if (!steady) break;
    if (c.speed)
      row["coordinates"][coordinate_label(c) + ".speed"] = *c.speed;
    else if (!c.driven)
      row["coordinates"][coordinate_label(c)] = c.value;
  }
  if (steady && !p.solution.frictions.empty())
    row["rests_on_friction"] = frictions_json(p.solution.frictions);
  if (steady && !p.solution.measures.empty()) row["measures"] = measures_json(p.solution.measures);
  const std::optional<bool> stable = is_stable(p);
  row["stable"] = stable ? nlohmann::ordered_json(*stable) : nlohmann::ordered_json(nullptr);
  const auto reason = steady ? p.solution.stability_reason : motion_of(p)->stability_reason;
  row["stability_reason"] = reason ? nlohmann::ordered_json(word(*reason)) : nlohmann::ordered_json(nullptr);
  if (steady && p.solution.floquet) row["floquet"] = floquet_json(*p.solution.floquet);
  row["residual"] = number_json(residual_of(p));
  if (columns.times) row["run_time_s"] = run_time_of(p);
  return row;
}

} // namespace

std::vector<Column> SweepColumns::columns() const {
  std::vector<Column> out;
  for (const Variation& variation : variations)
    out.push_back({variation.address});
  out.push_back({"status", CellKind::word});
  if (all) out.insert(out.end(), {{"equilibria"}, {"equilibrium"}});
  if (friction) out.push_back({"rests_on_friction", CellKind::word});
  if (periodic) out.push_back({"period_s"});
  for (const ValueColumn& value : values) {
    const std::string name = column_name(value.name);
    out.push_back({name});
    if (periodic) out.insert(out.end(), {{name + ".min"}, {name + ".max"}});
  }
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
    out += status_of(p);
    if (columns.all) {
      out += ',' + std::to_string(p.equilibria) + ',';
      if (p.equilibria > 0) out += std::to_string(p.equilibrium);
    }
    if (columns.friction) (out += ',') += friction_of(p);
    const auto add = [&](double number) {
      out += ',';
      append_number(out, number);
    };
    if (columns.periodic) add(period_of(p));
    for (const ValueColumn& value : columns.values)
      add_value(columns, p, value, add);
    const std::optional<bool> stable = is_stable(p);
    out += stable ? (*stable ? ",true" : ",false") : ",";
    add(residual_of(p));
    if (columns.times) add(run_time_of(p));
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
    append_word(out, status_of(p));
  for (std::size_t i = 0; columns.friction && i < points.size(); ++i)
    append_word(out, friction_of(points[i]));
  if (columns.periodic) numbers(period_of);
  for (const ValueColumn& value : columns.values) {
    numbers([&](const SweepPoint& p) { return value_of(p, value); });
    for (std::size_t i = 0; columns.periodic && i < 2; ++i)
      numbers([&](const SweepPoint& p) { return extremes_of(p, value)[i]; });
  }
  for (const SweepPoint& p : points)
    out += static_cast<char>(npz_verdict(is_stable(p)));
  numbers(residual_of);
  if (columns.times) numbers(run_time_of);
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
  if (columns.friction) head.emplace_back("friction");
  if (columns.periodic) head.emplace_back("period [s]");
  for (const ValueColumn& value : columns.values) {
    head.push_back(named_with_unit(value.name, value.unit));
    if (columns.periodic) head.insert(head.end(), {"min", "max"});
  }
  head.insert(head.end(), {"stable", "residual"});
  if (columns.times) head.emplace_back("time [µs]");
  return head;
}

std::string table_rows(const SweepColumns& columns, std::span<const SweepPoint> points) {
  std::string out;
  for (const SweepPoint& p : points) {
    for (const double value : p.parameters)
      out += fmt::format("{:.8g}\t", value);
    out += status_of(p);
    if (columns.all)
      out += fmt::format("\t{}\t{}", p.equilibria, p.equilibria > 0 ? std::to_string(p.equilibrium) : "-");
    if (columns.friction) (out += '\t') += friction_of(p).empty() ? "-" : friction_of(p);
    if (columns.periodic) out += motion_of(p) ? fmt::format("\t{:.8g}", period_of(p)) : "\t-";
    for (const ValueColumn& value : columns.values)
      add_value(columns, p, value, [&](double number) {
        if (std::isfinite(number))
          out += value.measure ? fmt::format("\t{:.10g}", number)
                               : fmt::format("\t{:.10f}", std::abs(number) < 5e-11 ? 0 : number); // no sign
        else
          out += value.measure ? "\t-" : "\t";
      });
    const std::optional<bool> stable = is_stable(p);
    out += stable ? (*stable ? "\tyes" : "\tno") : "\t-";
    out += std::isfinite(residual_of(p)) ? fmt::format("\t{:.1e}", residual_of(p)) : "\t-";
    if (columns.times) out += fmt::format("\t{:.1f}", run_time_of(p) * 1e6);
    out += '\n';
  }
  return out;
}

} // namespace flyball::cli
