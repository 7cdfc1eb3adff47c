#include "engine/stability/kinks.hpp"

#include "engine/stability/moved_inputs.hpp"
#include "engine/system/air_force.hpp"
#include "engine/system/cut_damper.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/residual.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace flyball {
namespace {

constexpr double far = 1e-6, near = far / 64; // of the size of a number
// The same: nearer to its limit a coordinate is just at its stop. Stiff stops give way by little, and one
// that is pressed is on its one side.
constexpr double at_stop = 1e-10;
constexpr double at_rest = 1e-12; // of the terms of the forces along the coordinate

// Slopes before and after a jump within some 1e-8 of `size` beside x, of a law with this slope.
template <class Slope>
std::optional<std::array<double, 2>> jump_at(const Slope& slope, double x, double size) {
  const auto slopes = [&](double h) { return std::array<double, 2>{slope(x - h), slope(x + h)}; };
  const auto difference = [](const std::array<double, 2>& s) { return std::abs(s[1] - s[0]); };
  const auto close = slopes(near * size);
  const double largest = std::max(std::abs(close[0]), std::abs(close[1]));
  if (!(difference(close) > 1e-6 * largest)) return {};
  if (difference(close) < 0.5 * difference(slopes(far * size))) return {}; // a smooth one: 1/64 as much
  // Where it jumps it is as before or as after in between, too; a smooth law that bends within so little has
  // slopes of its own there. On the kink itself what is asked for twice has neither.
  for (const double part : {-0.75, -0.5, -0.25, 0.25, 0.5, 0.75}) {
    const double there = slope(x + part * near * size);
    if (std::min(std::abs(there - close[0]), std::abs(there - close[1])) > 0.1 * difference(close)) return {};
  }
  return close;
}

// Collects those that stand on one.
class Search {
 public:
  Search(Kink::Of of, std::size_t entry, std::vector<Kink>& out) : of_(of), entry_(entry), out_(out) {}

  void look(const BoundLaw& law, Kink::Law which, double at, double size) const {
    if (law) add(which, at, jump_at([&](double x) { return law.slope(x); }, at, size));
  }
  // At +-pi the flow comes from behind, from either side.
  void look_round(const BoundLaw& law, Kink::Law which, double at) const {
    const auto slope = [&](double x) { return law.slope(std::remainder(x, 2 * std::numbers::pi)); };
    if (law) add(which, at, jump_at(slope, at, 1));
  }

 private:
  void add(Kink::Law which, double at, const std::optional<std::array<double, 2>>& jump) const {
    if (jump) out_.push_back({of_, entry_, which, at, *jump, 0, {}});
  }

  Kink::Of of_;
  std::size_t entry_;
  std::vector<Kink>& out_;
};

void look_at_polar(const Search& search, const BodyForceParameters& p, const Mat3& rotation,
                   const Vec3& flow) {
  const Vec3 normal = rotation * p.normal, chord = (rotation * p.span).cross(normal);
  const double up = flow.dot(normal), along = flow.dot(chord);
  if (up == 0 && along == 0) return; // no force, on either side
  const double incidence = std::atan2(up, along);
  search.look_round(p.polar->lift, Kink::Law::lift, incidence);
  search.look_round(p.polar->drag, Kink::Law::drag, incidence);
}

bool has_stop(const CoordinateForce& force) {
  return force.stop_stiffness != 0 && (force.has_lower || force.has_upper);
}

// Of a coordinate just at its stop.
std::optional<std::array<double, 2>> stiffness_beside_stop(const CoordinateForce& force, double x,
                                                           double size) {
  if (!has_stop(force)) return {};
  const auto stop = [&](double at) { return force.touched(at) ? force.stop_stiffness : 0; };
  const double before = stop(x - at_stop * size), after = stop(x + at_stop * size);
  if (before == after) return {};
  const double spring = force.curvature(x) - stop(x);
  return std::array{spring + before, spring + after};
}

// The force by which a coordinate presses on its stop, or would at its other side of it.
double force_at_stop(const CoordinateForce& force, double x) {
  double away = std::numeric_limits<double>::infinity();
  if (force.has_lower) away = std::abs(x - force.lower);
  if (force.has_upper) away = std::min(away, std::abs(x - force.upper));
  return force.stop_stiffness * away;
}

// Whether two inputs cross the same kink, be it in opposite directions.
bool same_sides(const Kink& a, const Kink& b) {
  const auto alike = [](const std::vector<double>& x, const std::vector<double>& y) {
    constexpr double smooth = 1e-4; // more than what a smooth law changes so near
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!(std::abs(x[i] - y[i]) <= smooth * std::max(std::abs(x[i]), std::abs(y[i])))) return false;
    return true;
  };
  const auto& [before, after] = a.gradients;
  return a.law == b.law && ((alike(before, b.gradients[0]) && alike(after, b.gradients[1])) ||
                            (alike(before, b.gradients[1]) && alike(after, b.gradients[0])));
}

// Of the torque or load of a drive, along each of its inputs that a steady state or its motion can change.
void look_at_drive_law(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                       std::size_t drive, Kink::Law which, std::vector<Kink>& out) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  const DriveTorqueElement& e = system.torques[drive];
  const bool torque = which == Kink::Law::torque;
  const DriveLaw& law = torque ? e.torque : e.load;
  const DriveLawParameters& numbers = torque ? p.torques[drive].torque : p.torques[drive].load;
  const std::size_t first = out.size();
  for (std::size_t i = 0; i < law.inputs.size(); ++i) {
    const DriveLaw::Input& input = law.inputs[i];
    const double at = law_input(system, p, law, numbers, i, q, k);
    if (stands_on_own_kink(system, p, law, numbers, i, q, k)) {
      if (!is_moved(problem, law, numbers, i, q, k)) continue;
      const double slope = drive_law_slopes(system, p, law, numbers, q, k, i, 0)[i];
      if (slope != 0) out.push_back({Kink::Of::drive, drive, which, at, {-slope, slope}, i, {}});
      continue;
    }
    // A 64th of that of a number: some laws press by stiffnesses that leave no more between both sides.
    double size = (input.quantity.result == Result::angle ? 1 : p.length) / 64;
    if (input.coordinate >= 0) {
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
      const Link& link = system.links[static_cast<std::size_t>(c.link)];
      if (link.v < 0) continue;
      size = (link.type == LinkType::spherical ? 1 : problem.scaling.column[link.v]) / 64;
    }
    // A bearing gives way by little: what it bears is small beside what it might.
    if (input.bearing >= 0)
      size = std::max(std::abs(at), 1e-8 * law_input_size(system, p, law, numbers, i, q, k)) / 64;
    else if (is_spring_force(input.quantity.result) || input.quantity.result == Result::spring)
      size = law_input_size(system, p, law, numbers, i, q, k) / 64;
    const auto slopes = [&](double by) { return drive_law_slopes(system, p, law, numbers, q, k, i, by); };
    const auto slope = [&](double by) { // of all that ask for the same
      const std::vector<double> all = slopes(by);
      double sum = 0;
      for (std::size_t j = 0; j < all.size(); ++j)
        if (law.inputs[j] == input) sum += all[j];
      return sum;
    };
    const auto jump = jump_at(slope, 0, size);
    if (!jump || !is_moved(problem, law, numbers, i, q, k)) continue;
    Kink kink{Kink::Of::drive, drive, which, at, *jump, i, {slopes(-near * size), slopes(near * size)}};
    if (std::none_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                     [&](const Kink& other) { return same_sides(kink, other); }))
      out.push_back(std::move(kink));
  }
}

} // namespace

std::vector<Kink> find_kinks(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  std::vector<Kink> out;
  for (std::size_t i = 0; i < system.coordinate_laws.size(); ++i) {
    const ForceLawElement& e = system.coordinate_laws[i];
    const auto l = static_cast<std::size_t>(e.at);
    const Link& link = system.links[l];
    if (link.v < 0) continue;
    const CoordinateForce& force = p.links[l].force[static_cast<std::size_t>(e.component)];
    const Search search(Kink::Of::coordinate, i, out);
    const double size = link.type == LinkType::prismatic ? p.length : 1;
    if (link.drive < 0) {
      const double value =
          link.type == LinkType::spherical ? rotation_vector(link, p.links[l], q)[e.component] : q[link.q];
      search.look(force.laws->spring, Kink::Law::spring, value - force.laws->free, size);
    }
    search.look(force.laws->damper, Kink::Law::damper, finds_speed(link) ? q[link.q] : 0, size);
  }
  for (std::size_t i = 0; i < system.spring_laws.size(); ++i) {
    const auto n = static_cast<std::size_t>(system.spring_laws[i].at);
    const PointSpringParameters& spring = p.springs[n];
    const SpringState<double> s = spring_state(system.springs[n], spring, k);
    const Search search(Kink::Of::spring, i, out);
    search.look(spring.laws->spring, Kink::Law::spring, s.length - spring.free_length, p.length);
    search.look(spring.laws->damper, Kink::Law::damper, stretching(system.springs[n], s, k), p.length);
  }
  for (std::size_t i = 0; i < system.cut_damper_laws.size(); ++i) {
    const auto n = static_cast<std::size_t>(system.cut_damper_laws[i].at);
    const CutDamperElement& e = system.cut_dampers[n];
    Search(Kink::Of::cut_damper, i, out)
        .look(p.cut_dampers[n].laws->damper, Kink::Law::damper,
              cut_damper_state<double>(e, p.cut_dampers[n], k).rate, e.angular ? 1 : p.length);
  }
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    const BodyForceParameters& vane = p.body_forces[i];
    const int link = system.body_forces[i].link;
    if (!vane.polar) continue;
    look_at_polar(Search(Kink::Of::vane, i, out), vane, k.at(link).R,
                  vane.wind - k.velocity(link, k.point(link, vane.at)));
  }
  for (std::size_t i = 0; i < system.turning_air.size(); ++i) {
    const BodyForceParameters& vane = p.turning_air[i];
    if (!vane.polar) continue;
    const TurningAirElement& e = system.turning_air[i];
    look_at_polar(Search(Kink::Of::vane_in_turning_air, i, out), vane, k.at(e.ends.b).R,
                  turning_air_force<double>(e, vane, k).flow);
  }
  // What is pressed by more than rounding leaves of the forces there is on one side for good, however little
  // a stiff stop gives way.
  Magnitudes terms;
  const auto is_pressed = [&](const CoordinateForce& force, double x, double size, int v) {
    if (terms.force.size() == 0) {
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.rows);
      evaluate_magnitudes(system, p, q, none, k, terms);
    }
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(x), size);
    return force_at_stop(force, x) > std::max(at_rest * terms.force[v], force.stop_stiffness * rounding);
  };
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.v < 0 || link.drive >= 0 || !p.links[l].elastic) continue;
    const bool spherical = link.type == LinkType::spherical;
    const double size = link.type == LinkType::prismatic ? p.length : 1;
    for (std::size_t i = 0; i < (spherical ? 3 : 1); ++i) {
      const CoordinateForce& force = p.links[l].force[i];
      if (!has_stop(force)) continue;
      const double x =
          spherical ? rotation_vector(link, p.links[l], q)[static_cast<Eigen::Index>(i)] : q[link.q];
      const auto slopes = stiffness_beside_stop(force, x, size);
      if (slopes && !is_pressed(force, x, size, link.v + static_cast<int>(i)))
        out.push_back({Kink::Of::stop, l, Kink::Law::spring, x, *slopes, i, {}});
    }
  }
  for (std::size_t i = 0; i < system.torques.size(); ++i)
    for (const Kink::Law which : {Kink::Law::torque, Kink::Law::load})
      look_at_drive_law(problem, q, k, i, which, out);
  return out;
}

bool may_have_kinks(const System& system, const Parameters& p) {
  return !system.coordinate_laws.empty() || !system.spring_laws.empty() || !system.cut_damper_laws.empty() ||
         !system.torques.empty() || std::ranges::any_of(p.links, [](const LinkParameters& l) {
           return l.elastic && std::ranges::any_of(l.force, has_stop);
         });
}

Parameters beside_kink(const Problem& problem, const Kink& kink, std::size_t side) {
  Parameters out = problem.parameters;
  DriveTorqueParameters& drive = out.torques[kink.entry];
  (kink.law == Kink::Law::torque ? drive.torque : drive.load).slopes = kink.gradients[side];
  return out;
}

Parameters straightened(const Problem& problem, const std::vector<Kink>& kinks, KinkSide side) {
  const System& system = problem.system;
  Parameters out = problem.parameters;
  for (const Kink& kink : kinks) {
    if (kink.law != Kink::Law::spring) continue;
    if (kink.of == Kink::Of::stop) {
      CoordinateForce& force = out.links[kink.entry].force.hold(kink.input);
      if (side == KinkSide::softer)
        force.has_lower = force.has_upper = false;
      else // by a hair beyond its limit, of which no force comes
        (kink.slopes[0] < kink.slopes[1] ? force.upper : force.lower) =
            std::nextafter(kink.at, kink.slopes[0] < kink.slopes[1] ? kink.at - 1 : kink.at + 1);
      continue;
    }
    const ForceLawElement& e =
        (kink.of == Kink::Of::spring ? system.spring_laws : system.coordinate_laws)[kink.entry];
    auto& laws = kink.of == Kink::Of::spring ? out.springs[static_cast<std::size_t>(e.at)].laws
                                             : out.links[static_cast<std::size_t>(e.at)]
                                                   .force.hold(static_cast<std::size_t>(e.component))
                                                   .laws;
    const auto [least, most] = std::minmax(kink.slopes[0], kink.slopes[1]);
    laws = std::make_shared<const ForceLaws>(
        ForceLaws{line_through(laws->spring, kink.at, side == KinkSide::softer ? least : most), laws->damper,
                  laws->free});
  }
  return out;
}

} // namespace flyball
