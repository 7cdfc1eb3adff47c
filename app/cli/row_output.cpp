#include "app/cli/row_output.hpp"

#include "app/cli/npz.hpp"
#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

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

class CsvOutput final : public RowOutput {
 public:
  CsvOutput(const SweepColumns& columns, std::filesystem::path file, std::string head)
      : columns_(columns), file_(std::move(file)), head_(std::move(head)) {}

  std::string format(std::span<const SweepPoint> points) const override {
    std::string out;
    for (const SweepPoint& p : points) {
      for (const double value : p.parameters) {
        append_number(out, value);
        out += ',';
      }
      out += word(p.solution.status);
      for (const SweepColumns::Value& value : columns_.values) {
        out += ',';
        append_number(out, value_at(p.solution, value));
      }
      out += p.solution.stable ? (*p.solution.stable ? ",true," : ",false,") : ",,";
      append_number(out, p.solution.residual);
      if (columns_.times) {
        out += ',';
        append_number(out, p.solution.run_time_s);
      }
      out += '\n';
    }
    return out;
  }
  void begin() override { writer_.emplace(file_); }
  void take(std::size_t, std::size_t, std::string_view rows) override {
    writer_->write(std::exchange(head_, {})); // no word to a pipe before there is a row
    writer_->write(rows);
  }
  void finish() override {
    writer_->write(head_);
    writer_->finish();
  }

 private:
  const SweepColumns& columns_;
  std::filesystem::path file_;
  std::string head_;
  std::optional<FileWriter> writer_;
};

class NpzOutput final : public RowOutput {
 public:
  NpzOutput(const SweepColumns& columns, std::filesystem::path file, std::uint64_t count)
      : columns_(columns), file_(std::move(file)), count_(count) {}

  // Column by column.
  std::string format(std::span<const SweepPoint> points) const override {
    std::string out;
    const auto numbers = [&](const auto& of) {
      for (const SweepPoint& p : points)
        append_item(out, of(p));
    };
    for (std::size_t v = 0; v < columns_.variations.size(); ++v)
      numbers([v](const SweepPoint& p) { return p.parameters[v]; });
    for (const SweepPoint& p : points)
      append_word(out, word(p.solution.status));
    for (const SweepColumns::Value& value : columns_.values)
      numbers([&](const SweepPoint& p) { return value_at(p.solution, value); });
    for (const SweepPoint& p : points)
      out += static_cast<char>(npz_stable(p.solution.stable));
    numbers([](const SweepPoint& p) { return p.solution.residual; });
    if (columns_.times) numbers([](const SweepPoint& p) { return p.solution.run_time_s; });
    return out;
  }
  void begin() override {
    writer_.emplace(file_, npz_columns(columns_.names(), columns_.variations.size()), count_);
  }
  void take(std::size_t begin, std::size_t end, std::string_view rows) override {
    writer_->write(begin, end, rows);
  }
  void finish() override { writer_->finish(); }

 private:
  const SweepColumns& columns_;
  std::filesystem::path file_;
  std::uint64_t count_;
  std::optional<NpzWriter> writer_;
};

nlohmann::ordered_json row_json(const SweepColumns& columns, const SweepPoint& p) {
  nlohmann::ordered_json row;
  for (std::size_t v = 0; v < columns.variations.size(); ++v)
    row["parameters"][columns.variations[v].address] = p.parameters[v];
  row["status"] = word(p.solution.status);
  row["message"] = p.solution.message;
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
  row["residual"] = std::isfinite(p.solution.residual) ? nlohmann::ordered_json(p.solution.residual)
                                                       : nlohmann::ordered_json(nullptr);
  if (columns.times) row["run_time_s"] = p.solution.run_time_s;
  return row;
}

// An object as print_json() would have it, its rows as they come.
class JsonOutput final : public RowOutput {
 public:
  JsonOutput(const SweepColumns& columns, const Mechanism& mechanism)
      : columns_(columns), end_(with_warnings(nlohmann::ordered_json::object(), mechanism).dump(2)) {}

  std::string format(std::span<const SweepPoint> points) const override {
    std::string out;
    for (const SweepPoint& p : points) {
      out += ",\n    ";
      for (const char c : row_json(columns_, p).dump(2)) {
        out += c;
        if (c == '\n') out += "    ";
      }
    }
    return printable_json(out);
  }
  void take(std::size_t begin, std::size_t, std::string_view rows) override {
    constexpr std::size_t separator = 2; // before the first row there is none
    if (begin == 0) fmt::print("{{\n  \"points\": [\n{}", rows.substr(separator));
    if (begin > 0) fmt::print("{}", rows);
  }
  void finish() override { fmt::print("\n  ],{}\n", printable_json(end_.substr(1))); }

 private:
  const SweepColumns& columns_;
  std::string end_;
};

class TableOutput final : public RowOutput {
 public:
  TableOutput(const SweepColumns& columns, const Mechanism& mechanism) : columns_(columns) {
    const auto with_unit = [](const std::string& name, const std::string& unit) {
      return unit.empty() ? printable(name) : fmt::format("{} [{}]", printable(name), unit);
    };
    for (const Variation& v : columns.variations)
      add(with_unit(v.address, parameter_unit(mechanism, v.address)));
    add("status");
    for (const SweepColumns::Value& value : columns.values)
      add(with_unit(value.name, value.unit));
    add("stable");
    add("residual");
    if (columns.times) add("time [µs]");
    end_row();
  }

  std::string format(std::span<const SweepPoint> points) const override {
    std::string out;
    for (const SweepPoint& p : points) {
      for (const double value : p.parameters)
        out += fmt::format("{:.8g}\t", value);
      out += word(p.solution.status);
      for (const SweepColumns::Value& value : columns_.values) {
        const double number = value_at(p.solution, value);
        if (std::isfinite(number))
          out += value.measure ? fmt::format("\t{:.10g}", number) : fmt::format("\t{:.10f}", number);
        else
          out += value.measure ? "\t-" : "\t";
      }
      out += p.solution.stable ? (*p.solution.stable ? "\tyes" : "\tno") : "\t-";
      out += std::isfinite(p.solution.residual) ? fmt::format("\t{:.1e}", p.solution.residual) : "\t-";
      if (columns_.times) out += fmt::format("\t{:.1f}", p.solution.run_time_s * 1e6);
      out += '\n';
    }
    return out;
  }
  void take(std::size_t, std::size_t, std::string_view rows) override {
    for (std::size_t at = 0; at < rows.size();) {
      const std::size_t end = rows.find_first_of("\t\n", at);
      add(std::string(rows.substr(at, end - at)));
      if (rows[end] == '\n') end_row();
      at = end + 1;
    }
  }
  void finish() override { print_text(aligned(rows_)); }

 private:
  void add(std::string cell) { row_.push_back(std::move(cell)); }
  void end_row() { rows_.push_back(std::exchange(row_, {})); }

  const SweepColumns& columns_;
  std::vector<std::string> row_;
  std::vector<std::vector<std::string>> rows_;
};

} // namespace

std::string csv_head(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names)
    out += (out.empty() ? "" : ",") + csv_field(name);
  return out + "\n";
}

std::unique_ptr<RowOutput> csv_output(const SweepColumns& columns, const std::filesystem::path& file,
                                      std::string head) {
  return std::make_unique<CsvOutput>(columns, file, std::move(head));
}
std::unique_ptr<RowOutput> npz_output(const SweepColumns& columns, const std::filesystem::path& file,
                                      std::uint64_t count) {
  return std::make_unique<NpzOutput>(columns, file, count);
}
std::unique_ptr<RowOutput> json_output(const SweepColumns& columns, const Mechanism& mechanism) {
  return std::make_unique<JsonOutput>(columns, mechanism);
}
std::unique_ptr<RowOutput> table_output(const SweepColumns& columns, const Mechanism& mechanism) {
  return std::make_unique<TableOutput>(columns, mechanism);
}

} // namespace flyball::cli
