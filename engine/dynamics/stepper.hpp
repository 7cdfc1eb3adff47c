// Ordinary differential equations, and what steps through them: SUNDIALS behind a narrow door. Nothing here
// knows of mechanisms.
#pragma once

#include "engine/dynamics/simulation.hpp"

#include <Eigen/Core>

namespace flyball {

// y' = f(t, y), some of whose solutions live on a manifold.
class Ode {
 public:
  virtual ~Ode() = default;
  virtual int size() const = 0;
  // False where f cannot be evaluated: the step is tried again, shorter.
  virtual bool rate(double t, const double* y, double* out) = 0;
  // The size of each entry that counts as an error of one.
  virtual void weights(const double* y, double* out) = 0;
  // For implicit steps: takes J = f_y, `rate` being f at y; factors I - gamma J with the J taken last, both
  // false where that fails; b := (I - gamma J)^-1 b with these factors.
  virtual bool linearise(double t, const double* y, const double* rate) = 0;
  virtual bool factor(double gamma) = 0;
  virtual void solve(double* b) = 0;
  // Once this is false nothing more is evaluated, and a step fails for good.
  virtual bool wanted() const = 0;

  virtual bool has_manifold() const = 0;
  // Puts y back on the manifold.
  virtual bool project(double t, double* y) = 0;

  // Functions whose sign changes end a step.
  virtual int events() const = 0;
  virtual void event_values(double t, const double* y, double* out) = 0;
};

struct StepOutcome {
  enum Kind { advanced, event, failed } kind = advanced;
  double time = 0;
  std::vector<int> events; // whose signs changed
  std::string message;     // of a failure, a clause
};

class Stepper {
 public:
  virtual ~Stepper() = default;
  // Begins at a state, at first or again.
  virtual void start(double t, const Eigen::VectorXd& y) = 0;
  // One step. `stop` is a time at which the state will be asked for: methods without an interpolant of their
  // own order do not step over it, others may.
  virtual StepOutcome step(double stop) = 0;
  // The state within the last step.
  virtual void state_at(double t, Eigen::VectorXd& y) = 0;
  // Adds to the statistics what was done since they were last asked for.
  virtual void count(RunStatistics& statistics) = 0;
};

std::unique_ptr<Stepper> make_cvode_stepper(Ode& ode, Integrator method);
// With a fixed step where that is not zero.
std::unique_ptr<Stepper> make_runge_kutta_stepper(Ode& ode, double fixed_step);

} // namespace flyball
