#include "engine/report/report.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/kink_message.hpp"
#include "engine/report/messages.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/system/classify.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/point_motion.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace flyball {
namespace {

double error_of(const System& system, const Parameters& p, const CoordinateInfo& c, const Eigen::VectorXd& q,
                const Eigen::VectorXd& error) {
  const Link& link = system.links[static_cast<std::size_t>(c.link)];
  if (link.v < 0 || link.drive >= 0) return 0;
  if (link.type != LinkType::spherical) return error[link.v];
  const Mat3 rate = rotation_vector_rate(link, p.links[static_cast<std::size_t>(c.link)], q);
  return rate.row(c.index - link.coordinate).cwiseAbs().dot(error.segment<3>(link.v));
}

// The motion of the state q as the drives turn; those that stand turn slowly, so that what is driven does not
// depend on their speeds.
Kinematics<double> turning_motion(const System& system, const Parameters& p, const Eigen::VectorXd& q) {
  Parameters turning = p;
  const double fastest = fastest_given_rate(system, p);
  for (const DrivenCoordinate& d : system.drives) {
    const auto l = static_cast<std::size_t>(d.link);
    LinkParameters& link = turning.links[l];
    const double unit = system.links[l].type == LinkType::revolute ? 1 : p.length;
    if (link.speed == 0) link.speed = link.gear_ratio * unit * (fastest > 0 ? 0.37 * fastest : 1);
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

// Of what drives move, rad/s: with a slide's speed over the mechanism's reach.
double fastest_drive(const System& system, const Parameters& p, const Kinematics<double>& k) {
  double fastest = 0;
  for (const DrivenCoordinate& d : system.drives)
    fastest = std::max(fastest, k.at(d.link).w.norm() + k.at(d.link).v.norm() / std::max(p.length, 1e-300));
  return fastest;
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
  out.fastest = fastest_drive(system, p, turning);
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

// Whether a coordinate of a joint that closes a loop turns as the drives do, even where these stand.
bool turns_on(const System& system, const ReportedCoordinate& of) {
  const CutJoint& cut = system.cuts[static_cast<std::size_t>(of.cut)];
  return cut.turns && of.angle && (cut.type == JointType::revolute || cut.type == JointType::cylindrical);
}

struct RateWithError {
  double value = 0, error = 0; // rad/s or m/s
};

// At which a coordinate of a joint that closes a loop goes on in the steady state q; nothing where that
// changes with the phase of the drives. The error by those of q.
std::optional<RateWithError> constant_rate(const System& system, const Parameters& p,
                                           const Eigen::VectorXd& q, const Eigen::VectorXd& error,
                                           const ReportedCoordinate& of) {
  const auto c = static_cast<std::size_t>(of.cut);
  const double unit = of.angle ? 1 : p.length;
  Kinematics<double> k;
  const auto rate_at = [&](const Eigen::VectorXd& there, double t) {
    forward<double>(system, p, there, t, k);
    const JointCoordinates at = joint_coordinates(system.cuts[c], p.cuts[c], k);
    return at.rate.row(of.index).dot(relative_velocity(system.cuts[c], p.cuts[c], k));
  };
  RateWithError out{rate_at(q, 0), 0};
  const double fastest = fastest_drive(system, p, k);
  // Of a rotation vector only one that stands goes on at the same rate.
  if (is_rotation_vector(system.cuts[c].type, of.index) && !(std::abs(out.value) <= 1e-9 * fastest * unit))
    return {};
  const std::vector<DriveRate> rates = drive_rates(system, p, q);
  for (const double time : phase_times(rates))
    if (!(std::abs(rate_at(q, time) - out.value) <=
          (1e-9 + 4 * angle_rounding(rates, time)) * fastest * unit))
      return {};
  // Rates add up the speeds that are found; what the other coordinates change of them is taken as it comes.
  Eigen::VectorXd others = error;
  for (const DriveTorqueElement& torque : system.torques) {
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    if (!finds_speed(link) || error[link.v] == 0) continue;
    Eigen::VectorXd moved = q;
    moved[link.q] += error[link.v];
    others[link.v] = 0;
    out.error += std::abs(rate_at(moved, 0) - out.value);
  }
  if (!others.isZero(0)) {
    Eigen::VectorXd moved = q;
    retract<double>(system, others, moved);
    out.error += std::abs(rate_at(moved, 0) - out.value);
  }
  out.error += 4 * std::numeric_limits<double>::epsilon() * fastest * unit;
  return out;
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
    x.scale = r.angle ? 1 : p.length;
    if (r.cut >= 0) {
      if (!turning && !system.drives.empty() && !all_drives_turn(system, p))
        turning = turning_motion(system, p, q);
      if (measured.cut != r.cut) measured = measure(system, p, r.cut, k, turning ? *turning : k, error);
      x.value = measured.at.value[static_cast<std::size_t>(r.index)];
      x.error = measured.error[r.index];
      x.dependent = true;
      // A loop joint that turns or slides with the drives is driven, too, also where it stands for a moment.
      x.driven = std::abs(measured.rate[r.index]) > 1e-9 * measured.fastest * (r.angle ? 1 : p.length) ||
                 turns_on(system, r);
      const CutJoint& cut = system.cuts[static_cast<std::size_t>(r.cut)];
      const bool may_go_on = !x.driven && !p.phase_free && measured.fastest > 0 &&
                             moving_frame(system, cut.ends.a) != moving_frame(system, cut.ends.b) &&
                             !is_rotation_vector(cut.type, r.index);
      const auto rate =
          x.driven || may_go_on ? constant_rate(system, p, q, error, r) : std::optional<RateWithError>{};
      if (may_go_on && !rate) x.driven = true;
      if (x.driven) x.error = 0;
      if (x.driven && rate) {
        x.speed = rate->value;
        x.speed_error = rate->error;
      }
      out.push_back(std::move(x));
      continue;
    }
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(r.coordinate)];
    x.driven = system.links[static_cast<std::size_t>(c.link)].drive >= 0;
    x.value = coordinate_value(system, p, q, c);
    if (turns_freely(system, p, c.link)) x.value = wrapped_angle(x.value);
    x.error = error_of(system, p, c, q, error);
    if (const Link& link = system.links[static_cast<std::size_t>(c.link)]; finds_speed(link)) {
      x.speed = q[link.q];
      x.speed_error = error[link.v];
      x.speed_scale = found_scale(system, p, c);
    }
    out.push_back(std::move(x));
  }
  return out;
}

std::vector<std::pair<std::string, double>> start_values(const std::vector<CoordinateSolution>& coordinates) {
  std::vector<std::pair<std::string, double>> values;
  for (const CoordinateSolution& c : coordinates)
    if (const auto found = found_number(c); found && !c.dependent)
      values.emplace_back(found->name, found->value);
  return values;
}

bool is_finite(const Solution& s) {
  const auto numbers = [](const auto& list, const auto& of) {
    return std::ranges::all_of(list, [&](const auto& x) { return std::isfinite(of(x)); });
  };
  return std::isfinite(s.residual) && std::isfinite(s.potential.value_or(0)) &&
         std::isfinite(s.condition.value_or(0)) &&
         numbers(s.coordinates,
                 [](const CoordinateSolution& c) {
                   return c.value + c.error + c.speed.value_or(0) + c.speed_error;
                 }) &&
         numbers(s.multipliers,
                 [](const JointMultipliers& m) {
                   return std::accumulate(m.values.begin(), m.values.end(), 0.);
                 }) &&
         numbers(s.drive_torques, [](const DriveTorque& t) { return t.value; }) &&
         numbers(s.reactions, [](const Reaction& r) { return r.force.sum() + r.torque.sum(); }) &&
         numbers(s.bearings, [](const BearingForce& b) { return b.force.sum() + b.torque.sum(); }) &&
         numbers(s.centres, [](const PointMotion& p) { return p.velocity.sum() + p.acceleration.sum(); }) &&
         numbers(s.points,
                 [](const PointSolution& p) {
                   return p.motion.position.sum() + p.motion.velocity.sum() + p.motion.acceleration.sum();
                 }) &&
         numbers(s.poses, [](const Pose& p) { return p.position.sum() + p.rotation.coeffs().sum(); });
}

std::string unknown_coordinate_message(const std::vector<CoordinateSolution>& coordinates) {
  // What is soft may be anywhere, which its error tells, and the rest be known all the same. A speed has a
  // part in all that turns with it.
  constexpr double anywhere = 1e6;
  const auto lost = [](double value, double error, double scale, double times) {
    return error > times * std::max(std::abs(value), scale);
  };
  for (const CoordinateSolution& c : coordinates)
    if ((!c.driven && lost(c.value, c.error, c.scale, anywhere)) ||
        (c.speed && lost(*c.speed, c.speed_error, c.speed_scale, 1)))
      return "An equilibrium was found, but rounding leaves no digit of " + coordinate_label(c) +
             ": the scene's numbers differ too much in size.";
  return {};
}

void report(const ReportInput& in, const Eigen::VectorXd& error, bool details, Workspace& w, Solution& out) {
  const System& system = in.problem.system;
  const Parameters& p = in.problem.parameters;
  out.varies = in.existence.varies;
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
  if (in.measures)
    out.measures = in.measures->solutions(in.problem, z, details ? error : Eigen::VectorXd(), w);
  if (details)
    for (const int l : system.body_link)
      out.centres.push_back(point_motion(p, w.kinematics, {l, p.links[static_cast<std::size_t>(l)].com}));
  if (details) {
    ReportedForces forces = report_forces(in.mechanism, in.problem, z, w);
    out.multipliers = std::move(forces.multipliers);
    out.drive_torques = std::move(forces.drive_torques);
    out.reactions = std::move(forces.reactions);
    out.gears = std::move(forces.gears);
    out.bearings = std::move(forces.bearings);
    out.reactions_nonunique = forces.nonunique;
    if (in.measures)
      in.measures->mark_nonunique(in.mechanism, out.reactions, out.drive_torques, out.measures);
  }
  out.message = solution_message(in, rank, out);
  if (const std::string kinks = kink_message(system, in.mechanism, in.stability); !kinks.empty())
    out.message += " " + kinks;
}

Sensitivity name_rates(const System& system, const std::string& address, const Eigen::VectorXd& rate) {
  Sensitivity out;
  out.address = address;
  for (const CoordinateInfo& c : system.coordinates) {
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (link.v < 0 || link.type == LinkType::spherical) continue;
    out.rates.push_back({joint.name, c.index, coordinate_count(joint.type), rate[link.v], finds_speed(link)});
  }
  return out;
}

void set_start(const System& system, const Parameters& parameters,
               const std::vector<std::pair<std::string, double>>& start, Eigen::VectorXd& q) {
  std::vector<std::optional<double>> values(system.coordinates.size());
  for (const auto& [name, value] : start) {
    if (const CoordinateInfo* turning = coordinate_of_speed(system, name)) {
      q[system.links[static_cast<std::size_t>(turning->link)].q] = value;
      continue;
    }
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
      throw SceneError(name, finds_speed(system.links[static_cast<std::size_t>(c->link)])
                                 ? "is driven by a torque; its speed begins at " + name + ".speed"
                                 : "is driven; a start is for free coordinates");
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
