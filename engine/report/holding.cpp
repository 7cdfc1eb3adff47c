#include "engine/report/holding.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/linear/root_bracket.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/found_speeds.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_forces.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/tied_motions.hpp"
#include "engine/system/elastic_force.hpp"

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

Coordinate& coordinate_at(Mechanism& mechanism, CoordinateReference at) {
  return mechanism.joints[static_cast<std::size_t>(at.joint)]
      .coordinates[static_cast<std::size_t>(at.coordinate)];
}

void drive_at_rest(Coordinate& c) {
  c = {.drawn = c.drawn, .spring = {}, .damping = 0, .stop = {}, .friction = {}, .drive = Drive{}};
}

// Of these coordinates those that close a loop of joints that are driven or held: they cannot be driven, too.
std::vector<bool> closing_driven_loops(const Mechanism& mechanism,
                                       std::span<const CoordinateReference> coordinates) {
  const BodyNumbers numbers(mechanism);
  BodyGroups driven(numbers);
  for (const Joint& joint : mechanism.joints)
    if (joint.type != JointType::gear &&
        std::ranges::any_of(joint.coordinates, [](const Coordinate& c) { return c.drive.has_value(); }))
      driven.join(joint.bodies);
  std::vector<bool> out;
  for (const CoordinateReference& c : coordinates) {
    const Joint& joint = mechanism.joints[static_cast<std::size_t>(c.joint)];
    const bool one_axis = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    const bool geared = std::ranges::any_of(mechanism.joints, [&](const Joint& gear) {
      return gear.type == JointType::gear && std::ranges::find(gear.joints, joint.name) != gear.joints.end();
    });
    out.push_back(!driven.join(joint.bodies) && one_axis && !geared);
  }
  return out;
}

void fix(Joint& joint) {
  joint.type = JointType::fixed;
  joint.coordinates.clear();
  joint.formulas.clear();
  joint.cut.reset();
}

// Calls act(numbers) for what gears move along with a drive.
template <class Act>
void for_geared(Compiled& held, int drive, const Act& act) {
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
double geared_springs(Compiled& held, int drive) {
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
// independent motion all limits are used alike. With several, between the share of the least-squares forces
// and the work that any one motion takes.
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
  const VectorXd shares = fit(scaled, d);
  const bool balances = (scaled * shares - d).norm() <= 1e-9 * d.norm();
  out.takes = balances ? shares.lpNorm<Eigen::Infinity>() : infinite;
  // The motion that goes with them does work, too.
  const VectorXd motion = fit(scaled * scaled.transpose(), d);
  out.at_least = std::min(*out.takes, std::max(out.at_least, work_share(motion)));
}

// Of a coordinate that stands still, as a law may ask for it.
struct Standing {
  CoordinateReference at;
  double value = 0; // rad or m
};

// A law with what it asks of these in numbers.
std::string without_standing(const Mechanism& mechanism, std::string_view law,
                             std::span<const Standing> standing) {
  std::string text = with_measures(mechanism, law);
  const Expression read(text, Expression::Results::allowed);
  for (auto call = read.results().rbegin(); call != read.results().rend(); ++call) {
    if (!asks_for_coordinate(*call)) continue; // of places: the same where the coordinate is held
    const CoordinateReference asked = find_coordinate(mechanism, *call);
    const auto found = std::ranges::find_if(standing, [&](const Standing& x) {
      return x.at.joint == asked.joint && x.at.coordinate == asked.coordinate;
    });
    if (found == standing.end()) continue;
    const Joint& joint = mechanism.joints[static_cast<std::size_t>(asked.joint)];
    const bool angle = is_angle(joint.type, asked.coordinate);
    const auto held = [&]() -> std::string {
      if (call->result == Result::rate) return angle ? "(0 rad/s)" : "(0 m/s)";
      if (call->result == Result::coordinate)
        return "(" + number_text(found->value) + (angle ? " rad)" : " m)");
      const double free = joint.coordinates[static_cast<std::size_t>(asked.coordinate)].spring->free;
      const ElasticForce spring = elastic_force(mechanism, joint, asked.coordinate, found->value - free);
      return "(" + number_text(-spring.force) + (angle ? " N m)" : " N)");
    };
    const ResultCall::Argument& last = call->arguments.back();
    const std::size_t end = text.find(')', last.begin + last.length);
    text.replace(call->begin, end + 1 - call->begin, held());
  }
  return text;
}

// The laws of all drives with these in numbers: they cannot ask for what is driven.
void put_into_laws(Mechanism& mechanism, std::span<const Standing> standing) {
  for (Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      for (const char* which : {"torque", "load"}) {
        const Formula* law = drive_law(mechanism, joint, static_cast<int>(i), which);
        if (!law) continue;
        const std::string text = without_standing(mechanism, law->text, standing);
        Formula& now = joint.formulas[static_cast<std::size_t>(law - joint.formulas.data())];
        now.text = text;
        if (is_of_state(mechanism, text)) continue;
        Drive& drive = *joint.coordinates[i].drive;
        (std::string_view(which) == "torque" ? drive.torque : drive.load) = evaluate_expression(
            mechanism, text, fields::force_unit(is_angle(joint.type, static_cast<int>(i))), now.key);
        std::erase_if(joint.formulas, [key = now.key](const Formula& each) { return each.key == key; });
      }
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

Holding hold(const Mechanism& mechanism, const Coordinates& at, const std::atomic<bool>* cancel,
             bool explain) {
  Holding out;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (const CoordinateReference& f : frictions) {
    const Joint& joint = mechanism.joints[static_cast<std::size_t>(f.joint)];
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

  Mechanism locked = mechanism;
  for (const CoordinateReference& f : frictions) {
    Coordinate& c = coordinate_at(locked, f);
    c.friction.reset();
  }
  out.independent = which.independent;
  std::vector<Standing> standing; // all with friction: those that loops tie stand, too
  for (const CoordinateReference& f : frictions) {
    const CoordinateInfo& c = free.system.coordinates[static_cast<std::size_t>(free.find(mechanism, f))];
    standing.push_back({f, coordinate_value<double>(free.system, free.parameters, free.q, c)});
  }
  try {
    put_into_laws(locked, standing);
  } catch (const SceneError& error) { // not a number there
    out.message = "What holding takes is not found with the joints that have friction standing still: " +
                  std::string(error.what()) + ".";
    return out;
  }
  locked.sliders.clear();
  locked.measures.clear();
  std::vector<CoordinateReference> independent;
  for (const std::size_t i : which.independent)
    independent.push_back(frictions[i]);
  const std::vector<bool> fixed = closing_driven_loops(mechanism, independent);
  for (std::size_t k = 0; k < independent.size(); ++k) {
    Joint& joint = locked.joints[static_cast<std::size_t>(independent[k].joint)];
    if (fixed[k]) {
      const Link& link = free.link(free.find(mechanism, independent[k]));
      if (free.q[link.q] != coordinate_at(locked, independent[k]).drawn) {
        out.message = "What holding takes is not found away from the drawn pose: " + joint.name +
                      " closes a loop of driven joints.";
        return out;
      }
      fix(joint);
      continue;
    }
    joint.cut = false; // what it takes is told of a drive in the tree
    drive_at_rest(coordinate_at(locked, independent[k]));
  }
  std::optional<Compiled> made;
  try {
    made.emplace(locked);
  } catch (const SceneError& error) { // loops that they close, say
    out.message = "What holding takes is not found with the joints that have friction standing still: " +
                  std::string(error.what()) + ".";
    return out;
  }
  Compiled& held = *made;
  Coordinates rest;
  for (const auto& [name, value] : at) {
    const CoordinateReference c = find_coordinate(mechanism, name);
    const bool is_held = std::ranges::any_of(which.independent, [&](std::size_t i) {
      return frictions[i].joint == c.joint && frictions[i].coordinate == c.coordinate;
    });
    // Without friction of its own a joint may close a loop, and then follows; so it does behind a gear.
    const int there = c.joint >= 0 ? held.find(locked, c) : -1;
    const bool follows = c.joint >= 0 && (there < 0 || moved_by_gears(held, there));
    if (!is_held && !follows) rest.emplace_back(name, value);
  }
  for (std::size_t k = 0; k < independent.size(); ++k) {
    if (fixed[k]) continue;
    const int to = held.find(locked, independent[k]), from = free.find(mechanism, independent[k]);
    const LinkParameters& p = held.numbers(to);
    move_drive(held, held.link(to).drive, free.q[free.link(from).q] - p.drawn);
  }
  try {
    set_start(held.system, held.parameters, rest, held.q);
  } catch (const SceneError& error) { // a speed that nothing finds where they stand still
    out.message = "What holding takes is not found: with the joints that have friction standing still, " +
                  std::string(error.what()) + ".";
    return out;
  }
  const Problem problem = held.problem(cancel);
  SteadyState steady;
  steady.find(problem, held.q, held.q, {.nearest = !at.empty()});
  if (!steady.holds) {
    const std::string why = held.system.torques.empty() || !explain
                                ? ""
                                : missing_speed_message(locked, problem, steady.elsewhere());
    out.message =
        "With the joints that have friction standing still there, the others find no steady state." +
        (why.empty() ? "" : " " + why);
    return out;
  }
  const Unknowns z = evaluate_reported(problem, steady.found.z.q, w);
  const Kinematics<double> there_drawn = w.kinematics;
  const ReportedForces forces = report_forces(locked, problem, z, w);
  std::vector<double> needed;
  for (std::size_t k = 0; k < independent.size(); ++k) {
    const std::size_t i = which.independent[k];
    const int c = free.find(mechanism, frictions[i]);
    CoordinateForce spring = free.numbers(c).force[0];
    spring.friction = 0;
    const double of_spring = spring.gradient(free.q[free.link(c).q]);
    if (fixed[k]) {
      const Joint& joint = mechanism.joints[static_cast<std::size_t>(frictions[i].joint)];
      const auto reaction = std::ranges::find(forces.reactions, joint.name, &Reaction::joint);
      const BodyNumbers numbers(mechanism);
      const int parent = static_cast<int>(numbers[joint.bodies[0]]) - 1;
      const Mat3 turned = parent < 0
                              ? Mat3(Mat3::Identity())
                              : there_drawn.at(held.system.body_link[static_cast<std::size_t>(parent)]).R;
      if (reaction == forces.reactions.end() || reaction->varying) {
        out.message = "What holding takes is not found: what " + joint.name +
                      " takes changes with the phase of the drives.";
        return out;
      }
      needed.push_back(holding_force(joint, *reaction, turned) + of_spring);
      continue;
    }
    const auto torque = std::ranges::find_if(forces.drive_torques, [&](const DriveTorque& d) {
      return d.joint == out.joints[i].joint && d.index == out.joints[i].index;
    });
    if (torque == forces.drive_torques.end()) {
      out.message = "What holding takes is not found: loops or gears tie " + out.joints[i].joint +
                    " to another drive, which holds it or turns it.";
      return out;
    }
    if (torque->nonunique && !held.system.torques.empty()) {
      out.message =
          "What holding takes is not determined: loops are redundant, and leave it open how much of "
          "what the drives give reaches " +
          out.joints[i].joint + ".";
      return out;
    }
    const double own = of_spring + geared_springs(held, held.link(held.find(locked, frictions[i])).drive);
    if (torque->varying && !torque->range) {
      out.message = "What holding takes is not found: what " + out.joints[i].joint +
                    " takes changes with the phase of drives that are too many, or slide, to try all that "
                    "they can take.";
      return out;
    }
    double value = torque->value + own;
    if (torque->range) {
      const double least = torque->range->least + own, most = torque->range->most + own;
      value = std::abs(most) > std::abs(least) ? most : least;
    }
    needed.push_back(value);
  }
  if (which.others.empty())
    tell_each(needed, out);
  else
    tell_shared(which, needed, out);
  const std::string speeds = at_found_speeds(held.system, steady.found.z.q);
  const std::string there = speeds.empty() ? "there" : "there, with " + speeds;
  out.message = *out.takes <= 1 ? "Friction holds it " + there + ": that takes " +
                                      rounded_text(100 * *out.takes, 3) + " % of what it can give."
                : out.at_least > 1
                    ? "Friction does not hold it " + there +
                          (out.first.empty() ? std::string(".") : ": " + out.first + " slips.")
                    : "Whether friction holds it " + there +
                          " depends on how the joints in loops share the load, which is not determined.";
  return out;
}

// Where the share that holding takes passes 1, between a speed at which it is below and one at which it is
// above.
double find_slip(const auto& takes, double below, double above) {
  RootBracket bracket(below, takes(below) - 1, above, takes(above) - 1);
  for (int i = 0; i < 100 && bracket.width() > 1e-14 * std::abs(bracket.high()); ++i) {
    const double speed = bracket.next(), value = takes(speed) - 1;
    if (value == 0) return speed;
    bracket.take(speed, value);
  }
  return bracket.high();
}

} // namespace

Mechanism standing_still(const Mechanism& mechanism, std::span<const CoordinateReference> coordinates) {
  Mechanism out = mechanism;
  std::vector<Standing> standing;
  for (const CoordinateReference& c : coordinates)
    standing.push_back({c, coordinate_at(out, c).drawn});
  put_into_laws(out, standing);
  const std::vector<bool> fixed = closing_driven_loops(mechanism, coordinates);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    Joint& joint = out.joints[static_cast<std::size_t>(coordinates[i].joint)];
    if (fixed[i]) {
      fix(joint);
      continue;
    }
    joint.cut = false;
    drive_at_rest(coordinate_at(out, coordinates[i]));
  }
  return out;
}

double holding_force(const Joint& joint, const Reaction& reaction, const Mat3& turned) {
  const Vec3 axis = turned * joint.axis.normalized();
  return axis.dot(joint.type == JointType::revolute ? reaction.torque : reaction.force);
}

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
      if (takes(0) > 1) held.lower = speed * find_slip(takes, 1, 0);
      for (double part = 1.125; part < 1000; part = 1 + 2 * (part - 1)) {
        if (!(takes(part) > 1)) continue;
        held.upper = speed * find_slip(takes, 1, part);
        break;
      }
      if (speed < 0) std::swap(held.lower, held.upper);
      drive->speed = speed;
      out.push_back(std::move(held));
    }
  return out;
}

} // namespace flyball
