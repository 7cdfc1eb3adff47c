#include "engine/equilibrium/drive_cuts.hpp"

#include "engine/equilibrium/problem.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <deque>

namespace flyball {
namespace {

// Whether the drives carry the loops along at the drawn pose: each cut joint that they open counts.
int loops_opened(const System& system, const Mechanism& mechanism) {
  if (system.rows == 0 || system.drives.empty()) return 0;
  Parameters p;
  bind(system, mechanism, p);
  if (!p.moving) return 0;
  Scaling scaling;
  set_scaling(system, p, scaling);
  Configuration<double> q;
  drawn_configuration(system, p, q);
  Kinematics<double> k;
  Residual<double> r;
  const Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.rows);
  const Eigen::VectorXd fastest = [&] {
    double rate = 0;
    for (const DrivenCoordinate& d : system.drives) {
      const auto l = static_cast<std::size_t>(d.link);
      rate = std::max(rate, std::abs(p.links[l].speed) /
                                (system.links[l].type == LinkType::revolute ? 1 : p.length));
    }
    return Eigen::VectorXd::Constant(1, rate);
  }();
  Eigen::VectorXd before, after;
  const double turn = 0.05 / fastest[0];
  forward<double>(system, p, q, 0, k);
  evaluate_residual<double>(system, p, q, lambda, k, r);
  before = r.phi;
  forward<double>(system, p, q, turn, k);
  evaluate_residual<double>(system, p, q, lambda, k, r);
  after = r.phi;
  int opened = 0;
  for (const CutJoint& cut : system.cuts) {
    double change = 0;
    for (int i = cut.first_row; i < cut.first_row + static_cast<int>(cut.rows.size()); ++i)
      change = std::max(change, std::abs(after[i] - before[i]) * scaling.row[i]);
    opened += change > 1e-6;
  }
  return opened;
}

} // namespace

System compile_for_drives(const Mechanism& mechanism, std::vector<std::string>& notes) {
  System best = compile(mechanism);
  int opened = loops_opened(best, mechanism);
  if (opened == 0) return best;
  std::deque<CutChoice> queue;
  std::vector<std::vector<int>> seen;
  const auto enqueue = [&](const System& from) {
    for (CutChoice& c : neighbouring_cuts(mechanism, from)) {
      std::ranges::sort(c.cut);
      if (std::ranges::find(seen, c.cut) != seen.end()) continue;
      seen.push_back(c.cut);
      queue.push_back(std::move(c));
    }
  };
  enqueue(best);
  for (int tried = 0; tried < 500 && !queue.empty() && opened > 0; ++tried) {
    const CutChoice choice = std::move(queue.front());
    queue.pop_front();
    System other;
    try {
      other = compile(mechanism, choice);
    } catch (const SceneError&) {
      continue; // not admissible: a drive would be cut
    }
    const int count = loops_opened(other, mechanism);
    if (count < opened) {
      opened = count;
      best = other;
    }
    enqueue(other);
  }
  if (opened == 0)
    for (const CutJoint& cut : best.cuts) {
      const Joint& j = mechanism.joints[static_cast<std::size_t>(cut.joint)];
      if (j.cut != true && coordinate_count(j.type) > 0)
        notes.push_back("The loop is cut at " + j.name +
                        ", which turns or slides at a constant rate in the steady state.");
    }
  return best;
}

} // namespace flyball
