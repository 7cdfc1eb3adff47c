#include "engine/report/turned_measures.hpp"

#include "engine/mechanism/error.hpp"

#include <cmath>
#include <limits>

namespace flyball {
namespace {

constexpr double step_beside = 1e-5; // of the number

// Of a mechanism of which the number is `by` further, at the steady state by its rates.
Eigen::VectorXd measures_beside(const Problem& problem, const Eigen::VectorXd& q, const TurnedRate& rate,
                                MeasureSet& measures, const Mechanism& mechanism, double by, Workspace& w) {
  const System& system = problem.system;
  Parameters there;
  bind(system, mechanism, there);
  for (std::size_t l = 0; l < system.links.size(); ++l)
    if (finds_speed(system.links[l]))
      there.links[l].start =
          problem.parameters.links[l].start + by * rate.starts[static_cast<Eigen::Index>(l)];
  Eigen::VectorXd moved = q;
  const Eigen::VectorXd step = by * rate.q;
  retract<double>(system, step, moved);
  measures.bind(mechanism, system, there);
  return measures.evaluate_at({system, there, problem.scaling}, moved, w);
}

} // namespace

Eigen::VectorXd turned_measure_rates(const Problem& problem, const Eigen::VectorXd& q, const TurnedRate& rate,
                                     MeasureSet& measures, const Mechanism& mechanism, VariedNumbers& numbers,
                                     std::size_t which, Workspace& w) {
  measures.bind(mechanism, problem.system, problem.parameters);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(measures.size()));
  const std::vector<double> values = numbers.values();
  const double size = std::abs(values[which]), step = step_beside * (size > 0 ? size : 1);
  try {
    for (const double by : {step, -step}) {
      std::vector<double> moved = values;
      moved[which] += by;
      numbers.set(moved);
      out += measures_beside(problem, q, rate, measures, mechanism, by, w) / (2 * by);
    }
  } catch (const SceneError&) { // expressions make no mechanism of it
    out.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  numbers.set(values);
  measures.bind(mechanism, problem.system, problem.parameters);
  return out;
}

} // namespace flyball
