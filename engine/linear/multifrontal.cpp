#include "engine/linear/multifrontal.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace flyball {
namespace {

// A pivot may be this small beside its column: waiting for larger ones makes triple the work in nets of
// cables. What it costs in digits corrections get back.
constexpr double least_pivot = 1e-6;
constexpr int together = 48;   // columns eliminated one by one, before the rest follows at once
constexpr int small_node = 16; // columns; smaller ones join their parent where that adds few zeros

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// Parents in the elimination tree (Liu 1986), -1 of a root; by paths shortened on the way.
std::vector<int> elimination_tree(const Multifrontal::Columns& columns) {
  const int n = columns.size();
  std::vector<std::vector<int>> by_row(at(n));
  for (int j = 0; j < n; ++j)
    for (int e = columns.start[at(j)] + 1; e < columns.start[at(j) + 1]; ++e)
      by_row[at(columns.row[at(e)])].push_back(j);
  std::vector<int> parent(at(n), -1), ancestor(at(n), -1);
  for (int i = 0; i < n; ++i)
    for (const int entry : by_row[at(i)]) {
      int j = entry;
      while (j >= 0 && j != i) {
        const int next = ancestor[at(j)];
        ancestor[at(j)] = i;
        if (next < 0) parent[at(j)] = i;
        j = next;
      }
    }
  return parent;
}

} // namespace

std::vector<int> Multifrontal::postorder(const Columns& columns) {
  const int n = columns.size();
  const std::vector<int> parent = elimination_tree(columns);
  std::vector<std::vector<int>> children(at(n));
  std::vector<int> order, stack;
  for (int j = n; j-- > 0;)
    if (parent[at(j)] >= 0)
      children[at(parent[at(j)])].push_back(j);
    else
      stack.push_back(j);
  // Parents before children, and all of it backwards.
  while (!stack.empty()) {
    const int j = stack.back();
    stack.pop_back();
    order.push_back(j);
    for (auto c = children[at(j)].rbegin(); c != children[at(j)].rend(); ++c)
      stack.push_back(*c);
  }
  std::ranges::reverse(order);
  return order;
}

void Multifrontal::analyse(const Columns& columns) {
  columns_ = &columns;
  const int n = columns.size();
  const std::vector<int> parent = elimination_tree(columns);
  nodes_.clear();
  place_.assign(at(n), -1);
  std::vector<int> node_of(at(n)), mark(at(n), -1);
  std::vector<std::vector<int>> children(at(n)); // nodes, by column that is the parent
  for (int j = 0; j < n; ++j) {
    // What lies below a column is what it and its children have there.
    std::vector<int> below;
    mark[at(j)] = j;
    const auto add = [&](int i) {
      if (i <= j || mark[at(i)] == j) return;
      mark[at(i)] = j;
      below.push_back(i);
    };
    for (int e = columns.start[at(j)]; e < columns.start[at(j) + 1]; ++e)
      add(columns.row[at(e)]);
    for (const int c : children[at(j)])
      for (const int i : nodes_[at(c)].below)
        add(i);
    std::ranges::sort(below);
    // The last node, where this column is its parent and has no more below or little.
    if (!nodes_.empty() && parent[at(j - 1)] == j) {
      Node& last = nodes_.back();
      const auto columns_of_last = static_cast<std::size_t>(j - last.first);
      const std::size_t zeros = below.size() + 1 - last.below.size();
      const bool small = columns_of_last < at(small_node) && zeros * columns_of_last <= 4 * at(small_node) &&
                         children[at(j)].size() == 1;
      if (zeros == 0 || small) {
        last.end = j + 1;
        last.below = std::move(below);
        node_of[at(j)] = static_cast<int>(nodes_.size()) - 1;
        for (const int c : children[at(j)])
          if (c != node_of[at(j)]) last.children.push_back(c);
        if (parent[at(j)] >= 0) children[at(parent[at(j)])].push_back(node_of[at(j)]);
        continue;
      }
    }
    Node node;
    node.first = j;
    node.end = j + 1;
    node.below = std::move(below);
    node.children = children[at(j)];
    node_of[at(j)] = static_cast<int>(nodes_.size());
    if (parent[at(j)] >= 0) children[at(parent[at(j)])].push_back(node_of[at(j)]);
    nodes_.push_back(std::move(node));
  }
  for (std::size_t s = 0; s < nodes_.size(); ++s)
    for (const int c : nodes_[s].children)
      nodes_[at(c)].parent = static_cast<int>(s);
}

// The dense matrix of a node: columns of the candidates for elimination with all their rows; of a matrix that
// is not symmetric their rows, too, transposed; and the block of what comes later, of a symmetric matrix its
// lower triangle. Candidates change places: first those eliminated, in the end those that wait, last those in
// which the matrix is singular.
class Multifrontal::Front {
 public:
  Front(std::vector<int>& unknowns, int candidates, bool symmetric)
      : unknowns_(unknowns), candidates_(candidates), rows_(static_cast<int>(unknowns.size())),
        symmetric_(symmetric), singular_(at(candidates), false) {
    c_.setZero(rows_, candidates_);
    if (!symmetric_) r_.setZero(rows_, candidates_);
    s_.setZero(rows_ - candidates_, rows_ - candidates_);
  }

  // A(i, j) and A(j, i), by place, j a candidate and i not before it.
  void add(int i, int j, double below, double above) {
    c_(i, j) += below;
    if (!symmetric_) r_(i, j) += above;
    if (i == j || i >= candidates_) return;
    c_(j, i) += above;
    if (!symmetric_) r_(j, i) += below;
  }

  // What a child leaves, by the places of its unknowns here.
  void add_update(const Eigen::MatrixXd& update, const std::vector<int>& place) {
    for (Eigen::Index b = 0; b < update.cols(); ++b) {
      const int j = place[static_cast<std::size_t>(b)];
      for (Eigen::Index a = b; a < update.rows(); ++a) {
        const int i = place[static_cast<std::size_t>(a)];
        const double above = symmetric_ ? update(a, b) : update(b, a);
        if (j < candidates_) {
          add(i, j, update(a, b), above);
        } else if (i < candidates_) {
          add(j, i, above, update(a, b));
        } else {
          s_(i - candidates_, j - candidates_) += update(a, b);
          if (!symmetric_ && i != j) s_(j - candidates_, i - candidates_) += above;
        }
      }
    }
  }

  void eliminate(double zero) {
    pivots_.resize(candidates_);
    for (int end = 0; end < candidates_;) {
      const int first = done_;
      end = std::min(end + together, candidates_);
      eliminate_until(end, zero);
      follow(first, end);
    }
    for (int before = -1; before != done_;) { // what waited may have its turn after others
      before = done_;
      eliminate_until(candidates_, zero);
    }
    int end = candidates_;
    for (int p = candidates_; p-- > done_;)
      if (singular_[at(p)]) swap(p, --end);
    waiting_ = end - done_;
    follow_later();
  }

  int done() const { return done_; }
  int waiting() const { return waiting_; }
  int candidates() const { return candidates_; }
  Eigen::VectorXd pivots() const { return pivots_.head(done_); }
  Eigen::MatrixXd rest() const { return c_.block(done_, done_, waiting_, waiting_); }

  // L and U^T, whose diagonals are ones.
  Eigen::MatrixXd lower() const { return c_.leftCols(done_) * pivots().cwiseInverse().asDiagonal(); }
  Eigen::MatrixXd upper() const { return r_.leftCols(done_) * pivots().cwiseInverse().asDiagonal(); }

  // Of what waits and what comes later; of a symmetric matrix the lower triangle.
  Eigen::MatrixXd update() const {
    const int w = waiting_, later = rows_ - candidates_;
    Eigen::MatrixXd out(w + later, w + later);
    out.topLeftCorner(w, w) = rest();
    out.bottomLeftCorner(later, w) = c_.block(candidates_, done_, later, w);
    if (!symmetric_) out.topRightCorner(w, later) = r_.block(candidates_, done_, later, w).transpose();
    out.bottomRightCorner(later, later) = s_;
    return out;
  }

 private:
  // One by one the candidates before `end` that have a pivot now; the others there follow.
  void eliminate_until(int end, double zero) {
    for (int p = done_; p < end; ++p) {
      if (singular_[at(p)]) continue;
      double largest = c_.col(p).tail(rows_ - done_).cwiseAbs().maxCoeff();
      if (!symmetric_) largest = std::max(largest, r_.col(p).tail(rows_ - done_).cwiseAbs().maxCoeff());
      if (!(largest > zero)) {
        singular_[at(p)] = true;
        continue;
      }
      const double pivot = c_(p, p);
      if (!(std::abs(pivot) > std::max(least_pivot * largest, zero))) continue;
      swap(p, done_);
      pivots_[done_] = pivot;
      const int rest = rows_ - done_ - 1;
      const Eigen::MatrixXd& across = symmetric_ ? c_ : r_;
      for (int j = done_ + 1; j < end; ++j) {
        if (const double by = across(j, done_) / pivot; by != 0)
          c_.col(j).tail(rest) -= by * c_.col(done_).tail(rest);
        if (symmetric_) continue;
        if (const double by = c_(j, done_) / pivot; by != 0)
          r_.col(j).tail(rest) -= by * r_.col(done_).tail(rest);
      }
      ++done_;
    }
  }

  // The candidates from `begin` on follow the elimination since `first`.
  void follow(int first, int begin) {
    const int count = done_ - first, others = candidates_ - begin, rest = rows_ - done_;
    if (count == 0 || others == 0) return;
    const auto inverse = pivots_.segment(first, count).cwiseInverse().asDiagonal();
    const Eigen::MatrixXd& across = symmetric_ ? c_ : r_;
    c_.block(done_, begin, rest, others).noalias() -=
        c_.block(done_, first, rest, count) *
        (inverse * across.block(begin, first, others, count).transpose());
    if (!symmetric_)
      r_.block(done_, begin, rest, others).noalias() -=
          r_.block(done_, first, rest, count) * (inverse * c_.block(begin, first, others, count).transpose());
  }

  void follow_later() {
    if (done_ == 0 || rows_ == candidates_) return;
    const auto below = c_.bottomLeftCorner(rows_ - candidates_, done_);
    if (symmetric_) {
      const Eigen::MatrixXd scaled = pivots().cwiseInverse().asDiagonal() * below.transpose();
      s_.triangularView<Eigen::Lower>() -= below * scaled;
    } else {
      s_.noalias() -= below * (pivots().cwiseInverse().asDiagonal() *
                               r_.bottomLeftCorner(rows_ - candidates_, done_).transpose());
    }
  }

  void swap(int a, int b) {
    if (a == b) return;
    c_.col(a).swap(c_.col(b));
    c_.row(a).swap(c_.row(b));
    if (!symmetric_) {
      r_.col(a).swap(r_.col(b));
      r_.row(a).swap(r_.row(b));
    }
    std::swap(unknowns_[at(a)], unknowns_[at(b)]);
    const bool other = singular_[at(a)];
    singular_[at(a)] = singular_[at(b)];
    singular_[at(b)] = other;
  }

  std::vector<int>& unknowns_;
  const int candidates_, rows_;
  const bool symmetric_;
  int done_ = 0, waiting_ = 0;
  std::vector<bool> singular_; // by place
  Eigen::MatrixXd c_, r_, s_;
  Eigen::VectorXd pivots_;
};

void Multifrontal::factor(const std::vector<double>& lower, const std::vector<double>& upper, double zero) {
  symmetric_ = upper.empty();
  negative_ = 0;
  singular_.clear();
  for (std::size_t s = 0; s < nodes_.size(); ++s) {
    interruption_point();
    eliminate(static_cast<int>(s), lower, upper, zero);
  }
}

void Multifrontal::eliminate(int number, const std::vector<double>& lower, const std::vector<double>& upper,
                             double zero) {
  Node& node = nodes_[at(number)];
  node.unknowns.resize(at(node.end - node.first));
  std::iota(node.unknowns.begin(), node.unknowns.end(), node.first);
  for (const int c : node.children) {
    const auto waiting = nodes_[at(c)].unknowns.begin() + nodes_[at(c)].eliminated();
    node.unknowns.insert(node.unknowns.end(), waiting, waiting + nodes_[at(c)].waiting);
  }
  const int candidates = static_cast<int>(node.unknowns.size());
  node.unknowns.insert(node.unknowns.end(), node.below.begin(), node.below.end());
  for (std::size_t p = 0; p < node.unknowns.size(); ++p)
    place_[at(node.unknowns[p])] = static_cast<int>(p);

  Front front(node.unknowns, candidates, symmetric_);
  for (int j = node.first; j < node.end; ++j)
    for (int e = columns_->start[at(j)]; e < columns_->start[at(j) + 1]; ++e)
      front.add(place_[at(columns_->row[at(e)])], j - node.first, lower[at(e)],
                symmetric_ ? lower[at(e)] : upper[at(e)]);
  std::vector<int> place;
  for (const int c : node.children) {
    Node& child = nodes_[at(c)];
    place.clear();
    for (int p = child.eliminated(); p < child.eliminated() + child.waiting; ++p)
      place.push_back(place_[at(child.unknowns[at(p)])]);
    for (const int i : child.below)
      place.push_back(place_[at(i)]);
    front.add_update(child.update, place);
    child.update.resize(0, 0);
  }

  front.eliminate(zero);
  node.lower = front.lower();
  if (!symmetric_) node.upper = front.upper();
  node.pivots = front.pivots();
  negative_ += static_cast<int>((node.pivots.array() < 0).count());
  node.waiting = front.waiting();
  for (int p = front.done() + front.waiting(); p < candidates; ++p)
    singular_.push_back({number, node.unknowns[at(p)], 0});
  if (node.parent >= 0)
    node.update = front.update();
  else
    decompose_rest(number, front.rest(), zero);
}

// What waits at a root has pivots in pairs or none at all.
void Multifrontal::decompose_rest(int number, const Eigen::MatrixXd& rest, double zero) {
  Node& node = nodes_[at(number)];
  node.left.resize(0, 0);
  if (rest.size() == 0) return;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(rest.rows());
  node.left = node.right = Eigen::MatrixXd::Identity(rest.rows(), rest.rows());
  if (symmetric_) {
    SymmetricEigen eigen;
    if (eigen.compute(rest)) {
      values = eigen.values();
      node.left = node.right = eigen.vectors();
    }
  } else if (const auto svd = singular_vectors(rest)) {
    values = svd->values;
    node.left = svd->left;
    node.right = svd->right;
  }
  node.inverse = values;
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    if (std::abs(values[i]) > zero) {
      negative_ += symmetric_ && values[i] < 0 ? 1 : 0;
      node.inverse[i] = 1 / values[i];
      continue;
    }
    node.inverse[i] = 0;
    singular_.push_back({number, -1, i});
  }
}

void Multifrontal::solve(Eigen::Ref<Eigen::VectorXd> x) {
  for (const Node& node : nodes_) {
    const int done = node.eliminated(), rows = static_cast<int>(node.unknowns.size());
    gather(node, x);
    auto own = values_.head(done);
    node.lower.topRows(done).triangularView<Eigen::UnitLower>().solveInPlace(own);
    values_.segment(done, rows - done).noalias() -= node.lower.bottomRows(rows - done) * own;
    own.array() /= node.pivots.array();
    // What waits or comes later goes on; what is singular gets nothing.
    const int later = rows - static_cast<int>(node.below.size());
    for (int p = done + node.waiting; p < later; ++p)
      values_[p] = 0;
    if (node.parent < 0 && node.left.size() > 0) {
      auto rest = values_.segment(done, node.waiting);
      rest = (node.right * node.inverse.cwiseProduct(node.left.transpose() * rest)).eval();
    }
    for (int p = 0; p < rows; ++p)
      x[node.unknowns[at(p)]] = values_[p];
  }
  substitute_back(x);
}

void Multifrontal::substitute_back(Eigen::Ref<Eigen::VectorXd> x) {
  for (std::size_t s = nodes_.size(); s-- > 0;) {
    const Node& node = nodes_[s];
    const int done = node.eliminated(), rows = static_cast<int>(node.unknowns.size());
    const Eigen::MatrixXd& upper = symmetric_ ? node.lower : node.upper;
    gather(node, x);
    auto own = values_.head(done);
    own.noalias() -= upper.bottomRows(rows - done).transpose() * values_.segment(done, rows - done);
    upper.topRows(done).triangularView<Eigen::UnitLower>().transpose().solveInPlace(own);
    for (int p = 0; p < done; ++p)
      x[node.unknowns[at(p)]] = values_[p];
  }
}

void Multifrontal::gather(const Node& node, const Eigen::Ref<const Eigen::VectorXd>& x) {
  const auto rows = static_cast<Eigen::Index>(node.unknowns.size());
  if (values_.size() < rows) values_.resize(rows);
  for (Eigen::Index p = 0; p < rows; ++p)
    values_[p] = x[node.unknowns[static_cast<std::size_t>(p)]];
}

void Multifrontal::null_vector(int i, Eigen::Ref<Eigen::VectorXd> x) {
  x.setZero();
  const Singular& singular = singular_[at(i)];
  const Node& node = nodes_[at(singular.node)];
  if (singular.unknown >= 0)
    x[singular.unknown] = 1;
  else
    for (int p = 0; p < node.waiting; ++p)
      x[node.unknowns[at(node.eliminated() + p)]] = node.right(p, singular.direction);
  substitute_back(x);
}

} // namespace flyball
