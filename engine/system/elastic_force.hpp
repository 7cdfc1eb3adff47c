// What single springs and dampers of a mechanism do, for those that show it: by their numbers or laws.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace flyball {

struct ElasticForce {
  double force = 0;  // N or N m, against the deflection
  double energy = 0; // J
};

// Of a joint's coordinate `i`, which has a spring, and of a spring between points; `deflection` in m or rad.
ElasticForce elastic_force(const Mechanism& mechanism, const Joint& joint, int i, double deflection);
ElasticForce elastic_force(const Mechanism& mechanism, const Force& spring, double deflection);

// N, of a spring between points, against its length's `rate` (m/s).
double damping_force(const Mechanism& mechanism, const Force& spring, double rate);

} // namespace flyball
