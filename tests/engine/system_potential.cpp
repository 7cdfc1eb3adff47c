// The amended potential against the balance that it is the potential of, and against the reference's.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"

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
