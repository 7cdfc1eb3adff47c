#include "engine/solve/open_directions.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double aligned = 1e-6; // rad: directions so near to an axis or its plane lie in it

} // namespace

OpenDirections open_directions(std::vector<Vec3> changes, double least) {
  OpenDirections out;
  for (int rank = 0; rank < 3 && !changes.empty(); ++rank) { // by Gram and Schmidt, the largest first
    const Vec3 most = *std::ranges::max_element(changes, {}, [](const Vec3& v) { return v.norm(); });
    if (!(most.norm() > least)) break;
    const Vec3 direction = most.normalized();
    out.projector += direction * direction.transpose();
    for (Vec3& change : changes)
      change -= direction.dot(change) * direction;
  }
  for (int i = 0; i < 3; ++i) {
    const double open = out.projector(i, i);
    const bool none = open < aligned * aligned, all = 1 - open < aligned * aligned;
    if (!none && !all) continue;
    out.projector.row(i).setZero();
    out.projector.col(i).setZero();
    out.projector(i, i) = all ? 1 : 0;
  }
  return out;
}

} // namespace flyball
