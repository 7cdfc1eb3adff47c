// Ways to make runs and to read them, for the tests of motion.
#pragma once

#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"

namespace flyball::test {

inline constexpr Integrator all_integrators[]{Integrator::bdf, Integrator::adams, Integrator::runge_kutta};

// By name: "pendulum" and the like.
inline const std::vector<std::string> shipped_names{
    "ball_on_string",    "chain20",           "conical_pendulum", "fourbar_turntable", "governor",
    "governor_bearing",  "pendulum",          "rate_gyro",        "watt_governor",     "governor_parametric",
    "governor_engine",   "governor_hartnell", "governor_porter",  "governor_proell",   "governor_watt",
    "governor_friction", "free_top",          "differential",     "horizontal_rotor",  "centrifugal_clutch",
    "fan_governor",      "windmill",          "gear_train",       "rotor_oil_whip"};

// A drive makes its balance turn: it moves periodically and has no steady state.
inline bool moves_periodically(const std::string& shipped) {
  return shipped == "horizontal_rotor";
}

inline SimulationOptions lasting(double duration, Integrator method = Integrator::automatic,
                                 double tolerance = 1e-10) {
  SimulationOptions o;
  o.duration = duration;
  o.method = method;
  o.tolerance = tolerance;
  return o;
}

inline SimulationOptions undamped(SimulationOptions o) {
  o.damped = false;
  return o;
}

inline SimulationOptions starting_at(SimulationOptions o, const std::string& coordinate, double value) {
  o.at.emplace_back(coordinate, value);
  return o;
}

inline SimulationOptions kicked(SimulationOptions o, const std::string& coordinate, double rate) {
  o.kick.emplace_back(coordinate, rate);
  return o;
}

inline const CoordinateTrack& track(const Run& run, std::string_view joint, int index = 0) {
  const auto found = std::ranges::find_if(
      run.coordinates, [&](const CoordinateTrack& t) { return t.joint == joint && t.index == index; });
  REQUIRE(found != run.coordinates.end());
  return *found;
}

inline double last(const Run& run, const std::string& joint, int index = 0) {
  return track(run, joint, index).value.back();
}

// J, the largest of all energies that take part, to measure errors of energy by.
inline double energy_size(const Run& run) {
  double size = 1e-300;
  for (const std::vector<double>* tracked :
       {&run.energy.kinetic, &run.energy.potential, &run.energy.dissipated, &run.energy.delivered})
    for (const double e : *tracked)
      size = std::max(size, std::abs(e));
  return size;
}

inline double worst_balance(const Run& run) {
  double worst = 0;
  for (const double b : run.energy.balance)
    worst = std::max(worst, std::abs(b));
  return worst / energy_size(run);
}

// Of T_2 + V - T_0 from its first value, relative to the kinetic and potential energies at play.
inline double jacobi_drift(const Run& run) {
  REQUIRE(run.energy.jacobi.size() == run.time.size());
  double worst = 0;
  for (const double j : run.energy.jacobi)
    worst = std::max(worst, std::abs(j - run.energy.jacobi.front()));
  return worst / energy_size(run);
}

// Every number of a run, so that none of them is missing or no number.
inline void check_whole(const Run& run) {
  const std::size_t samples = run.time.size();
  REQUIRE(samples > 0);
  CHECK_FALSE(run.message.empty());
  CHECK_FALSE(run.method_reason.empty());
  bool finite = true, complete = true;
  const auto look = [&](const std::vector<double>& values) {
    complete = complete && values.size() == samples;
    for (const double x : values)
      finite = finite && std::isfinite(x);
  };
  look(run.time);
  for (const CoordinateTrack& t : run.coordinates) {
    look(t.value);
    look(t.rate);
  }
  for (const DriveTrack& d : run.drives)
    look(d.torque);
  for (const ReactionTrack& r : run.reactions) {
    complete = complete && r.force.size() == samples && r.torque.size() == samples;
    for (std::size_t i = 0; i < r.force.size(); ++i)
      finite = finite && r.force[i].allFinite() && r.torque[i].allFinite();
  }
  const EnergyTracks& e = run.energy;
  for (const auto* tracked : {&e.kinetic, &e.potential, &e.dissipated, &e.delivered, &e.applied, &e.balance})
    look(*tracked);
  if (!e.jacobi.empty()) look(e.jacobi);
  for (const double x : run.states)
    finite = finite && std::isfinite(x);
  CHECK(finite);
  CHECK(complete);
  CHECK(std::ranges::is_sorted(run.time));
}

// Completed, whole, with its energy accounted for and its loops closed.
inline void check_sound(const Run& run, double balance = 1e-7) {
  INFO(run.message);
  CHECK(run.status == RunStatus::completed);
  check_whole(run);
  CHECK(worst_balance(run) < balance);
  CHECK(run.statistics.position_drift < 1e-13);
  CHECK(run.statistics.velocity_drift < 1e-11);
}

} // namespace flyball::test
