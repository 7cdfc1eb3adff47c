// Flyball at the job, and the job made from a mechanism.
#pragma once

#include "tests/bench/peers/clock.hpp"
#include "tests/bench/peers/job.hpp"

#include "engine/mechanism/mechanism.hpp"

namespace flyball::peers {

// For mechanisms of revolute and prismatic joints and links, with the answer that Flyball finds. Throws
// std::invalid_argument for others and where there is no answer.
Job make_job(const std::string& name, const Mechanism& mechanism);

struct FlyballResult {
  Times cold;            // from the drawn pose: the stable answer, refined
  Times warm;            // Newton-Raphson from a good guess
  Times iteration;       // one Newton iteration
  Times residual;        // one plain evaluation
  double error = 0;      // estimated, of the cold answer: rad or m
  int iterations = 0;    // of the cold solve
  double warm_error = 0; // what is left after the warm iterations, rad or m
  int warm_iterations = 0;
};
// `cold_too` leaves out the cold solve where it is false.
FlyballResult measure_flyball(const Mechanism& mechanism, bool cold_too = true);

} // namespace flyball::peers
