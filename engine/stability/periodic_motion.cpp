#include "engine/stability/periodic_motion.hpp"

#include "engine/linear/exponential.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/linear_motion.hpp"

#include <algorithm>
#include <complex>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr int most_samples = 4096;
constexpr double series_accuracy = 1e-11; // of the matrices between the samples
constexpr double nothing = 1e-12;         // relative: no mass, no damping

double angle(Eigen::Index j, Eigen::Index count) {
  return 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(count);
}

// Coefficients of the trigonometric polynomial through equidistant samples, one a column: (size, 2 h + 1),
// with h harmonics, as many as an odd number of samples tells.
Eigen::MatrixXd fourier(const Eigen::MatrixXd& samples) {
  const Eigen::Index count = samples.cols(), harmonics = (count - 1) / 2;
  Eigen::MatrixXd waves(count, 2 * harmonics + 1);
  for (Eigen::Index j = 0; j < count; ++j) {
    waves(j, 0) = 1. / static_cast<double>(count);
    for (Eigen::Index h = 1; h <= harmonics; ++h) {
      const double x = angle(h * j % count, count);
      waves(j, 2 * h - 1) = 2 * std::cos(x) / static_cast<double>(count);
      waves(j, 2 * h) = 2 * std::sin(x) / static_cast<double>(count);
    }
  }
  return samples * waves;
}

// The waves of a series at the phase x (rad), differentiated `order` times with respect to x.
Eigen::VectorXd waves_at(double x, Eigen::Index columns, int order = 0) {
  Eigen::VectorXd out(columns);
  out[0] = order == 0 ? 1 : 0;
  const std::complex<double> once = std::polar(1., x), quarter(0, 1);
  std::complex<double> turned = 1; // exp(i h x): products cost less than sines, and this is the inner loop
  for (Eigen::Index h = 1; 2 * h < columns; ++h) {
    turned *= once;
    std::complex<double> wave = turned;
    for (int d = 0; d < order; ++d)
      wave *= quarter * static_cast<double>(h);
    out[2 * h - 1] = wave.real();
    out[2 * h] = wave.imag();
  }
  return out;
}

Eigen::MatrixXd wrap(const Eigen::VectorXd& entries, Eigen::Index rows, Eigen::Index columns) {
  return entries.reshaped(rows, columns);
}

// The orthonormal columns of `basis` mixed so that they lie as near as they can to those of `reference`: by
// the polar factor of N^T N_ref (Golub and Van Loan, section 6.4.1). Nothing where some direction lies
// further than 60 degrees from all of the reference.
std::optional<Eigen::MatrixXd> beside(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& reference) {
  if (basis.rows() == basis.cols()) return basis; // no constraints: both are the identity
  const auto svd = singular_vectors(basis.transpose() * reference);
  if (!svd || !(svd->values.minCoeff() > 0.5)) return {};
  return Eigen::MatrixXd(basis * (svd->left * svd->right.transpose()));
}

// Each basis beside the one before: parallel transport along the samples, so that directions turn no more
// than the null space makes them. False where samples lie too far apart for it.
bool transport_bases(std::vector<LinearMotion>& motions) {
  for (std::size_t j = 1; j < motions.size(); ++j) {
    auto basis = beside(motions[j].basis, motions[j - 1].basis);
    if (!basis) return false;
    motions[j].basis = std::move(*basis);
  }
  return true;
}

} // namespace

std::optional<PeriodicMotion> PeriodicMotion::sample(const Problem& problem, const Eigen::VectorXd& q,
                                                     double period, int turns, Workspace& w) {
  double previous = std::numeric_limits<double>::infinity();
  for (Eigen::Index count = 8 * std::max(1, turns) + 1; count <= most_samples; count = 2 * count + 1) {
    std::vector<LinearMotion> motions;
    for (Eigen::Index j = 0; j < count; ++j) {
      if (problem.cancelled()) return {};
      motions.push_back(
          linear_motion(problem, q, period * static_cast<double>(j) / static_cast<double>(count), w));
    }
    const Eigen::Index n = motions.front().basis.rows(), k = motions.front().basis.cols(), square = k * k;
    if (k == 0 || std::ranges::any_of(motions, [&](const LinearMotion& m) { return m.basis.cols() != k; }))
      return {};
    if (!transport_bases(motions)) continue;
    const auto turned = beside(motions.front().basis, motions.back().basis);
    if (!turned) continue;
    const auto rotation = rotation_logarithm(motions.front().basis.transpose() * *turned);
    // A basis that comes back as its mirror image has come back after as long again.
    if (!rotation) return sample(problem, q, 2 * period, 2 * turns, w);
    Eigen::MatrixXd bases(n * k, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto back = matrix_exponential(-static_cast<double>(j) / static_cast<double>(count) * *rotation);
      if (!back) return {};
      bases.col(j) = (motions[static_cast<std::size_t>(j)].basis * *back).reshaped();
    }
    PeriodicMotion out;
    out.period_ = period;
    out.k_ = k;
    const Eigen::MatrixXd basis_series = fourier(bases);
    const double rate = 2 * std::numbers::pi / period;
    // Of what linear_motion() gives at a phase x with the basis' derivatives there.
    const auto reduced = [&](const LinearMotion& m, const Eigen::MatrixXd& basis, double x) {
      const Eigen::MatrixXd first = rate * wrap(basis_series * waves_at(x, count, 1), n, k);
      const Eigen::MatrixXd second = rate * rate * wrap(basis_series * waves_at(x, count, 2), n, k);
      return Matrices{basis.transpose() * m.mass * basis,
                      basis.transpose() * (2 * m.mass * first + m.velocity * basis),
                      basis.transpose() * (m.mass * second + m.velocity * first + m.stiffness * basis)};
    };
    std::vector<Matrices> samples;
    Eigen::MatrixXd entries(3 * square, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      samples.push_back(
          reduced(motions[static_cast<std::size_t>(j)], wrap(bases.col(j), n, k), angle(j, count)));
      entries.col(j) << samples.back().mass.reshaped(), samples.back().velocity.reshaped(),
          samples.back().stiffness.reshaped();
    }
    if (!entries.allFinite()) return {};
    out.series_ = fourier(entries);
    // Between samples, where a series that ends too early is furthest off.
    double worst = 0; // relative
    const auto block_size = [&](Eigen::Index block) {
      return entries.middleRows(block * square, square).cwiseAbs().maxCoeff();
    };
    // What is smaller than a rate of the drives times the block before is not felt in a period.
    const double mass_size = block_size(0), velocity_size = std::max(block_size(1), rate * mass_size),
                 stiffness_size = std::max(block_size(2), rate * velocity_size);
    for (const double part : {0.137, 0.4219, 0.8631}) {
      const Eigen::Index j = static_cast<Eigen::Index>(part * static_cast<double>(count));
      const double x = angle(2 * j + 1, 2 * count);
      const LinearMotion m = linear_motion(problem, q, period * x / (2 * std::numbers::pi), w);
      if (m.basis.cols() != k) return {};
      const Eigen::MatrixXd between = wrap(basis_series * waves_at(x, count), n, k),
                            basis = m.basis * (m.basis.transpose() * between);
      const Matrices there = reduced(m, basis, x), series = out.at(period * x / (2 * std::numbers::pi));
      const double basis_error = (between - basis).cwiseAbs().maxCoeff();
      const auto compare = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double size) {
        const double difference = (a - b).cwiseAbs().maxCoeff();
        if (difference > 0) worst = std::max(worst, difference / size);
      };
      worst = std::max(worst, basis_error);
      compare(series.mass, there.mass, mass_size);
      compare(series.velocity, there.velocity, velocity_size);
      compare(series.stiffness, there.stiffness, stiffness_size);
    }
    // Where large terms cancel, rounding is what is left before the accuracy asked for.
    const bool rounding = worst < 1e-7 && worst > 0.3 * previous;
    if (worst <= series_accuracy || rounding) {
      out.singular_ = !out.sort_directions(samples);
      if (!out.singular_) out.expand_state_matrix();
      return out;
    }
    previous = worst;
  }
  return {};
}

PeriodicMotion::Matrices PeriodicMotion::at(double t) const {
  const Eigen::VectorXd entries = series_ * waves_at(2 * std::numbers::pi * t / period_, series_.cols());
  const Eigen::Index square = k_ * k_;
  return {wrap(entries.head(square), k_, k_), wrap(entries.segment(square, square), k_, k_),
          wrap(entries.tail(square), k_, k_)};
}

// Directions that have mass at every phase, those without mass that are damped, and those without either.
// What feels no force at all is left out.
bool PeriodicMotion::sort_directions(const std::vector<Matrices>& samples) {
  Matrices sum{Eigen::MatrixXd::Zero(k_, k_), Eigen::MatrixXd::Zero(k_, k_), Eigen::MatrixXd::Zero(k_, k_)};
  for (const Matrices& m : samples) {
    sum.mass += (m.mass + m.mass.transpose()) / 2;
    sum.velocity += m.velocity.transpose() * m.velocity + m.velocity * m.velocity.transpose();
    sum.stiffness += m.stiffness.transpose() * m.stiffness + m.stiffness * m.stiffness.transpose();
  }
  const double count = static_cast<double>(samples.size());
  const double mass = sum.mass.norm() / count, damping = std::sqrt(sum.velocity.norm() / count),
               stiffness = std::sqrt(sum.stiffness.norm() / count);
  rate_ = mass > 0 && stiffness > 0 ? std::sqrt(stiffness / mass) : 2 * std::numbers::pi / period_;
  SymmetricEigen eigen;
  if (!eigen.compute(sum.mass)) return false;
  Eigen::Index without = 0;
  while (without < k_ && !(eigen.values()[without] > nothing * eigen.values()[k_ - 1]))
    ++without;
  massive_ = eigen.vectors().rightCols(k_ - without);
  Eigen::MatrixXd rest = eigen.vectors().leftCols(without);
  // Of the columns of `rest` those that the form feels, by more than `limit`; the others stay.
  const auto split = [&](const Eigen::MatrixXd& form, double limit, Eigen::MatrixXd& felt) {
    felt.resize(k_, 0);
    if (rest.cols() == 0) return true;
    SymmetricEigen shape;
    if (!shape.compute(rest.transpose() * form * rest)) return false;
    Eigen::Index none = 0;
    while (none < rest.cols() && !(shape.values()[none] > limit))
      ++none;
    felt = rest * shape.vectors().rightCols(rest.cols() - none);
    rest = (rest * shape.vectors().leftCols(none)).eval();
    return true;
  };
  const auto square = [](double x) { return x * x; };
  return split(sum.velocity, count * square(nothing * std::max(damping, stiffness / rate_)), damped_) &&
         split(sum.stiffness, count * square(nothing * stiffness), standing_) && size() > 0;
}

bool PeriodicMotion::state_matrix(double t, Eigen::MatrixXd& a) const {
  if (state_series_.size() == 0) {
    const auto inverted = invert(t);
    if (inverted) a = *inverted;
    return inverted.has_value();
  }
  a.resize(size(), size());
  a.reshaped().noalias() = state_series_ * waves_at(2 * std::numbers::pi * t / period_, state_series_.cols());
  return true;
}

// Steps along the period take A thousands of times: a series of its own spares them the inverses.
void PeriodicMotion::expand_state_matrix() {
  constexpr Eigen::Index most = 257;
  for (Eigen::Index count = series_.cols(); count <= most; count = 2 * count + 1) {
    Eigen::MatrixXd entries(size() * size(), count);
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto a = invert(period_ * static_cast<double>(j) / static_cast<double>(count));
      if (!a) return;
      entries.col(j) = a->reshaped();
    }
    state_series_ = fourier(entries);
    double worst = 0;
    for (const double part : {0.137, 0.4219, 0.8631}) {
      Eigen::MatrixXd series;
      const double t =
          period_ * (std::floor(part * static_cast<double>(count)) + 0.5) / static_cast<double>(count);
      const auto a = invert(t);
      if (!a || !state_matrix(t, series)) break;
      worst = std::max(worst, (series - *a).cwiseAbs().maxCoeff());
    }
    if (worst <= series_accuracy * entries.cwiseAbs().maxCoeff()) return;
  }
  state_series_.resize(0, 0);
}

std::optional<Eigen::MatrixXd> PeriodicMotion::invert(double t) const {
  const Matrices m = at(t);
  const Eigen::Index r = massive_.cols(), d = damped_.cols();
  Eigen::MatrixXd moving(k_, r + d);
  moving << massive_, damped_;
  Eigen::MatrixXd stiffness = moving.transpose() * m.stiffness * moving;
  if (standing_.cols() > 0) { // K_ab - K_as K_ss^-1 K_sb
    Lu standing;
    if (!standing.compute(standing_.transpose() * m.stiffness * standing_)) return {};
    const Eigen::MatrixXd across = standing_.transpose() * m.stiffness * moving;
    Eigen::MatrixXd follows(standing_.cols(), r + d);
    for (Eigen::Index c = 0; c < r + d; ++c)
      follows.col(c) = standing.solve(across.col(c));
    stiffness -= moving.transpose() * m.stiffness * standing_ * follows;
  }
  const Eigen::MatrixXd velocity = moving.transpose() * m.velocity * moving;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size(), size());
  // p_d' = -D_dd^-1 (D_dr v + K_dr p_r + K_dd p_d)
  Eigen::MatrixXd damped_rate(d, size());
  if (d > 0) {
    Lu damping;
    if (!damping.compute(velocity.bottomRightCorner(d, d))) return {};
    Eigen::MatrixXd right(d, size());
    right << stiffness.bottomLeftCorner(d, r), rate_ * velocity.bottomLeftCorner(d, r),
        stiffness.bottomRightCorner(d, d);
    for (Eigen::Index c = 0; c < size(); ++c)
      damped_rate.col(c) = -damping.solve(right.col(c));
    a.bottomRows(d) = damped_rate;
  }
  if (r == 0) return a;
  // M_rr v' = -(D_rr v + D_rd p_d' + K_rr p_r + K_rd p_d)
  Cholesky mass;
  const Eigen::MatrixXd heavy = massive_.transpose() * m.mass * massive_;
  if (!mass.compute((heavy + heavy.transpose()) / 2)) return {};
  Eigen::MatrixXd force(r, size());
  force << stiffness.topLeftCorner(r, r), rate_ * velocity.topLeftCorner(r, r),
      stiffness.topRightCorner(r, d);
  if (d > 0) force += velocity.topRightCorner(r, d) * damped_rate;
  a.block(0, r, r, r).diagonal().setConstant(rate_);
  a.middleRows(r, r) = -mass.solve(force) / rate_;
  return a;
}

} // namespace flyball
