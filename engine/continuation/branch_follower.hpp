// One branch of equilibria followed from a state to where it ends, with what is met on the way.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/continuation/continuation.hpp"
#include "engine/continuation/pair_crossing.hpp"
#include "engine/report/measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace flyball {

struct FollowedBranch {
  std::vector<ResponsePoint> points;
  std::vector<BranchState> states; // of all points but a crossing that it begins at
  std::vector<std::pair<SpecialPointType, ResponsePoint>> special;
  std::vector<BranchState> crossings; // where another branch leaves; tangent to this one
  double lead = 0;                    // scaled length from a crossing that it begins at to the first state
  std::string end;                    // why it stops
  bool closed = false;                // came back to where it began
  bool drifts = false;                // along directions that nothing, or hardly anything, resists
};

// A valid mechanism with one number changed. Throws SceneError.
Mechanism with_parameter(const Mechanism& mechanism, const std::string& address, double value);

// The configuration given by a point's free coordinates.
Eigen::VectorXd configuration_of(const Problem& problem, const std::vector<CoordinateSolution>& coordinates);

// Where what is driven stands at a point: Parameters::links[].start by link (rad or m).
Eigen::VectorXd starts_of(const Problem& problem, const std::vector<CoordinateSolution>& coordinates);

struct PointDetails {
  bool eigenvalues = true, reactions = false;
  MeasureSet* measures = nullptr; // to be taken; null: none
};

// What there is to say about one steady state, its parameter left out. `error` by coordinate of q_R (rad, m),
// empty where it is not known.
ResponsePoint response_point(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                             const Eigen::VectorXd& error, PointDetails details, Workspace& w);

class BranchFollower {
 public:
  // Compiles for the parameter at `from`. Throws SceneError.
  BranchFollower(const Mechanism& mechanism, const std::string& address, double from, double to,
                 const BranchOptions& options);

  // With the parameter set. Refers to this object, and is good until the parameter is set again.
  Problem problem_at(double parameter);
  // At the state's, with its angles.
  Problem problem_at(const BranchState& state);
  const Mechanism& mechanism() const { return family_.mechanism(); }
  Workspace& workspace() { return w_; }
  bool cancelled() const { return options_.cancel && options_.cancel->load(std::memory_order_relaxed); }

  // The state of a balance that holds at `parameter`, going on with the parameter towards `to` (or back, for
  // `forth` false). Nothing at a singular state that has no single direction.
  std::optional<BranchState> begin(Unknowns z, double parameter, bool forth);
  // The same of one that stands turned (search/phase_search.hpp): from here on states are followed with the
  // angles that are tied so among their unknowns.
  std::optional<BranchState> begin(const TurnedState& state, double parameter, bool forth);

  // From here on states stand as drawn again.
  void untie();
  // From here on branches that come back to the beginning of the range end here.
  void begin_range_at(double parameter) { from_ = parameter; }

  // Whether states were met that belong to families, along which nothing resists, without these being kept
  // still: then folds and crossings were not looked for.
  bool met_drifting() const { return drifting_; }

  FollowedBranch follow(BranchState state, bool tell_progress);

  // A state off a crossing on the other branch, `length` (scaled, either sign) away. Nothing where none is
  // found in the range.
  std::optional<BranchState> off(const BranchState& crossing, double length);

  ResponsePoint point(const BranchState& state);

  // A sentence on what is not looked for in a mechanism this large; empty where all is.
  std::string limits() const;

  // States here and there in the family of a state, itself the first: all there are where it has none.
  std::vector<BranchState> family(const BranchState& state);
  // Whether a state is a point of a branch that was followed, or another of that one's family is.
  bool lies_on(const std::vector<BranchState>& family, const FollowedBranch& branch);
  bool same(const BranchState& a, const BranchState& b);

 private:
  struct Described {
    ResponsePoint point;
    int right = 0; // eigenvalues to the right of the axis
  };
  // Part of a step (scaled arclength from its start) along which the number of eigenvalues to the right of
  // the axis changes.
  struct CrossingBracket {
    double low = 0, high = 0;
    int right_low = 0, right_high = 0;
  };
  // Where the determinant of the bordered balance changes its sign on a step: another branch crosses, or the
  // step leaps to one that passes close by.
  struct Crossing {
    BranchState at;
    double along = 0; // scaled arclength from the step's start
    bool leaps = false;
    std::optional<double> parameter_error{};
  };
  // Where a pair of eigenvalues crosses the axis.
  struct PairPlace {
    SpecialPointType type = SpecialPointType::hopf;
    BranchState at;
    std::optional<double> parameter_error;
  };
  void follow(BranchState state, bool tell_progress, FollowedBranch& out);
  Described describe(const BranchState& state);
  // By coordinate of q_R (rad, m, rad/s, m/s), where speeds are found, of which all digits may be lost: empty
  // where none are.
  Eigen::VectorXd error_of(const Problem& problem, const BranchState& state);
  template <class Value>
  std::pair<BranchState, double> locate(const BranchState& from, double low, double at_low, double high,
                                        double at_high, const BranchState& beyond, Value value);
  // How well the parameter of a state that locate() found is known. Nothing where rounding hides the slope of
  // `value`, or no steps lead past it.
  template <class Value>
  std::optional<double> parameter_error(const BranchState& from, const BranchState& at, double along,
                                        Value value);
  ResponsePoint special_point(const BranchState& at, std::optional<double> parameter_error);
  std::optional<Crossing> find_crossing(const BranchState& state, const BranchState& next, double length);
  // Whether what steps of this length reach is on two branches, not on two sides of a kink.
  bool jumps_aside(const BranchState& state, double along);
  // `crossing`: where it is known already.
  void find_specials(const BranchState& state, const BranchState& next, double length, const Described& now,
                     const Described& then, std::optional<Crossing> crossing, FollowedBranch& out);
  // Where two eigenvalues of K go through zero on one step, as of what hangs on a shaft's axis and may swing
  // out to any side, the determinant keeps its sign: by their number to the left, of which `explained` change
  // anyway. Returns how many of the linearised motion's that explains.
  int find_even_crossings(const BranchState& state, const BranchState& next, double length, int explained,
                          FollowedBranch& out);
  void find_specials_inside(const BranchState& state, const BranchState& beyond, double length,
                            const Described& now, std::optional<Crossing> crossing, FollowedBranch& out);
  Spectrum spectrum(const BranchState& state);
  void find_pair_crossings(const BranchState& state, const BranchState& next, double length, int before,
                           int after, FollowedBranch& out);
  // Halves the bracket to `width`. False where the branch cannot be followed into it.
  bool narrow(const BranchState& state, double width, CrossingBracket& at);
  std::optional<PairPlace> locate_pair_crossing(const BranchState& state, const BranchState& next,
                                                double length, const CrossingBracket& at);
  std::optional<PairPlace> jumping_pair(const BranchState& state, CrossingBracket at);
  // Of a step along which the linearised motion turns with the drives.
  void find_multiplier_crossing(const BranchState& state, const BranchState& next, double length,
                                FollowedBranch& out);
  // The other side of a stop that a state is just before, where the curve has turned round. Nothing where no
  // coordinate comes to its stop.
  std::optional<BranchState> beyond_stop(const BranchState& state);
  void land_on_border(const BranchState& state, double border, FollowedBranch& out);
  bool holds_at_every_phase(const BranchState& state);
  double position(double parameter) const { return (parameter - from_) / (to_ - from_); }
  std::optional<BranchState> begin(BranchState state, bool forth);
  // Continuation's, with what nothing resists kept still.
  bool start(BranchState& state, double way);
  // Whether a little along each of the directions that it keeps still there are others.
  bool is_a_family(const BranchState& state);
  // Of a family the one nearest to `to`, from the nearest of these on.
  BranchState nearest_of_family(const std::vector<BranchState>& family, const BranchState& to);
  // Whether folds and crossings between them are to be told by their determinants.
  static bool comparable(const BranchState& a, const BranchState& b) {
    constexpr double rounding = 1e-9; // beside directions that are kept still
    return !a.drifts && !b.drifts && a.still.cols() == b.still.cols() &&
           (a.still.cols() == 0 || std::max(std::abs(a.determinant), std::abs(b.determinant)) > rounding);
  }
  // Of the angles that are tied, from a to b.
  Eigen::VectorXd angles(const BranchState& a, const BranchState& b) const;
  bool same_place(const BranchState& a, const BranchState& b, double near) const;
  // Scaled step of q_R from a to b, of angles and of the parameter.
  Eigen::VectorXd difference(const BranchState& a, const BranchState& b) const;
  // Of a scaled step; of a speed that is found and has grown beyond its scale, as a share of that.
  double size_of(const BranchState& at, Eigen::VectorXd step) const;

  BranchOptions options_;
  System system_;
  Family family_;
  Continuation continuation_;
  double from_, to_;
  bool drifting_ = false;
  MeasureSet measures_;
  Workspace w_;
};

} // namespace flyball
