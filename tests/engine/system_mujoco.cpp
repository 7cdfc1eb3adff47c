// Inverse dynamics of open trees against MuJoCo.
#include "tests/catch.hpp"
#include "tests/engine/reference/mujoco_reference.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"

#include "engine/system/reactions.hpp"

#include <set>

using namespace flyball;
using namespace flyball::testing;
using reference::RandomDrives;
using reference::RandomOptions;

TEST_CASE("the balance of open trees is MuJoCo's inverse dynamics") {
  if (!reference::mujoco_available()) {
    WARN("skipped: MuJoCo is not installed (libmujoco-dev)");
    return;
  }
  std::set<JointType> seen;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    RandomOptions options;
    options.drives = static_cast<RandomDrives>(seed % 3);
    options.steady = seed % 2 == 0;
    options.forces = options.stops = options.massless = false;
    Mechanism m = reference::random_mechanism(seed, options);
    for (Joint& joint : m.joints)
      for (int i = 0; i < coordinate_count(joint.type); ++i)
        if (is_rotation_vector(joint.type, i)) {
          joint.coordinates[static_cast<std::size_t>(i)].spring.reset();
          joint.coordinates[static_cast<std::size_t>(i)].damping = 0;
        }
    REQUIRE(reference::mujoco_can_hold(m));
    const Model model(m);
    Dice dice(seed);
    const double t = dice.between(-2, 2);
    const Eigen::VectorXd q = model.displaced(dice, 0.8);
    const auto theirs = reference::mujoco_inverse(m, model.state(q, t));
    const reference::Tree tree = reference::span_tree(m, {});
    VectorR by_coordinate = VectorR::Zero(static_cast<Eigen::Index>(tree.coordinates.size()));
    for (const auto& [name, forces] : theirs)
      by_coordinate.segment(tree.first[static_cast<std::size_t>(joint_index(m, name))], forces.size()) =
          forces;
    const Eigen::VectorXd none;
    const Point<double> p = evaluate_at<double>(model, q, none, t);
    const double scale = 1 + largest(by_coordinate);
    const VectorR expected = model.tangents(q, tree).transpose() * by_coordinate;
    CHECK(largest(VectorR(p.residual.f.cast<Real>() - expected)) < 1e-10 * scale);
    const TransmittedForces forces =
        transmitted_forces(model.system, model.parameters, none, p.kinematics, p.residual);
    for (std::size_t d = 0; d < model.system.drives.size(); ++d) {
      const Link& link = model.system.links[static_cast<std::size_t>(model.system.drives[d].link)];
      const std::string& joint = model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name;
      CHECK(std::abs(forces.drives[d] - static_cast<double>(theirs.at(joint)[link.coordinate])) <
            1e-10 * scale);
    }
    for (const Joint& joint : m.joints)
      seen.insert(joint.type);
  }
  CHECK(seen.size() == 8);
}
