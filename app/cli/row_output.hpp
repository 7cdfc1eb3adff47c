// The forms in which rows of a sweep are put out, as they come: each process or thread that solves points
// puts their rows into form, and one takes them in order.
#pragma once

#include "app/cli/sweep_columns.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace flyball::cli {

class RowOutput {
 public:
  virtual ~RowOutput() = default;
  // The rows of points that follow one another; on any thread.
  virtual std::string format(std::span<const SweepPoint> points) const = 0;
  // Where they are put out: before the first, then in order, then after the last, when a file comes to its
  // place. Throw SceneError where nothing can be written.
  virtual void begin() {}
  virtual void take(std::size_t begin, std::size_t end, std::string_view rows) = 0;
  virtual void finish() = 0;
};

// A table of text. `head` comes before the first row.
std::unique_ptr<RowOutput> csv_output(const SweepColumns& columns, const std::filesystem::path& file,
                                      std::string head);
// Its first line.
std::string csv_head(const std::vector<std::string>& names);
// An array of numbers for each column, see npz.hpp. `count`: of rows.
std::unique_ptr<RowOutput> npz_output(const SweepColumns& columns, const std::filesystem::path& file,
                                      std::uint64_t count);
// To standard output, a JSON object {"points": [...], "warnings": [...]}.
std::unique_ptr<RowOutput> json_output(const SweepColumns& columns, const Mechanism& mechanism);
// To standard output, aligned and rounded for a person; all of it at the end.
std::unique_ptr<RowOutput> table_output(const SweepColumns& columns, const Mechanism& mechanism);

} // namespace flyball::cli
