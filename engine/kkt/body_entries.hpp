// The matrix of the bodies' equations as a list of entries, each a sum of stiffness, metric and what is fixed
// (the constraints), so that a multiple of the metric can be added without assembling anything again.
//
// Of the unknowns the first are six for each body. Those without stiffness and constraint, the unconstrained
// ones, are left out, and the others are numbered anew: the reduced unknowns.
#pragma once

#include "engine/kkt/body_stiffness.hpp"
#include "engine/linear/sparse_factorization.hpp"

#include <vector>

namespace flyball {

class BodyEntries {
 public:
  // Starts anew, with as many lists as can be added to side by side. Of a symmetric matrix one triangle is
  // kept. Blocks that are zero by chance of the pose are left out, or kept where the pattern is to stay as
  // the mechanism moves.
  enum class Zeros { left_out, kept };
  void clear(int bodies, int multipliers, bool symmetric, std::size_t lists, Zeros zeros = Zeros::left_out);

  // A body's own six equations.
  void add_body(std::size_t list, int node, const Mat6& stiffness, const Mat6& metric);

  // Between two bodies: ab of a's equations by b's motion, ba of b's by a's; the metric is symmetric.
  void add_between(std::size_t list, int a, int b, const Mat6& ab, const Mat6& ba, const Mat6& metric_ab);

  // A constraint's row, and its column, by a body's motion. Node -1 stands still.
  void add_row(std::size_t list, int row, int node, const Vec6& gradient);

  // After the last entry, one of these. What is solved for are all unknowns, with the metric in the place of
  // the stiffness; or all but the motions of bodies that meet no constraint and no stiffness above `noise`,
  // by node.
  void keep_all_with_metric();
  void drop_unconstrained_below(const std::vector<double>& noise);

  // By unknown: left out.
  const std::vector<bool>& unconstrained() const { return unconstrained_; }

  // Of the reduced unknowns.
  const SparsePattern& pattern() const { return pattern_; }

  // The pattern's values: multiples of stiffness and metric, and what is fixed. Valid until the next call.
  const std::vector<double>& sum(double stiffness, double metric);

  // From all unknowns to the reduced ones; and from there back, zero for those left out.
  void gather(const Eigen::VectorXd& unknowns, Eigen::VectorXd& reduced) const;
  void spread(const Eigen::Ref<const Eigen::VectorXd>& reduced, Eigen::VectorXd& unknowns) const;

 private:
  // What an entry is made of.
  struct Value {
    double stiffness = 0, metric = 0, fixed = 0;
  };

  // Rows and columns count all unknowns, from 0.
  struct List {
    std::vector<int> rows, columns;
    std::vector<Value> values;
    std::size_t begin = 0; // among all entries, in the end
    void add(int row, int column, const Value& value);
  };

  void add_block(List& list, int a, int first_i, int b, int first_j, const Mat6& ab, const Mat6& ba,
                 const Mat6& metric_ab);
  void drop_unconstrained(List& list) const;
  void number();

  SparsePattern pattern_;
  bool keep_zeros_ = false;
  std::size_t first_multiplier_ = 0; // among the unknowns
  std::vector<List> lists_;
  std::vector<double> sum_, largest_;
  std::vector<bool> unconstrained_;
  std::vector<int> place_; // by unknown: among the reduced ones; -1: left out
};

} // namespace flyball
