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
  metric_ = stiffness_;
  place_.clear();
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
  leave_out_what_is_loose();
}

// What nothing holds at all, like the turns of a point mass, is left out.
void SparseElimination::leave_out_what_is_loose() {
  std::vector<int> place(static_cast<std::size_t>(stiffness_.rows()), -1);
  held_ = 0;
  for (int i = 0; i < stiffness_.rows(); ++i) {
    double largest = 0;
    for (Sparse::InnerIterator it(stiffness_, i); it; ++it)
      largest = std::max(largest, std::abs(it.value()));
    if (largest > noise_[i]) place[static_cast<std::size_t>(i)] = held_++;
  }
  if (place == place_) return;
  place_ = std::move(place);
  analysed_ = false;
}

void SparseElimination::sum_up(double shift) {
  sum_.resize(held_, held_);
  sum_.reserve(stiffness_.nonZeros());
  for (int j = 0; j < stiffness_.outerSize(); ++j) {
    const int column = place_[static_cast<std::size_t>(j)];
    if (column < 0) continue;
    sum_.startVec(column);
    Sparse::InnerIterator weight(metric_, j);
    for (Sparse::InnerIterator it(stiffness_, j); it; ++it, ++weight)
      if (const int row = place_[static_cast<std::size_t>(it.row())]; row >= 0)
        sum_.insertBack(row, column) = it.value() + shift * weight.value();
  }
  sum_.finalize();
}

void SparseElimination::factor(double shift) {
  flat_.clear();
  negative_ = 0;
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] < 0) flat_.push_back({static_cast<int>(i), 1, Vec3::UnitX()});
  solved_ = true;
  if (held_ == 0) return;
  sum_up(shift);
  const std::size_t loose = flat_.size();
  // Other pivots without stiffness show in the elimination, one at a time: those after it have eliminated
  // with nothing.
  for (int round = 0; round < 8; ++round) {
    solved_ = decompose();
    if (!solved_ || !symmetric_) break;
    const Eigen::VectorXd pivots = ldlt_.vectorD();
    const auto& order = ldlt_.permutationP().indices();
    int next = -1, first = held_;
    negative_ = 0;
    for (std::size_t i = 0; i < place_.size(); ++i) {
      if (place_[i] < 0) continue;
      const int at = order.size() > 0 ? order[place_[i]] : place_[i];
      const double noise = noise_[static_cast<Eigen::Index>(i)];
      if (pivots[at] < -noise) ++negative_;
      if (std::abs(pivots[at]) > noise || at >= first) continue;
      first = at;
      next = static_cast<int>(i);
    }
    if (next < 0) break;
    const bool known = std::any_of(flat_.begin() + static_cast<std::ptrdiff_t>(loose), flat_.end(),
                                   [&](const Flat& f) { return f.v == next; });
    if (!known) flat_.push_back({next, 1, Vec3::UnitX()});
    const Entries entries(sum_);
    double& diagonal =
        entries(place_[static_cast<std::size_t>(next)], place_[static_cast<std::size_t>(next)]);
    diagonal += std::max(std::abs(diagonal), 1e3 * noise_[next]);
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
  x.setZero(rhs.size());
  if (!solved_ || held_ == 0) return;
  gathered_.resize(held_);
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] >= 0) gathered_[place_[i]] = rhs[static_cast<Eigen::Index>(i)];
  for (const Flat& f : flat_)
    if (const int at = place_[static_cast<std::size_t>(f.v)]; at >= 0) gathered_[at] = 0;
  if (symmetric_)
    gathered_ = ldlt_.solve(gathered_).eval();
  else
    gathered_ = lu_.solve(gathered_).eval();
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] >= 0) x[static_cast<Eigen::Index>(i)] = gathered_[place_[i]];
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
