// The job that every engine gets: a mechanism of hinges and sliders on a driven spindle, with springs,
// dampers and rigid links, from its drawn pose to |q - q*| below a tolerance. Plain C++17, since Simbody's
// headers do not compile as C++20.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace flyball::peers {

using Vec = std::array<double, 3>;

struct JobBody {
  std::string name;
  double mass = 0;                 // kg
  Vec position{};                  // m, mass centre in the drawn pose; axes are the world's
  std::array<double, 6> inertia{}; // kg m^2: xx, yy, zz, xy, xz, yz
};

struct JobJoint {
  std::string name;
  int parent = -1, child = 0; // in Job::bodies; -1 is the ground
  bool slides = false;
  Vec at{}, axis{};               // m; unit
  double drawn = 0;               // rad or m, as are all coordinates
  double stiffness = 0, free = 0; // N m/rad or N/m
  double damping = 0;             // N m s/rad or N s/m, the scene's
  int damper = 0;                 // which of the dampers that are chosen one by one; shared by symmetry
  bool driven = false;
  double speed = 0;  // rad/s
  double target = 0; // q*, of joints that are not driven
};

struct JobLink { // keeps two points at a distance
  int a = 0, b = 0;
  Vec on_a{}, on_b{}; // m, in the world at the drawn pose
  double length = 0;  // m
};

struct Job {
  std::string name;
  Vec gravity{};
  std::vector<JobBody> bodies;
  std::vector<JobJoint> joints; // parents first
  std::vector<JobLink> links;
  int dampers = 0;
  bool chain = false; // of many joints without dampers: the peers bring their own
};

constexpr double near_enough = 1e-6; // rad or m

// What the scan for an integrator's best settings may take, processor time.
constexpr double tuning_s = 2;

// Dampers that a peer may choose: all of the scene's times one factor, or one by one, as no real mechanism
// would have them, to see what the engine could do at the very best.
enum class Damping { critical, free };

struct PeerResult {
  bool available = false; // built with the peer's package
  bool reached = false;
  double fastest_s = 0, median_s = 0;
  long steps = 0;
  double bias = 0;      // |q - q*| where the tuned run stands in the end
  std::string settings; // what the scan chose
};

PeerResult run_mujoco(const Job& job, Damping damping);
PeerResult run_simbody(const Job& job, Damping damping);

} // namespace flyball::peers
