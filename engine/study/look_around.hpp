// Whether there is less beside the place at which a search for a minimum ended: it ends wherever no slope
// leads down, on maxima and saddles, too.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>

namespace flyball {

// Of a place x in the unit cube, all scaled.
struct PlaceBeside {
  double objective = 0;
  Eigen::VectorXd residuals; // of what is kept at zero
  Eigen::MatrixXd slopes;    // (residuals + 1, n), the objective's last; empty where they are not known
};
using EvaluateBeside = std::function<std::optional<PlaceBeside>(const Eigen::VectorXd& x)>;

struct Surroundings {
  std::optional<Eigen::VectorXd> lower; // a place beside where there is less
  bool flat = false;                    // the objective changes nowhere beside
  bool slopes = false;                  // down, along what keeps the residuals: no search ends there
};

// Around x, where the slopes are known. Along each number, or where there are residuals along what keeps them
// and leaves numbers at the ends of their ranges there, then along the least curvature, then between each two
// of these ways but where curvature shows that it rises there. Close by, and where that changes nothing
// farther off. `evaluate` gives nothing where there is no value.
Surroundings look_around(const Eigen::VectorXd& x, const PlaceBeside& here, const EvaluateBeside& evaluate);

} // namespace flyball
