// Joint reactions against each body's balance as the reference has it, and the torques of the drives.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"

#include "engine/mechanism/scene.hpp"
#include "engine/report/analysis.hpp"
#include "engine/system/reactions.hpp"

#include <algorithm>
#include <filesystem>

using namespace flyball;
using namespace flyball::testing;
using reference::Evaluation;
using reference::RandomDrives;
using reference::RandomOptions;
using reference::Vec3R;

namespace {

// Sum of what the joints exert on each body less what its motion and the other forces ask for.
class BodyBalance {
 public:
  BodyBalance(const Mechanism& mechanism, const Evaluation& e) : mechanism_(mechanism), e_(e) {
    for (const reference::ReferenceBody& b : e.bodies) {
      missing_.push_back({b.inertial.force - b.applied.force, b.inertial.torque - b.applied.torque});
      scale_ = std::max({scale_, static_cast<double>(b.inertial.force.norm() + b.applied.force.norm()),
                         static_cast<double>(b.inertial.torque.norm() + b.applied.torque.norm())});
    }
  }
  // By the joint's parent on its child at a point, and back.
  void add(const std::array<std::string, 2>& bodies, const Vec3& point, const Vec3& force,
           const Vec3& torque) {
    for (const int end : {0, 1}) {
      const int b = body_index(mechanism_, bodies[static_cast<std::size_t>(end)]);
      if (b < 0) continue;
      const Real sign = end == 1 ? 1 : -1;
      const auto i = static_cast<std::size_t>(b);
      const Vec3R f = sign * force.cast<Real>(), arm = point.cast<Real>() - e_.bodies[i].position;
      missing_[i].force -= f;
      missing_[i].torque -= sign * torque.cast<Real>() + arm.cross(f);
    }
    scale_ = std::max({scale_, force.norm(), torque.norm()});
  }
  double worst() const {
    Real sum = 0;
    for (const reference::Wrench& w : missing_)
      sum = std::max({sum, w.force.norm(), w.torque.norm()});
    return static_cast<double>(sum);
  }
  double scale() const { return scale_; }

 private:
  const Mechanism& mechanism_;
  const Evaluation& e_;
  std::vector<reference::Wrench> missing_;
  double scale_ = 1;
};

void check_reactions(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda, double t) {
  const Evaluation e = reference::evaluate(model.mechanism, model.cuts, model.state(q, t));
  const Point<double> p = evaluate_at<double>(model, q, lambda, t);
  const TransmittedForces forces =
      transmitted_forces(model.system, model.parameters, lambda, p.kinematics, p.residual);
  BodyBalance balance(model.mechanism, e);
  const auto add = [&](int joint, const JointWrench& w) {
    balance.add(model.mechanism.joints[static_cast<std::size_t>(joint)].bodies,
                model.parameters.origin + w.point, w.force, w.torque);
  };
  for (std::size_t i = 0; i < forces.tree.size(); ++i) {
    const TreeJoint& joint = model.system.tree_joints[i];
    if (!joint.closes_loop) add(joint.joint, forces.tree[i]);
  }
  for (std::size_t i = 0; i < forces.cuts.size(); ++i) {
    const CutJoint& cut = model.system.cuts[i];
    if (cut.type == JointType::gear) continue; // in the joints that it gears
    add(cut.joint, forces.cuts[i]);
    if (cut.tree_joint < 0) continue;
    // The weld passes on what the joint transmits.
    const JointWrench& w = forces.tree[static_cast<std::size_t>(cut.tree_joint)];
    const Vec3 torque = w.torque + (w.point - forces.cuts[i].point).cross(w.force);
    CHECK((w.force - forces.cuts[i].force).norm() < 1e-12 * balance.scale());
    CHECK((torque - forces.cuts[i].torque).norm() < 1e-12 * balance.scale());
  }
  CHECK(balance.worst() < 1e-12 * balance.scale());
}

} // namespace

TEST_CASE("reactions hold each body in its motion") {
  int loops = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    INFO("seed " << seed);
    RandomOptions options;
    options.loops = static_cast<int>(seed % 4);
    options.drives = static_cast<RandomDrives>(seed / 4 % 3);
    options.steady = false;
    options.air = seed % 5 == 1;
    const Model model(reference::random_mechanism(seed, options));
    Dice dice(seed);
    Eigen::VectorXd lambda(model.system.rows);
    for (double& l : lambda)
      l = dice.between(-20, 20);
    const Eigen::VectorXd q = model.displaced(dice, 0.7);
    check_reactions(model, q, lambda, dice.between(-2, 2));
    loops += model.system.rows > 0;
  }
  CHECK(loops > 80);
}

TEST_CASE("reactions of redundant and open loops hold each body, too") {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    INFO("seed " << seed);
    RandomOptions options;
    options.bodies = 4;
    options.loops = 2;
    options.parallel_axes = true;
    options.loop_types = {JointType::revolute, JointType::prismatic, JointType::planar, JointType::fixed,
                          JointType::distance};
    const Model model(reference::random_mechanism(seed, options));
    Dice dice(seed);
    Eigen::VectorXd lambda(model.system.rows);
    for (double& l : lambda)
      l = dice.between(-20, 20);
    check_reactions(model, model.displaced(dice, 0.7), lambda, dice.between(-2, 2));
  }
}

namespace {

// The reference at a solved equilibrium, with the engine's own tree.
void check_solution(const Mechanism& m, const Solution& s) {
  // The reactions that the solution reports, on the bodies where it says they are.
  const Model model(m);
  ReferenceState state;
  std::map<std::string, std::vector<Real>> values;
  for (const CoordinateSolution& c : s.coordinates)
    values[c.joint].push_back(c.value);
  state.coordinates = values;
  const Evaluation e = reference::evaluate(model.mechanism, model.cuts, state);
  CHECK(largest(e.unbalanced()) < 1e-8 * (1 + largest(e.balance)));
  BodyBalance balance(model.mechanism, e);
  for (std::size_t b = 0; b < s.poses.size(); ++b)
    CHECK(static_cast<double>((s.poses[b].position.cast<Real>() - e.bodies[b].position).norm()) < 1e-9);
  for (const Reaction& r : s.reactions) {
    const int j = joint_index(m, r.joint);
    REQUIRE(j >= 0);
    const Joint& joint = m.joints[static_cast<std::size_t>(j)];
    const Vec3 at = joint.type == JointType::distance ? joint.points[1] : joint.at;
    const Vec3 point = carried_point(m, s.poses, body_index(m, joint.bodies[1]), at);
    balance.add(joint.bodies, point, r.force, r.torque);
  }
  CHECK(balance.worst() < 1e-8 * balance.scale());
  // Torques of the drives, where the loops leave no choice of multipliers.
  const auto forces = e.by_joint(model.mechanism, e.multipliers());
  if (s.reactions_nonunique) return;
  for (const DriveTorque& d : s.drive_torques) {
    CAPTURE(d.joint);
    const Real theirs = forces.at(d.joint)[d.index];
    CHECK(std::abs(d.value - static_cast<double>(theirs)) < 1e-8 * (balance.scale() + std::abs(d.value)));
  }
}

} // namespace

TEST_CASE("a solved mechanism reports the reactions and drive torques of the reference") {
  int solved = 0;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    INFO("seed " << seed);
    RandomOptions options;
    options.bodies = 2 + static_cast<int>(seed % 4);
    options.loops = static_cast<int>(seed % 3);
    options.parallel_axes = seed % 2 == 0;
    options.spring_share = 1;
    options.air = seed % 5 == 1;
    const Mechanism m = reference::random_mechanism(seed, options);
    const Solution s = Analysis(m).solve();
    if (s.status != Status::converged) continue;
    ++solved;
    check_solution(m, s);
  }
  CHECK(solved > 50);
}
