#include "engine/search/all_equilibria.hpp"

#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/singular_loops.hpp"

#include <algorithm>
#include <chrono>
#include <random>

namespace flyball {
namespace {

// Seconds that an iteration takes on one core of 2020 or so: evaluating and linearising the balance, and its
// factors in the form of the problem (measured: chains, ladders and nets of 30 to 1000 bodies).
double iteration_cost(const Problem& problem) {
  const System& system = problem.system;
  const double n = system.nv, m = system.rows, links = static_cast<double>(system.links.size());
  const double elements = static_cast<double>(system.springs.size() + system.body_forces.size());
  const auto bodies = static_cast<double>(system.body_link.size());
  if (problem.form == KktForm::tree) return 1e-9 * (600 + 600 * links + 100 * elements);
  if (problem.form == KktForm::sparse) return 1e-9 * (600 + 12000 * bodies + 4000 * elements + 50000 * m);
  return 1e-9 * (600 + 150 * links + 100 * elements + 12 * links * n + 40 * n * n + 1.5 * n * n * n + 60 * m +
                 3 * m * n * (m + n));
}

class Searcher {
 public:
  Searcher(const Problem& problem, const Eigen::VectorXd& drawn, const SearchOptions& options, Workspace& w)
      : p_(problem), drawn_(drawn), options_(options), w_(w), cost_(iteration_cost(problem)) {}

  EquilibriumList run() {
    report_.ranges = search_ranges(p_, drawn_);
    for (const DriveTorqueElement& torque : p_.system.torques)
      if (torque.keeps_momentum && finds_speed(link_of(torque))) kept_.push_back(torque.link);
    take_answer();
    arrive(drawn_);
    deflate_from(drawn_, 8);
    const std::vector<SearchRange> ranges = report_.ranges;
    SearchStarts starts(p_, ranges, options_.seed);
    const bool settled = look_in_ranges(starts, 0.7);
    look_at_all_speeds();
    if (!settled) look_in_ranges(starts, 1);
    combine();
    report_.unseen = unseen();
    note_fastest();
    list_.report = std::move(report_);
    return std::move(list_);
  }

 private:
  static constexpr int closing = 8; // iterations that closing the loops costs, about

  void note_fastest() {
    for (std::size_t i = 0; i < report_.ranges.size(); ++i) {
      const CoordinateInfo& c = p_.system.coordinates[i];
      const SearchRange& range = report_.ranges[i];
      if (std::ranges::find(kept_, c.link) != kept_.end()) continue; // which no range bounds
      const double most = std::max(std::abs(range.lower), std::abs(range.upper));
      if (!finds_speed(p_.system.links[static_cast<std::size_t>(c.link)]) || most <= report_.fastest)
        continue;
      report_.fastest = most;
      report_.fastest_turns = c.angle;
    }
  }

  const Link& link_of(const DriveTorqueElement& torque) const {
    return p_.system.links[static_cast<std::size_t>(torque.link)];
  }

  // The speeds at which drives have the momentum that they keep, the rest standing as in `q`: the rows of the
  // balance, in which they are linear, vanish.
  void set_kept_speeds(Eigen::VectorXd& q) {
    const auto count = static_cast<Eigen::Index>(kept_.size());
    if (count == 0) return;
    const auto link = [&](Eigen::Index i) -> const Link& {
      return p_.system.links[static_cast<std::size_t>(kept_[static_cast<std::size_t>(i)])];
    };
    Unknowns z{q, Eigen::VectorXd::Zero(p_.system.rows)};
    Eigen::VectorXd left(count), there(count);
    const auto evaluate_into = [&](Eigen::VectorXd& rows) {
      evaluate(p_, z, 0, w_);
      for (Eigen::Index i = 0; i < count; ++i)
        rows[i] = w_.residual.f[link(i).v];
    };
    for (Eigen::Index i = 0; i < count; ++i)
      z.q[link(i).q] = 0;
    evaluate_into(left);
    Eigen::MatrixXd inertia(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      z.q[link(i).q] = p_.scaling.column[link(i).v];
      evaluate_into(there);
      z.q[link(i).q] = 0;
      inertia.col(i) = there - left;
    }
    const auto speeds = least_squares(inertia, -left);
    if (!speeds || !speeds->allFinite()) return;
    for (Eigen::Index i = 0; i < count; ++i)
      q[link(i).q] = (*speeds)[i] * p_.scaling.column[link(i).v];
    reach_kept_speeds(q);
  }

  // They follow from where the rest stands: no range bounds them.
  void reach_kept_speeds(const Eigen::VectorXd& q) {
    for (std::size_t i = 0; i < report_.ranges.size() && !kept_.empty(); ++i) {
      const int l = p_.system.coordinates[i].link;
      if (std::ranges::find(kept_, l) == kept_.end()) continue;
      const double speed = q[p_.system.links[static_cast<std::size_t>(l)].q];
      SearchRange& range = report_.ranges[i];
      range = {std::min(range.lower, speed), std::max(range.upper, speed)};
    }
  }

  // Until nothing more is to be expected there, or this share of the budget is spent: false.
  bool look_in_ranges(SearchStarts& starts, double share) {
    Eigen::VectorXd q = drawn_;
    while (p_.system.nv > 0 && spent_ < share * options_.seconds && !ended()) {
      if (settled()) {
        if (deflated_from_ == list_.states.size()) return true;
        deflate_from(Eigen::VectorXd(list_.states[deflated_from_++].q), 8);
        continue;
      }
      starts.next(q);
      ++spread_;
      spend(closing + static_cast<double>(kept_.size()));
      if (assemble(p_, q, 0, w_)) {
        set_kept_speeds(q);
        if (arrive(q)) ++report_.arrivals;
        deflate_from(q, 2);
      }
      if (list_.states.size() > 1 && !ended()) arrive_from_mixture();
      if (list_.states.size() >= 2 * combined_) combine();
    }
    return false;
  }

  // Laws of torques have states at any speed: far from where they begin, of every order of magnitude, until
  // as many starts as tell what the ranges hold find nothing more, or so many that there is no end of them.
  void look_at_all_speeds() {
    constexpr double times = 1000;
    const bool none = list_.states.empty();
    if (kept_.size() == p_.system.torques.size()) return;
    if (ended() || !widen_speeds(p_, times, report_.ranges)) return;
    most_ = list_.states.size() + 50;
    SearchStarts starts(p_, report_.ranges, options_.seed);
    Eigen::VectorXd q = drawn_;
    const int enough = (none ? 10 : 2) * least_arrivals(); // of either way
    std::size_t known = list_.states.size();
    for (int vain = 0; vain < enough && known < most_ && !ended(); ++vain) {
      starts.next(q);
      spend(closing + static_cast<double>(kept_.size()));
      if (!assemble(p_, q, 0, w_)) continue;
      set_kept_speeds(q);
      if (arrive(q)) ++report_.arrivals;
      deflate_from(q, 1);
      if (list_.states.size() == known) continue;
      known = list_.states.size();
      vain = 0;
    }
    while (deflated_from_ < list_.states.size() && list_.states.size() < most_ && !ended())
      deflate_from(Eigen::VectorXd(list_.states[deflated_from_++].q), 8);
  }

  int least_arrivals() const { return 20 + 10 * p_.system.nv; }

  // What comparing a state with all that are known costs, in iterations.
  double comparing() const {
    return 1e-8 * static_cast<double>(list_.states.size()) * (1 + 0.5 * p_.system.nv) / cost_;
  }

  void spend(double iterations) { spent_ += iterations * cost_; }

  // Whether to stop short, and why.
  bool ended() {
    report_progress(options_.progress, "searching", std::min(1., spent_ / options_.seconds));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin_;
    if (p_.cancelled())
      report_.end = SearchEnd::cancelled;
    else if (options_.starts > 0 && report_.starts >= options_.starts)
      report_.end = SearchEnd::starts;
    else if (spent_ >= options_.seconds)
      report_.end = SearchEnd::budget;
    else if (taken.count() > 20 * options_.seconds + 5)
      report_.end = SearchEnd::time;
    else
      return false;
    return true;
  }

  double unseen() const {
    const auto found = static_cast<double>(list_.states.size()), n = static_cast<double>(report_.arrivals);
    if (p_.system.nv == 0) return 0;
    return n > found + 2 ? found * (found + 1) / (n - found - 2) : std::numeric_limits<double>::infinity();
  }

  bool settled() const {
    if (report_.arrivals == 0) return spread_ >= 10 * least_arrivals();
    return report_.arrivals >= least_arrivals() && unseen() <= options_.unseen;
  }

  // What solving answers belongs to the list: the ranges reach as far.
  void take_answer() {
    Found found;
    std::vector<double> history;
    find_equilibrium(p_, drawn_, false, false, w_, history, found);
    spend(found.iterations);
    if (found.status != Status::converged) return;
    ++report_.starts;
    include(p_, found.z.q, report_.ranges);
    keep(std::move(found.z), found.newton);
  }

  // The equilibrium that a run arrived at, evaluated last, if it is one that is looked for: known or new.
  bool keep(Unknowns z, NewtonOutcome outcome) {
    if (!same_assembly_mode(p_, w_.kinematics) || passes_singular_loops(p_, z, w_)) return false;
    reach_kept_speeds(z.q);
    const Placement placement = bring_within(p_, report_.ranges, z.q);
    if (placement == Placement::outside) return false;
    if (placement == Placement::turned) {
      outcome = newton(p_, z, w_, {}, nullptr);
      spend(outcome.iterations);
      if (!outcome.converged || !same_assembly_mode(p_, w_.kinematics) ||
          bring_within(p_, report_.ranges, z.q) != Placement::within)
        return false;
    }
    const double near = uncertainty(outcome);
    Family family;
    family.known = false;
    for (std::size_t i = 0; i < list_.states.size(); ++i) {
      const Unknowns& other = list_.states[i];
      if (same_but_for_turns(p_, other.q, z.q, std::max(near, families_[i].near))) return true;
      if (families_[i].neutral.empty()) continue;
      if (!family.known) family = family_of(z, outcome);
      if (family.neutral == families_[i].neutral &&
          same_potential(family.potential, families_[i].potential) &&
          same_pose(p_, other.q, z.q, tolerance::same_state, family.neutral))
        return true;
    }
    if (!family.known) family = family_of(z, outcome);
    family.near = near;
    list_.states.push_back(std::move(z));
    list_.outcomes.push_back(outcome);
    families_.push_back(std::move(family));
    return true;
  }

  // How far (scaled) from the state that a run arrived at the same root may be found another time. A root of
  // higher order is known to half of the digits; so is one beside a singular pose of the loops, where
  // rounding makes one more row count. Of large loops that pose is not known.
  double uncertainty(const NewtonOutcome& outcome) const {
    constexpr double half = 1e-4, singular_pose = 1e-3;
    if (const DenseKkt* matrices = w_.matrices(p_)) {
      const double pivot = matrices->constraints().least_pivot();
      if (pivot < singular_pose) return std::max(half, 10 * pivot);
    }
    return outcome.linear ? half : tolerance::same_state;
  }

  // The coordinates that take part in directions without stiffness, and the amended potential: along a family
  // it stays the same.
  struct Family {
    bool known = true;
    double near = tolerance::same_state; // scaled: how far away another state is still this one
    std::vector<int> neutral;
    Potential potential;
  };

  Family family_of(Unknowns& z, const NewtonOutcome& outcome) {
    Family out;
    evaluate(p_, z, 0, w_);
    if (p_.system.conservative)
      out.potential = amended_potential(p_.system, p_.parameters, z.q, w_.kinematics);
    factor(p_, z, w_);
    KktSystem& kkt = w_.kkt(p_);
    if (outcome.linear || !kkt.known() || !kkt.singular()) return out;
    Eigen::VectorXd direction, share = Eigen::VectorXd::Zero(p_.system.nv);
    for (const KktSystem::NullDirection& null : kkt.null_directions()) {
      kkt.direction_of(null, direction);
      if (const double size = largest_size(direction); size > 0)
        share = share.cwiseMax(direction.cwiseAbs() / size);
    }
    for (int v = 0; v < p_.system.nv; ++v)
      if (share[v] > 1e-6) out.neutral.push_back(v);
    return out;
  }

  // Runs plainly, then damped. True where that leads to an equilibrium in the ranges.
  bool arrive(const Eigen::VectorXd& from) {
    ++report_.starts;
    Unknowns z{from, Eigen::VectorXd::Zero(p_.system.rows)};
    NewtonOutcome outcome = newton(p_, z, w_, {}, nullptr);
    spend(outcome.iterations);
    if (outcome.converged) return keep(std::move(z), outcome);
    z = {from, Eigen::VectorXd::Zero(p_.system.rows)};
    outcome = newton(p_, z, w_, {100, true}, nullptr);
    spend(2 * outcome.iterations);
    return outcome.converged && keep(std::move(z), outcome);
  }

  // From two equilibria mixed joint by joint: where branches of the tree feel little of each other any such
  // mixture is close to another.
  void arrive_from_mixture() {
    const auto any = [&](std::size_t count) { return static_cast<std::size_t>(random_()) % count; };
    const Eigen::VectorXd& other = list_.states[any(list_.states.size())].q;
    Eigen::VectorXd q = list_.states[any(list_.states.size())].q;
    for (const TreeJoint& joint : p_.system.tree_joints) {
      if (any(2) == 0) continue;
      for (int l = joint.first_link; l < joint.first_link + joint.link_count; ++l)
        take_link(other, p_.system.links[static_cast<std::size_t>(l)], q);
    }
    arrive_from_parts(std::move(q));
  }

  static void take_link(const Eigen::VectorXd& from, const Link& link, Eigen::VectorXd& q) {
    if (link.v < 0) return;
    const int entries = link.type == LinkType::spherical ? 4 : 1;
    q.segment(link.q, entries) = from.segment(link.q, entries);
  }

  // From what is put together of equilibria.
  void arrive_from_parts(Eigen::VectorXd q) {
    spend(p_.system.rows > 0 ? closing : 0);
    if (!assemble(p_, q, 0, w_)) return;
    ++report_.starts;
    Unknowns z{std::move(q), Eigen::VectorXd::Zero(p_.system.rows)};
    const NewtonOutcome outcome = newton(p_, z, w_, {}, nullptr);
    spend(outcome.iterations);
    if (outcome.converged) keep(std::move(z), outcome);
  }

  bool is_known(const Eigen::VectorXd& q) {
    spend(comparing());
    return std::ranges::any_of(list_.states, [&](const Unknowns& known) {
      return same_but_for_turns(p_, known.q, q, tolerance::same_state);
    });
  }

  // From what is put together of the equilibria known, each once, as long as that finds new ones: for at most
  // half of what the rest of the search has taken.
  void combine() {
    const double begin = spent_;
    combine_until_ = begin + std::max(0., 0.5 * (begin - combining_) - combining_);
    for (std::size_t known = 0; known < list_.states.size() && list_.states.size() > 1 && combines();) {
      known = list_.states.size();
      look_between();
      exchange_branches();
    }
    combined_ = list_.states.size();
    combining_ += spent_ - begin;
  }

  bool many() const { return list_.states.size() >= most_; }
  bool combines() const { return spent_ < combine_until_ && !many(); }

  // Halfway to the nearest neighbour along each coordinate: of three speeds at which a shaft may run few
  // starts lead to the one between, at which it runs away.
  void look_between() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto count = static_cast<std::size_t>(p_.system.nv);
    for (; between_ < list_.states.size() && combines() && !ended(); ++between_) {
      const std::size_t i = between_;
      std::vector<double> nearest(count, infinity);
      std::vector<Eigen::VectorXd> way(count);
      spend(comparing());
      for (std::size_t j = 0; j < list_.states.size(); ++j) {
        difference_.take(list_.states[i].q, list_.states[j].q, away_);
        Eigen::Index most = 0;
        const double distance = away_.maxCoeff(&most);
        const auto v = static_cast<std::size_t>(most);
        if (j == i || !(distance >= -away_.minCoeff()) || !(distance < nearest[v])) continue;
        nearest[v] = distance;
        way[v] = away_;
      }
      for (std::size_t v = 0; v < count && !ended(); ++v) {
        if (nearest[v] == infinity) continue;
        Eigen::VectorXd q = list_.states[i].q;
        w_.step = 0.5 * way[v].cwiseProduct(p_.scaling.column);
        retract<double>(p_.system, w_.step, q);
        spend(p_.system.rows > 0 ? closing : 0);
        if (!assemble(p_, q, 0, w_)) continue;
        const std::size_t before = list_.states.size();
        arrive(q);
        if (list_.states.size() == before) deflate_from(q, 1);
      }
    }
  }

  // From every two with what a joint carries of one put into the other, until that has found nothing for
  // long: where what the joints of the ground carry feels nothing of each other all such combinations are
  // equilibria.
  void exchange_branches() {
    int vain = 0;
    const auto done = [&] { return vain >= least_arrivals() || !combines() || ended(); };
    for (; exchanged_ < list_.states.size() && !done(); ++exchanged_)
      for (std::size_t k = 0; k < 2 * exchanged_ && !done(); ++k)
        for (const TreeJoint& joint : p_.system.tree_joints) {
          const std::size_t other = k / 2, into = k % 2 == 0 ? exchanged_ : other;
          Eigen::VectorXd q = list_.states[into].q;
          take_branch(list_.states[into == other ? exchanged_ : other].q, joint, q);
          if (is_known(q)) continue;
          const std::size_t before = list_.states.size();
          arrive_from_parts(std::move(q));
          vain = list_.states.size() > before ? 0 : vain + 1;
          if (done()) return;
        }
  }

  // Of a joint and what it carries.
  void take_branch(const Eigen::VectorXd& from, const TreeJoint& joint, Eigen::VectorXd& q) const {
    const auto first = static_cast<std::size_t>(joint.first_link);
    std::vector<char> carried(p_.system.links.size());
    for (std::size_t l = first; l < carried.size(); ++l) {
      const Link& link = p_.system.links[l];
      carried[l] = link.tree_joint == p_.system.links[first].tree_joint ||
                   (link.parent >= 0 && carried[static_cast<std::size_t>(link.parent)] != 0);
      if (carried[l]) take_link(from, link, q);
    }
  }

  // Deflated runs as long as they find new equilibria, at most `most`.
  void deflate_from(const Eigen::VectorXd& from, int most) {
    for (int i = 0; i < most && !list_.states.empty() && !ended(); ++i) {
      ++report_.starts;
      Unknowns z{from, Eigen::VectorXd::Zero(p_.system.rows)};
      if (std::ranges::any_of(list_.states,
                              [&](const Unknowns& known) { return same_pose(p_, known.q, from, 1e-9); })) {
        w_.step = 0.01 * p_.scaling.column;
        retract<double>(p_.system, w_.step, z.q);
      }
      const std::size_t before = list_.states.size();
      if (deflated_newton(z)) {
        const NewtonOutcome outcome = newton(p_, z, w_, {}, nullptr);
        spend(outcome.iterations);
        if (outcome.converged) keep(std::move(z), outcome);
      }
      if (list_.states.size() == before) return;
    }
  }

  // The derivative of the logarithm of the deflation operator prod_i (1 + 1 / |x - r_i|^2), the r_i being the
  // equilibria known, along a scaled step.
  double deflation_slope(const Eigen::VectorXd& q, const Eigen::VectorXd& scaled_step) {
    double slope = 0;
    for (const Unknowns& known : list_.states) {
      difference_.take(known.q, q, away_);
      const double square = std::max(away_.squaredNorm(), 1e-30);
      slope -= 2 * away_.dot(scaled_step) / (square * (1 + square));
    }
    return slope;
  }

  // Newton-Raphson on the balance times the deflation operator: the same direction, another length (Farrell
  // et al., section 3.2). True where it came near an equilibrium that is not known.
  bool deflated_newton(Unknowns& z) {
    for (int i = 0; i < 60; ++i) {
      spend(1 + comparing());
      evaluate(p_, z, 0, w_);
      if (!std::isfinite(scaled_residual(p_, w_))) return false;
      factor(p_, z, w_);
      if (!w_.kkt(p_).known()) return false;
      const bool whole = w_.matrices(p_) != nullptr; // those of redundant rows are then of this state alone
      find_step(p_, whole, z, w_);
      const double size = largest_size(w_.scaled_step);
      if (!std::isfinite(size) || size == 0) return false;
      const double slope = deflation_slope(z.q, w_.scaled_step);
      double length = 1 / (1 - slope);
      if (!std::isfinite(length)) return false;
      length = std::clamp(length, -2., 2.);
      length *= std::min(1., 1.5 / (std::abs(length) * size));
      w_.step = length * w_.scaled_step.cwiseProduct(p_.scaling.column);
      retract<double>(p_.system, w_.step, z.q);
      if (size < 1e-3 && std::abs(slope) < 0.3) return true; // plain Newton-Raphson finishes
    }
    return false;
  }

  const Problem& p_;
  const Eigen::VectorXd& drawn_;
  const SearchOptions& options_;
  Workspace& w_;
  const double cost_; // s, of an iteration
  const ScaledDifference difference_{p_};
  Eigen::VectorXd away_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double spent_ = 0;                                           // s
  int spread_ = 0;                                             // starts
  double combining_ = 0, combine_until_ = 0;                   // s, of what is spent
  std::size_t deflated_from_ = 0, combined_ = 1;               // states
  std::size_t between_ = 0, exchanged_ = 1;                    // states that combine() is done with
  std::size_t most_ = std::numeric_limits<std::size_t>::max(); // of which there may be no end
  std::mt19937 random_{options_.seed};
  SearchReport report_;
  EquilibriumList list_;
  std::vector<Family> families_; // by state of the list
  std::vector<int> kept_;        // links whose drives keep a momentum
};

} // namespace

EquilibriumList find_all_equilibria(const Problem& problem, const Eigen::VectorXd& drawn,
                                    const SearchOptions& options, Workspace& w) {
  return Searcher(problem, drawn, options, w).run();
}

} // namespace flyball
