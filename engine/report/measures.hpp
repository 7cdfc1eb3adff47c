// The measures of a mechanism at a state: values, how they change along steps of the coordinates, and errors.
// Everything is at the drawn phase of the drives.
#pragma once

#include "engine/kkt/workspace.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/measured_quantity.hpp"
#include "engine/solve/solution.hpp"
#include "engine/system/reactions.hpp"

namespace flyball {

// A state that measures are taken of. Of a steady state coordinates and rates are found where they are asked
// for; of a motion they are given, by System::reported, and with them what drives by torque give, by
// System::torques: there these are no drives of the system.
struct MeasuredState {
  const System& system;
  const Parameters& parameters;
  const Eigen::VectorXd& q;
  const Kinematics<double>& kinematics;
  const TransmittedForces* forces = nullptr; // needed where MeasureSet::needs_forces()
  bool accelerated = true;                   // the kinematics' accelerations are known
  std::span<const double> coordinates{}, rates{}, torques{};

  // Of a coordinate of a joint, as listed: rad or m, as the joint labels it, and rad/s or m/s.
  double coordinate(int listed) const;
  double rate(int listed) const;
};

// Read once a topology; a change of numbers reads nothing again.
class MeasureSet {
 public:
  MeasureSet() = default;

  // Takes the mechanism's measures and numbers. Throws SceneError for a measure that is wrong.
  void bind(const Mechanism& mechanism, const System& system, const Parameters& parameters);

  bool empty() const { return plan_.empty(); }
  std::size_t size() const { return plan_.size(); }
  // Whether some measure asks for reactions, torques or powers; for accelerations.
  bool needs_forces() const { return needs_forces_; }
  bool needs_accelerations() const { return needs_accelerations_; }

  // The values of all measures in the scene's order, in SI units; not finite where one is undefined.
  const Eigen::VectorXd& evaluate(const MeasuredState& state);
  // The same of a steady state that is evaluated in the workspace with these multipliers.
  const Eigen::VectorXd& evaluate(const Problem& problem, const Unknowns& z, const Workspace& w);
  // The same by coordinates alone, multipliers being those that balance the forces best.
  const Eigen::VectorXd& evaluate_at(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);

  // (measures, nv): their rates by the entries of a step of q_R, unscaled, multipliers following as in
  // evaluate_at(). Exact by the kinematics; those of forces (of springs along their lines too where there is
  // a damper) and of the rates of joints that close loops by central differences. Of what was evaluated last,
  // which is evaluated in `w` (its kinematics); `elsewhere` is for states beside it. Not a number where a
  // measure has no rate, and of more than 64 coordinates where it takes differences, two balances a
  // coordinate, unless these are asked for.
  const Eigen::MatrixXd& gradient(const Problem& problem, const Eigen::VectorXd& q, const Workspace& w,
                                  Workspace& elsewhere, bool all_differences = false);

  // (measures, numbers): their rates along the steady states of the mechanism, per unit of each of these
  // numbers of it, which have been set, where the coordinates' are `rates` (by number, see sensitivities();
  // empty: none). Evaluates at q. Not a number where a measure has none, or where the number moves others at
  // no finite rate. For differences the numbers are varied, and set back.
  Eigen::MatrixXd rates_along(const Problem& problem, const Mechanism& mechanism, VariedNumbers& numbers,
                              const Eigen::VectorXd& q, std::span<const Eigen::VectorXd> rates, Workspace& w);
  // The same by the addresses of numbers that may not have been set, such as a length that is as drawn.
  Eigen::MatrixXd rates_along(const Problem& problem, const Mechanism& mechanism,
                              std::span<const std::string> addresses, const Eigen::VectorXd& q,
                              std::span<const Eigen::VectorXd> rates, Workspace& w);

  // By name, with the errors that errors of the coordinates (by coordinate of q_R: rad, m) make; where these
  // are empty or there are no rates errors are left out. One that has a pole within those errors (or about
  // half of the digits, where it is huge and they are empty) has no value. Of a steady state that is
  // evaluated in `w` with these multipliers.
  std::vector<MeasureSolution> solutions(const Problem& problem, const Unknowns& z,
                                         const Eigen::VectorXd& error, Workspace& w);

  // Which measures rest on the reaction of this joint, or on the torque of its drive.
  void mark_nonunique(const Mechanism& mechanism, const std::vector<Reaction>& reactions,
                      const std::vector<DriveTorque>& torques, std::vector<MeasureSolution>& out) const;

 private:
  // Where a quantity is found in the system.
  struct Place {
    int reported = -1, tree = -1, cut = -1, drive = -1;
    int torque = -1; // of System::torques
    ElasticPlace elastic;
    bool differenced = false; // its rates along coordinates are found by differences
    // Those by numbers, too: of forces, whose multipliers follow, and of joints that close loops.
    bool differenced_by_numbers = false;
  };
  void find_places(const Mechanism& mechanism, const System& system);
  double value(const MeasuredState& state, std::size_t quantity) const;
  // What the drive at a place gives (N m or N); not a number where nothing drives.
  static double torque(const MeasuredState& state, const Place& place);
  void evaluate_quantities(const MeasuredState& state);
  Clearance clearance_of(const Kinematics<double>& kinematics, std::size_t quantity) const;
  // Adds the rates of a quantity to a row of quantity_rates_.
  void rates(const MeasuredState& state, std::size_t quantity, Eigen::VectorXd& out) const;
  // After gradient().
  void estimate_errors(const Problem& problem, const Unknowns& z, const Eigen::VectorXd& error,
                       const Workspace& w, std::vector<MeasureSolution>& out) const;
  // Whether a measure peaks at the state that was evaluated and falls to less than half of it either way by
  // the errors of the coordinates: it has a pole within them, and its value is rounding. Evaluates elsewhere.
  bool has_pole(const Problem& problem, const Eigen::VectorXd& q, const Eigen::VectorXd& error,
                std::size_t measure, double value, Workspace& elsewhere);
  // Says why a clearance has no value.
  void explain_unknown_depths(std::vector<MeasureSolution>& out) const;
  // By how much of it a quantity may be wrong by rounding alone, in parts of 1e-16.
  double rounding_size(const MeasuredState& state, std::size_t quantity) const;
  // The same of what a spring or bearing exerts.
  static double elastic_rounding(const MeasuredState& state, const ElasticPlace& elastic, Result result);
  void difference(const Problem& problem, const Eigen::VectorXd& q, Workspace& w);
  const Eigen::VectorXd& combine();
  bool differenced_by_numbers() const;
  // Of one of the numbers, with those along the coordinates that gradient() found.
  Eigen::VectorXd rates_by_number(const Problem& problem, const Mechanism& mechanism, VariedNumbers& numbers,
                                  std::size_t k, const Eigen::VectorXd& q, const Eigen::VectorXd& rate,
                                  Workspace& w);
  // Their rates by a number whose rates are given, and all others with it, while the coordinates stand: exact
  // but for those quantities that take `differences`. After evaluate_at().
  Eigen::VectorXd rates_by(const Problem& problem, const Mechanism& mechanism, const NumberRates& rates,
                           const Eigen::VectorXd& q, const Workspace& w,
                           const std::vector<double>& differences);
  // Of the quantities by the number k: central ones, relative error about 1e-9.
  std::vector<double> differences_by(const Problem& problem, const Mechanism& mechanism,
                                     VariedNumbers& numbers, std::size_t k, const Eigen::VectorXd& q,
                                     Workspace& w);

  MeasurePlan plan_;
  // By quantity.
  std::vector<Place> places_;
  std::vector<QuantityNumbers> numbers_;
  std::vector<BasicQuantityNumbers<Dual>> number_rates_; // workspace
  std::vector<std::string> names_, units_;
  bool needs_forces_ = false, needs_accelerations_ = false, differenced_ = false;
  // Of the last state.
  double largest_force_ = 0;  // N, moments by the mechanism's reach
  std::vector<double> found_; // by quantity
  std::vector<Dual> duals_, combined_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd quantity_rates_, rates_; // (quantities, nv), (measures, nv)
  Eigen::MatrixXd partials_;               // (measures, quantities)
};

} // namespace flyball
