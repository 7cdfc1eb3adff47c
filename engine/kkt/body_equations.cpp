#include "engine/kkt/body_equations.hpp"

#include "engine/kkt/kkt_system.hpp"

#include <algorithm>

namespace flyball {
namespace {

// What a joint with an elastic element, and the load beyond it, ask for by a unit of its coordinates; and how
// the load turns with each of them.
struct JointTerms {
  Mat6 stiffness = Mat6::Zero(), turns = Mat6::Zero();
};

JointTerms joint_terms(const Problem& problem, const BodyNode& x, const Vec6& load, const Eigen::VectorXd& q,
                       const Kinematics<double>& kinematics, const MotionWeights& weights) {
  const int k = x.columns;
  const double length = problem.parameters.length;
  JointTerms terms;
  auto& [g, turns] = terms;
  for (int c = 0; c < k; ++c) {
    Vec6 s = x.s.col(c);
    s.tail<3>() *= length;
    turns.col(c) = turned(s, load.head<3>(), load.tail<3>());
    turns.col(c).tail<3>() *= length;
  }
  for (int c = 0; c < k; ++c) {
    const auto column = static_cast<std::size_t>(c);
    const Link& link = problem.system.links[static_cast<std::size_t>(x.stage[column])];
    const LinkParameters& lp = problem.parameters.links[static_cast<std::size_t>(x.stage[column])];
    for (int d = 0; d < k; ++d) { // what is nearer the root feels a wrench turn, and a rotation its own
      const int at = x.stage[static_cast<std::size_t>(d)];
      if (at < x.stage[column] || (at == x.stage[column] && k > 1 && link.type == LinkType::spherical))
        g(d, c) += weights.stiffness * x.s.col(d).dot(turns.col(c));
    }
    if (link.type != LinkType::spherical) {
      const double unit = problem.scaling.column[link.v] * problem.scaling.column[link.v];
      if (lp.elastic) g(c, c) += weights.stiffness * lp.force[0].curvature(q[link.q]) * unit;
      if (weights.velocity != 0)
        g(c, c) += weights.velocity *
                   coordinate_damping(problem.system, problem.parameters, x.stage[column], kinematics) * unit;
    } else if (link.v == x.v[column]) {
      if (lp.elastic) g.block<3, 3>(c, c) += weights.stiffness * rotation_stiffness(link, lp, q);
      if (weights.velocity != 0) g.block<3, 3>(c, c) += weights.velocity * rotation_damping(link, lp, q);
    }
  }
  turns *= weights.stiffness;
  return terms;
}

// Of the parent's motion to that of a body by itself.
Mat6 carrying(const BodyNode& x) {
  Mat6 m = Mat6::Identity();
  m.bottomLeftCorner<3, 3>() = -skew(x.lever);
  return m;
}

} // namespace

void BodyEquations::assemble(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                             const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines) {
  weights_ = {};
  lay_out(problem, problem.symmetric(), BodyEntries::Zeros::left_out);
  add_all(problem, z, k, residual, lines);
  noise_.resize(static_cast<std::size_t>(nodes_.size()));
  nodes_.for_each(
      [&](int i) { noise_[static_cast<std::size_t>(i)] = noise_of(problem, nodes_[i], magnitudes); });
  entries_.drop_unconstrained_below(noise_);
}

void BodyEquations::assemble_motion(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                    const Residual<double>& residual, const Magnitudes& magnitudes,
                                    const MotionWeights& weights) {
  weights_ = weights;
  const bool mass_alone = weights.velocity == 0 && weights.stiffness == 0;
  lay_out(problem, mass_alone, BodyEntries::Zeros::kept);
  add_all(problem, z, k, residual, Lines::exact);
  noise_.assign(static_cast<std::size_t>(nodes_.size()), 0);
  if (!mass_alone)
    nodes_.for_each([&](int i) {
      noise_[static_cast<std::size_t>(i)] = weights.stiffness * noise_of(problem, nodes_[i], magnitudes);
    });
  entries_.drop_unconstrained_below(noise_);
}

void BodyEquations::add_all(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                            const Residual<double>& residual, Lines lines) {
  const Division& division = problem.system.division;
  const bool forces = weights_.stiffness != 0 || weights_.velocity != 0;
  for_parts(division, [&](const SystemPart& part, std::size_t n) {
    add_bodies(problem, k, n, true);
    if (forces) add_pairs(problem, z, k, lines, part, n);
  });
  if (forces) {
    add_body_forces(problem, k);
    add_pairs(problem, z, k, lines, division.between, between_);
    if (problem.parameters.moving) add_dampers(problem, k, between_);
  }
  for_parts(division, [&](const SystemPart& part, std::size_t n) {
    for (int i = nodes_.first_of_part()[n + 1]; i-- > nodes_.first_of_part()[n];) {
      if (forces) sum_up_load(i, residual);
      add_joint(problem, k, n, i, &z.q);
    }
    add_rows(problem, k, part, n);
  });
  add_rows(problem, k, division.between, between_);
}

void BodyEquations::assemble_metric(const Problem& problem, const Kinematics<double>& k,
                                    BodyEntries::Zeros zeros) {
  const Division& division = problem.system.division;
  lay_out(problem, true, zeros);
  for_parts(division, [&](const SystemPart&, std::size_t n) { add_bodies(problem, k, n, false); });
  for_parts(division, [&](const SystemPart& part, std::size_t n) {
    for (int i = nodes_.first_of_part()[n + 1]; i-- > nodes_.first_of_part()[n];)
      add_joint(problem, k, n, i, nullptr);
    add_rows(problem, k, part, n);
  });
  add_rows(problem, k, division.between, between_);
  entries_.keep_all_with_metric();
}

bool BodyEquations::compressed() const {
  return std::ranges::find(compressed_, true) != compressed_.end();
}

// Numbers the unknowns: motions, multipliers of tree joints, those of cut joints.
void BodyEquations::lay_out(const Problem& problem, bool symmetric, BodyEntries::Zeros zeros) {
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
  const std::size_t parts = problem.system.division.parts.size();
  between_ = parts > 1 ? parts : 0;
  entries_.clear(nodes_.size(), multipliers(), symmetric, between_ + 1, zeros);
  compressed_.assign(between_ + 1, false);
  sums_.resize(static_cast<std::size_t>(nodes_.size()));
}

// What each body does by itself. Bodies go through the cache one after the other, few times.
void BodyEquations::add_bodies(const Problem& problem, const Kinematics<double>& k, std::size_t part,
                               bool stiff) {
  const double reach = nodes_.length() * nodes_.length();
  const double least = KktSystem::own_share * KktSystem::own_share * std::max(mass_, 1e-300) * reach;
  for (int i = nodes_.first_of_part()[part]; i < nodes_.first_of_part()[part + 1]; ++i) {
    BodyNode& x = nodes_[i];
    Sums& sums = sums_[static_cast<std::size_t>(i)];
    nodes_.place_node(i, problem, k);
    if (stiff) {
      sums.load.setZero();
      set_body_stiffness(problem.parameters, static_cast<std::size_t>(x.link), k, x, sums.stiffness);
      sums.stiffness *= weights_.stiffness;
      if (weights_.velocity != 0 && !x.massless())
        sums.stiffness += weights_.velocity * coriolis_matrix(x, k.links[static_cast<std::size_t>(x.link)].w);
      if (weights_.mass != 0) {
        BodyInertia body = x;
        body.turning = 0;
        sums.stiffness += weights_.mass * inertia_matrix(body);
      }
    } else {
      set_body_inertia(problem.parameters, static_cast<std::size_t>(x.link), k, x);
    }
    const Mat6 inertia = nodes_.scaled(inertia_matrix(x));
    x.weight.setZero();
    for (int c = 0; c < x.columns; ++c)
      x.weight[c] = std::max(KktSystem::own_share * x.s.col(c).dot(inertia * x.s.col(c)), least);
    sums.metric = inertia + x.d * x.weight.asDiagonal() * x.d.transpose();
  }
}

void BodyEquations::add_body_forces(const Problem& problem, const Kinematics<double>& k) {
  for (std::size_t i = 0; i < problem.system.body_forces.size(); ++i) {
    const BodyForceElement& e = problem.system.body_forces[i];
    const BodyForceParameters& f = problem.parameters.body_forces[i];
    const int n = nodes_.at(e.link);
    if (n < 0) continue;
    Mat6 change = Mat6::Zero();
    add_body_force(e, f, k, change);
    change *= weights_.stiffness;
    if (weights_.velocity != 0 && is_of_air(f.type)) {
      Mat6 air = Mat6::Zero();
      add_air_damping(e, f, k, air);
      change += weights_.velocity * air;
    }
    sums_[static_cast<std::size_t>(n)].stiffness += change;
  }
}

void BodyEquations::add_pair(std::size_t list, int a, int b, const PairBlocks& x) {
  if (x.compressed) compressed_[list] = true;
  const int na = nodes_.at(a), nb = nodes_.at(b);
  const double weight = weights_.stiffness;
  if (na >= 0) {
    sums_[static_cast<std::size_t>(na)].stiffness += weight * x.aa;
    sums_[static_cast<std::size_t>(na)].load += x.on_a;
  }
  if (nb >= 0) {
    sums_[static_cast<std::size_t>(nb)].stiffness += weight * x.bb;
    sums_[static_cast<std::size_t>(nb)].load += x.on_b;
  }
  if (na < 0 || nb < 0) return;
  if (na == nb)
    sums_[static_cast<std::size_t>(na)].stiffness += weight * (x.ab + x.ba);
  else
    entries_.add_between(list, na, nb, nodes_.scaled(weight * x.ab), nodes_.scaled(weight * x.ba),
                         Mat6::Zero());
}

void BodyEquations::add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                              Lines lines, const SystemPart& part, std::size_t list) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  for (const int n : part.springs) {
    const auto i = static_cast<std::size_t>(n);
    const PointSpringElement& e = system.springs[i];
    add_pair(list, e.ends.a, e.ends.b, spring_blocks(e, p.springs[i], k, p.moving, lines));
    if (weights_.velocity != 0) add_damping(list, e.ends, spring_damping(e, p.springs[i], k));
  }
  PairBlocks sum;
  for (const int n : part.cuts) {
    const auto c = static_cast<std::size_t>(n);
    const CutJoint& cut = system.cuts[c];
    if (cut.type == JointType::gear) continue;
    const auto multiplier = [&](std::size_t r) {
      return z.lambda.size() > 0 ? z.lambda[cut.first_row + static_cast<int>(r)] : 0;
    };
    if (cut.rows.size() == 1 && multiplier(0) != 0) {
      add_pair(list, cut.ends.a, cut.ends.b,
               row_blocks(cut, p.cuts[c], cut.rows[0], multiplier(0), k, lines));
      continue;
    }
    sum.set_zero();
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      if (const double m = multiplier(r); m != 0) sum += row_blocks(cut, p.cuts[c], cut.rows[r], m, k, lines);
    add_pair(list, cut.ends.a, cut.ends.b, sum);
  }
}

void BodyEquations::add_dampers(const Problem& problem, const Kinematics<double>& k, std::size_t list) {
  for (std::size_t i = 0; i < problem.system.cut_dampers.size(); ++i) {
    const CutDamperElement& e = problem.system.cut_dampers[i];
    const CutDamperParameters& damper = problem.parameters.cut_dampers[i];
    add_pair(list, e.ends.a, e.ends.b, damper_blocks(e, damper, k));
    if (weights_.velocity != 0) add_damping(list, e.ends, damper_damping(e, damper, k));
  }
}

// c g g^T of both ends.
void BodyEquations::add_damping(std::size_t list, const PairEnds& ends, const PairDamping& x) {
  if (x.damping == 0) return;
  const double weight = weights_.velocity * x.damping;
  const int na = nodes_.at(ends.a), nb = nodes_.at(ends.b);
  const auto block = [&](const Vec6& on, const Vec6& by) { return Mat6(weight * on * by.transpose()); };
  if (na >= 0) sums_[static_cast<std::size_t>(na)].stiffness += block(x.rate.a, x.rate.a);
  if (nb >= 0) sums_[static_cast<std::size_t>(nb)].stiffness += block(x.rate.b, x.rate.b);
  if (na < 0 || nb < 0) return;
  if (na == nb)
    sums_[static_cast<std::size_t>(na)].stiffness += block(x.rate.a, x.rate.b) + block(x.rate.b, x.rate.a);
  else
    entries_.add_between(list, na, nb, nodes_.scaled(block(x.rate.a, x.rate.b)),
                         nodes_.scaled(block(x.rate.b, x.rate.a)), Mat6::Zero());
}

// Of a body with all beyond it, whose own loads were summed up before.
void BodyEquations::sum_up_load(int i, const Residual<double>& residual) {
  const BodyNode& x = nodes_[i];
  Vec6& load = sums_[static_cast<std::size_t>(i)].load;
  if (x.parent >= 0) sums_[static_cast<std::size_t>(x.parent)].load += about(load, x.arm);
  load.head<3>() += residual.moment[static_cast<std::size_t>(x.link)];
  load.tail<3>() += residual.force[static_cast<std::size_t>(x.link)];
}

// A body with what its tree joint transmits, and what that holds; after those beyond it, so that then nothing
// is missing. Without q the metric alone.
void BodyEquations::add_joint(const Problem& problem, const Kinematics<double>& k, std::size_t list, int i,
                              const Eigen::VectorXd* q) {
  const BodyNode& x = nodes_[i];
  Sums& sums = sums_[static_cast<std::size_t>(i)];
  Mat6 p = Mat6::Zero(), t = Mat6::Zero();
  if (q) {
    const JointTerms terms = joint_terms(problem, x, sums.load, *q, k, weights_);
    p = x.d * terms.stiffness * x.d.transpose();
    sums.stiffness = nodes_.scaled(sums.stiffness) + p;
    if (x.parent >= 0) t = terms.turns * x.d.transpose();
  } else {
    sums.stiffness.setZero();
  }
  entries_.add_body(list, i, sums.stiffness, sums.metric);
  if (x.columns == 6 && x.parent < 0) return;
  const BodyColumns forbidden = forbidden_motions(x);
  for (int r = 0; r < forbidden.cols(); ++r)
    entries_.add_row(list, x.multipliers + r, i, forbidden.col(r));
  if (x.parent < 0) return;
  Sums& parent = sums_[static_cast<std::size_t>(x.parent)];
  const Mat6 shift = carrying(x), w = x.d * x.weight.asDiagonal() * x.d.transpose();
  const Mat6 by_parent = -p * shift, on_parent = shift.transpose() * (t - p);
  // The parent's sums are in units of its own as yet.
  if (q) parent.stiffness -= nodes_.unscaled(on_parent * shift);
  parent.metric += shift.transpose() * w * shift;
  if (q == nullptr || weights_.stiffness != 0 || weights_.velocity != 0)
    entries_.add_between(list, i, x.parent, by_parent, on_parent, -w * shift);
  for (int r = 0; r < forbidden.cols(); ++r)
    entries_.add_row(list, x.multipliers + r, x.parent, -shift.transpose() * forbidden.col(r));
}

void BodyEquations::add_rows(const Problem& problem, const Kinematics<double>& k, const SystemPart& part,
                             std::size_t list) {
  const System& system = problem.system;
  for (const int n : part.cuts) {
    const auto c = static_cast<std::size_t>(n);
    const CutJoint& cut = system.cuts[c];
    const CutParameters& p = problem.parameters.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const int row = cut.first_row + static_cast<int>(r);
      const double unit = problem.scaling.row[row];
      if (cut.type == JointType::gear) {
        add_coordinate(list, first_row_ + row, cut.gear_va,
                       -p.ratio * unit * problem.scaling.column[cut.gear_va]);
        add_coordinate(list, first_row_ + row, cut.gear_vb, unit * problem.scaling.column[cut.gear_vb]);
        continue;
      }
      RowGradient g = body_row_gradient(cut, p, cut.rows[r], k);
      g.a.tail<3>() *= nodes_.length();
      g.b.tail<3>() *= nodes_.length();
      entries_.add_row(list, first_row_ + row, nodes_.at(cut.ends.a), unit * g.a);
      entries_.add_row(list, first_row_ + row, nodes_.at(cut.ends.b), unit * g.b);
    }
  }
}

void BodyEquations::add_coordinate(std::size_t list, int row, int coordinate, double gradient) {
  const auto [n, column] = nodes_.place(coordinate);
  const BodyNode& x = nodes_[n];
  const Vec6 g = gradient * x.d.col(column);
  entries_.add_row(list, row, n, g);
  entries_.add_row(list, row, x.parent, -about(g, x.lever));
}

// The turns of a point mass feel nothing, but the terms of their balance cancel with rounding only.
double BodyEquations::noise_of(const Problem& problem, const BodyNode& x,
                               const Magnitudes& magnitudes) const {
  double force = magnitudes.link_force[static_cast<std::size_t>(x.link)] * problem.parameters.length;
  for (int c = 0; c < x.columns; ++c) {
    const int v = x.v[static_cast<std::size_t>(c)];
    force = std::max(force, magnitudes.force[v] * problem.scaling.column[v]);
  }
  return KktSystem::rounding * force;
}

void BodyEquations::assemble_rhs(const Eigen::VectorXd& force, const Eigen::VectorXd& closing,
                                 Eigen::VectorXd& reduced) {
  work_.setZero(unknowns_);
  work_.tail(rows_) = closing;
  nodes_.for_each([&](int i) {
    const BodyNode& n = nodes_[i];
    Vec6 g = Vec6::Zero();
    for (int c = 0; c < n.columns; ++c)
      g += n.d.col(c) * force[n.v[static_cast<std::size_t>(c)]];
    work_.segment<6>(6 * i) += g;
    if (n.parent >= 0) work_.segment<6>(6 * n.parent) -= about(g, n.lever);
  });
  entries_.gather(work_, reduced);
}

void BodyEquations::extract_solution(const Eigen::Ref<const Eigen::VectorXd>& reduced,
                                     Eigen::Ref<Eigen::VectorXd> x) {
  entries_.spread(reduced, work_);
  nodes_.for_each([&](int i) {
    const BodyNode& n = nodes_[i];
    Vec6 m = work_.segment<6>(6 * i);
    if (n.parent >= 0) m -= carried(work_.segment<6>(6 * n.parent), n.lever);
    for (int c = 0; c < n.columns; ++c)
      x[n.v[static_cast<std::size_t>(c)]] = n.d.col(c).dot(m);
  });
}

void BodyEquations::extract_solution(const Eigen::Ref<const Eigen::VectorXd>& reduced,
                                     Eigen::Ref<Eigen::VectorXd> x, Eigen::VectorXd& lambda) {
  extract_solution(reduced, x);
  lambda = work_.tail(rows_);
}

} // namespace flyball
