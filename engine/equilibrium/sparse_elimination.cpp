#include "engine/equilibrium/sparse_elimination.hpp"

#include "engine/system/coordinate_pattern.hpp"

namespace flyball {
namespace {

// A point mass that may turn feels nothing of it, but the terms of its balance cancel with rounding only,
// which nothing is there to drown. `force` is the size of those terms.
void clear_rounding(Eigen::SparseMatrix<double>& m, int i, double force) {
  using It = Eigen::SparseMatrix<double>::InnerIterator;
  const Entries entries(m);
  for (It it(m, i); it; ++it)
    if (std::abs(it.value()) > force || std::abs(entries(i, it.row())) > force) return;
  for (It it(m, i); it; ++it)
    it.valueRef() = entries(i, it.row()) = 0;
}

} // namespace

void SparseElimination::take_pattern(const System& system) {
  const std::size_t hash = pattern_hash(system);
  if (hash == pattern_ && stiffness_.rows() == system.nv) return;
  pattern_ = hash;
  analysed_ = false;
  std::vector<Eigen::Triplet<double>> places;
  for_coordinate_pairs(system, [&](int i, int j) { places.emplace_back(i, j, 0.); });
  stiffness_.resize(system.nv, system.nv);
  stiffness_.setFromTriplets(places.begin(), places.end());
  stiffness_.makeCompressed();
  metric_ = sum_ = stiffness_;
}

void SparseElimination::linearize(const Problem& problem, const Eigen::VectorXd& q,
                                  const Kinematics<double>& k, const Residual<double>& residual,
                                  const Magnitudes& magnitudes) {
  const System& system = problem.system;
  symmetric_ = problem.symmetric();
  take_pattern(system);
  std::fill_n(stiffness_.valuePtr(), stiffness_.nonZeros(), 0.);
  std::fill_n(metric_.valuePtr(), metric_.nonZeros(), 0.);
  const Eigen::VectorXd none;
  linearize_stiffness(system, problem.parameters, q, none, k, residual, Entries(stiffness_), work_);
  linearize_mass(system, k, work_, Entries(metric_));
  const Eigen::VectorXd& unit = problem.scaling.column;
  for (Sparse* m : {&stiffness_, &metric_})
    for (int j = 0; j < m->outerSize(); ++j)
      for (Sparse::InnerIterator it(*m, j); it; ++it)
        it.valueRef() *= unit[it.row()] * unit[j];
  for (std::size_t l = 0; l < system.links.size(); ++l)
    if (const Link& link = system.links[l]; link.v >= 0 && link.type == LinkType::spherical)
      for (int c = 0; c < 3; ++c)
        clear_rounding(stiffness_, link.v + c,
                       rounding * magnitudes.link_force[l] * problem.parameters.length);
  if (symmetric_) stiffness_ = Sparse(0.5 * (stiffness_ + Sparse(stiffness_.transpose())));
  mass_ = 0;
  for (std::size_t l = 0; l < system.links.size(); ++l)
    if (system.links[l].mobile) mass_ += problem.parameters.links[l].mass;
  const double least =
      own_share * own_share * std::max(mass_, 1e-300) * problem.parameters.length * problem.parameters.length;
  noise_.resize(system.nv);
  const Entries entries(stiffness_), weights(metric_);
  for (int i = 0; i < system.nv; ++i) {
    noise_[i] = std::max(zero * std::abs(entries(i, i)), rounding * magnitudes.force[i] * unit[i]);
    double& weight = weights(i, i);
    weight = weight > 0 ? weight * (1 + own_share) : least;
  }
}

void SparseElimination::factor(double shift) {
  sum_ = stiffness_;
  const double* weights = metric_.valuePtr();
  for (Eigen::Index e = 0; e < sum_.nonZeros(); ++e)
    sum_.valuePtr()[e] += shift * weights[e];
  flat_.clear();
  negative_ = 0;
  const auto n = static_cast<std::size_t>(sum_.rows());
  pinned_.assign(n, false);
  const Entries entries(sum_);
  // What nothing holds at all, like a point mass that may turn: held for the elimination's sake.
  for (int i = 0; i < sum_.rows(); ++i) {
    double largest = 0;
    for (Sparse::InnerIterator it(sum_, i); it; ++it)
      largest = std::max(largest, std::abs(it.value()));
    if (largest > noise_[i]) continue;
    pinned_[static_cast<std::size_t>(i)] = true;
    flat_.push_back({i, 1, Vec3::UnitX()});
    entries(i, i) += 1;
  }
  // Other pivots without stiffness show in the elimination.
  for (int round = 0; round < 4; ++round) {
    solved_ = decompose();
    if (!solved_ || !symmetric_) break;
    const Eigen::VectorXd pivots = ldlt_.vectorD();
    const auto& place = ldlt_.permutationP().indices();
    bool again = false;
    negative_ = 0;
    for (int i = 0; i < sum_.rows(); ++i) {
      const double pivot = pivots[place.size() > 0 ? place[i] : i];
      if (pivot < -noise_[i]) ++negative_;
      if (std::abs(pivot) > noise_[i] || pinned_[static_cast<std::size_t>(i)]) continue;
      pinned_[static_cast<std::size_t>(i)] = again = true;
      flat_.push_back({i, 1, Vec3::UnitX()});
      entries(i, i) += std::max(std::abs(entries(i, i)), 1e3 * noise_[i]);
      break; // those after it have eliminated with nothing
    }
    if (!again) break;
  }
  if (!solved_) negative_ = std::max(negative_, 1);
}

bool SparseElimination::decompose() {
  if (symmetric_) {
    if (!analysed_) ldlt_.analyzePattern(sum_);
    analysed_ = true;
    ldlt_.factorize(sum_);
    return ldlt_.info() == Eigen::Success;
  }
  if (!analysed_) lu_.analyzePattern(sum_);
  analysed_ = true;
  lu_.factorize(sum_);
  return lu_.info() == Eigen::Success;
}

void SparseElimination::solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
  if (!solved_) {
    x.setZero(rhs.size());
    return;
  }
  masked_ = rhs;
  for (const Flat& f : flat_)
    masked_[f.v] = 0;
  if (symmetric_)
    x = ldlt_.solve(masked_);
  else
    x = lu_.solve(masked_);
  for (const Flat& f : flat_)
    x[f.v] = 0;
}

double SparseElimination::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  product.noalias() = metric_ * x;
  return x.dot(product);
}

void SparseElimination::direction_of(const Flat& flat, Eigen::VectorXd& x) {
  Eigen::VectorXd rhs = -stiffness_.col(flat.v);
  solve(rhs, x);
  x[flat.v] = 1;
}

} // namespace flyball
