// What a row of a sweep tells, in each form: the varied numbers, the status, coordinates, measures,
// stability, residual and run time; of all equilibria also how many there are and which one it is. Where
// there is dry friction whether the state rests on it: "held" or "slips". Of periodic motions in the place of
// steady states also the period and, of each value, the mean, least and most.
#pragma once

#include "app/cli/row_output.hpp"
#include "app/cli/value_columns.hpp"
#include "engine/study/sweep.hpp"

#include <span>
#include <string>
#include <vector>

namespace flyball::cli {

struct SweepColumns {
  std::vector<Variation> variations;
  std::vector<ValueColumn> values;
  bool all = false;  // of all equilibria
  bool times = true; // run times, which are others in every run
  bool periodic = false;
  bool friction = false; // there is some

  std::vector<Column> columns() const;
};

// Points that follow one another, as row_output.hpp wants them.
std::string csv_rows(const SweepColumns& columns, std::span<const SweepPoint> points);
std::string npz_rows(const SweepColumns& columns, std::span<const SweepPoint> points);
std::string json_rows(const SweepColumns& columns, std::span<const SweepPoint> points);
// Rounded.
std::string table_rows(const SweepColumns& columns, std::span<const SweepPoint> points);
std::vector<std::string> table_head(const SweepColumns& columns, const Mechanism& mechanism);

} // namespace flyball::cli
