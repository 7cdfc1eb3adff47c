// The dampers that a peer's scan may choose, as ranges of numbers and as one value a joint.
#pragma once

#include "tests/bench/peers/job.hpp"
#include "tests/bench/peers/tune.hpp"

namespace flyball::peers {

inline std::vector<Range> damper_ranges(const Job& job, Damping damping) {
  if (damping == Damping::critical) return {{1e-3, 1e3}}; // times the scene's
  return std::vector<Range>(static_cast<std::size_t>(job.dampers), Range{1e-3, 1e7});
}

// By joint, N m s/rad or N s/m where the scan is of those.
inline std::vector<double> chosen_dampers(const Job& job, Damping damping, const double* x) {
  std::vector<double> c;
  for (const JobJoint& joint : job.joints) {
    if (joint.driven)
      c.push_back(0);
    else if (damping == Damping::critical)
      c.push_back(x[0] * joint.damping);
    else
      c.push_back(x[joint.damper]);
  }
  return c;
}

} // namespace flyball::peers
