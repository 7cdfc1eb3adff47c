#include "engine/report/holding.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/linear_program.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/measures.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/report/standstill.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/tied_motions.hpp"
#include "engine/system/drive_rates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

using Coordinates = std::vector<std::pair<std::string, double>>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int most_held = 400; // by matrices

// What solving takes of a mechanism at coordinates.
struct Compiled {
  System system;
  Parameters parameters;
  Scaling scaling;
  VectorXd q;

  explicit Compiled(const Mechanism& mechanism) : Compiled(mechanism, compile_for_drives(mechanism)) {}
  Compiled(const Mechanism& mechanism, System compiled) : system(std::move(compiled)) {
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, q);
  }
  // The number of a coordinate in the system's list, or -1.
  int find(const Mechanism& mechanism, CoordinateReference at) const {
    for (std::size_t c = 0; c < system.coordinates.size(); ++c) {
      const CoordinateInfo& x = system.coordinates[c];
      if (system.tree_joints[static_cast<std::size_t>(x.tree_joint)].joint == at.joint &&
          x.index == at.coordinate && at.joint < static_cast<int>(mechanism.joints.size()))
        return static_cast<int>(c);
    }
    return -1;
  }
  const Link& link(int coordinate) const {
    return system
        .links[static_cast<std::size_t>(system.coordinates[static_cast<std::size_t>(coordinate)].link)];
  }
  LinkParameters& numbers(int coordinate) {
    return parameters
        .links[static_cast<std::size_t>(system.coordinates[static_cast<std::size_t>(coordinate)].link)];
  }
  Problem problem(const std::atomic<bool>* cancel) const { return {system, parameters, scaling, cancel}; }
};

// Least squares of least norm; numbers that are not finite have none.
VectorXd fit(const MatrixXd& a, const VectorXd& b) {
  return least_squares(a, b).value_or(VectorXd::Zero(a.cols()));
}

// Calls act(numbers) for what gears move along with a drive.
template <class Act>
void for_geared(auto& held, int drive, const Act& act) {
  for (std::size_t d = 0; d < held.system.drives.size(); ++d)
    if (static_cast<int>(d) != drive && held.system.drives[d].motor == drive)
      act(held.parameters.links[static_cast<std::size_t>(held.system.drives[d].link)]);
}

// Whether a coordinate is driven by the drive of another.
bool moved_by_gears(const Compiled& held, int coordinate) {
  const int drive = held.link(coordinate).drive;
  return drive >= 0 && held.system.drives[static_cast<std::size_t>(drive)].motor != drive &&
         !finds_speed(held.link(coordinate));
}

// A drive at rest to another place, rad or m from the drawn one, with what gears move along.
void move_drive(Compiled& held, int drive, double to) {
  LinkParameters& own =
      held.parameters
          .links[static_cast<std::size_t>(held.system.drives[static_cast<std::size_t>(drive)].link)];
  for_geared(held, drive, [&](LinkParameters& x) { x.start += x.gear_ratio * (to - own.start); });
  own.start = to;
}

// What springs and stops of these take of the drive: they are on driven coordinates, which no balance has.
double geared_springs(const Compiled& held, int drive) {
  double sum = 0;
  for_geared(held, drive,
             [&](const LinkParameters& x) { sum += x.gear_ratio * x.force[0].gradient(x.drawn + x.start); });
  return sum;
}

std::string label(const HeldJoint& joint) {
  return coordinate_label(joint);
}

// What friction gives where each of the joints moves by itself.
void tell_each(const std::vector<double>& needed, Holding& out) {
  double most = -1;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    HeldJoint& joint = out.joints[i];
    joint.force = needed[i];
    const double part = joint.limit > 0 ? std::abs(needed[i]) / joint.limit : needed[i] != 0 ? infinite : 0;
    if (part > most) {
      most = part;
      out.first = label(joint);
    }
  }
  out.takes = out.at_least = std::max(most, 0.);
}

// The least largest share t with |force_i| <= t limit_i and G force = needed; G [I, follow^T]. With one
// independent motion all limits are used alike. With several where no least is found it is between the share
// of the least-squares forces and the work that any one motion takes.
void tell_shared(const TiedMotions& which, const std::vector<double>& needed, Holding& out) {
  const auto n = static_cast<Index>(which.independent.size()), m = static_cast<Index>(which.others.size());
  MatrixXd g(n, n + m);
  g << MatrixXd::Identity(n, n), which.follow.transpose();
  VectorXd limits(n + m), d(n);
  for (Index i = 0; i < n; ++i) {
    limits[i] = out.joints[which.independent[static_cast<std::size_t>(i)]].limit;
    d[i] = needed[static_cast<std::size_t>(i)];
  }
  for (Index i = 0; i < m; ++i)
    limits[n + i] = out.joints[which.others[static_cast<std::size_t>(i)]].limit;
  const MatrixXd scaled = g * limits.asDiagonal();
  const auto work_share = [&](const VectorXd& motion) { // no forces within t do more work than t this
    const double most = (scaled.transpose() * motion).lpNorm<1>(), work = std::abs(d.dot(motion));
    return most > 0 ? work / most : work > 0 ? infinite : 0;
  };
  for (Index i = 0; i < n; ++i)
    out.at_least = std::max(out.at_least, work_share(VectorXd::Unit(n, i)));
  if (n == 1) {
    out.takes = out.at_least;
    return;
  }
  if (const std::optional<double> least = least_largest(scaled, d)) {
    out.takes = out.at_least = *least;
    return;
  }
  const VectorXd shares = fit(scaled, d);
  const bool balances = (scaled * shares - d).norm() <= 1e-9 * d.norm();
  out.takes = balances ? shares.lpNorm<Eigen::Infinity>() : infinite;
  // The motion that goes with them does work, too.
  const VectorXd motion = fit(scaled * scaled.transpose(), d);
  out.at_least = std::min(*out.takes, std::max(out.at_least, work_share(motion)));
}

// At which speeds that are found it holds: "spin at 48 rad/s"; empty where none are.
std::string at_found_speeds(const System& system, const VectorXd& q) {
  std::string out;
  for (const DriveTorqueElement& torque : system.torques) {
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    out += (out.empty() ? "" : ", ") + system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name +
           " at " + rounded_text(q[link.q], 6) + (link.type == LinkType::revolute ? " rad/s" : " m/s");
  }
  return out;
}

// How loops tie the coordinates that have friction, with what torques turn free to move as well.
TiedMotions tied_motions_of(const Mechanism& mechanism, std::span<const CoordinateReference> frictions,
                            const Compiled& free, const Coordinates& at, const std::atomic<bool>* cancel,
                            Workspace& w) {
  Compiled moving(mechanism, compile_for_motion(mechanism, free.system));
  Coordinates places = at;
  std::erase_if(places, [&](const auto& x) { return find_coordinate(mechanism, x.first).joint < 0; });
  set_start(moving.system, moving.parameters, places, moving.q);
  std::vector<int> entries;
  for (const CoordinateReference& f : frictions)
    entries.push_back(moving.link(moving.find(mechanism, f)).v);
  return find_tied_motions(moving.problem(cancel), moving.q, entries, w);
}

// Where a coordinate with friction stands: what torques turn as drawn.
double standing_value(const Compiled& free, int coordinate) {
  if (finds_speed(free.link(coordinate)))
    return free.parameters
        .links[static_cast<std::size_t>(free.system.coordinates[static_cast<std::size_t>(coordinate)].link)]
        .drawn;
  return coordinate_value<double>(free.system, free.parameters, free.q,
                                  free.system.coordinates[static_cast<std::size_t>(coordinate)]);
}

// One way to hold a mechanism: all its coordinates with friction stand, and some drives by torque have come
// to rest.
class HoldingAttempt {
 public:
  HoldingAttempt(const Mechanism& mechanism, const Coordinates& at,
                 const std::vector<CoordinateReference>& frictions, Compiled& free, const TiedMotions& which,
                 const std::atomic<bool>* cancel, bool explain)
      : mechanism_(mechanism), at_(at), frictions_(frictions), free_(free), which_(which), cancel_(cancel),
        explain_(explain) {
    for (const std::size_t i : which.independent)
      independent_.push_back(frictions[i]);
  }

  const std::vector<CoordinateReference>& independent() const { return independent_; }

  // Into `out`, which knows the joints; or a message why it is not found. False where the others find no
  // steady state, so that other drives may rest.
  bool hold(std::span<const CoordinateReference> at_rest, Holding& out) {
    try {
      return find(at_rest, out);
    } catch (const SceneError& error) { // a law that is no number there, loops that they close, say
      out.message = "What holding takes is not found with the joints that have friction standing still: " +
                    std::string(error.what()) + ".";
      return at_rest.empty();
    }
  }

 private:
  bool find(std::span<const CoordinateReference> at_rest, Holding& out) {
    std::vector<Standing> held, others; // those that loops tie stand, too
    for (std::size_t i = 0; i < frictions_.size(); ++i) {
      const bool is_independent = std::ranges::find(which_.independent, i) != which_.independent.end();
      (is_independent ? held : others)
          .push_back({frictions_[i], standing_value(free_, free_.find(mechanism_, frictions_[i]))});
    }
    Standstill still = stand_still(mechanism_, held, others, at_rest);
    Mechanism& locked = still.mechanism;
    for (const CoordinateReference& f : frictions_)
      if (auto& c = joint_of(locked, f).coordinates; !c.empty())
        c[static_cast<std::size_t>(f.coordinate)].friction.reset();
    for (std::size_t k = 0; k < held.size(); ++k) {
      const Joint& joint = joint_of(mechanism_, held[k].at);
      if (still.fixed[k] &&
          held[k].value != joint.coordinates[static_cast<std::size_t>(held[k].at.coordinate)].drawn) {
        out.message = "What holding takes is not found away from the drawn pose: " + joint.name +
                      " closes a loop of driven joints.";
        return true;
      }
    }
    Compiled there(locked);
    return settle(still, held, there, out);
  }

  // Coordinates of `at` that are free in the locked mechanism.
  Coordinates rest_of_start(const Standstill& still, const Compiled& held) const {
    Coordinates rest;
    for (const auto& [name, value] : at_) {
      const CoordinateReference c = find_coordinate(mechanism_, name);
      const bool is_held = std::ranges::find(independent_, c) != independent_.end();
      // Without friction of its own a joint may close a loop, and then follows; so it does behind a gear.
      const int there = c.joint >= 0 ? held.find(still.mechanism, c) : -1;
      const bool follows = c.joint >= 0 && (there < 0 || moved_by_gears(held, there));
      if (!is_held && !follows && !is_speed_at_rest(mechanism_, still, name)) rest.emplace_back(name, value);
    }
    return rest;
  }

  bool settle(const Standstill& still, std::span<const Standing> standing, Compiled& held, Holding& out) {
    const Mechanism& locked = still.mechanism;
    for (std::size_t k = 0; k < standing.size(); ++k) {
      if (still.fixed[k]) continue;
      const int to = held.find(locked, standing[k].at);
      move_drive(held, held.link(to).drive, standing[k].value - held.numbers(to).drawn);
    }
    try {
      set_start(held.system, held.parameters, rest_of_start(still, held), held.q);
    } catch (const SceneError& error) { // a speed that nothing finds where they stand still
      out.message = "What holding takes is not found: with the joints that have friction standing still, " +
                    std::string(error.what()) + ".";
      return true;
    }
    const Problem problem = held.problem(cancel_);
    SteadyState steady;
    steady.find(problem, held.q, held.q, {.nearest = !at_.empty()});
    if (!steady.holds) {
      const std::string why = held.system.torques.empty() || !explain_
                                  ? ""
                                  : missing_speed_message(locked, problem, steady.elsewhere());
      out.message =
          "With the joints that have friction standing still there, the others find no steady state." +
          (why.empty() ? "" : " " + why);
      return false;
    }
    if (explain_)
      out.rest_stable = held.system.nv == 0 ? true : find_stability(steady.factored(problem), false).stable;
    tell(still, held, problem, steady.found.z.q, out);
    return true;
  }

  void tell(const Standstill& still, const Compiled& held, const Problem& problem, const VectorXd& q,
            Holding& out) {
    const Mechanism& locked = still.mechanism;
    Workspace w;
    const Unknowns z = evaluate_reported(problem, q, w);
    MeasureSet measures;
    measures.bind(locked, held.system, held.parameters);
    const std::vector<MeasureSolution> laws = measures.solutions(problem, z, {}, w);
    const Kinematics<double> drawn = w.kinematics;
    if (const std::string going = going_on(held, q, drawn); !going.empty()) {
      out.message = "Friction does not hold " + going + ", which goes on with the drives.";
      return;
    }
    const ReportedForces forces = report_forces(locked, problem, z, w);
    std::vector<double> needed;
    for (std::size_t k = 0; k < independent_.size(); ++k) {
      const std::optional<double> carried = carried_torque(still, independent_[k], laws);
      if (!carried) {
        out.message = "What holding takes is not found: a torque has no value there.";
        return;
      }
      const std::optional<double> takes = still.fixed[k] ? needed_by_fixed(k, held, drawn, forces, out)
                                                         : needed_by_drive(k, held, forces, out);
      if (!takes) return;
      needed.push_back(*takes - *carried);
    }
    if (which_.others.empty())
      tell_each(needed, out);
    else
      tell_shared(which_, needed, out);
    const std::string speeds = at_found_speeds(held.system, q);
    const std::string there = speeds.empty() ? "there" : "there, with " + speeds;
    const std::string part = rounded_text(100 * *out.takes, 3) + " % of what it can give";
    out.message = *out.takes <= 1 && out.rest_stable == false
                      ? "With " + part + " friction would hold its joints " + there +
                            ", but what is free beside them is unstable there."
                  : *out.takes <= 1 ? "Friction holds it " + there + ": that takes " + part + "."
                  : out.at_least > 1
                      ? "Friction does not hold it " + there +
                            (out.first.empty() ? std::string(".") : ": " + out.first + " slips.")
                      : "Whether friction holds it " + there +
                            " depends on how the joints in loops share the load, which is not determined.";
  }

  // Of the joints that loops tie one that does not stand, as drives turn the loop; empty where there is none.
  std::string going_on(const Compiled& held, const VectorXd& q, const Kinematics<double>& drawn) const {
    if (which_.others.empty()) return {};
    const double fastest = fastest_given_rate(held.system, held.parameters);
    for (const CoordinateSolution& c :
         coordinate_solutions(held.system, held.parameters, q, VectorXd::Zero(held.system.nv), drawn))
      for (const std::size_t i : which_.others) {
        const CoordinateReference& at = frictions_[i];
        if (c.joint != joint_of(mechanism_, at).name || c.index != at.coordinate) continue;
        const double rate = 1e-9 * fastest * (c.angle ? 1 : held.parameters.length);
        if (c.speed ? std::abs(*c.speed) > rate : c.driven && c.dependent) return coordinate_label(c);
      }
    return {};
  }

  // Of its own spring, where it stands.
  double of_spring(std::size_t k) const {
    const int c = free_.find(mechanism_, independent_[k]);
    if (finds_speed(free_.link(c))) return 0;
    CoordinateForce spring = free_.numbers(c).force[0];
    spring.friction = 0;
    return spring.gradient(free_.q[free_.link(c).q]);
  }

  std::optional<double> needed_by_fixed(std::size_t k, const Compiled& held, const Kinematics<double>& drawn,
                                        const ReportedForces& forces, Holding& out) const {
    const Joint& joint = joint_of(mechanism_, independent_[k]);
    const auto reaction = std::ranges::find(forces.reactions, joint.name, &Reaction::joint);
    if (reaction == forces.reactions.end() || reaction->varying) {
      out.message = "What holding takes is not found: what " + joint.name +
                    " takes changes with the phase of the drives.";
      return std::nullopt;
    }
    const BodyNumbers numbers(mechanism_);
    const int parent = static_cast<int>(numbers[joint.bodies[0]]) - 1;
    const Mat3 turned = parent < 0 ? Mat3(Mat3::Identity())
                                   : drawn.at(held.system.body_link[static_cast<std::size_t>(parent)]).R;
    return holding_force(joint, *reaction, turned) + of_spring(k);
  }

  std::optional<double> needed_by_drive(std::size_t k, const Compiled& held, const ReportedForces& forces,
                                        Holding& out) const {
    const HeldJoint& joint = out.joints[which_.independent[k]];
    const auto torque = std::ranges::find_if(forces.drive_torques, [&](const DriveTorque& d) {
      return d.joint == joint.joint && d.index == joint.index;
    });
    if (torque == forces.drive_torques.end()) {
      out.message = "What holding takes is not found: loops or gears tie " + joint.joint +
                    " to another drive, which holds it or turns it.";
      return std::nullopt;
    }
    if (torque->nonunique && !held.system.torques.empty()) {
      out.message =
          "What holding takes is not determined: loops are redundant, and leave it open how much of "
          "what the drives give reaches " +
          joint.joint + ".";
      return std::nullopt;
    }
    const double own =
        of_spring(k) + geared_springs(held, held.link(held.find(mechanism_, independent_[k])).drive);
    if (torque->varying && !torque->range) {
      out.message = "What holding takes is not found: what " + joint.joint +
                    " takes changes with the phase of drives that slide, or have too many phases together to "
                    "try all.";
      return std::nullopt;
    }
    if (!torque->range) return torque->value + own;
    const double least = torque->range->least + own, most = torque->range->most + own;
    return std::abs(most) > std::abs(least) ? most : least;
  }

  const Mechanism& mechanism_;
  const Coordinates& at_;
  const std::vector<CoordinateReference>& frictions_;
  Compiled& free_;
  const TiedMotions& which_;
  const std::atomic<bool>* cancel_;
  bool explain_;
  std::vector<CoordinateReference> independent_;
};

Holding hold(const Mechanism& mechanism, const Coordinates& at, const std::atomic<bool>* cancel,
             bool explain) {
  Holding out;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (const CoordinateReference& f : frictions) {
    const Joint& joint = joint_of(mechanism, f);
    out.joints.push_back({joint.name,
                          f.coordinate,
                          coordinate_count(joint.type),
                          is_angle(joint.type, f.coordinate),
                          friction_limit(friction_at(mechanism, f)),
                          {}});
  }
  Compiled free(mechanism);
  if (free.system.nv > most_held) {
    out.message = "The margin of holding is not looked for in mechanisms of more than " +
                  std::to_string(most_held) + " coordinates.";
    return out;
  }
  set_start(free.system, free.parameters, at, free.q);

  Workspace w;
  const TiedMotions which = tied_motions_of(mechanism, frictions, free, at, cancel, w);
  out.independent = which.independent;
  HoldingAttempt attempt(mechanism, at, frictions, free, which, cancel, explain);
  std::string first;
  for (const std::vector<CoordinateReference>& at_rest : may_rest(mechanism, attempt.independent())) {
    if (attempt.hold(at_rest, out)) return out;
    if (first.empty()) first = out.message;
  }
  out.message = std::move(first);
  return out;
}

// The part of the speed at which the share that holding takes passes 1: between all of it, where it is below,
// and one where it is above.
double find_slip(const auto& takes, double above) {
  RootBracket bracket(1, takes(1) - 1, above, takes(above) - 1);
  for (int i = 0; i < 100 && bracket.width() > 1e-14 * std::abs(bracket.high()); ++i) {
    const double part = bracket.next(), value = takes(part) - 1;
    if (value == 0) return part;
    bracket.take(part, value);
  }
  return bracket.high();
}

} // namespace

Holding find_holding(const Mechanism& mechanism, const Coordinates& at, const std::atomic<bool>* cancel,
                     bool explain) {
  const Interruptible scope(cancel);
  try {
    return hold(mechanism, at, cancel, explain);
  } catch (const Interrupted&) {
    Holding out;
    out.message = "Cancelled.";
    return out;
  }
}

std::vector<HeldSpeeds> find_held_speeds(const Mechanism& mechanism, const Coordinates& at,
                                         const std::atomic<bool>* cancel) {
  std::vector<HeldSpeeds> out;
  const Holding now = find_holding(mechanism, at, cancel, false);
  if (!now.takes || !(*now.takes < 1)) return out;
  Mechanism varied = mechanism;
  for (Joint& joint : varied.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      std::optional<Drive>& drive = joint.coordinates[i].drive;
      if (!drive || finds_speed(*drive) || drive->speed == 0) continue;
      const double speed = drive->speed;
      HeldSpeeds held{joint.name,
                      static_cast<int>(i),
                      coordinate_count(joint.type),
                      is_angle(joint.type, static_cast<int>(i)),
                      speed,
                      {},
                      {}};
      const auto takes = [&](double part) { // at a part of the speed
        drive->speed = part * speed;
        return find_holding(varied, at, cancel, false).takes.value_or(infinite);
      };
      if (takes(0) > 1) held.lower = speed * find_slip(takes, 0);
      for (double part = 1.125; part < 1000; part = 1 + 2 * (part - 1)) {
        if (!(takes(part) > 1)) continue;
        held.upper = speed * find_slip(takes, part);
        break;
      }
      if (speed < 0) std::swap(held.lower, held.upper);
      drive->speed = speed;
      out.push_back(std::move(held));
    }
  return out;
}

} // namespace flyball
