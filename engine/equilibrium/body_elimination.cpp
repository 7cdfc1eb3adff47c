#include "engine/equilibrium/body_elimination.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

namespace flyball {
namespace {

constexpr int most_null_directions = 200; // of which all that follows is told

} // namespace

// Units of energy in every equation: turns in radians, shifts in the mechanism's reach.
Mat6 BodyElimination::scaled(const Mat6& m) const {
  Mat6 x = m;
  x.rightCols<3>() *= length_;
  x.bottomRows<3>() *= length_;
  return x;
}

void BodyElimination::lay_out(const Problem& problem, const Kinematics<double>& k) {
  const System& system = problem.system;
  const std::size_t count = system.links.size();
  symmetric_ = problem.symmetric();
  length_ = problem.parameters.length;
  coordinates_ = system.nv;
  rows_ = system.rows;
  children_.assign(count, 0);
  next_.assign(count, -1);
  for (const Link& link : system.links)
    if (link.parent >= 0) ++children_[static_cast<std::size_t>(link.parent)];
  for (std::size_t l = 0; l < count; ++l) {
    const int p = system.links[l].parent;
    if (p < 0) continue;
    const Link& parent = system.links[static_cast<std::size_t>(p)];
    if (parent.mobile && parent.body < 0 && parent.tree_joint == system.links[l].tree_joint &&
        children_[static_cast<std::size_t>(p)] == 1)
      next_[static_cast<std::size_t>(p)] = static_cast<int>(l);
  }
  node_of_link_.assign(count, -1);
  place_.resize(static_cast<std::size_t>(system.nv));
  std::size_t n = 0;
  for (std::size_t l = 0; l < count; ++l) {
    if (!system.links[l].mobile || next_[l] >= 0) continue;
    if (nodes_.size() <= n) nodes_.emplace_back();
    Node& x = nodes_[n];
    node_of_link_[l] = static_cast<int>(n++);
    x.link = static_cast<int>(l);
    int head = x.link;
    const auto parent_of = [&](int i) { return system.links[static_cast<std::size_t>(i)].parent; };
    while (parent_of(head) >= 0 && next_[static_cast<std::size_t>(parent_of(head))] == head)
      head = parent_of(head);
    x.parent = node_at(parent_of(head));
    x.columns = 0;
    for (int i = head; i >= 0; i = i == x.link ? -1 : next_[static_cast<std::size_t>(i)]) {
      const Link& link = system.links[static_cast<std::size_t>(i)];
      if (link.v < 0) continue;
      for (int c = 0; c < (link.type == LinkType::spherical ? 3 : 1); ++c) {
        const auto at = static_cast<std::size_t>(x.columns);
        x.v[at] = link.v + c;
        x.stage[at] = i;
        place_[static_cast<std::size_t>(link.v + c)] = {static_cast<int>(n) - 1, x.columns++};
      }
    }
  }
  nodes_.resize(n);
  mass_ = 0;
  int next = 6 * static_cast<int>(n);
  for (Node& x : nodes_) {
    x.multipliers = next;
    next += 6 - x.columns;
    set_columns(problem, k, x);
  }
  first_row_ = next;
  unknowns_ = next + rows_;
  pattern_.clear(unknowns_, symmetric_);
  values_.clear();
}

void BodyElimination::set_columns(const Problem& problem, const Kinematics<double>& k, Node& x) const {
  const Vec3& o = k.links[static_cast<std::size_t>(x.link)].o;
  x.arm =
      x.parent < 0
          ? Vec3(Vec3::Zero())
          : Vec3(o - k.links[static_cast<std::size_t>(nodes_[static_cast<std::size_t>(x.parent)].link)].o);
  x.shift.setIdentity();
  x.shift.bottomLeftCorner<3, 3>() = -skew(x.arm) / length_;
  x.s.resize(6, x.columns);
  for (int c = 0; c < x.columns; ++c) {
    const int v = x.v[static_cast<std::size_t>(c)];
    const Column<double>& column = k.columns[static_cast<std::size_t>(v)];
    const double unit = problem.scaling.column[v];
    x.s.col(c) << unit * column.turn(), unit / length_ * column.at(o);
  }
  if (x.columns == 0) {
    x.d.resize(6, 0);
    x.n = Mat6::Identity();
    return;
  }
  if (x.columns == 6) {
    x.d = Mat6(x.s).transpose().inverse();
    x.n.resize(6, 0);
    return;
  }
  const Square gram = x.s.transpose() * x.s;
  x.d = x.s * gram.inverse();
  const Eigen::HouseholderQR<Columns> qr(x.s);
  const Mat6 q = qr.householderQ() * Mat6::Identity();
  x.n = q.rightCols(6 - x.columns);
}

void BodyElimination::add_bodies(const Problem& problem, const Kinematics<double>& k) {
  for (Node& x : nodes_) {
    set_body_stiffness(problem.parameters, static_cast<std::size_t>(x.link), k, x);
    mass_ += x.mass;
  }
  for (std::size_t i = 0; i < problem.system.body_forces.size(); ++i) {
    const BodyForceElement& e = problem.system.body_forces[i];
    if (const int n = node_at(e.link); n >= 0)
      add_body_force(e, problem.parameters.body_forces[i], k, node(n).own);
  }
  const double reach = length_ * length_;
  const double least = own_share * own_share * std::max(mass_, 1e-300) * reach;
  for (Node& x : nodes_) {
    x.stiffness = scaled(x.own);
    x.inertial = scaled(inertia_matrix(x));
    for (int c = 0; c < x.columns; ++c)
      x.weight[c] = std::max(own_share * x.s.col(c).dot(x.inertial * x.s.col(c)), least);
  }
}

void BodyElimination::add_pair(int a, int b, const PairBlocks& x) {
  compressed_ |= x.compressed;
  const int na = node_at(a), nb = node_at(b);
  if (na >= 0) {
    node(na).stiffness += scaled(x.aa);
    node(na).load += x.on_a;
  }
  if (nb >= 0) {
    node(nb).stiffness += scaled(x.bb);
    node(nb).load += x.on_b;
  }
  if (na < 0 || nb < 0) return;
  if (na == nb)
    node(na).stiffness += scaled(x.ab) + scaled(x.ba);
  else
    emit_between(na, nb, scaled(x.ab), scaled(x.ba), Mat6::Zero());
}

void BodyElimination::add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                Lines lines) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    const PointSpringElement& e = system.springs[i];
    add_pair(e.ends.a, e.ends.b, spring_blocks(e, p.springs[i], k, p.moving, lines));
  }
  if (p.moving)
    for (std::size_t i = 0; i < system.cut_dampers.size(); ++i) {
      const CutDamperElement& e = system.cut_dampers[i];
      add_pair(e.ends.a, e.ends.b, damper_blocks(e, p.cut_dampers[i], k));
    }
  PairBlocks sum;
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    if (cut.type == JointType::gear) continue;
    sum.set_zero();
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const double multiplier = z.lambda.size() > 0 ? z.lambda[cut.first_row + static_cast<int>(r)] : 0;
      if (multiplier == 0) continue;
      sum += row_blocks(cut, p.cuts[c], cut.rows[r], multiplier, k, lines);
    }
    add_pair(cut.ends.a, cut.ends.b, sum);
  }
}

// What tree joints transmit, and what they hold. Without q the metric alone.
void BodyElimination::add_joints(const Problem& problem, const Eigen::VectorXd* q) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& x = nodes_[i];
    const int k = x.columns;
    Mat6 p = Mat6::Zero(), t = Mat6::Zero();
    if (q) {
      Square g = Square::Zero(k, k);
      Columns turns(6, k);
      for (int c = 0; c < k; ++c) {
        Vec6 s = x.s.col(c);
        s.tail<3>() *= length_;
        turns.col(c) = turned(s, x.load.head<3>(), x.load.tail<3>());
        turns.col(c).tail<3>() *= length_;
      }
      for (int c = 0; c < k; ++c) {
        const auto column = static_cast<std::size_t>(c);
        const Link& link = problem.system.links[static_cast<std::size_t>(x.stage[column])];
        const LinkParameters& lp = problem.parameters.links[static_cast<std::size_t>(x.stage[column])];
        for (int d = 0; d < k; ++d) { // what is nearer the root feels a wrench turn, and a rotation its own
          const int at = x.stage[static_cast<std::size_t>(d)];
          if (at < x.stage[column] || (at == x.stage[column] && k > 1 && link.type == LinkType::spherical))
            g(d, c) += x.s.col(d).dot(turns.col(c));
        }
        if (!lp.elastic) continue;
        if (link.type != LinkType::spherical) {
          const double unit = problem.scaling.column[link.v];
          g(c, c) += lp.force[0].curvature((*q)[link.q]) * unit * unit;
        } else if (link.v == x.v[column]) {
          g.block<3, 3>(c, c) += rotation_stiffness(link, lp, *q);
        }
      }
      p = x.d * g * x.d.transpose();
      t = turns * x.d.transpose();
    }
    const Mat6 w = x.d * x.weight.head(k).asDiagonal() * x.d.transpose();
    x.stiffness += p;
    x.inertial += w;
    for (int r = 0; r < 6 - k; ++r)
      emit_row(x.multipliers + r, static_cast<int>(i), x.n.col(r));
    if (x.parent < 0) continue;
    Node& parent = node(x.parent);
    const Mat6 by_parent = -p * x.shift, on_parent = x.shift.transpose() * (t - p);
    parent.stiffness -= on_parent * x.shift;
    parent.inertial += x.shift.transpose() * w * x.shift;
    emit_between(static_cast<int>(i), x.parent, by_parent, on_parent, -w * x.shift);
    for (int r = 0; r < 6 - k; ++r)
      emit_row(x.multipliers + r, x.parent, -x.shift.transpose() * x.n.col(r));
  }
}

void BodyElimination::add_rows(const Problem& problem, const Kinematics<double>& k) {
  const System& system = problem.system;
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    const CutParameters& p = problem.parameters.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const int row = cut.first_row + static_cast<int>(r);
      const double unit = problem.scaling.row[row];
      if (cut.type == JointType::gear) {
        emit_coordinate(first_row_ + row, cut.gear_va, -p.ratio * unit * problem.scaling.column[cut.gear_va]);
        emit_coordinate(first_row_ + row, cut.gear_vb, unit * problem.scaling.column[cut.gear_vb]);
        continue;
      }
      RowGradient g = body_row_gradient(cut, p, cut.rows[r], k);
      g.a.tail<3>() *= length_;
      g.b.tail<3>() *= length_;
      emit_row(first_row_ + row, node_at(cut.ends.a), unit * g.a);
      emit_row(first_row_ + row, node_at(cut.ends.b), unit * g.b);
    }
  }
}

void BodyElimination::emit(int row, int column, const Value& value) {
  pattern_.rows.push_back(row + 1);
  pattern_.columns.push_back(column + 1);
  values_.push_back(value);
}

// Point masses feel no turns, neither their own nor each other's.
void BodyElimination::emit_between(int a, int b, const Mat6& ab, const Mat6& ba, const Mat6& metric_ab) {
  for (const int i : {0, 3})
    for (const int j : {0, 3}) {
      const bool shifts = i == 3 && j == 3;
      if (shifts || !ab.block<3, 3>(i, j).isZero(0) || !ba.block<3, 3>(j, i).isZero(0) ||
          !metric_ab.block<3, 3>(i, j).isZero(0))
        emit_block(a, i, b, j, ab, ba, metric_ab);
    }
}

void BodyElimination::emit_block(int a, int first_i, int b, int first_j, const Mat6& ab, const Mat6& ba,
                                 const Mat6& metric_ab) {
  for (int j = first_j; j < first_j + 3; ++j)
    for (int i = first_i; i < first_i + 3; ++i) {
      if (symmetric_) {
        emit(6 * a + i, 6 * b + j, {(ab(i, j) + ba(j, i)) / 2, metric_ab(i, j), 0});
      } else {
        emit(6 * a + i, 6 * b + j, {ab(i, j), metric_ab(i, j), 0});
        emit(6 * b + j, 6 * a + i, {ba(j, i), metric_ab(i, j), 0});
      }
    }
}

void BodyElimination::emit_row(int row, int n, const Vec6& gradient) {
  if (n < 0) return;
  for (int i = 0; i < 6; ++i) {
    emit(row, 6 * n + i, {0, 0, gradient[i]});
    if (!symmetric_) emit(6 * n + i, row, {0, 0, gradient[i]});
  }
}

void BodyElimination::emit_coordinate(int row, int coordinate, double gradient) {
  const auto [n, column] = place_[static_cast<std::size_t>(coordinate)];
  const Node& x = node(n);
  const Vec6 g = gradient * x.d.col(column);
  emit_row(row, n, g);
  emit_row(row, x.parent, -x.shift.transpose() * g);
}

void BodyElimination::finish_nodes() {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& x = nodes_[n];
    const int at = 6 * static_cast<int>(n);
    for (int j = 0; j < 6; ++j)
      for (int i = symmetric_ ? j : 0; i < 6; ++i) {
        const double stiffness = symmetric_ ? (x.stiffness(i, j) + x.stiffness(j, i)) / 2 : x.stiffness(i, j);
        emit(at + i, at + j, {stiffness, x.inertial(i, j), 0});
      }
  }
  loose_.assign(static_cast<std::size_t>(unknowns_), false);
}

void BodyElimination::linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                const Residual<double>& residual, const Magnitudes& magnitudes) {
  take_in(problem, z, k, residual, magnitudes, Lines::exact);
}

bool BodyElimination::linearize_convex(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                       const Residual<double>& residual, const Magnitudes& magnitudes) {
  if (!compressed_) return false;
  take_in(problem, z, k, residual, magnitudes, Lines::convex);
  return true;
}

void BodyElimination::take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                              const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines) {
  lay_out(problem, k);
  compressed_ = false;
  tolerance_ = zero;
  metric_alone_ = false;
  add_bodies(problem, k);
  for (Node& x : nodes_)
    x.load.setZero();
  add_pairs(problem, z, k, lines);
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& x = nodes_[i];
    if (x.parent >= 0) add_wrench(x.load, x.arm, node(x.parent).load);
    x.load.head<3>() += residual.moment[static_cast<std::size_t>(x.link)];
    x.load.tail<3>() += residual.force[static_cast<std::size_t>(x.link)];
  }
  add_joints(problem, &z.q);
  add_rows(problem, k);
  finish_nodes();
  leave_out_what_is_loose(problem, magnitudes);
}

void BodyElimination::linearize_metric(const Problem& problem, const Kinematics<double>& k,
                                       double tolerance) {
  lay_out(problem, k);
  symmetric_ = pattern_.symmetric = true;
  tolerance_ = tolerance;
  metric_alone_ = true;
  add_bodies(problem, k);
  for (Node& x : nodes_)
    x.stiffness.setZero();
  add_joints(problem, nullptr);
  add_rows(problem, k);
  finish_nodes();
  for (Value& value : values_)
    std::swap(value.stiffness, value.metric);
  number();
}

// The turns of a point mass feel nothing, but the terms of their balance cancel with rounding only.
void BodyElimination::leave_out_what_is_loose(const Problem& problem, const Magnitudes& magnitudes) {
  largest_.assign(static_cast<std::size_t>(unknowns_), 0);
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const double size =
        values_[e].fixed != 0 ? std::numeric_limits<double>::infinity() : std::abs(values_[e].stiffness);
    for (int at : {pattern_.rows[e] - 1, pattern_.columns[e] - 1})
      largest_[static_cast<std::size_t>(at)] = std::max(largest_[static_cast<std::size_t>(at)], size);
  }
  bool any = false;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& x = nodes_[n];
    double force = magnitudes.link_force[static_cast<std::size_t>(x.link)] * problem.parameters.length;
    for (int c = 0; c < x.columns; ++c) {
      const int v = x.v[static_cast<std::size_t>(c)];
      force = std::max(force, magnitudes.force[v] * problem.scaling.column[v]);
    }
    const double noise = rounding * force;
    for (std::size_t u = 6 * n; u < 6 * n + 6; ++u)
      if (largest_[u] <= noise) loose_[u] = any = true;
  }
  if (!any) return number();
  std::size_t kept = 0;
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const auto row = static_cast<std::size_t>(pattern_.rows[e] - 1);
    const auto column = static_cast<std::size_t>(pattern_.columns[e] - 1);
    if (loose_[row] || loose_[column]) continue;
    pattern_.rows[kept] = pattern_.rows[e];
    pattern_.columns[kept] = pattern_.columns[e];
    values_[kept++] = values_[e];
  }
  pattern_.rows.resize(kept);
  pattern_.columns.resize(kept);
  values_.resize(kept);
  number();
}

// Numbers what is solved for.
void BodyElimination::number() {
  place_of_unknown_.resize(loose_.size());
  int next = 0;
  for (std::size_t u = 0; u < loose_.size(); ++u)
    place_of_unknown_[u] = loose_[u] ? -1 : next++;
  pattern_.size = next;
  for (std::vector<int>* list : {&pattern_.rows, &pattern_.columns})
    for (int& i : *list)
      i = place_of_unknown_[static_cast<std::size_t>(i - 1)] + 1;
}

void BodyElimination::sum_up(double stiffness, double metric) {
  sum_.resize(values_.size());
  for (std::size_t e = 0; e < values_.size(); ++e)
    sum_[e] = stiffness * values_[e].stiffness + metric * values_[e].metric + values_[e].fixed;
}

void BodyElimination::factor(double shift) {
  flat_.clear();
  sum_up(1, shift);
  negative_ = 1;
  solved_ = pattern_.size == 0 || factors_.factor(pattern_, sum_, tolerance_);
  if (!solved_) return;
  if (pattern_.size == 0) {
    negative_ = redundant_ = 0;
    return find_flat_directions();
  }
  const int multipliers = unknowns_ - 6 * static_cast<int>(nodes_.size());
  // What the metric, which is positive definite, leaves singular are the constraints.
  if (factors_.nullity() == 0 || metric_alone_) {
    redundant_ = factors_.nullity();
  } else if (factors_.nullity() != redundant_) {
    sum_up(0, 1);
    redundant_ = constraints_.factor(pattern_, sum_, zero)
                     ? std::min(constraints_.nullity(), factors_.nullity())
                     : factors_.nullity();
  }
  negative_ = symmetric_ ? std::max(0, factors_.negative() - (multipliers - redundant_)) : 0;
  find_flat_directions();
}

void BodyElimination::find_flat_directions() {
  for (std::size_t u = 0; u < loose_.size(); ++u) {
    if (!loose_[u]) continue;
    const Node& x = nodes_[u / 6];
    Flat flat;
    for (int c = 0; c < x.columns; ++c)
      if (const double share = x.d(static_cast<Eigen::Index>(u % 6), c); share != 0)
        flat.emplace_back(x.v[static_cast<std::size_t>(c)], share);
    if (!flat.empty()) flat_.push_back(std::move(flat));
  }
  const int count = pattern_.size == 0 ? 0 : factors_.nullity() - redundant_;
  if (count <= 0) return;
  if (factors_.nullity() > most_null_directions) {
    flat_.resize(flat_.size() + static_cast<std::size_t>(count));
    return;
  }
  // In coordinates, what is left of the null space is that of the stiffness.
  const Eigen::MatrixXd& space = factors_.null_space();
  Eigen::MatrixXd motions(coordinates_, space.cols());
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < space.cols(); ++i) {
    spread(space.col(i));
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& x = nodes_[n];
      Vec6 m = work_.segment<6>(6 * static_cast<Eigen::Index>(n));
      if (x.parent >= 0) m -= x.shift * work_.segment<6>(6 * x.parent);
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> e = x.d.transpose() * m;
      for (int c = 0; c < x.columns; ++c)
        motions(x.v[static_cast<std::size_t>(c)], i) = e[c];
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> order(motions);
  for (int i = 0; i < count; ++i) {
    column = motions.col(order.colsPermutation().indices()[i]);
    const double size = column.lpNorm<Eigen::Infinity>();
    Flat flat;
    for (int v = 0; v < coordinates_; ++v)
      if (std::abs(column[v]) > 1e-12 * size) flat.emplace_back(v, column[v] / size);
    flat_.push_back(std::move(flat));
  }
}

void BodyElimination::solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                            Eigen::VectorXd& lambda) {
  x.setZero(coordinates_);
  lambda.setZero(rows_);
  if (!solved_) return;
  work_.setZero(unknowns_);
  work_.tail(rows_) = closing;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& n = nodes_[i];
    n.g.setZero();
    for (int c = 0; c < n.columns; ++c)
      n.g += n.d.col(c) * rhs[n.v[static_cast<std::size_t>(c)]];
    work_.segment<6>(6 * static_cast<Eigen::Index>(i)) += n.g;
    if (n.parent >= 0) work_.segment<6>(6 * n.parent) -= n.shift.transpose() * n.g;
  }
  solve_unknowns();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    Vec6 m = work_.segment<6>(6 * static_cast<Eigen::Index>(i));
    if (n.parent >= 0) m -= n.shift * work_.segment<6>(6 * n.parent);
    for (int c = 0; c < n.columns; ++c)
      x[n.v[static_cast<std::size_t>(c)]] = n.d.col(c).dot(m);
  }
  lambda = work_.tail(rows_);
}

// In place; what is loose gets nothing.
void BodyElimination::solve_unknowns() {
  held_.resize(pattern_.size);
  for (std::size_t u = 0; u < loose_.size(); ++u)
    if (const int at = place_of_unknown_[u]; at >= 0) held_[at] = work_[static_cast<Eigen::Index>(u)];
  if (pattern_.size > 0) factors_.solve(held_);
  spread(held_);
}

void BodyElimination::spread(const Eigen::Ref<const Eigen::VectorXd>& held) {
  work_.resize(unknowns_);
  for (std::size_t u = 0; u < loose_.size(); ++u) {
    const int at = place_of_unknown_[u];
    work_[static_cast<Eigen::Index>(u)] = at >= 0 ? held[at] : 0;
  }
}

double BodyElimination::metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) {
  product.resize(x.size());
  double square = 0;
  for (Node& n : nodes_) {
    n.motion.setZero();
    if (n.parent >= 0) n.motion = n.shift * node(n.parent).motion;
    for (int c = 0; c < n.columns; ++c) {
      const int v = n.v[static_cast<std::size_t>(c)];
      n.motion += n.s.col(c) * x[v];
      product[v] = n.weight[c] * x[v];
      square += product[v] * x[v];
    }
    n.g = scaled(inertia_matrix(n)) * n.motion;
    square += n.motion.dot(n.g);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    for (int c = 0; c < n.columns; ++c)
      product[n.v[static_cast<std::size_t>(c)]] += n.s.col(c).dot(n.g);
    if (n.parent >= 0) node(n.parent).g += n.shift.transpose() * n.g;
  }
  return square;
}

void BodyElimination::direction_of(const Flat& flat, Eigen::VectorXd& x) {
  x.setZero(coordinates_);
  for (const auto& [v, share] : flat)
    x[v] = share;
}

} // namespace flyball
