// The matrix of the bodies' equations as a list of entries, each a sum of stiffness, metric and what is fixed
// (the constraints), so that a multiple of the metric can be added without assembling anything again.
//
// Of the unknowns the first are six for each body. Those that nothing holds, the loose ones, are left out,
// and in the metric bodies that meet others by rows alone are solved for apart, which leaves their rows; the
// others are numbered anew: they are the ones held.
#pragma once

#include "engine/kkt/body_stiffness.hpp"
#include "engine/linear/sparse_factorization.hpp"

#include <vector>

namespace flyball {

class BodyEntries {
 public:
  // Starts anew, with as many lists as can be added to side by side. Of a symmetric matrix one triangle is
  // kept.
  void clear(int unknowns, bool symmetric, std::size_t lists);

  // Before the first entry: the bodies to be solved for by hand, by node with the number of their lines; -1
  // is one that stays. They must meet others by rows alone, and the metric must be what is solved for.
  void set_apart(const std::vector<int>& lines);

  // A body's own six equations.
  void add_body(std::size_t list, int node, const Mat6& stiffness, const Mat6& metric);

  // Between two bodies: ab of a's equations by b's motion, ba of b's by a's; the metric is symmetric.
  void add_between(std::size_t list, int a, int b, const Mat6& ab, const Mat6& ba, const Mat6& metric_ab);

  // A constraint's row, and its column, by a body's motion. Node -1 stands still.
  void add_row(std::size_t list, int row, int node, const Vec6& gradient);

  // After the last entry, one of these. What is solved for are all unknowns, with the metric in the place of
  // the stiffness; or all but the motions of bodies that meet no constraint and no stiffness above `noise`,
  // by node.
  void hold_all_by_metric();
  void hold_above(const std::vector<double>& noise);

  // By unknown: what nothing holds.
  const std::vector<bool>& loose() const { return loose_; }

  // Of what is held.
  const SparsePattern& pattern() const { return pattern_; }

  // The pattern's values: multiples of stiffness and metric, and what is fixed. Valid until the next call.
  const std::vector<double>& sum(double stiffness, double metric);

  // From all unknowns to those held, where bodies apart get what they would do without rows; and from there
  // back, where what is loose gets nothing.
  void gather(Eigen::VectorXd& unknowns, Eigen::VectorXd& held) const;
  void spread(const Eigen::Ref<const Eigen::VectorXd>& held, Eigen::VectorXd& unknowns) const;

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
  bool apart(int node) const { return !alone_.empty() && alone_[static_cast<std::size_t>(node)]; }
  void leave_rows_of(std::size_t body, List& list) const;
  void drop_loose(List& list) const;
  void number();

  SparsePattern pattern_;
  std::vector<List> lists_;
  std::vector<double> sum_, largest_;
  std::vector<bool> loose_;
  std::vector<int> place_; // by unknown: among those held; -1: loose, or apart

  // Of bodies apart, by body: whether one is, the inverse of its metric, and its rows' gradients.
  struct Line {
    int row = 0;
    Vec6 gradient;
  };
  std::vector<bool> alone_;
  std::vector<Mat6> blocks_;
  std::vector<int> first_line_, next_line_;
  std::vector<Line> lines_;
};

} // namespace flyball
