#include "engine/study/linear_matrices.hpp"

#include "engine/study/input_effect.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double rounding_of_signals = 1e-11; // of what a signal feels, beside the most that it feels
constexpr double same_phase = 1e-7;           // the same, of two phases

} // namespace

void expect_same(const LinearMatrices& a, const LinearMatrices& b, const LinearSignals& signals,
                 bool values_turn, double rounding_of_angles) {
  const double alike = same_phase + rounding_of_angles;
  for (Eigen::Index j = 0; j < a.b0.cols() && a.b0.rows() > 0; ++j) {
    const auto differs = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, double size) {
      const double value = std::abs(signals.inputs[static_cast<std::size_t>(j)].value);
      const double floor = value > 0 ? rounding_of_signals * size / value : 0;
      return (x.col(j) - y.col(j)).lpNorm<Eigen::Infinity>() >
             std::max(alike * x.col(j).lpNorm<Eigen::Infinity>(), floor);
    };
    if (differs(a.force, b.force, a.stiffness_size) || differs(a.momentum, b.momentum, a.momentum_size))
      throw Refusal{"The input " + signals.inputs[static_cast<std::size_t>(j)].name +
                    " acts otherwise at every phase of the drives: no constant matrices tell of it."};
  }
  for (Eigen::Index i = 0; i < a.values.size(); ++i) {
    const double size = alike * a.most[i];
    bool same =
        values_turn || std::abs(a.values[i] - b.values[i]) <= std::max(size, alike * std::abs(a.values[i]));
    for (Eigen::Index s = 0; s < a.normalised.cols(); ++s) {
      const double measured = a.sizes[s] > 0 ? b.sizes[s] / a.sizes[s] : 1;
      same = same && std::abs(a.normalised(i, s) - measured * b.normalised(i, s)) <= size;
    }
    if (!same)
      throw Refusal{"The output " + signals.outputs[static_cast<std::size_t>(i)].name +
                    " is another at every phase of the drives: no constant matrices tell of it."};
  }
}

} // namespace flyball
