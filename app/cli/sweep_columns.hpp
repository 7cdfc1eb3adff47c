// What a row of a sweep tells: the varied numbers, the status, coordinates, measures, stability, residual and
// run time.
#pragma once

#include "engine/study/sweep.hpp"

#include <string>
#include <vector>

namespace flyball::cli {

struct SweepColumns {
  struct Value {
    std::string name, unit; // "slide", or "free.2"
    bool measure = false;   // one of Solution::measures rather than ::coordinates
    std::size_t place = 0;  // there
  };
  std::vector<Variation> variations;
  // Free coordinates and speeds that torques give, then measures: the same at every point, whether it has an
  // answer or not.
  std::vector<Value> values;
  bool times = true;

  // Without `times` rows do not tell run times, which are others in every run.
  SweepColumns(const Mechanism& mechanism, std::vector<Variation> variations, bool times);
  std::vector<std::string> names() const;
};

// Of a solution; not finite where there is none, or a coordinate turns with the drives.
double value_at(const Solution& solution, const SweepColumns::Value& value);

} // namespace flyball::cli
