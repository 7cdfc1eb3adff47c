// Linear models that are there, and what their transfer functions must be.
#pragma once

#include "engine/study/linear_model.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <complex>
#include <string>
#include <vector>

namespace flyball::test {

using Names = std::vector<std::string>;

inline LinearModel linear_model(const Mechanism& m, const Names& inputs, const Names& outputs,
                                const LinearModelOptions& options = {}) {
  LinearModel model = linearize(m, inputs, outputs, options);
  INFO(model.refusal);
  REQUIRE(model.refusal.empty());
  return model;
}

// At s, of the descriptor form and of the best one.
inline void check_transfer(const LinearModel& model, Eigen::Index output, Eigen::Index input,
                           std::complex<double> s, std::complex<double> wanted, double tolerance = 1e-10) {
  for (const StateSpace& x : {model.descriptor, best_form(model)}) {
    const auto h = transfer(x, s);
    REQUIRE(h);
    CAPTURE(s, wanted, (*h)(output, input));
    CHECK(std::abs((*h)(output, input) - wanted) <= tolerance * std::abs(wanted));
  }
}

} // namespace flyball::test
