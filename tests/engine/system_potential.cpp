// The amended potential against the balance that it is the potential of, and against the reference's.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"
#include "tests/support/parts.hpp"

#include "engine/system/potential.hpp"

using namespace flyball;
using namespace flyball::testing;
using reference::RandomDrives;
using reference::RandomOptions;

namespace {

Potential potential_at(const Model& model, const Eigen::VectorXd& q) {
  Kinematics<double> k;
  forward<double>(model.system, model.parameters, q, 0, k);
  return amended_potential(model.system, model.parameters, q, k);
}

RandomOptions conservative(std::uint32_t seed) {
  RandomOptions options;
  options.bodies = 1 + static_cast<int>(seed % 6);
  options.loops = static_cast<int>(seed % 3);
  options.drives = seed % 4 == 0 ? RandomDrives::none : RandomDrives::root;
  options.steady = seed % 2 == 0;
  options.conservative = true;
  return options;
}

// The kinetic energy is a potential only while no free coordinate carries a drive (see potential.hpp).
bool drives_stand_on_ground(const System& system) {
  for (const DrivenCoordinate& d : system.drives)
    for (int l = system.links[static_cast<std::size_t>(d.link)].parent; l >= 0;
         l = system.links[static_cast<std::size_t>(l)].parent)
      if (system.links[static_cast<std::size_t>(l)].v >= 0) return false;
  return true;
}

} // namespace

TEST_CASE("the balance is the gradient of the amended potential") {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    INFO("seed " << seed);
    const Model model(reference::random_mechanism(seed, conservative(seed)));
    if (!drives_stand_on_ground(model.system)) continue;
    REQUIRE(model.system.conservative);
    REQUIRE(model.system.single_drives);
    Dice dice(seed);
    const Eigen::VectorXd q = model.displaced(dice, 0.6);
    const Eigen::VectorXd f =
        evaluate_at<double>(model, q, Eigen::VectorXd::Zero(model.system.rows), 0).residual.f;
    const double scale = 1 + potential_at(model, q).magnitude;
    for (int j = 0; j < model.system.nv; ++j) {
      const auto central = [&](double h) {
        Eigen::VectorXd up = q, down = q;
        retract<double>(model.system, h * Eigen::VectorXd::Unit(model.system.nv, j), up);
        retract<double>(model.system, -h * Eigen::VectorXd::Unit(model.system.nv, j), down);
        return (potential_at(model, up).value - potential_at(model, down).value) / (2 * h);
      };
      const double gradient = (4 * central(1e-3) - central(2e-3)) / 3;
      CAPTURE(j);
      CHECK(std::abs(gradient - f[j]) < 1e-9 * (scale + std::abs(f[j])));
    }
    ++compared;
  }
  CHECK(compared > 120);
}

TEST_CASE("differences of the amended potential are the reference's") {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    const Model model(reference::random_mechanism(seed, conservative(seed)));
    if (model.has_twins()) continue; // have their own coordinates while their loops are open
    Dice dice(seed);
    const Eigen::VectorXd a = model.displaced(dice, 0.6), b = model.displaced(dice, 0.6);
    const Potential ua = potential_at(model, a), ub = potential_at(model, b);
    const Real theirs = reference::potential(model.mechanism, model.cuts, model.state(a, 0)) -
                        reference::potential(model.mechanism, model.cuts, model.state(b, 0));
    CHECK(std::abs(ua.value - ub.value - static_cast<double>(theirs)) <
          1e-14 * (1 + ua.magnitude + ub.magnitude));
    ++compared;
  }
  CHECK(compared > 70);
}

TEST_CASE("a torque about a fixed axis has a potential") {
  struct Case {
    const char* what;
    Mechanism mechanism;
    ForceType type;
    ForceFrame frame;
    bool conservative;
  };
  const auto chain = [](const Joint& first, std::optional<Joint> second = {}) {
    Mechanism m;
    m.gravity = {0.3, -9.8, 1.1};
    m.bodies = {test::body("a", 1.3, {0.2, -0.1, 0.3}, {1, 2, 2})};
    m.joints = {first};
    if (second) {
      m.bodies.push_back(test::body("b", 0.7, {0.5, 0.2, 0.1}, {1, 1, 1}));
      m.joints.push_back(*second);
    }
    return m;
  };
  const auto hinge = [](const char* on) { return test::revolute("hinge", on, "b", {0.2, 0, 0}, {1, 2, -1}); };
  const auto slide = [](const char* on) { return test::prismatic("slide", on, "b", {0, 0, 0}, {2, 1, 1}); };
  const Joint root_hinge = test::revolute("root", "ground", "a", {0.1, 0, 0}, {1, 1, 3}),
              root_slide = test::prismatic("root", "ground", "a", {0, 0, 0}, {1, -1, 0}),
              plane = test::joint(JointType::planar, "root", "ground", "a", {0, 0, 0}, {0, 1, 1}),
              ball = test::joint(JointType::spherical, "root", "ground", "a", {0, 0, 0});
  // The child first: the engine's tree runs against the joint.
  Joint turned = test::revolute("root", "a", "ground", {0.1, 0, 0}, {1, 1, 3});
  const auto force = ForceType::force, torque = ForceType::torque;
  const auto world = ForceFrame::world, body = ForceFrame::body;
  const std::vector<Case> cases = {
      {"torque on a hinge", chain(root_hinge), torque, world, true},
      {"torque that turns with it", chain(root_hinge), torque, body, true},
      {"force that turns with it", chain(root_hinge), force, body, true},
      {"torque on a hinge told the other way", chain(turned), torque, world, true},
      {"force that turns with that", chain(turned), force, body, true},
      {"torque in a plane", chain(plane), torque, body, true},
      {"force that turns in a plane", chain(plane), force, body, false},
      {"force on a slide", chain(root_slide), force, body, true},
      {"torque on a hinge on a slide", chain(root_slide, hinge("a")), torque, world, true},
      {"force that turns on a slide", chain(root_slide, hinge("a")), force, body, false},
      {"torque on a slide on a hinge", chain(root_hinge, slide("a")), torque, body, true},
      {"torque beyond two hinges", chain(root_hinge, hinge("a")), torque, world, false},
      {"torque on a ball joint", chain(ball), torque, world, false},
  };
  for (const Case& c : cases) {
    INFO(c.what);
    Mechanism m = c.mechanism;
    Force load;
    load.name = "load";
    load.type = c.type;
    load.frame = c.frame;
    load.body = m.bodies.back().name;
    load.at = Vec3(0.4, 0.3, -0.2);
    load.vector = {0.7, -1.9, 1.2};
    m.forces = {load};
    const Model model(m);
    CHECK(model.system.conservative == c.conservative);
    if (!c.conservative) continue;
    Dice dice(7);
    const Eigen::VectorXd q = model.displaced(dice, 0.8);
    const Eigen::VectorXd f = evaluate_at<double>(model, q, Eigen::VectorXd(), 0).residual.f;
    for (int j = 0; j < model.system.nv; ++j) {
      const auto at = [&](double step) {
        Eigen::VectorXd moved = q;
        retract<double>(model.system, step * Eigen::VectorXd::Unit(model.system.nv, j), moved);
        return potential_at(model, moved).value;
      };
      const auto central = [&](double h) { return (at(h) - at(-h)) / (2 * h); };
      CHECK(std::abs((4 * central(1e-3) - central(2e-3)) / 3 - f[j]) < 1e-9);
    }
    const Eigen::MatrixXd k = linearize_at(model, q, Eigen::VectorXd(), 0).stiffness;
    CHECK((k - k.transpose()).norm() <= 1e-14 * (1 + k.norm()));
  }
}
