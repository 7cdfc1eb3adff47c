#include "engine/report/report_forces.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/report/phase_range.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/drive_torque.hpp"
#include "engine/system/reactions.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace flyball {
namespace {

// Relative to the largest forces of all: what changes less does not change, and what multipliers that balance
// among themselves move less they do not move.
constexpr double varying_reaction = 1e-7, varying_torque = 1e-9, touched = 1e-7;
constexpr double rounding = 1e-13; // of the loads

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// What the parent's and the child's own axes are, for telling a wrench that turns with a part from one that
// changes.
struct Frames {
  Mat3 parent, child;
};

Frames frames_of(const System& system, const Kinematics<double>& k, const TreeJoint& t) {
  const auto r = [&](int body) {
    return body < 0 ? Mat3(Mat3::Identity()) : k.at(system.body_link[at(body)]).R;
  };
  return {r(t.parent_body), r(t.child_body)};
}

// Of one phase.
struct Snapshot {
  TransmittedForces forces;
  std::vector<Frames> tree, cuts, bearings;
};

Snapshot snapshot(const Problem& problem, const Eigen::VectorXd& lambda, const Workspace& w) {
  const System& system = problem.system;
  Snapshot s{transmitted_forces(system, problem.parameters, lambda, w.kinematics, w.residual), {}, {}, {}};
  for (const TreeJoint& tree : system.tree_joints)
    s.tree.push_back(frames_of(system, w.kinematics, tree));
  for (const CutJoint& cut : system.cuts)
    s.cuts.push_back({w.kinematics.at(cut.ends.a).R, w.kinematics.at(cut.ends.b).R});
  for (const BearingElement& bearing : system.bearings)
    s.bearings.push_back({w.kinematics.at(bearing.ends.a).R, w.kinematics.at(bearing.ends.b).R});
  return s;
}

// N, moments by the mechanism's reach.
double size_of(const TransmittedForces& forces, double length) {
  double size = 0;
  for (const auto* list : {&forces.tree, &forces.cuts, &forces.bearings})
    for (const JointWrench& x : *list)
      size = std::max({size, x.force.norm(), x.torque.norm() / length});
  return size;
}

// What the weights and inertial loads come to, each by its size (N, moments by the mechanism's reach): the
// forces that balance them are rounded by a part of this, however small they are themselves.
double loads_on(const Problem& problem, const Kinematics<double>& k) {
  const Parameters& p = problem.parameters;
  double sum = 0;
  for (std::size_t i = 0; i < k.links.size(); ++i) {
    const double rate = k.links[i].w.squaredNorm();
    sum += p.links[i].mass * (k.links[i].dv.norm() + rate * p.links[i].com.norm()) +
           p.links[i].inertia.norm() * rate / p.length;
  }
  return sum;
}

// Multipliers that balance among themselves, Phi_q^T lambda = 0, with part of every direction of that null
// space: arbitrary ones, the `draw`-th, less those of the same forces that are found for any. At evaluated
// and factored constraints.
Eigen::VectorXd self_balanced_multipliers(const Problem& problem, int draw, Workspace& w) {
  const System& system = problem.system;
  Eigen::VectorXd arbitrary(system.rows); // scaled
  for (Eigen::Index i = 0; i < system.rows; ++i)
    arbitrary[i] =
        1.5 + std::sin(2.4 * static_cast<double>(i * i) + 1 + draw * (1.7 + static_cast<double>(i)));
  Eigen::VectorXd force = Eigen::VectorXd::Zero(system.nv);
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    for (std::size_t r = 0; r < cut.rows.size(); ++r) {
      const int row = cut.first_row + static_cast<int>(r);
      const double multiplier = arbitrary[row] * problem.scaling.row[row];
      row_gradient(cut, problem.parameters.cuts[c], cut.rows[r], w.kinematics,
                   [&](int v, double g) { force[v] += multiplier * g; });
    }
  }
  const Eigen::VectorXd target = force.cwiseProduct(problem.scaling.column);
  Eigen::VectorXd found;
  if (!balance_with_tied_angles(problem, w.kinematics, target, found))
    w.kkt(problem).balance_with_least_norm(target, found);
  return (arbitrary - found).cwiseProduct(problem.scaling.row);
}

// What of the transmitted forces other multipliers would change.
struct Touched {
  std::vector<OpenWrench> tree, cuts;
  std::vector<bool> drives, gears;
};

// `drawn` with multipliers that balance among themselves besides, as large as what is there, so that rounding
// of neither hides the other; nothing where there are none.
class OtherBalances {
 public:
  OtherBalances(const Problem& problem, const TransmittedForces& drawn, const Unknowns& z, Workspace& w)
      : problem_(problem), z_(z), w_(w), none_(with(Eigen::VectorXd::Zero(problem.system.rows))),
        load_(size_of(drawn, problem.parameters.length)) {}

  double size() const { return load_ > 0 ? load_ : 1; } // N, of the change

  std::optional<TransmittedForces> draw(int number) const {
    const Eigen::VectorXd free = self_balanced_multipliers(problem_, number, w_);
    if (!free.allFinite()) return std::nullopt;
    const TransmittedForces once = with(free);
    double alone = 0;
    for (std::size_t i = 0; i < once.cuts.size(); ++i)
      alone = std::max({alone, (once.cuts[i].force - none_.cuts[i].force).norm(),
                        (once.cuts[i].torque - none_.cuts[i].torque).norm() / problem_.parameters.length});
    for (std::size_t i = 0; i < once.gears.size(); ++i)
      alone = std::max(alone, std::abs(once.gears[i].b.value - none_.gears[i].b.value));
    if (!(alone > 0)) return std::nullopt;
    return with(z_.lambda + free * (size() / alone));
  }

 private:
  TransmittedForces with(const Eigen::VectorXd& lambda) const {
    return transmitted_forces(problem_.system, problem_.parameters, lambda, w_.kinematics, w_.residual);
  }

  const Problem& problem_;
  const Unknowns& z_;
  Workspace& w_;
  TransmittedForces none_;
  double load_; // N
};

Touched find_touched(const Problem& problem, const TransmittedForces& drawn, const Unknowns& z,
                     Workspace& w) {
  Touched out{std::vector<OpenWrench>(drawn.tree.size()), std::vector<OpenWrench>(drawn.cuts.size()),
              std::vector<bool>(drawn.drives.size()), std::vector<bool>(drawn.gears.size())};
  const int dependent = problem.system.rows > 0 ? problem.system.rows - independent_rows(problem, w) : 0;
  if (dependent == 0) return out;
  const double length = problem.parameters.length;
  const OtherBalances others(problem, drawn, z, w);
  std::vector<TransmittedForces> moved;
  for (int i = 0; i < std::min(dependent, 3); ++i) // a vector has three directions
    if (std::optional<TransmittedForces> other = others.draw(i)) moved.push_back(std::move(*other));
  const double least = touched * others.size();
  const auto wrenches = [&](std::vector<JointWrench> TransmittedForces::*list,
                            std::vector<OpenWrench>& open) {
    for (std::size_t i = 0; i < open.size(); ++i) {
      std::vector<Vec3> forces, torques;
      for (const TransmittedForces& other : moved) {
        forces.push_back((other.*list)[i].force - (drawn.*list)[i].force);
        torques.push_back((other.*list)[i].torque - (drawn.*list)[i].torque);
      }
      open[i] = {open_directions(std::move(forces), least),
                 open_directions(std::move(torques), least * length)};
    }
  };
  wrenches(&TransmittedForces::tree, out.tree);
  wrenches(&TransmittedForces::cuts, out.cuts);
  for (const TransmittedForces& other : moved) {
    const auto differs = [&](double a, double b) { return std::abs(a - b) > least * std::min(1., length); };
    for (std::size_t i = 0; i < out.drives.size(); ++i)
      out.drives[i] = out.drives[i] || differs(other.drives[i], drawn.drives[i]);
    for (std::size_t i = 0; i < out.gears.size(); ++i)
      out.gears[i] = out.gears[i] || differs(other.gears[i].b.value, drawn.gears[i].b.value);
  }
  return out;
}

class ForceReport {
 public:
  ForceReport(const Mechanism& mechanism, const Problem& problem, const Unknowns& z, Workspace& w)
      : mechanism_(mechanism), problem_(problem), q_(z.q), system_(problem.system), p_(problem.parameters),
        drawn_(snapshot(problem, z.lambda, w)), touched_(find_touched(problem, drawn_.forces, z, w)),
        size_(size_of(drawn_.forces, p_.length)), loads_(loads_on(problem, w.kinematics)) {
    for (double t : sample_phases(system_, p_, z.q))
      others_.push_back(snapshot(problem, with_reported_multipliers(problem, z.q, t, w).lambda, w));
  }

  void reactions(ReportedForces& out) const {
    const std::size_t joints = mechanism_.joints.size();
    std::vector<int> tree_of(joints, -1), cut_of(joints, -1);
    for (std::size_t i = 0; i < system_.tree_joints.size(); ++i)
      if (const int j = system_.tree_joints[i].joint; j >= 0) tree_of[at(j)] = static_cast<int>(i);
    for (std::size_t i = 0; i < system_.cuts.size(); ++i)
      cut_of[at(system_.cuts[i].joint)] = static_cast<int>(i);
    for (std::size_t n = 0; n < joints; ++n) {
      const Joint& j = mechanism_.joints[n];
      if (j.type == JointType::gear) continue;
      const bool tree = tree_of[n] >= 0;
      if (!tree && cut_of[n] < 0) continue;
      const std::size_t i = at(tree ? tree_of[n] : cut_of[n]);
      const auto wrench = [&](const Snapshot& s) -> const JointWrench& {
        return tree ? s.forces.tree[i] : s.forces.cuts[i];
      };
      const auto frames = [&](const Snapshot& s) -> const Frames& { return tree ? s.tree[i] : s.cuts[i]; };
      const bool varying = std::ranges::any_of(others_, [&](const Snapshot& s) {
        return varies(wrench(drawn_), frames(drawn_), wrench(s), frames(s));
      });
      const OpenWrench& open = tree ? touched_.tree[i] : touched_.cuts[i];
      out.reactions.push_back({j.name, wrench(drawn_).force, wrench(drawn_).torque, varying, open});
      out.nonunique = out.nonunique || open.any();
    }
  }

  void bearings(ReportedForces& out) const {
    for (std::size_t i = 0; i < system_.bearings.size(); ++i) {
      const JointWrench& drawn = drawn_.forces.bearings[i];
      const bool varying = std::ranges::any_of(others_, [&](const Snapshot& s) {
        return varies(drawn, drawn_.bearings[i], s.forces.bearings[i], s.bearings[i]);
      });
      out.bearings.push_back(
          {mechanism_.forces[at(system_.bearings[i].force)].name, drawn.force, drawn.torque, varying});
    }
  }

  void gears(const Kinematics<double>& k, ReportedForces& out) const {
    for (std::size_t g = 0; g < drawn_.forces.gears.size(); ++g) {
      const GearForces& x = drawn_.forces.gears[g];
      const Joint& gear = mechanism_.joints[at(x.joint)];
      GearReaction r;
      r.joint = gear.name;
      r.nonunique = touched_.gears[g] || x.a.link < 0;
      out.nonunique = out.nonunique || r.nonunique;
      const auto [a, b] = ends_in_order(mechanism_, system_, x);
      if (a.link >= 0) {
        const Link& link = system_.links[at(b.link)];
        r.a = a.value;
        r.b = b.value;
        r.angle_a = system_.links[at(a.link)].type == LinkType::revolute;
        r.angle_b = link.type == LinkType::revolute;
        (r.angle_b ? r.torque : r.force) = k.links[at(b.link)].axis * (link.reversed ? -r.b : r.b);
      }
      for (const Snapshot& s : others_)
        r.varying =
            r.varying || std::abs(s.forces.gears[g].b.value - x.b.value) > torque_tolerance(r.angle_b);
      out.gears.push_back(std::move(r));
    }
  }

  void drive_torques(const Kinematics<double>& drawn, Workspace& w, ReportedForces& out) const {
    std::vector<int> varying;
    for (std::size_t d = 0; d < system_.drives.size(); ++d) {
      if (system_.drives[d].motor != static_cast<int>(d)) continue;
      const Link& link = system_.links[at(system_.drives[d].link)];
      const TreeJoint& joint = system_.tree_joints[at(link.tree_joint)];
      if (joint.joint >= 0 && !mechanism_.joints[at(joint.joint)].coordinates[at(link.coordinate)].drive)
        continue; // loops or gears make it turn
      DriveTorque torque;
      torque.joint = joint.name;
      torque.index = link.coordinate;
      torque.count = coordinate_count(joint.type);
      torque.angle = link.type == LinkType::revolute;
      // Where the tree runs against the joint its axes are turned round and so is nothing else: the
      // coordinate keeps its sign.
      torque.value = drawn_.forces.drives[d];
      torque.nonunique = touched_.drives[d];
      torque.given = given(system_.drives[d].link, drawn);
      for (const Snapshot& s : others_)
        if (std::abs(s.forces.drives[d] - torque.value) > torque_tolerance(torque.angle))
          torque.varying = true;
      if (torque.varying) varying.push_back(static_cast<int>(d));
      out.drive_torques.push_back(std::move(torque));
    }
    if (varying.empty()) return;
    std::vector<std::optional<PhaseRange>> ranges = drive_ranges(problem_, q_, varying, w);
    std::size_t next = 0;
    for (DriveTorque& torque : out.drive_torques)
      if (torque.varying) torque.range = ranges[next++];
  }

 private:
  // Nothing where the drive on this link gives no torque.
  std::optional<DriveTorque::Given> given(int link, const Kinematics<double>& drawn) const {
    for (std::size_t i = 0; i < system_.torques.size(); ++i) {
      const DriveTorqueElement& element = system_.torques[i];
      if (element.link != link || element.keeps_momentum || element.implied) continue;
      const TorqueAndLoad parts = torque_and_load(system_, p_, i, q_, drawn);
      return DriveTorque::Given{parts.torque, parts.load};
    }
    return std::nullopt;
  }

  bool varies(const JointWrench& a, const Frames& fa, const JointWrench& b, const Frames& fb) const {
    const double least = std::max(varying_reaction * size_, rounding * loads_);
    const auto differs = [&](const Mat3& ra, const Mat3& rb) {
      return (ra.transpose() * a.force - rb.transpose() * b.force).norm() > least ||
             (ra.transpose() * a.torque - rb.transpose() * b.torque).norm() > least * p_.length;
    };
    return differs(fa.parent, fb.parent) && differs(fa.child, fb.child);
  }

  double torque_tolerance(bool angle) const {
    return std::max(varying_torque * size_, rounding * loads_) * (angle ? p_.length : 1);
  }

  const Mechanism& mechanism_;
  const Problem& problem_;
  const Eigen::VectorXd& q_;
  const System& system_;
  const Parameters& p_;
  Snapshot drawn_;
  Touched touched_;
  double size_, loads_; // N
  std::vector<Snapshot> others_;
};

} // namespace

Unknowns with_reported_multipliers(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  Unknowns z{q, Eigen::VectorXd::Zero(problem.system.rows)};
  forward<double>(problem.system, problem.parameters, z.q, t, w.kinematics);
  evaluate_residual<double>(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  if (problem.system.rows == 0) return z;
  factor_constraints(problem, w);
  w.scaled_force = -w.residual.f.cwiseProduct(problem.scaling.column);
  if (!balance_with_tied_angles(problem, w.kinematics, w.scaled_force, w.scaled_lambda))
    w.kkt(problem).balance_with_least_norm(w.scaled_force, w.scaled_lambda);
  z.lambda = w.scaled_lambda.cwiseProduct(problem.scaling.row);
  return z;
}

// Ends come in the order of the chain from the motor, or of the gear.
GearEnds ends_in_order(const Mechanism& mechanism, const System& system, const GearForces& gear) {
  if (gear.a.link < 0) return {gear.a, gear.b};
  const bool in_order = reference_to(system, system.links[at(gear.a.link)]) ==
                        find_coordinate(mechanism, mechanism.joints[at(gear.joint)].joints[0]);
  return in_order ? GearEnds{gear.a, gear.b} : GearEnds{gear.b, gear.a};
}

OpenForces find_open_forces(const Problem& problem, std::size_t joints, const Eigen::VectorXd& q, double t,
                            Workspace& w) {
  const System& system = problem.system;
  OpenForces out;
  const Unknowns z = with_reported_multipliers(problem, q, t, w);
  if (system.rows > 0)
    evaluate_residual<double>(system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  const TransmittedForces forces =
      transmitted_forces(system, problem.parameters, z.lambda, w.kinematics, w.residual);
  Touched open = find_touched(problem, forces, z, w);
  out.joints.resize(joints);
  out.gears.resize(joints);
  for (std::size_t i = 0; i < open.tree.size(); ++i)
    if (const int j = system.tree_joints[i].joint; j >= 0) out.joints[at(j)] = open.tree[i];
  for (std::size_t i = 0; i < open.cuts.size(); ++i)
    out.joints[at(system.cuts[i].joint)] = open.cuts[i];
  for (std::size_t i = 0; i < open.gears.size(); ++i)
    out.gears[at(forces.gears[i].joint)] = open.gears[i] || forces.gears[i].a.link < 0;
  out.drives = std::move(open.drives);
  return out;
}

Unknowns evaluate_reported(const Problem& problem, const Eigen::VectorXd& q, Workspace& w) {
  Unknowns z = with_reported_multipliers(problem, q, 0, w);
  if (problem.system.rows > 0)
    evaluate_residual<double>(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  return z;
}

ReportedForces report_forces(const Mechanism& mechanism, const Problem& problem, const Unknowns& z,
                             Workspace& w) {
  ReportedForces out;
  for (const CutJoint& cut : problem.system.cuts) {
    JointMultipliers m;
    m.joint = mechanism.joints[at(cut.joint)].name;
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      m.values.push_back(z.lambda[cut.first_row + static_cast<int>(r)]);
    out.multipliers.push_back(std::move(m));
  }
  const Kinematics<double> drawn = w.kinematics;
  const ForceReport report(mechanism, problem, z, w);
  report.reactions(out);
  report.bearings(out);
  report.gears(drawn, out);
  report.drive_torques(drawn, w, out);
  return out;
}

} // namespace flyball
