#include "engine/equilibrium/report.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/reactions.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace flyball {
namespace {

double wrapped(double angle) {
  const double turn = 2 * std::numbers::pi;
  angle = std::remainder(angle, turn);
  return angle <= -std::numbers::pi ? angle + turn : angle;
}

std::string cut_name(const ReportInput& in, int cut) {
  return in.mechanism
      .joints[static_cast<std::size_t>(in.problem.system.cuts[static_cast<std::size_t>(cut)].joint)]
      .name;
}

double error_of(const System& system, const Parameters& p, const CoordinateInfo& c, const Eigen::VectorXd& q,
                const Eigen::VectorXd& error) {
  const Link& link = system.links[static_cast<std::size_t>(c.link)];
  if (link.v < 0) return 0;
  if (link.type != LinkType::spherical) return error[link.v];
  const Mat3 rate = rotation_vector_rate(link, p.links[static_cast<std::size_t>(c.link)], q);
  return rate.row(c.index - link.coordinate).cwiseAbs().dot(error.segment<3>(link.v));
}

// Whether a transmitted wrench changes with the drives' phase as seen from both its parts.
struct Frames {
  Mat3 parent, child;
};

Frames frames_of(const System& system, const Kinematics<double>& k, const TreeJoint& t) {
  const auto r = [&](int body) {
    return body < 0 ? Mat3(Mat3::Identity()) : k.at(system.body_link[static_cast<std::size_t>(body)]).R;
  };
  return {r(t.parent_body), r(t.child_body)};
}

// Evaluates the state found at phase t without multipliers, and finds them. Where loops are redundant those
// of least norm, or in large mechanisms with none on rows that follow from others.
Unknowns with_reported_multipliers(const ReportInput& in, double t, Workspace& w) {
  const Problem& problem = in.problem;
  Unknowns z{in.found.z.q, Eigen::VectorXd::Zero(problem.system.rows)};
  forward<double>(problem.system, problem.parameters, z.q, t, w.kinematics);
  evaluate_residual<double>(problem.system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual);
  if (problem.system.rows == 0) return z;
  factor_constraints(problem, w);
  best_multipliers(problem, w, z.lambda);
  if (problem.is_dense())
    z.lambda = w.constraints.least_norm_multipliers(w.target).cwiseProduct(problem.scaling.row);
  return z;
}

// The first of the states is `z`, which is evaluated.
void report_forces(const ReportInput& in, const Unknowns& z, Workspace& w, Solution& out) {
  const System& system = in.problem.system;
  const Parameters& p = in.problem.parameters;
  struct Snapshot {
    TransmittedForces forces;
    std::vector<Frames> tree, cuts;
  };
  const auto snapshot = [&](const Eigen::VectorXd& lambda) {
    Snapshot s{transmitted_forces(system, p, lambda, w.kinematics, w.residual), {}, {}};
    for (const TreeJoint& tree : system.tree_joints)
      s.tree.push_back(frames_of(system, w.kinematics, tree));
    for (const CutJoint& cut : system.cuts)
      s.cuts.push_back({w.kinematics.at(cut.ends.a).R, w.kinematics.at(cut.ends.b).R});
    return s;
  };
  const Snapshot drawn = snapshot(z.lambda);
  std::vector<Snapshot> others;
  for (double t : sample_phases(system, p))
    others.push_back(snapshot(with_reported_multipliers(in, t, w).lambda));
  for (const CutJoint& cut : system.cuts) {
    JointMultipliers m;
    m.joint = in.mechanism.joints[static_cast<std::size_t>(cut.joint)].name;
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      m.values.push_back(z.lambda[cut.first_row + static_cast<int>(r)]);
    out.multipliers.push_back(std::move(m));
  }
  double size = 0;
  for (const JointWrench& x : drawn.forces.tree)
    size = std::max({size, x.force.norm(), x.torque.norm() / p.length});
  const auto varies = [&](const JointWrench& a, const Frames& fa, const JointWrench& b, const Frames& fb) {
    const auto differs = [&](const Mat3& ra, const Mat3& rb) {
      return (ra.transpose() * a.force - rb.transpose() * b.force).norm() > 1e-7 * size ||
             (ra.transpose() * a.torque - rb.transpose() * b.torque).norm() > 1e-7 * size * p.length;
    };
    return differs(fa.parent, fb.parent) && differs(fa.child, fb.child);
  };
  std::vector<int> tree_of(in.mechanism.joints.size(), -1), cut_of(in.mechanism.joints.size(), -1);
  for (std::size_t i = 0; i < system.tree_joints.size(); ++i)
    if (const int j = system.tree_joints[i].joint; j >= 0)
      tree_of[static_cast<std::size_t>(j)] = static_cast<int>(i);
  for (std::size_t i = 0; i < system.cuts.size(); ++i)
    cut_of[static_cast<std::size_t>(system.cuts[i].joint)] = static_cast<int>(i);
  for (std::size_t n = 0; n < in.mechanism.joints.size(); ++n) {
    const Joint& j = in.mechanism.joints[n];
    if (j.type == JointType::gear) continue;
    const auto add = [&](const JointWrench& x, bool varying) {
      out.reactions.push_back({j.name, x.force, x.torque, varying});
    };
    if (tree_of[n] >= 0) {
      const auto i = static_cast<std::size_t>(tree_of[n]);
      add(drawn.forces.tree[i], std::ranges::any_of(others, [&](const Snapshot& s) {
            return varies(drawn.forces.tree[i], drawn.tree[i], s.forces.tree[i], s.tree[i]);
          }));
      continue;
    }
    if (cut_of[n] < 0) continue;
    const auto i = static_cast<std::size_t>(cut_of[n]);
    add(drawn.forces.cuts[i], std::ranges::any_of(others, [&](const Snapshot& s) {
          return varies(drawn.forces.cuts[i], drawn.cuts[i], s.forces.cuts[i], s.cuts[i]);
        }));
  }
  for (std::size_t d = 0; d < system.drives.size(); ++d) {
    if (system.drives[d].motor != static_cast<int>(d)) continue;
    const Link& link = system.links[static_cast<std::size_t>(system.drives[d].link)];
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    DriveTorque torque;
    torque.joint = joint.name;
    torque.index = link.coordinate;
    torque.count = coordinate_count(joint.type);
    torque.angle = link.type == LinkType::revolute;
    // Where the tree runs against the joint its axes are turned round and so is nothing else: the coordinate
    // keeps its sign.
    torque.value = drawn.forces.drives[d];
    for (const Snapshot& s : others)
      if (std::abs(s.forces.drives[d] - torque.value) > 1e-7 * size * (torque.angle ? p.length : 1))
        torque.varying = true;
    out.drive_torques.push_back(std::move(torque));
  }
}

std::string floquet_message(const Floquet& f, std::optional<bool> stable) {
  std::string out = " The linearised motion turns with the drives: in a period of " +
                    rounded_text(f.period, 4) + " s its largest multiplier is " +
                    rounded_text(std::abs(f.multipliers.front()), 7) + " in size.";
  if (stable == true && f.growth.front() > -1e-9 / f.period)
    out += " Motions beside the state neither grow nor die out.";
  else if (!stable)
    out += " That is too close to 1 to tell.";
  return out;
}

std::string floquet_message(FloquetFailure failure) {
  const std::string begin =
      " Whether it is stable is not known: the linearised motion turns with the drives, ";
  switch (failure) {
  case FloquetFailure::no_period: return begin + "and their speeds have no common period.";
  case FloquetFailure::singular:
    return begin +
           "and a direction in which it moves has neither mass nor damping nor stiffness at some phase.";
  case FloquetFailure::unresolved: return begin + "and is too large or too stiff to follow through a period.";
  case FloquetFailure::cancelled: return begin + "and looking for its multipliers was cancelled.";
  }
  return "";
}

} // namespace

bool turns_freely(const System& system, const Parameters& p, int l) {
  const Link& link = system.links[static_cast<std::size_t>(l)];
  return link.type == LinkType::revolute && link.drive < 0 && !p.links[static_cast<std::size_t>(l)].elastic &&
         std::ranges::none_of(system.cuts, [&](const CutJoint& cut) {
           return cut.type == JointType::gear && (cut.gear_va == link.v || cut.gear_vb == link.v);
         });
}

std::vector<CoordinateSolution> coordinate_solutions(const System& system, const Parameters& p,
                                                     const Eigen::VectorXd& q, const Eigen::VectorXd& error) {
  std::vector<CoordinateSolution> out;
  for (const CoordinateInfo& c : system.coordinates) {
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    CoordinateSolution x;
    x.joint = joint.name;
    x.index = c.index;
    x.count = coordinate_count(joint.type);
    x.angle = c.angle;
    x.driven = system.links[static_cast<std::size_t>(c.link)].drive >= 0;
    x.value = coordinate_value(system, p, q, c);
    if (turns_freely(system, p, c.link)) x.value = wrapped(x.value);
    x.error = error_of(system, p, c, q, error);
    out.push_back(std::move(x));
  }
  return out;
}

std::vector<std::pair<std::string, double>> start_values(const std::vector<CoordinateSolution>& coordinates) {
  std::vector<std::pair<std::string, double>> values;
  for (const CoordinateSolution& c : coordinates)
    if (!c.driven) values.emplace_back(coordinate_label(c), c.value);
  return values;
}

std::string failure_message(const ReportInput& in, Workspace& w) {
  if (in.found.status == Status::infeasible)
    return "The loops cannot be closed: \"" + cut_name(in, in.found.open_cut) +
           "\" stays open however the other coordinates are chosen.";
  if (in.found.status == Status::not_converged) return in.found.message;
  if (in.existence.loops_open)
    return "No steady state: as the drives turn, \"" + cut_name(in, in.existence.worst_cut) +
           "\" cannot be held with all other coordinates constant, whichever joint of its loop is cut" +
           (std::ranges::any_of(
                in.mechanism.joints,
                [](const Joint& j) { return j.cut.has_value() && coordinate_count(j.type) > 0; })
                ? "; the joints marked with \"cut\" were left as marked."
                : ".");
  return "No steady state: " + blame(in.problem, in.mechanism, in.found.z.q, in.existence.phase, w) +
         " turns with the drives, so the balance holds at one moment only.";
}

bool is_finite(const Solution& s) {
  const auto numbers = [](const auto& list, const auto& of) {
    return std::ranges::all_of(list, [&](const auto& x) { return std::isfinite(of(x)); });
  };
  return std::isfinite(s.residual) && std::isfinite(s.potential.value_or(0)) &&
         std::isfinite(s.condition.value_or(0)) &&
         numbers(s.coordinates, [](const CoordinateSolution& c) { return c.value + c.error; }) &&
         numbers(s.multipliers,
                 [](const JointMultipliers& m) {
                   return std::accumulate(m.values.begin(), m.values.end(), 0.);
                 }) &&
         numbers(s.drive_torques, [](const DriveTorque& t) { return t.value; }) &&
         numbers(s.reactions, [](const Reaction& r) { return r.force.sum() + r.torque.sum(); }) &&
         numbers(s.poses, [](const Pose& p) { return p.position.sum() + p.rotation.coeffs().sum(); });
}

void report(const ReportInput& in, const Eigen::VectorXd& error, bool details, Workspace& w, Solution& out) {
  const System& system = in.problem.system;
  const Parameters& p = in.problem.parameters;
  out.coordinates = coordinate_solutions(system, p, in.found.z.q, error);
  out.stable = in.stability.stable;
  out.stability_reason = in.stability.reason;
  out.eigenvalues = in.stability.eigenvalues;
  out.floquet = in.stability.floquet;
  if (!in.stability.neutral.empty()) {
    std::vector<bool> takes_part(static_cast<std::size_t>(system.nv)), named(system.tree_joints.size());
    for (int v : in.stability.neutral)
      takes_part[static_cast<std::size_t>(v)] = true;
    for (const Link& link : system.links)
      for (int v = link.v; link.v >= 0 && v < link.v + (link.type == LinkType::spherical ? 3 : 1); ++v) {
        const auto t = static_cast<std::size_t>(link.tree_joint);
        if (!takes_part[static_cast<std::size_t>(v)] || named[t]) continue;
        named[t] = true;
        out.neutral.push_back(system.tree_joints[t].name);
      }
  }
  // The balance with its multipliers, as solved.
  const Unknowns z = with_reported_multipliers(in, 0, w);
  if (system.rows > 0) evaluate_residual<double>(system, p, z.q, z.lambda, w.kinematics, w.residual);
  evaluate_magnitudes(system, p, z.q, z.lambda, w.kinematics, w.magnitudes);
  const int rank = independent_rows(in.problem, w);
  out.residual = scaled_residual(in.problem, w);
  body_poses(system, in.mechanism, p, w.kinematics, out.poses);
  if (details && system.nv > 0 && system.nv <= largest_for_eigenvalues) {
    const Problem whole{system, p, in.problem.scaling, in.problem.cancel};
    factor(whole, z, w);
    // Of the balance on the null space and the constraints on the range, both in scaled units and
    // equilibrated.
    out.condition = 1;
    if (const Eigen::VectorXd values = w.hessian.singular_values(); values.size() > 0) {
      // Directions that nothing resists are not solved for.
      double low = values.maxCoeff();
      for (double value : values)
        if (value > ReducedHessian::zero * values.maxCoeff()) low = std::min(low, value);
      if (low > 0) out.condition = values.maxCoeff() / low;
    }
  }
  if (details) {
    out.reactions_nonunique = rank < system.rows;
    report_forces(in, z, w, out);
  }
  out.message = in.found.message;
  if (out.message.empty()) out.message = "Converged.";
  if (rank < system.rows)
    out.message += " The loops are redundant: " + std::to_string(rank) + " of " +
                   std::to_string(system.rows) + " constraint equations are independent.";
  if (!out.neutral.empty()) {
    constexpr std::size_t named = 20;
    out.message += " Nothing resists";
    for (std::size_t i = 0; i < std::min(named, out.neutral.size()); ++i)
      out.message += (i ? ", " : " ") + out.neutral[i];
    if (out.neutral.size() > named)
      out.message += " and " + std::to_string(out.neutral.size() - named) + " more";
    out.message += out.neutral.size() == 1 ? "; its value is arbitrary." : "; their values are arbitrary.";
  }
  if (!out.stability_reason && !out.eigenvalues && system.nv <= largest_for_eigenvalues)
    out.message +=
        " Whether it is stable is not known: the eigenvalues were not found, the iteration for them does "
        "not converge.";
  else if (!out.stability_reason)
    out.message += " Whether it is stable was left out: that takes eigenvalues, and there are more than " +
                   std::to_string(largest_for_eigenvalues) + " coordinates.";
  if (out.floquet) out.message += floquet_message(*out.floquet, out.stable);
  if (in.stability.floquet_failure) out.message += floquet_message(*in.stability.floquet_failure);
  if (out.stability_reason == StabilityReason::gyroscopic_only)
    out.message +=
        " Rotation alone keeps this state, which is no minimum of the amended potential: any damping in "
        "what moves would make it unstable.";
  if (out.stable == false && in.found.message.empty()) out.message += " This state is unstable.";
}

Sensitivity name_rates(const System& system, const std::string& address, const Eigen::VectorXd& rate) {
  Sensitivity out;
  out.address = address;
  for (const CoordinateInfo& c : system.coordinates) {
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (link.v < 0 || link.type == LinkType::spherical) continue;
    out.rates.push_back({joint.name, c.index, coordinate_count(joint.type), rate[link.v]});
  }
  return out;
}

void set_start(const System& system, const Parameters& parameters,
               const std::vector<std::pair<std::string, double>>& start, Eigen::VectorXd& q) {
  std::vector<std::optional<double>> values(system.coordinates.size());
  for (const auto& [name, value] : start) {
    const auto named = [&system, &name = name](const CoordinateInfo& c) { // clang captures no binding
      const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
      return name == joint.name + "." + std::to_string(c.index) ||
             (coordinate_count(joint.type) == 1 && name == joint.name);
    };
    const auto c = std::ranges::find_if(system.coordinates, named);
    if (c == system.coordinates.end())
      throw SceneError(name,
                       "is not a free coordinate; use the joint's name, or name.index where it has several");
    if (system.links[static_cast<std::size_t>(c->link)].drive >= 0)
      throw SceneError(name, "is driven; a start is for free coordinates");
    values[static_cast<std::size_t>(c - system.coordinates.begin())] = value;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const CoordinateInfo& c = system.coordinates[i];
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (link.type != LinkType::spherical) {
      if (values[i]) set_coordinate(system, parameters, c, *values[i], q);
    } else if (c.index == link.coordinate) { // the three components of a rotation vector come together
      const LinkParameters& p = parameters.links[static_cast<std::size_t>(c.link)];
      Vec3 r = rotation_vector(link, p, q);
      bool given = false; // else not even rounding changes
      for (int k = 0; k < 3; ++k)
        if (const auto& value = values[i + static_cast<std::size_t>(k)]) {
          r[k] = *value;
          given = true;
        }
      if (given) set_rotation_vector(link, p, r, q);
    }
  }
}

} // namespace flyball
