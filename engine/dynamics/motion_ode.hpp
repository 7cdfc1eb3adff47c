// The equations of motion as y' = f(t, y), y = [q; s; dissipated; delivered; applied]: the configuration with
// its quaternions, the velocity that carries the momentum, and three energies that are integrated along.
#pragma once

#include "engine/dynamics/friction_modes.hpp"
#include "engine/dynamics/newton_matrix.hpp"
#include "engine/dynamics/stepper.hpp"

namespace flyball {

class MotionOde : public Ode {
 public:
  // `rate_scale` (1/s): how fast a coordinate that moves through a radian or the reach is as a rule;
  // `energy_scale` (J): the energies at play.
  MotionOde(Equations& equations, const Watch& watch, double tolerance, double rate_scale,
            double energy_scale);

  // What ends steps: stops reached or left, rotation vectors that turn over.
  void set_events(std::vector<StopElement> stops, std::vector<FlipElement> flips);
  // Those that slip come to a stop, or what sticks takes all that friction gives; see FrictionModes.
  void set_frictions(const std::vector<FrictionElement>& frictions, const std::vector<int>& slips,
                     const std::vector<FrictionHold>& holds);
  // Which stops are touched. They are left, or reached again, a hair beyond their limit, so that no step
  // begins right at an event: SUNDIALS does not see that one.
  void set_touching(const std::vector<bool>& touching) { touching_ = touching; }
  // Whether the manifold has to be kept inside f, for want of a better place.
  void set_inner_projection(bool on) { inner_projection_ = on; }

  void pack(const Eigen::VectorXd& q, const Eigen::VectorXd& s, const Eigen::Vector3d& energies,
            Eigen::VectorXd& y) const;
  void unpack(const double* y, Eigen::VectorXd& q, Eigen::VectorXd& s) const;
  Eigen::Vector3d energies(const Eigen::VectorXd& y) const { return y.tail<3>(); }

  int size() const override { return nq_ + nv_ + 3; }
  bool rate(double t, const double* y, double* out) override;
  void weights(const double* y, double* out) override;
  bool linearise(double t, const double* y, const double* rate) override;
  bool factor(double gamma) override { return matrix_.factor(gamma); }
  void solve(double* b) override { matrix_.solve(b); }
  bool wanted() const override { return !watch_.over(); }
  bool has_manifold() const override { return rotations_ || equations_.needs_projection(); }
  bool project(double t, double* y) override;
  int events() const override {
    return static_cast<int>(stops_.size() + flips_.size() + slips_.size() + 2 * holds_.size());
  }
  void event_values(double t, const double* y, double* out) override;

 private:
  Equations& equations_;
  const Watch& watch_;
  const MotionModel& model_;
  int nq_, nv_;
  double tolerance_, energy_scale_;
  bool rotations_ = false, inner_projection_ = false;
  std::vector<StopElement> stops_;
  std::vector<bool> touching_;
  std::vector<FlipElement> flips_;
  struct Slip {
    int v = 0, way = 1;
  };
  std::vector<Slip> slips_;
  std::vector<FrictionHold> holds_;
  double rate_scale_;
  Eigen::VectorXd q_, s_, scale_;
  NewtonMatrix matrix_;
};

} // namespace flyball
