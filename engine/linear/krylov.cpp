#include "engine/linear/krylov.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/spectral.hpp"

#include <Spectra/GenEigsSolver.h>
#include <Spectra/SymEigsSolver.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace flyball {
namespace {

using Eigen::Index;

constexpr double enough = 1e-12;       // of an eigenvalue's size: its residual
constexpr double enough_to_ask = 1e-4; // where only its size is asked for
constexpr double surely_less = 1e-2;   // relative: then what was asked for so far is not missing
constexpr double repeated = 1e-9;      // relative difference of eigenvalues that counts as none
constexpr Index most_restarts = 300;
// Below this, and three times what is asked for, the matrix itself is as quick.
constexpr Index small = 40;

struct NotFinite : std::runtime_error {
  NotFinite() : std::runtime_error("a product is not finite") {}
};

// A (1 - Q Q^T), and for a symmetric A (1 - Q Q^T) A (1 - Q Q^T): A without what Q spans, which it maps to
// itself.
class Rest {
 public:
  using Scalar = double; // as Spectra asks
  Rest(Index size, const Product& product, const Eigen::MatrixXd& found, bool symmetric)
      : size_(size), product_(product), found_(found), symmetric_(symmetric) {}
  Index rows() const { return size_; }
  Index cols() const { return size_; }
  void perform_op(const double* in, double* out) const {
    interruption_point();
    x_ = Eigen::Map<const Eigen::VectorXd>(in, size_);
    if (found_.cols() > 0) x_ -= found_ * (found_.transpose() * x_);
    product_(x_, y_);
    if (symmetric_ && found_.cols() > 0) y_ -= found_ * (found_.transpose() * y_);
    if (!y_.allFinite()) throw NotFinite();
    Eigen::Map<Eigen::VectorXd>(out, size_) = y_;
  }

 private:
  Index size_;
  const Product& product_;
  const Eigen::MatrixXd& found_;
  bool symmetric_;
  mutable Eigen::VectorXd x_, y_;
};

// Appends a column, orthogonal to those there are and of length one; not where nothing is left of it.
void append(Eigen::MatrixXd& basis, Eigen::VectorXd x) {
  const double before = x.norm();
  for (int twice = 0; twice < 2; ++twice)
    x -= basis * (basis.transpose() * x);
  const double size = x.norm();
  if (!(size > 1e-8 * before)) return;
  basis.conservativeResize(x.size(), basis.cols() + 1);
  basis.rightCols<1>() = x / size;
}

// Another start for every run.
Eigen::VectorXd start_of(Index size, unsigned run) {
  std::mt19937 random(run + 1);
  Eigen::VectorXd x(size);
  for (double& entry : x)
    entry = static_cast<double>(random()) / 2147483648. - 1;
  return x;
}

Index dimension(Index size, Index count) {
  return std::min(size, std::max<Index>(2 * count + 2, count + 20));
}

// One run. False where fewer converge.
template <class Solver>
bool run(Solver& solver, Index count, unsigned number, double tolerance, Index size) {
  const Eigen::VectorXd start = start_of(size, number);
  solver.init(start.data());
  return solver.compute(Spectra::SortRule::LargestMagn, most_restarts, tolerance,
                        Spectra::SortRule::LargestMagn) >= count;
}

Eigen::MatrixXd matrix_of(Index size, const Product& product) {
  Eigen::MatrixXd a(size, size);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size), y;
  for (Index j = 0; j < size; ++j) {
    interruption_point();
    x[j] = 1;
    product(x, y);
    a.col(j) = y;
    x[j] = 0;
  }
  return a;
}

// Columns in the order of the sizes of the values, the largest first.
template <class Values, class Vectors>
void sort_by_size(Values& values, Vectors& vectors) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = static_cast<Index>(i);
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](Index i) { return std::abs(values[i]); });
  values = Values(values(order));
  vectors = Vectors(vectors(Eigen::all, order));
}

struct SymmetricSearch {
  Index size, count;
  const Product& product;
  SymmetricPairs found{Eigen::VectorXd(0), Eigen::MatrixXd(size, 0)};

  // Finds `more` in what is left.
  bool add(Index more, unsigned number) {
    Rest rest(size, product, found.vectors, true);
    Spectra::SymEigsSolver<Rest> solver(rest, more, dimension(size, more));
    if (!run(solver, more, number, enough, size)) return false;
    const Eigen::VectorXd values = solver.eigenvalues();
    const Eigen::MatrixXd vectors = solver.eigenvectors();
    for (Index i = 0; i < values.size(); ++i) {
      append(found.vectors, vectors.col(i));
      if (found.vectors.cols() == found.values.size()) continue;
      found.values.conservativeResize(found.vectors.cols());
      found.values[found.values.size() - 1] = values[i];
    }
    sort_by_size(found.values, found.vectors);
    return true;
  }

  // The largest size in what is left, roughly.
  std::optional<double> left(unsigned number) {
    Rest rest(size, product, found.vectors, true);
    Spectra::SymEigsSolver<Rest> solver(rest, 1, dimension(size, 1));
    if (!run(solver, 1, number, enough_to_ask, size)) return {};
    return std::abs(solver.eigenvalues()[0]);
  }

  double least() const { return std::abs(found.values[count - 1]); }
};

struct GeneralSearch {
  Index size, count;
  const Product& product;
  Eigen::MatrixXd basis = Eigen::MatrixXd(size, 0); // orthonormal, of an invariant subspace
  ComplexPairs found{};

  bool add(Index more, unsigned number) {
    Rest rest(size, product, basis, false);
    Spectra::GenEigsSolver<Rest> solver(rest, more, dimension(size, more));
    if (!run(solver, more, number, enough, size)) return false;
    const Eigen::VectorXcd values = solver.eigenvalues();
    const Eigen::MatrixXcd vectors = solver.eigenvectors();
    for (Index i = 0; i < values.size(); ++i) {
      append(basis, vectors.col(i).real());
      if (values[i].imag() != 0) append(basis, vectors.col(i).imag());
    }
    // Of the subspace as a whole (Rayleigh and Ritz): what was taken out is part of the later vectors, too.
    Eigen::MatrixXd image(size, basis.cols());
    Eigen::VectorXd y;
    for (Index i = 0; i < basis.cols(); ++i) {
      product(basis.col(i), y);
      image.col(i) = y;
    }
    const auto pairs = eigenvectors(basis.transpose() * image);
    if (!pairs) return false;
    found.values = pairs->values;
    found.vectors = basis * pairs->vectors;
    sort_by_size(found.values, found.vectors);
    return true;
  }

  std::optional<double> left(unsigned number) {
    Rest rest(size, product, basis, false);
    Spectra::GenEigsSolver<Rest> solver(rest, 2, dimension(size, 2));
    if (!run(solver, 1, number, enough_to_ask, size)) return {};
    return std::abs(solver.eigenvalues()[0]);
  }

  double least() const { return std::abs(found.values[count - 1]); }
};

// Goes on until what is left is smaller than the last of those asked for. A guess may say more than there is,
// which another run then shows.
template <class Search>
bool search(Search& s) {
  try {
    unsigned number = 0;
    if (!s.add(s.count, number++)) return false;
    for (Index round = 0; round <= s.count; ++round) {
      const std::optional<double> left = s.left(number++);
      if (!left) return false;
      const double least = s.least();
      if (*left <= (1 - surely_less) * least) return true;
      const Index before = s.found.values.size();
      if (before + s.count + small > s.size || !s.add(s.count, number++)) return false;
      if (std::abs(s.least() - least) <= repeated * least) return true;
    }
    return false;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) { // by Spectra, or NotFinite
    return false;
  }
}

} // namespace

std::optional<SymmetricPairs> largest_symmetric(Index size, Index count, const Product& product) {
  count = std::min(count, size);
  SymmetricSearch s{size, count, product};
  if (size <= 3 * count + small) {
    const Eigen::MatrixXd a = matrix_of(size, product);
    SymmetricEigen eigen;
    if (size > 0 && !eigen.compute((a + a.transpose()) / 2)) return {};
    if (size > 0) s.found = {eigen.values(), eigen.vectors()};
    sort_by_size(s.found.values, s.found.vectors);
  } else if (!search(s)) {
    return {};
  }
  return SymmetricPairs{s.found.values.head(count), s.found.vectors.leftCols(count)};
}

std::optional<ComplexPairs> largest_of_any(Index size, Index count, const Product& product) {
  count = std::min(count, size);
  GeneralSearch s{size, count, product};
  if (size <= 3 * count + small) {
    const auto pairs = eigenvectors(matrix_of(size, product));
    if (!pairs) return {};
    s.found = {pairs->values, pairs->vectors};
    sort_by_size(s.found.values, s.found.vectors);
  } else if (!search(s)) {
    return {};
  }
  if (count > 0 && count < s.found.values.size() && s.found.values[count - 1].imag() != 0 &&
      s.found.values[count] == std::conj(s.found.values[count - 1]))
    ++count;
  return ComplexPairs{s.found.values.head(count), s.found.vectors.leftCols(count)};
}

} // namespace flyball
