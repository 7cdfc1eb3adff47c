#include "engine/system/law_phase.hpp"

#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/point_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace flyball {
namespace {

constexpr double rounding = 1e-9; // of the size of a number

bool is_of_points(const DriveLaw::Input& input) {
  return input.coordinate < 0;
}

bool is_of_spring_force(const DriveLaw::Input& input) {
  return input.spring >= 0 && is_spring_force(input.quantity.result);
}

// Of no particular place, at speeds (1/s, of slides in reaches) that are like the largest that are given.
Eigen::VectorXd some_configuration(const System& system, const Parameters& p, double speed) {
  Eigen::VectorXd q(system.nq);
  drawn_configuration(system, p, q);
  Eigen::VectorXd step(system.nv);
  for (Eigen::Index v = 0; v < system.nv; ++v)
    step[v] = 0.9 * std::sin(1.1 + 2.3 * static_cast<double>(v));
  for (const Link& link : system.links)
    if (link.v >= 0 && link.type == LinkType::prismatic) step[link.v] *= p.length;
  retract<double>(system, step, q);
  for (const Link& link : system.links)
    if (finds_speed(link))
      q[link.q] = speed * (link.type == LinkType::prismatic ? p.length : 1) *
                  (1 + 0.4 * std::sin(0.7 + 1.9 * static_cast<double>(link.v)));
  return q;
}

// An input's value, and how it changes with the rates of the coordinates. Of what a spring exerts its length,
// and how much of its direction a component takes: some laws have no value for any length.
struct AtPhase {
  double value = 0, direction = 0;
  Eigen::VectorXd by_rates;
};

AtPhase at_phase(const System& system, const Parameters& p, const DriveLaw& law,
                 const DriveLawParameters& numbers, std::size_t i, const Eigen::VectorXd& q,
                 const Kinematics<double>& k) {
  AtPhase out{0, 0, Eigen::VectorXd::Zero(system.nv)};
  const Result asked = law.inputs[i].quantity.result;
  if (is_of_spring_force(law.inputs[i])) {
    const auto s = static_cast<std::size_t>(law.inputs[i].spring);
    const SpringState<double> spring = spring_state(system.springs[s], p.springs[s], k);
    out.value = spring.length;
    if (asked != Result::tension && asked != Result::force)
      out.direction = spring.direction[static_cast<int>(asked) - static_cast<int>(Result::force_x)];
    return out;
  }
  out.value = law_input(system, p, law, numbers, i, q, k);
  if (is_of_velocity(asked))
    add_velocity_rates(system, point_rates_of(asked, numbers.points[i], k), numbers.points[i], k,
                       [&](int v, double rate) { out.by_rates[v] += rate; });
  return out;
}

} // namespace

bool asks_for_points(const System& system) {
  const auto asks = [](const DriveLaw& law) { return std::ranges::any_of(law.inputs, is_of_points); };
  return std::ranges::any_of(system.torques, [&](const DriveTorqueElement& torque) {
    return asks(torque.torque) || asks(torque.load);
  });
}

void refuse_turning_laws(const System& system, const Mechanism& mechanism, const Parameters& p) {
  if (!asks_for_points(system)) return;
  const double given = fastest_given_rate(system, p);
  const Eigen::VectorXd q = some_configuration(system, p, given > 0 ? given : 1);
  Kinematics<double> here, later;
  forward<double>(system, p, q, 0, here);
  const std::vector<DriveRate> rates = drive_rates(system, p, q);
  const std::vector<double> times = phase_times(rates);
  Eigen::VectorXd units = Eigen::VectorXd::Ones(system.nv); // of what velocities are by rates, over the reach
  for (const Link& link : system.links)
    if (link.v >= 0 && link.type == LinkType::prismatic) units[link.v] = p.length;
  const auto differ = [&](const AtPhase& a, const AtPhase& b, double size, double least) {
    return !(std::abs(a.value - b.value) <= least * size && std::abs(a.direction - b.direction) <= least &&
             (a.by_rates - b.by_rates).cwiseProduct(units).lpNorm<Eigen::Infinity>() <= least * p.length);
  };
  const auto check = [&](const DriveLaw& law, const DriveLawParameters& numbers, const Link& link,
                         const char* which) {
    for (std::size_t i = 0; i < law.inputs.size(); ++i) {
      if (!is_of_points(law.inputs[i])) continue;
      const AtPhase a = at_phase(system, p, law, numbers, i, q, here);
      const Result result = law.inputs[i].quantity.result;
      const bool armless = result == Result::angle && std::isnan(a.value);
      if (!armless && !p.moving) continue;
      const double size = is_of_spring_force(law.inputs[i])
                              ? a.value + p.length
                              : law_input_size(system, p, law, numbers, i, q, here);
      const bool stays = std::ranges::none_of(times, [&](double time) {
        forward<double>(system, p, q, time, later);
        return differ(a, at_phase(system, p, law, numbers, i, q, later), size,
                      rounding + 4 * angle_rounding(rates, time));
      });
      if (stays && !armless) continue;
      const Joint& of = mechanism.joints[static_cast<std::size_t>(
          system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint)];
      const std::string text = drive_law(mechanism, of, link.coordinate, which)->text;
      const std::string asked = quantity_text(mechanism, law.inputs[i].quantity);
      throw SceneError("joints." + of.name + ".drive." + which,
                       "\"=" + text + "\": expected " +
                           (armless ? "an angle between two arms, found " + asked +
                                          ", of which one end stands where its corner does"
                                    : "what stays as it is while drives turn, found " + asked +
                                          ", which changes with them"));
    }
  };
  for (std::size_t t = 0; t < system.torques.size(); ++t) {
    const DriveTorqueElement& e = system.torques[t];
    const Link& link = system.links[static_cast<std::size_t>(e.link)];
    check(e.torque, p.torques[t].torque, link, "torque");
    check(e.load, p.torques[t].load, link, "load");
  }
}

bool tells_turns_apart(const DriveLaw& law, const DriveLawParameters& numbers, int coordinate) {
  const auto asked = [&](const DriveLaw::Input& input) {
    return input.coordinate == coordinate && input.quantity.result == Result::coordinate;
  };
  if (!law.expression || std::ranges::none_of(law.inputs, asked)) return false;
  std::vector<std::size_t> as_they_come(law.inputs.size());
  std::iota(as_they_come.begin(), as_they_come.end(), std::size_t{0});
  const auto value = [&](double place, double turns, double others) {
    std::vector<Dual> inputs;
    for (std::size_t i = 0; i < law.inputs.size(); ++i)
      inputs.emplace_back(asked(law.inputs[i])
                              ? place + turns * 2 * std::numbers::pi
                              : others * (1.5 + std::sin(0.7 + 2.3 * static_cast<double>(i))));
    return law.expression->evaluate(numbers.numbers, {}, inputs, as_they_come).value;
  };
  // What a law asks for may begin to matter many turns away, and where the others are large.
  for (const double others : {1., -1., 0.01, 30., -30., 1e3, -1e3, 1e5}) {
    double differs = 0, size = 0;
    for (const double place : {0.3, 1.4, -0.8, 2.9, -2.2}) {
      const double here = value(place, 0, others);
      size = std::max(size, std::abs(here));
      for (const double turns : {1., -3., 10., -30., 100., -300., 1e3, -3e3}) {
        const double there = value(place, turns, others);
        if (!std::isfinite(here) || !std::isfinite(there)) return true;
        differs = std::max(differs, std::abs(there - here));
      }
    }
    if (differs > rounding * size) return true;
  }
  return false;
}

} // namespace flyball
