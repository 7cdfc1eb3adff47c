#include "engine/equilibrium/body_equations.hpp"

#include "engine/equilibrium/eliminator.hpp"

namespace flyball {
namespace {

// What a joint with an elastic element, and the load beyond it, ask for by a unit of its coordinates; and how
// the load turns with each of them.
struct JointTerms {
  Mat6 stiffness = Mat6::Zero(), turns = Mat6::Zero();
};

JointTerms joint_terms(const Problem& problem, const BodyNode& x, const Eigen::VectorXd& q) {
  const int k = x.columns;
  const double length = problem.parameters.length;
  JointTerms terms;
  auto& [g, turns] = terms;
  for (int c = 0; c < k; ++c) {
    Vec6 s = x.s.col(c);
    s.tail<3>() *= length;
    turns.col(c) = turned(s, x.load.head<3>(), x.load.tail<3>());
    turns.col(c).tail<3>() *= length;
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
      g(c, c) += lp.force[0].curvature(q[link.q]) * unit * unit;
    } else if (link.v == x.v[column]) {
      g.block<3, 3>(c, c) += rotation_stiffness(link, lp, q);
    }
  }
  return terms;
}

} // namespace

void BodyEquations::assemble(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                             const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines) {
  lay_out(problem, problem.symmetric());
  compressed_ = false;
  add_bodies(problem, k, true);
  add_pairs(problem, z, k, lines);
  noise_.resize(static_cast<std::size_t>(nodes_.size()));
  for (int i = nodes_.size(); i-- > 0;) {
    sum_up_load(nodes_[i], residual);
    add_joint(problem, i, &z.q);
    noise_[static_cast<std::size_t>(i)] = noise_of(problem, nodes_[i], magnitudes);
  }
  add_rows(problem, k);
  entries_.hold_above(noise_);
}

void BodyEquations::assemble_metric(const Problem& problem, const Kinematics<double>& k) {
  lay_out(problem, true);
  add_bodies(problem, k, false);
  for (int i = nodes_.size(); i-- > 0;)
    add_joint(problem, i, nullptr);
  add_rows(problem, k);
  entries_.hold_all_by_metric();
}

// Numbers the unknowns: motions, multipliers of tree joints, those of cut joints.
void BodyEquations::lay_out(const Problem& problem, bool symmetric) {
  coordinates_ = problem.system.nv;
  rows_ = problem.system.rows;
  nodes_.lay_out(problem);
  first_row_ = 6 * nodes_.size();
  mass_ = 0;
  for (BodyNode& x : nodes_) {
    x.multipliers = first_row_;
    first_row_ += 6 - x.columns;
    mass_ += problem.parameters.links[static_cast<std::size_t>(x.link)].mass;
  }
  unknowns_ = first_row_ + rows_;
  entries_.clear(unknowns_, symmetric);
}

// What each body does by itself. Bodies go through the cache one after the other, few times.
void BodyEquations::add_bodies(const Problem& problem, const Kinematics<double>& k, bool stiff) {
  const double reach = nodes_.length() * nodes_.length();
  const double least = Eliminator::own_share * Eliminator::own_share * std::max(mass_, 1e-300) * reach;
  for (int i = 0; i < nodes_.size(); ++i) {
    BodyNode& x = nodes_[i];
    nodes_.place_node(i, problem, k);
    x.load.setZero();
    if (stiff) {
      set_body_stiffness(problem.parameters, static_cast<std::size_t>(x.link), k, x);
      x.stiffness = nodes_.scaled(x.own);
    } else {
      set_body_inertia(problem.parameters, static_cast<std::size_t>(x.link), k, x);
      x.stiffness.setZero();
    }
    x.inertial = nodes_.scaled(inertia_matrix(x));
    x.weight.setZero();
    for (int c = 0; c < x.columns; ++c)
      x.weight[c] = std::max(Eliminator::own_share * x.s.col(c).dot(x.inertial * x.s.col(c)), least);
  }
  if (!stiff) return;
  for (std::size_t i = 0; i < problem.system.body_forces.size(); ++i) {
    const BodyForceElement& e = problem.system.body_forces[i];
    const int n = nodes_.at(e.link);
    if (n < 0) continue;
    Mat6 own = Mat6::Zero();
    add_body_force(e, problem.parameters.body_forces[i], k, own);
    nodes_[n].stiffness += nodes_.scaled(own);
  }
}

void BodyEquations::add_pair(int a, int b, const PairBlocks& x) {
  compressed_ |= x.compressed;
  const int na = nodes_.at(a), nb = nodes_.at(b);
  if (na >= 0) {
    nodes_[na].stiffness += nodes_.scaled(x.aa);
    nodes_[na].load += x.on_a;
  }
  if (nb >= 0) {
    nodes_[nb].stiffness += nodes_.scaled(x.bb);
    nodes_[nb].load += x.on_b;
  }
  if (na < 0 || nb < 0) return;
  if (na == nb)
    nodes_[na].stiffness += nodes_.scaled(x.ab) + nodes_.scaled(x.ba);
  else
    entries_.add_between(na, nb, nodes_.scaled(x.ab), nodes_.scaled(x.ba), Mat6::Zero());
}

void BodyEquations::add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
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
    const auto multiplier = [&](std::size_t r) {
      return z.lambda.size() > 0 ? z.lambda[cut.first_row + static_cast<int>(r)] : 0;
    };
    if (cut.rows.size() == 1 && multiplier(0) != 0) {
      add_pair(cut.ends.a, cut.ends.b, row_blocks(cut, p.cuts[c], cut.rows[0], multiplier(0), k, lines));
      continue;
    }
    sum.set_zero();
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      if (const double m = multiplier(r); m != 0) sum += row_blocks(cut, p.cuts[c], cut.rows[r], m, k, lines);
    add_pair(cut.ends.a, cut.ends.b, sum);
  }
}

// Of a body with all beyond it, whose own loads were summed up before.
void BodyEquations::sum_up_load(BodyNode& x, const Residual<double>& residual) {
  if (x.parent >= 0) nodes_[x.parent].load += about(x.load, x.arm);
  x.load.head<3>() += residual.moment[static_cast<std::size_t>(x.link)];
  x.load.tail<3>() += residual.force[static_cast<std::size_t>(x.link)];
}

// What a tree joint transmits, and what it holds; after those beyond it, so that then nothing is missing of
// its body. Without q the metric alone.
void BodyEquations::add_joint(const Problem& problem, int i, const Eigen::VectorXd* q) {
  BodyNode& x = nodes_[i];
  const Mat6 w = x.d * x.weight.asDiagonal() * x.d.transpose();
  x.inertial += w;
  Mat6 p = Mat6::Zero(), t = Mat6::Zero();
  if (q) {
    const JointTerms terms = joint_terms(problem, x, *q);
    p = x.d * terms.stiffness * x.d.transpose();
    x.stiffness += p;
    if (x.parent >= 0) t = terms.turns * x.d.transpose();
  }
  entries_.add_body(i, x.stiffness, x.inertial);
  const int held = 6 - x.columns;
  for (int r = 0; r < held; ++r)
    entries_.add_row(x.multipliers + r, i, x.n.col(r));
  if (x.parent < 0) return;
  BodyNode& parent = nodes_[x.parent];
  const Mat6 by_parent = -p * x.shift, on_parent = x.shift.transpose() * (t - p);
  parent.stiffness -= on_parent * x.shift;
  parent.inertial += x.shift.transpose() * w * x.shift;
  entries_.add_between(i, x.parent, by_parent, on_parent, -w * x.shift);
  for (int r = 0; r < held; ++r)
    entries_.add_row(x.multipliers + r, x.parent, -x.shift.transpose() * x.n.col(r));
}

void BodyEquations::add_rows(const Problem& problem, const Kinematics<double>& k) {
  const System& system = problem.system;
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    const CutParameters& p = problem.parameters.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const int row = cut.first_row + static_cast<int>(r);
      const double unit = problem.scaling.row[row];
      if (cut.type == JointType::gear) {
        add_coordinate(first_row_ + row, cut.gear_va, -p.ratio * unit * problem.scaling.column[cut.gear_va]);
        add_coordinate(first_row_ + row, cut.gear_vb, unit * problem.scaling.column[cut.gear_vb]);
        continue;
      }
      RowGradient g = body_row_gradient(cut, p, cut.rows[r], k);
      g.a.tail<3>() *= nodes_.length();
      g.b.tail<3>() *= nodes_.length();
      entries_.add_row(first_row_ + row, nodes_.at(cut.ends.a), unit * g.a);
      entries_.add_row(first_row_ + row, nodes_.at(cut.ends.b), unit * g.b);
    }
  }
}

void BodyEquations::add_coordinate(int row, int coordinate, double gradient) {
  const auto [n, column] = nodes_.place(coordinate);
  const BodyNode& x = nodes_[n];
  const Vec6 g = gradient * x.d.col(column);
  entries_.add_row(row, n, g);
  entries_.add_row(row, x.parent, -x.shift.transpose() * g);
}

// The turns of a point mass feel nothing, but the terms of their balance cancel with rounding only.
double BodyEquations::noise_of(const Problem& problem, const BodyNode& x,
                               const Magnitudes& magnitudes) const {
  double force = magnitudes.link_force[static_cast<std::size_t>(x.link)] * problem.parameters.length;
  for (int c = 0; c < x.columns; ++c) {
    const int v = x.v[static_cast<std::size_t>(c)];
    force = std::max(force, magnitudes.force[v] * problem.scaling.column[v]);
  }
  return Eliminator::rounding * force;
}

void BodyEquations::put(const Eigen::VectorXd& force, const Eigen::VectorXd& closing, Eigen::VectorXd& held) {
  work_.setZero(unknowns_);
  work_.tail(rows_) = closing;
  for (int i = 0; i < nodes_.size(); ++i) {
    const BodyNode& n = nodes_[i];
    Vec6 g = Vec6::Zero();
    for (int c = 0; c < n.columns; ++c)
      g += n.d.col(c) * force[n.v[static_cast<std::size_t>(c)]];
    work_.segment<6>(6 * i) += g;
    if (n.parent >= 0) work_.segment<6>(6 * n.parent) -= n.shift.transpose() * g;
  }
  entries_.gather(work_, held);
}

void BodyEquations::take(const Eigen::Ref<const Eigen::VectorXd>& held, Eigen::Ref<Eigen::VectorXd> x) {
  entries_.spread(held, work_);
  for (int i = 0; i < nodes_.size(); ++i) {
    const BodyNode& n = nodes_[i];
    Vec6 m = work_.segment<6>(6 * i);
    if (n.parent >= 0) m -= n.shift * work_.segment<6>(6 * n.parent);
    for (int c = 0; c < n.columns; ++c)
      x[n.v[static_cast<std::size_t>(c)]] = n.d.col(c).dot(m);
  }
}

void BodyEquations::take(const Eigen::Ref<const Eigen::VectorXd>& held, Eigen::Ref<Eigen::VectorXd> x,
                         Eigen::VectorXd& lambda) {
  take(held, x);
  lambda = work_.tail(rows_);
}

} // namespace flyball
