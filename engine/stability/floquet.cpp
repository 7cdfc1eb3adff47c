#include "engine/stability/floquet.hpp"

#include "engine/linear/exponential.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/contraction.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/stability/periodic_motion.hpp"
#include "engine/system/common_period.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>
#include <variant>

namespace flyball {
namespace {

using Complex = std::complex<double>;

constexpr double accuracy = 1e-11;  // of multipliers, relative to the largest
constexpr double nothing_left = 40; // e^-40 of what moves is nothing beside 1, however exact
constexpr int cheap = 32;           // a part of the steps that are reasonable: then multipliers are found

// out = a b - b a
void commute(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& out) {
  out.noalias() = a * b;
  out.noalias() -= b * a;
}

// Speeds of the drives that turn, rad/s; those of slides have no period.
std::vector<double> turning_speeds(const Problem& problem, const Eigen::VectorXd& q) {
  std::vector<double> speeds;
  for (const DrivenCoordinate& d : problem.system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    const Link& link = problem.system.links[l];
    const double speed = std::abs(finds_speed(link) ? q[link.q] : problem.parameters.links[l].speed);
    if (speed == 0 || problem.system.links[l].type != LinkType::revolute) continue;
    if (std::ranges::none_of(speeds, [&](double s) { return std::abs(s - speed) <= same_speed * speed; }))
      speeds.push_back(speed);
  }
  std::ranges::sort(speeds);
  return speeds;
}

// Whether the matrices are the same a period later: other drives may turn without a share in them.
bool repeats(const Problem& problem, const Eigen::VectorXd& q, double period, Workspace& w) {
  return std::ranges::all_of(std::array{0.0, 0.3183, 0.7071}, [&](double part) {
    return same_motion(problem, linear_motion(problem, q, part * period, w),
                       linear_motion(problem, q, (1 + part) * period, w), (1 + part) * period);
  });
}

// Of all drives; else, where they have none or a long one, of as few as do.
std::optional<double> period_of_motion(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  const std::vector<double> speeds = turning_speeds(problem, q);
  if (const auto all = common_period(speeds, usual_turns); all && repeats(problem, q, *all, w)) return all;
  const std::size_t count = std::min<std::size_t>(speeds.size(), 10);
  std::vector<unsigned> subsets;
  for (unsigned set = 1; set < (1u << count); ++set)
    subsets.push_back(set);
  std::ranges::stable_sort(subsets, {}, [](unsigned set) { return std::popcount(set); });
  for (const unsigned set : subsets) {
    std::vector<double> some;
    for (std::size_t i = 0; i < count; ++i)
      if (set >> i & 1u) some.push_back(speeds[i]);
    if (problem.cancelled()) return {};
    if (const auto period = common_period(some, most_turns); period && repeats(problem, q, *period, w))
      return period;
  }
  return {};
}

// Of a period: each multiplies matrices of this size, and all together are to take a second or two.
int most_steps(Eigen::Index size) {
  const double n = static_cast<double>(size);
  return static_cast<int>(std::clamp(0x1p26 / (n * n * n), 32., 0x1p17));
}

struct Monodromy {
  Eigen::MatrixXd matrix;
  double log_scale = 0; // the true one is e^log_scale times as large
};

// A failure: singular where the equations of motion cannot be solved for the accelerations at some phase,
// unresolved where the steps are too long for what moves.
using MonodromyOutcome = std::variant<Monodromy, FloquetFailure>;

MonodromyOutcome monodromy(const PeriodicMotion& motion, int steps, CancelFlag cancel) {
  const double h = motion.period() / steps;
  const double node = std::sqrt(15.) / 10; // of Gauss' rule with three nodes
  Monodromy out{Eigen::MatrixXd::Identity(motion.size(), motion.size()), 0};
  Eigen::MatrixXd a1, a2, a3, b1, b2, b3, c1, c2, c3, sum, omega;
  for (int i = 0; i < steps; ++i) {
    if (cancel && cancel->load(std::memory_order_relaxed)) return FloquetFailure::cancelled;
    const double middle = (i + 0.5) * h;
    if (!motion.state_matrix(middle - node * h, a1) || !motion.state_matrix(middle, a2) ||
        !motion.state_matrix(middle + node * h, a3))
      return FloquetFailure::singular;
    b1 = h * a2;
    b2 = std::sqrt(15.) / 3 * h * (a3 - a1);
    b3 = 10. / 3 * h * (a3 - 2 * a2 + a1);
    // Omega = b1 + b3 / 12 + [-20 b1 - b3 + c1, b2 + c2] / 240, c1 = [b1, b2], c2 = -[b1, 2 b3 + c1] / 60
    commute(b1, b2, c1);
    sum = 2 * b3 + c1;
    commute(b1, sum, c2);
    c2 = b2 - c2 / 60;
    sum = -20 * b1 - b3 + c1;
    commute(sum, c2, c3);
    omega = b1 + b3 / 12 + c3 / 240;
    const auto step = matrix_exponential(omega);
    if (!step) return FloquetFailure::unresolved;
    sum.noalias() = *step * out.matrix;
    out.matrix.swap(sum);
    const double size = out.matrix.cwiseAbs().maxCoeff();
    if (!std::isfinite(size) || size == 0) return FloquetFailure::unresolved;
    if (size > 1e100 || size < 1e-100) {
      out.matrix /= size;
      out.log_scale += std::log(size);
    }
  }
  return out;
}

// Without those that lie at 1 by what is cyclic.
void leave_out_cyclic(const System& system, const Eigen::MatrixXd& basis, std::vector<Complex>& multipliers) {
  const Eigen::Index count =
      cyclic_directions(system, basis, false).cols() + 2 * cyclic_directions(system, basis, true).cols();
  for (Eigen::Index i = 0; i < count && !multipliers.empty(); ++i) {
    const auto nearest =
        std::ranges::min_element(multipliers, {}, [](Complex mu) { return std::abs(mu - 1.); });
    if (std::abs(*nearest - 1.) < tolerance::neutral_multiplier) multipliers.erase(nearest);
  }
}

// The largest distance of a multiplier from the nearest of the coarser ones, relative to the largest of all.
double difference(const std::vector<Complex>& fine, const std::vector<Complex>& coarse) {
  double largest = 0, worst = 0;
  for (const Complex mu : fine)
    largest = std::max(largest, std::abs(mu));
  for (const Complex mu : fine) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Complex other : coarse)
      nearest = std::min(nearest, std::abs(mu - other));
    worst = std::max(worst, nearest);
  }
  return largest > 0 ? worst / largest : 0;
}

} // namespace

std::optional<bool> stable_by_multipliers(std::vector<Complex> counted, double error, int neutral,
                                          bool has_hamiltonian) {
  std::ranges::sort(counted, {}, [](Complex mu) { return std::abs(mu - 1.); });
  auto begin = counted.begin();
  for (int i = 0;
       i < 2 * neutral && begin != counted.end() && std::abs(*begin - 1.) < tolerance::neutral_multiplier;
       ++i)
    ++begin;
  counted.erase(counted.begin(), begin);
  // Multipliers that lie close together are known to the root of what others are.
  const double rounding = tolerance::multiplier + 10 * error;
  bool inside = true, apart = true;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    const double size = std::abs(counted[i]);
    bool close = std::abs(counted[i].imag()) < tolerance::multipliers_meet; // at 1 or -1 a pair meets
    for (std::size_t j = 0; j < counted.size(); ++j)
      close = close || (i != j && std::abs(counted[i] - counted[j]) < tolerance::multipliers_meet);
    const double limit = close ? std::max(tolerance::meeting_multiplier, std::sqrt(10 * error)) : rounding;
    if (size > 1 + limit) return false;
    if (size < 1 - limit) continue;
    inside = false;
    if (close) apart = false;
  }
  if (neutral > 0) return {};
  // Of a Hamiltonian system they are mirrored by the unit circle: on it and apart from each other they cannot
  // leave it, and motions stay as small as they begin (Krein).
  if (inside || (apart && has_hamiltonian)) return true;
  return {};
}

FloquetOutcome find_floquet(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  FloquetOutcome out;
  const auto fail = [&](FloquetFailure failure) {
    out.failure = problem.cancelled() ? FloquetFailure::cancelled : failure;
    return out;
  };
  const auto period = period_of_motion(problem, q, w);
  if (!period) return fail(FloquetFailure::no_period);
  const std::vector<double> speeds = turning_speeds(problem, q);
  const int turns = static_cast<int>(std::ceil(speeds.back() * *period / (2 * std::numbers::pi) - 0.5));
  const auto motion = PeriodicMotion::sample(problem, q, *period, turns, w);
  if (!motion) return fail(FloquetFailure::unresolved);
  if (motion->singular()) return fail(FloquetFailure::singular);
  std::optional<std::vector<Complex>> coarse;
  double previous = std::numeric_limits<double>::infinity();
  // So many that the fastest motion makes no more than about a radian in a step.
  Eigen::MatrixXd drawn;
  if (!motion->state_matrix(0, drawn)) return fail(FloquetFailure::singular);
  const auto rates = eigenvalues(drawn, problem.cancel);
  double fastest = 0, slowest = std::numeric_limits<double>::infinity(), dies = slowest;
  for (const Complex rate : rates.value_or(std::vector<Complex>())) {
    fastest = std::max(fastest, std::abs(rate));
    slowest = std::min(slowest, std::abs(rate));
    dies = std::min(dies, -rate.real());
  }
  const double needed = std::max(8. * std::max(1, turns), fastest * motion->period());
  const int most = most_steps(motion->size());
  if (needed > most / cheap && std::isfinite(dies) && dies * motion->period() > nothing_left)
    if (const auto log = contraction(*motion, fastest, slowest, problem.cancel); log && *log > nothing_left) {
      Floquet result;
      result.period = motion->period();
      result.multipliers.assign(static_cast<std::size_t>(motion->size()), 0);
      result.error = std::exp(-std::min(*log, 690.));
      out.result = std::move(result);
      return out;
    }
  if (!(needed <= most)) return fail(FloquetFailure::unresolved);
  for (int steps = static_cast<int>(needed); steps <= most; steps *= 2) {
    const MonodromyOutcome outcome = monodromy(*motion, steps, problem.cancel);
    const auto* phi = std::get_if<Monodromy>(&outcome);
    if (!phi) return fail(std::get<FloquetFailure>(outcome));
    auto multipliers = eigenvalues(phi->matrix, problem.cancel);
    if (!multipliers) return fail(FloquetFailure::unresolved);
    if (phi->log_scale != 0) {
      // Beyond the range of numbers: only that it grows or dies out, and how fast, is left to tell.
      const double scale = std::exp(std::clamp(phi->log_scale, -690., 300.));
      for (Complex& mu : *multipliers)
        mu *= scale;
    }
    const double change =
        coarse ? difference(*multipliers, *coarse) : std::numeric_limits<double>::infinity();
    // Steps of sixth order: where the differences fall like that, what is left is a part of the last one
    // (Richardson); 64 times less in the limit. Rounding ends the fall of the differences before the accuracy
    // asked for where multipliers lie close together.
    const double left = change < previous / 20 ? change / 20 : change;
    const bool rounding = change < 1e-7 && change > 0.3 * previous;
    if (left <= accuracy || rounding) {
      std::ranges::sort(*multipliers, [](Complex a, Complex b) {
        return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
      });
      if (!problem.system.torques.empty())
        leave_out_cyclic(problem.system, linear_motion(problem, q, 0, w).basis, *multipliers);
      if (multipliers->empty()) return fail(FloquetFailure::unresolved);
      Floquet result;
      result.period = motion->period();
      result.multipliers = std::move(*multipliers);
      result.error = std::max(left, 1e-14) * std::abs(result.multipliers.front());
      for (const Complex mu : result.multipliers)
        if (std::abs(mu) > 1e-12 * std::abs(result.multipliers.front()))
          result.growth.push_back(std::log(std::abs(mu)) / motion->period());
      out.result = std::move(result);
      return out;
    }
    previous = change;
    coarse = std::move(multipliers);
  }
  return fail(FloquetFailure::unresolved);
}

std::vector<Complex> floquet_exponents(const Floquet& floquet) {
  std::vector<Complex> out;
  for (std::size_t i = 0; i < floquet.growth.size(); ++i)
    out.push_back(std::log(floquet.multipliers[i]) / floquet.period);
  std::ranges::sort(out, [](Complex a, Complex b) {
    if (std::abs(a.imag()) != std::abs(b.imag())) return std::abs(a.imag()) < std::abs(b.imag());
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return out;
}

} // namespace flyball
