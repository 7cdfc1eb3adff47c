#include "engine/report/report.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/point_motion.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace flyball {
namespace {

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

// The motion of the state q as the drives turn; those that stand turn slowly, so that what is driven does not
// depend on their speeds.
Kinematics<double> turning_motion(const System& system, const Parameters& p, const Eigen::VectorXd& q) {
  Parameters turning = p;
  double fastest = 0;
  for (const DrivenCoordinate& d : system.drives)
    fastest = std::max(fastest, std::abs(p.links[static_cast<std::size_t>(d.link)].speed));
  for (const DrivenCoordinate& d : system.drives) {
    LinkParameters& link = turning.links[static_cast<std::size_t>(d.link)];
    if (link.speed == 0) link.speed = link.gear_ratio * (fastest > 0 ? 0.37 * fastest : 1);
  }
  turning.moving = !system.drives.empty();
  turning.speed_scale = 1;
  Kinematics<double> k;
  forward<double>(system, turning, q, 0, k);
  return k;
}

bool all_drives_turn(const System& system, const Parameters& p) {
  return p.moving && std::ranges::all_of(system.drives, [&](const DrivenCoordinate& d) {
           return p.links[static_cast<std::size_t>(d.link)].speed != 0;
         });
}

// The coordinates of a joint that closes a loop, and their errors (rad, m).
struct Measured {
  int cut = -1;
  JointCoordinates at;
  Eigen::Matrix<double, 6, 1> error;
  Eigen::Matrix<double, 6, 1> rate; // rad/s or m/s, in the steady state
  double fastest = 0;               // of the drives, rad/s
};

// Errors of q_R by the rates of these coordinates, and what rounds along the chains from either body to the
// other.
Measured measure(const System& system, const Parameters& p, int c, const Kinematics<double>& k,
                 const Kinematics<double>& turning, const Eigen::VectorXd& error) {
  const CutJoint& cut = system.cuts[static_cast<std::size_t>(c)];
  const CutParameters& numbers = p.cuts[static_cast<std::size_t>(c)];
  Measured out{c, joint_coordinates(cut, numbers, k), Eigen::Matrix<double, 6, 1>::Zero(),
               Eigen::Matrix<double, 6, 1>::Zero()};
  out.rate = out.at.rate * relative_velocity(cut, numbers, turning);
  for (const DrivenCoordinate& d : system.drives)
    out.fastest = std::max(out.fastest, turning.at(d.link).w.norm() +
                                            turning.at(d.link).v.norm() / std::max(p.length, 1e-300));
  for (const SupportColumn& column : cut.ends.support)
    out.error += (out.at.rate * relative_velocity(cut, numbers, k, column)).cwiseAbs() * error[column.v];
  const auto depth = [&](int l) { return l < 0 ? 0 : system.links[static_cast<std::size_t>(l)].depth; };
  const double rounding =
      (4 + depth(cut.ends.a) + depth(cut.ends.b)) * std::numeric_limits<double>::epsilon();
  const double reach = k.point(cut.ends.a, numbers.a).norm() + k.point(cut.ends.b, numbers.b).norm();
  RelativeVelocity noise; // of the relative pose
  noise << Vec3::Constant(rounding), Vec3::Constant(rounding * reach);
  out.error += out.at.rate.cwiseAbs() * noise;
  for (int i = 0; i < 6; ++i)
    out.error[i] +=
        2 * std::numeric_limits<double>::epsilon() * std::abs(out.at.value[static_cast<std::size_t>(i)]);
  return out;
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
  case FloquetFailure::no_period:
    return begin + "and their speeds have no common period, or one of more than a thousand turns.";
  case FloquetFailure::singular:
    return begin +
           "and a direction in which it moves has neither mass nor damping nor stiffness at some phase.";
  case FloquetFailure::unresolved:
    return begin + "and is too large, too stiff or too slow in its period beside its own oscillations to "
                   "follow, or its loops turn too far.";
  case FloquetFailure::cancelled: return begin + "and looking for its multipliers was cancelled.";
  }
  return "";
}

} // namespace

std::vector<CoordinateSolution> coordinate_solutions(const System& system, const Parameters& p,
                                                     const Eigen::VectorXd& q, const Eigen::VectorXd& error,
                                                     const Kinematics<double>& k) {
  std::vector<CoordinateSolution> out;
  out.reserve(system.reported.size());
  Measured measured;
  std::optional<Kinematics<double>> turning; // where some drive stands
  for (const ReportedCoordinate& r : system.reported) {
    CoordinateSolution x;
    x.joint = r.joint;
    x.index = r.index;
    x.count = r.count;
    x.angle = r.angle;
    if (r.cut >= 0) {
      if (!turning && !system.drives.empty() && !all_drives_turn(system, p))
        turning = turning_motion(system, p, q);
      if (measured.cut != r.cut) measured = measure(system, p, r.cut, k, turning ? *turning : k, error);
      x.value = measured.at.value[static_cast<std::size_t>(r.index)];
      x.error = measured.error[r.index];
      x.dependent = true;
      // A loop joint that turns or slides with the drives is driven, too.
      x.driven = std::abs(measured.rate[r.index]) > 1e-9 * measured.fastest * (r.angle ? 1 : p.length);
      if (x.driven) x.error = 0;
      out.push_back(std::move(x));
      continue;
    }
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(r.coordinate)];
    x.driven = system.links[static_cast<std::size_t>(c.link)].drive >= 0;
    x.value = coordinate_value(system, p, q, c);
    if (turns_freely(system, p, c.link)) x.value = wrapped_angle(x.value);
    x.error = error_of(system, p, c, q, error);
    out.push_back(std::move(x));
  }
  return out;
}

std::vector<std::pair<std::string, double>> start_values(const std::vector<CoordinateSolution>& coordinates) {
  std::vector<std::pair<std::string, double>> values;
  for (const CoordinateSolution& c : coordinates)
    if (!c.driven && !c.dependent) values.emplace_back(coordinate_label(c), c.value);
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
         numbers(s.centres, [](const PointMotion& p) { return p.velocity.sum() + p.acceleration.sum(); }) &&
         numbers(s.points,
                 [](const PointSolution& p) {
                   return p.motion.position.sum() + p.motion.velocity.sum() + p.motion.acceleration.sum();
                 }) &&
         numbers(s.poses, [](const Pose& p) { return p.position.sum() + p.rotation.coeffs().sum(); });
}

void report(const ReportInput& in, const Eigen::VectorXd& error, bool details, Workspace& w, Solution& out) {
  const System& system = in.problem.system;
  const Parameters& p = in.problem.parameters;
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
  const Unknowns z = evaluate_reported(in.problem, in.found.z.q, w);
  evaluate_magnitudes(system, p, z.q, z.lambda, w.kinematics, w.magnitudes);
  const int rank = independent_rows(in.problem, w);
  out.residual = scaled_residual(in.problem, w);
  out.coordinates = coordinate_solutions(system, p, z.q, error, w.kinematics);
  body_poses(system, in.mechanism, p, w.kinematics, out.poses);
  for (const BodyPoint& point : in.points)
    out.points.push_back({point, point_motion(p, w.kinematics, find_point(system, in.mechanism, p, point))});
  if (details)
    for (const int l : system.body_link)
      out.centres.push_back(point_motion(p, w.kinematics, {l, p.links[static_cast<std::size_t>(l)].com}));
  if (details) {
    ReportedForces forces = report_forces(in.mechanism, in.problem, z, w);
    out.multipliers = std::move(forces.multipliers);
    out.drive_torques = std::move(forces.drive_torques);
    out.reactions = std::move(forces.reactions);
    out.gears = std::move(forces.gears);
    out.reactions_nonunique = forces.nonunique;
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
    if (c == system.coordinates.end() &&
        std::ranges::any_of(system.reported, [&name = name](const ReportedCoordinate& r) {
          return r.cut >= 0 && name == coordinate_label(r);
        }))
      throw SceneError(name, "closes a loop, so it follows from the other coordinates; a start is for those");
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
