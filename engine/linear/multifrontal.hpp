// A = L D L^T, or L D U, of a sparse matrix with a symmetric pattern, by the multifrontal method (Duff and
// Reid, The multifrontal solution of indefinite sparse symmetric linear systems, 1983; Liu, The multifrontal
// method for sparse matrix solution, 1992): every column's update meets those of others in a small dense
// matrix, its front, and what is eliminated there goes on to the front of its parent in the elimination tree.
// A pivot that is small beside its column waits for the parent's front; a column of nothing but rounding is a
// direction in which the matrix is singular, and is left out.
//
// Of its own because Eigen's SimplicialLDLT takes pivots as they come and ends at one that is zero, and no
// other packaged library that we know tells the inertia without Fortran. Reordered so that pivots need not
// wait, its fill took nine times as long for a net of ten thousand cables as with pivots that do.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace flyball {

class Multifrontal {
 public:
  // The lower triangle by columns in the order of elimination, rows ascending from the diagonal on.
  struct Columns {
    std::vector<int> start, row;
    int size() const { return static_cast<int>(start.size()) - 1; }
  };

  // The same columns in an order in which those of a subtree of the elimination tree follow each other: by
  // place in it the place now. The fill is the same.
  static std::vector<int> postorder(const Columns& columns);

  // Takes in a pattern in such an order; it has to stay where it is.
  void analyse(const Columns& columns);

  // `lower` has the values of the pattern's entries and `upper`, of a matrix that is not symmetric, those of
  // the transposed ones (else empty). Where all that is left of a column is no more than `zero` the matrix is
  // singular.
  void factor(const std::vector<double>& lower, const std::vector<double>& upper, double zero);

  // A^-1 x in place; unknowns in which the matrix is singular get nothing.
  void solve(Eigen::Ref<Eigen::VectorXd> x);

  int negative() const { return negative_; } // eigenvalues, of a symmetric matrix
  int nullity() const { return static_cast<int>(singular_.size()); }
  // A direction in which it is singular; and the unknown that was left out for it, -1 where it is several.
  int null_unknown(int i) const { return singular_[static_cast<std::size_t>(i)].unknown; }
  void null_vector(int i, Eigen::Ref<Eigen::VectorXd> x);

 private:
  // Columns with much the same rows below them, and what elimination leaves of their front.
  struct Node {
    int first = 0, end = 0; // columns of its own
    int parent = -1;
    std::vector<int> below; // rows
    std::vector<int> children;
    // The front's unknowns: those eliminated, those that wait, those in which the matrix is singular, those
    // below; the columns of L and of U^T.
    std::vector<int> unknowns;
    int waiting = 0;
    Eigen::MatrixXd lower, upper;
    Eigen::VectorXd pivots;
    Eigen::MatrixXd update; // for the parent
    // At a root: what waits still, by its singular value decomposition or its eigenvectors.
    Eigen::MatrixXd left, right;
    Eigen::VectorXd inverse; // of values; 0: singular
    int eliminated() const { return static_cast<int>(pivots.size()); }
  };
  class Front;
  // A direction in which the matrix is singular: an unknown that was left out with what follows, or (-1) of
  // what waited at a root.
  struct Singular {
    int node, unknown, direction;
  };

  void eliminate(int node, const std::vector<double>& lower, const std::vector<double>& upper, double zero);
  void decompose_rest(int node, const Eigen::MatrixXd& rest, double zero);
  void substitute_back(Eigen::Ref<Eigen::VectorXd> x);
  void gather(const Node& node, const Eigen::Ref<const Eigen::VectorXd>& x);

  const Columns* columns_ = nullptr;
  bool symmetric_ = true;
  std::vector<Node> nodes_; // children before parents
  std::vector<int> place_;  // by unknown, in the front at hand
  std::vector<Singular> singular_;
  int negative_ = 0;
  Eigen::VectorXd values_; // of a front's unknowns
};

} // namespace flyball
