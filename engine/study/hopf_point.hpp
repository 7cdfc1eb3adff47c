// What there is to say about a steady state at which a damped pair of eigenvalues crosses the imaginary axis:
// how fast it swings, and whether the mechanism begins to hunt softly or hard.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

enum class HopfLoss {
  soft,      // beyond it small oscillations, which grow with the root of the distance
  hard,      // beyond it nothing small holds the motion, and before it a larger push is enough
  undecided, // the error leaves the sign of the coefficient open, or there is none
};
std::string_view word(HopfLoss loss);

struct HopfPoint {
  double frequency = 0; // rad/s
  int growing = 0;      // other eigenvalues to the right of the axis: then it is no edge of stability
  // The first Lyapunov coefficient l1 (lyapunov.hpp), 1/rad^2 or 1/m^2, and its estimated error. The
  // amplitude a of `coordinate` follows a' = Re(s) a + w l1 a^3 beside the point, s the pair and w its
  // frequency: so a^2 = -Re(s) / (w l1) where a motion stays. Nothing where `reason` says why.
  std::optional<double> lyapunov;
  double error = 0;
  std::string reason;
  struct Coordinate {
    std::string joint;
    int index = 0, count = 1; // which of the joint's coordinates
    bool angle = false;
    bool operator==(const Coordinate&) const = default;
  };
  Coordinate coordinate;

  HopfLoss loss() const;
};

// Of a steady state of the mechanism, of which its coordinates and eigenvalues are taken; the pair is that
// next to i `frequency` (rad/s). `coordinate`: that whose amplitude counts; nothing for the one that moves
// most, in radians or reaches.
HopfPoint describe_hopf(const Mechanism& mechanism, const ResponsePoint& at, double frequency,
                        const std::optional<HopfPoint::Coordinate>& coordinate = {});

// Of each special point of branches that were followed over `address`: what there is to say of Hopf points of
// a motion that does not turn with the drives; nothing of others. Throws SceneError for an address that does
// not exist.
using HopfPoints = std::vector<std::optional<HopfPoint>>;
HopfPoints describe_hopf_points(const Mechanism& mechanism, const std::string& address,
                                const ResponseDiagram& diagram);

// The frequency (rad/s) of the pair nearest to the axis, as of a Hopf point of a branch; 0 where none swings.
double hopf_frequency(const std::vector<std::complex<double>>& eigenvalues);

} // namespace flyball
