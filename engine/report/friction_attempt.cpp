#include "engine/report/friction_attempt.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/standstill.hpp"
#include "engine/system/elastic_force.hpp"
#include "engine/system/joint_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

using Part = FrictionPart;

std::size_t entry_of(int i) {
  return static_cast<std::size_t>(i);
}

// The largest of the drives' speeds, rad/s or m/s; 1 where none turns.
double fastest_drive(const Mechanism& mechanism) {
  double most = 0;
  for (const Joint& joint : mechanism.joints)
    for (const Coordinate& c : joint.coordinates)
      if (c.drive) most = std::max(most, std::abs(c.drive->speed));
  return most > 0 ? most : 1;
}

// The friction of each coordinate played by its part.
class Attempt {
 public:
  // `holding`: what holding takes, where all hold and springs and stops of their own help. `implied`: of
  // those that slip the ones whose rate follows from the drives, by coordinate with friction; empty: none.
  Attempt(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
          std::vector<Part> parts, const Holding* holding = nullptr, std::vector<bool> implied = {})
      : mechanism_(mechanism), frictions_(frictions), parts_(std::move(parts)), holding_(holding),
        implied_(std::move(implied)) {
    implied_.resize(parts_.size(), false);
  }

  // Nothing where there is no such state. `loose`: see attempt_parts().
  std::optional<StateOnFriction> solve(const SolveOptions& options, bool loose) const {
    std::optional<StateOnFriction> first;
    const std::vector<std::vector<CoordinateReference>> sets = may_rest(mechanism_, held());
    SolveOptions resting = options; // those of drives at rest share one
    resting.search /= static_cast<double>(sets.size());
    for (const std::vector<CoordinateReference>& at_rest : sets) {
      auto out = solve_with(at_rest, at_rest.empty() ? options : resting, loose);
      if (!out) continue;
      if (!any_without_a_part([&](std::size_t i) { return out->margins[i] < 0; })) return out;
      if (!first) first = std::move(out);
    }
    return loose ? std::move(first) : std::nullopt;
  }

  // With its coordinates driven as their parts say, and drives by torque that have come to rest.
  Standstill driven(std::span<const CoordinateReference> at_rest = {}) const {
    std::vector<Standing> standing;
    for (const CoordinateReference& at : held())
      standing.push_back({at, coordinate_of(mechanism_, at).drawn});
    Standstill still = stand_still(mechanism_, standing, {}, at_rest);
    Mechanism& out = still.mechanism;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!slips(i)) continue;
      Joint& joint = joint_of(out, frictions_[i]);
      Coordinate& c = coordinate_of(out, frictions_[i]);
      c.friction.reset();
      if (implied_[i])
        put_as_damper(i, joint, c);
      else
        let_slip(i, out);
    }
    for (const NamedMeasure& measure : mechanism_.measures) {
      out.measures.push_back(measure);
      try {
        const MeasurePlan known(out);
      } catch (const SceneError&) { // of the spring of a joint that stands still, say
        out.measures.pop_back();
      }
    }
    return still;
  }

 private:
  std::optional<StateOnFriction> solve_with(std::span<const CoordinateReference> at_rest,
                                            const SolveOptions& options, bool loose) const try {
    const Standstill still = driven(at_rest);
    if (stands_without_a_part(still.mechanism)) return std::nullopt;
    StateOnFriction out{
        Analysis(std::make_shared<const Mechanism>(still.mechanism)), {}, parts_, implied_, {}};
    SolveOptions inner = options;
    inner.friction = inner.warm = false;
    inner.details = true; // what holding takes
    inner.explain = false;
    std::erase_if(inner.start, [&](const auto& named) {
      return plays(named.first) || is_speed_at_rest(mechanism_, still, named.first);
    });
    out.solution = out.analysis.solve(inner);
    if (out.solution.status != Status::converged || !tell(still, loose, out)) return std::nullopt;
    return out;
  } catch (const SceneError&) { // drives that close a loop, say
    return std::nullopt;
  }

  template <class Condition>
  bool any_without_a_part(Condition condition) const {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i] == Part::none && condition(i)) return true;
    return false;
  }

  // Whether gears tie what has no part to what is held or has come to rest: it would hold some of it.
  bool stands_without_a_part(const Mechanism& changed) const {
    return any_without_a_part([&](std::size_t i) { return is_at_given_speed(changed, frictions_[i]); });
  }

  std::vector<CoordinateReference> held() const {
    std::vector<CoordinateReference> out;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i] == Part::holds) out.push_back(frictions_[i]);
    return out;
  }

  bool slips(std::size_t i) const { return is_slipping(parts_[i]); }

  // The limit as a torque of its own, or of a coordinate that has one as a load more; all that gears turn
  // with it begins the way it slips.
  void let_slip(std::size_t which, Mechanism& out) const {
    const CoordinateReference at = frictions_[which];
    const double way = parts_[which] == Part::slips_forwards ? 1 : -1;
    double speed = fastest_drive(mechanism_);
    for (const GearedCoordinate& geared : gear_train(mechanism_, at)) {
      std::optional<Drive>& drive = coordinate_of(out, geared.at).drive;
      if (!drive || !finds_speed(*drive)) continue;
      speed = std::abs(drive->speed / geared.ratio);
      drive->speed = std::copysign(drive->speed, way * geared.ratio);
    }
    Joint& joint = joint_of(out, at);
    Coordinate& c = coordinate_of(out, at);
    if (c.drive) return add_load(joint, at.coordinate, -slipping_force(which));
    joint.cut = false;
    c.drive = Drive{.speed = way * speed, .torque = slipping_force(which), .load = 0};
  }

  void add_load(Joint& joint, int i, double load) const {
    const std::string key = coordinate_key(joint, entry_of(i), "drive") + ".load";
    if (const Formula* law = drive_law(mechanism_, joint, i, "load")) {
      Formula& now = joint.formulas[entry_of(static_cast<int>(law - joint.formulas.data()))];
      now.text = "(" + now.text + ")+(" + number_text(load) + (is_angle(joint.type, i) ? " N m)" : " N)");
      return;
    }
    std::erase_if(joint.formulas, [&](const Formula& each) { return each.key == key; });
    std::optional<double>& number = joint.coordinates[entry_of(i)].drive->load;
    number = number.value_or(0) + load;
  }

  // The limit against the way it slips, beside what dampers of its own give: a joint with a damper may close
  // a loop.
  void put_as_damper(std::size_t which, Joint& joint, Coordinate& c) const {
    const int i = frictions_[which].coordinate;
    const bool angle = is_angle(joint.type, i);
    const std::string force = angle ? " N m" : " N", rate = angle ? " rad/s" : " m/s";
    std::string text = number_text(-slipping_force(which)) + force;
    const std::string key = coordinate_key(joint, entry_of(i), "damping_force");
    if (const Formula* law = damper_law(joint, i)) {
      text += " + (" + law->text + ")";
      std::erase_if(joint.formulas, [&](const Formula& each) { return each.key == key; });
    } else if (c.damping != 0) {
      text += " + " + number_text(c.damping) + force + "/(1" + rate + ")*rate";
    }
    joint.formulas.push_back({key, text});
    c.damping = 0;
    c.damping_force = 0;
  }
  // Positive where it slips backwards.
  double slipping_force(std::size_t i) const {
    const double limit = friction_limit(friction_at(mechanism_, frictions_[i]));
    return parts_[i] == Part::slips_forwards ? -limit : limit;
  }

  bool plays(const std::string& name) const {
    const CoordinateReference named = find_coordinate(mechanism_, name);
    for (std::size_t i = 0; i < frictions_.size(); ++i)
      if (parts_[i] != Part::none && frictions_[i] == named) return true;
    return false;
  }

  // Less what others give along the coordinate.
  static double largest(const DriveTorque& drive, double others) {
    if (!drive.range) return drive.value - others;
    const double least = drive.range->least - others, most = drive.range->most - others;
    return std::abs(most) > std::abs(least) ? most : least;
  }

  // What a spring of a coordinate gives along it as drawn.
  double of_spring(CoordinateReference at) const {
    const Coordinate& c = coordinate_of(mechanism_, at);
    if (!c.spring) return 0;
    return -elastic_force(mechanism_, joint_of(mechanism_, at), at.coordinate, c.drawn - c.spring->free)
                .force;
  }

  // What springs of geared coordinates give along a held one as drawn: they are on driven coordinates, which
  // no balance has. Nothing where there are stops, too.
  std::optional<double> of_geared_springs(CoordinateReference held) const {
    double sum = 0;
    for (const GearedCoordinate& geared : gear_train(mechanism_, held)) {
      if (coordinate_of(mechanism_, geared.at).stop) return std::nullopt;
      sum += geared.ratio * of_spring(geared.at);
    }
    return sum;
  }

  // Gears bear what torques and springs beyond them, seen from what is held, give: no balance has these.
  // False where a torque is not known.
  bool add_to_gears(const Standstill& still, Solution& s) const {
    for (GearReaction& r : s.gears) {
      const Joint& gear = *std::ranges::find(mechanism_.joints, r.joint, &Joint::name);
      const CoordinateReference a = find_coordinate(mechanism_, gear.joints[0]),
                                b = find_coordinate(mechanism_, gear.joints[1]);
      const std::vector<GearedCoordinate> at_a = gear_train(mechanism_, a, &gear),
                                          at_b = gear_train(mechanism_, b, &gear);
      const auto holds = [&](const GearedCoordinate& x) {
        return std::ranges::any_of(held(), [&](CoordinateReference other) { return other == x.at; });
      };
      const bool from_a = std::ranges::any_of(at_a, holds), from_b = std::ranges::any_of(at_b, holds);
      r.nonunique = r.nonunique || (from_a && from_b); // each holds any share
      if (r.nonunique || from_a == from_b) continue;
      double beyond = 0; // along the farther end
      for (const GearedCoordinate& x : from_a ? at_b : at_a) {
        beyond += x.ratio * of_spring(x.at);
        for (const TorqueAtRest& torque : still.carried) {
          if (torque.at != x.at) continue;
          const std::optional<std::array<double, 2>> value = values_at_rest(torque, s.measures);
          if (!value) return false;
          beyond += x.ratio * ((*value)[0] - (*value)[1]);
        }
      }
      const double ratio = gear_ratio(gear); // of the rate of b over that of a
      const double before = r.b;
      r.b -= from_a ? beyond : -beyond / ratio;
      r.a = -ratio * r.b;
      (r.angle_b ? r.torque : r.force) += (r.b - before) * axis_of(b, s);
    }
    return true;
  }

  // Whether it stands still as a fixed joint: see Standstill.
  bool is_fixed(const Mechanism& changed, std::size_t i) const {
    const std::size_t j = entry_of(frictions_[i].joint);
    return changed.joints[j].type == JointType::fixed && mechanism_.joints[j].type != JointType::fixed;
  }

  // Coordinates of such joints, in the scene's order.
  void add_fixed(const Mechanism& changed, Solution& s) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i] != Part::holds || !is_fixed(changed, i)) continue;
      const int j = frictions_[i].joint;
      const Joint& joint = mechanism_.joints[entry_of(j)];
      CoordinateSolution held;
      held.joint = joint.name;
      held.angle = is_angle(joint.type, 0);
      held.value = joint.coordinates[0].drawn;
      const auto after = std::ranges::find_if(s.coordinates, [&](const CoordinateSolution& c) {
        return find_coordinate(mechanism_, coordinate_label(c)).joint > j;
      });
      s.coordinates.insert(after, std::move(held));
    }
  }

  // A body from the drawn pose.
  Mat3 turned(const std::string& name, const Solution& s) const {
    const auto body = std::ranges::find(mechanism_.bodies, name, &Body::name);
    if (body == mechanism_.bodies.end()) return Mat3::Identity();
    return (s.poses[entry_of(static_cast<int>(body - mechanism_.bodies.begin()))].rotation *
            body->rotation.normalized().conjugate())
        .toRotationMatrix();
  }

  // About or along which a coordinate moves, in the world.
  Vec3 axis_of(CoordinateReference at, const Solution& s) const {
    const Joint& joint = joint_of(mechanism_, at);
    if (joint.type == JointType::universal && at.coordinate == 1)
      return turned(joint.bodies[1], s) * joint.axis2.normalized();
    const int slides = joint.type == JointType::free ? 3 : joint.type == JointType::planar ? 2 : 0;
    const int axis = at.coordinate < slides ? at.coordinate : 2;
    return turned(joint.bodies[0], s) * joint_frame(joint).axes[entry_of(axis)];
  }

  // What holds one. Nothing where that changes as the drives turn.
  std::optional<double> of_fixed(const Joint& joint, const Solution& s) const {
    const auto reaction = std::ranges::find(s.reactions, joint.name, &Reaction::joint);
    if (reaction == s.reactions.end() || reaction->varying) return {};
    return holding_force(joint, *reaction, turned(joint.bodies[0], s));
  }

  // Puts what was found of drives into the words of friction. False where it is not found what they give.
  bool tell(const Standstill& still, bool loose, StateOnFriction& out) const {
    const Mechanism& changed = still.mechanism;
    Solution& s = out.solution;
    add_fixed(changed, s);
    out.margins.assign(parts_.size(), std::numeric_limits<double>::infinity());
    out.goes = true;
    bool slipping = false;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Joint& joint = joint_of(mechanism_, frictions_[i]);
      const auto is_it = [&](const auto& x) {
        return x.joint == joint.name && x.index == frictions_[i].coordinate;
      };
      const auto c = std::ranges::find_if(s.coordinates, is_it);
      if (parts_[i] == Part::none) { // what goes on has friction against it
        if (c == s.coordinates.end() || !c->speed || std::abs(*c->speed) <= c->speed_error) continue;
        out.margins[i] = -std::abs(*c->speed);
        out.goes = false;
        continue;
      }
      const auto drive = std::ranges::find_if(s.drive_torques, is_it);
      if (c == s.coordinates.end()) return false;
      FrictionForce& force = s.frictions.emplace_back();
      force.joint = joint.name;
      force.index = c->index;
      force.count = c->count;
      force.angle = c->angle;
      force.limit = friction_limit(friction_at(mechanism_, frictions_[i]));
      const bool stands = c->speed ? std::abs(*c->speed) <= c->speed_error : !c->driven; // else it varies
      force.slips = slips(i) && !(loose && stands);
      if (slips(i) && !force.slips) { // with others, of which it bears a share
        force.value = slipping_force(i);
        out.margins[i] = 0;
        if (!coordinate_of(mechanism_, frictions_[i]).drive) {
          c->driven = false;
          c->speed.reset();
        }
      } else if (force.slips) {
        slipping = true;
        force.value = slipping_force(i);
        if (!c->speed) return false;
        out.margins[i] = parts_[i] == Part::slips_forwards ? *c->speed : -*c->speed;
        out.goes = out.goes && out.margins[i] > c->speed_error;
      } else {
        c->driven = false;
        c->error = 0;
        if (holding_) {
          force.value = holding_->joints[i].force;
          out.margins[i] = 1 - *holding_->takes;
        } else {
          const std::optional<double> carried = carried_torque(still, frictions_[i], s.measures);
          if (!carried) return false;
          if (is_fixed(changed, i)) {
            force.value = of_fixed(joint, s);
            if (!force.value) return false;
            *force.value -= *carried;
          } else {
            const std::optional<double> springs = of_geared_springs(frictions_[i]);
            if (!springs || drive == s.drive_torques.end() || drive->nonunique ||
                (drive->varying && !drive->range))
              return false;
            force.value = largest(*drive, *carried + *springs);
          }
          out.margins[i] = force.limit > 0     ? 1 - std::abs(*force.value) / force.limit
                           : *force.value == 0 ? 0
                                               : -std::numeric_limits<double>::infinity();
        }
        out.goes = out.goes && out.margins[i] >= 0;
      }
      if (drive == s.drive_torques.end()) continue;
      if (slips(i) && coordinate_of(mechanism_, frictions_[i]).drive) { // its load without the friction
        drive->value -= slipping_force(i);
        if (drive->given) drive->given->load += slipping_force(i);
      } else {
        s.drive_torques.erase(drive);
      }
    }
    if (!add_to_gears(still, s) || !tell_drives_at_rest(still, s)) return false;
    for (CoordinateSolution& c : s.coordinates) // what closes a loop with those that are held stands
      if (c.dependent && c.speed && std::abs(*c.speed) <= c.speed_error) {
        c.driven = false;
        c.speed.reset();
      }
    if (slipping) s.at_constant_speed.reset(); // which prescribes the rates of what slips, too
    order_measures(s);
    return true;
  }

  // Of drives by torque that stand still.
  bool tell_drives_at_rest(const Standstill& still, Solution& s) const {
    for (const auto* list : {&still.carried, &still.resting})
      for (const TorqueAtRest& torque : *list) {
        const std::optional<std::array<double, 2>> value = values_at_rest(torque, s.measures);
        if (!value) return false;
        const Joint& joint = joint_of(mechanism_, torque.at);
        const auto c = std::ranges::find_if(s.coordinates, [&](const CoordinateSolution& x) {
          return x.joint == joint.name && x.index == torque.at.coordinate;
        });
        if (c == s.coordinates.end()) return false;
        if (list == &still.carried) {
          c->driven = true;
          c->speed = 0;
          c->speed_error = 0;
          c->speed_scale = std::abs(coordinate_of(mechanism_, torque.at).drive->speed);
        }
        DriveTorque drive;
        drive.joint = joint.name;
        drive.index = c->index;
        drive.count = c->count;
        drive.angle = c->angle;
        drive.value = (*value)[0] - (*value)[1];
        drive.given = DriveTorque::Given{(*value)[0], (*value)[1]};
        const auto after = std::ranges::find_if(s.drive_torques, [&](const DriveTorque& x) {
          return joint_index(mechanism_, x.joint) > torque.at.joint;
        });
        s.drive_torques.insert(after, std::move(drive));
      }
    return true;
  }

  // The scene's, in its order; those that could not be asked for without a value.
  void order_measures(Solution& s) const {
    std::vector<MeasureSolution> all;
    for (const NamedMeasure& measure : mechanism_.measures) {
      const auto found = std::ranges::find(s.measures, measure.name, &MeasureSolution::name);
      if (found != s.measures.end())
        all.push_back(std::move(*found));
      else
        all.push_back({measure.name, measure.unit, {}, {}, "Not told of a joint that friction holds."});
    }
    s.measures = std::move(all);
  }

  const Mechanism& mechanism_;
  const std::vector<CoordinateReference>& frictions_;
  std::vector<Part> parts_;
  const Holding* holding_;
  std::vector<bool> implied_;
};

} // namespace

std::optional<StateOnFriction> attempt_parts(const Mechanism& mechanism,
                                             const std::vector<CoordinateReference>& frictions,
                                             const FrictionParts& parts, const SolveOptions& options,
                                             const Holding* holding, std::vector<bool> implied, bool loose) {
  return Attempt(mechanism, frictions, parts, holding, std::move(implied)).solve(options, loose);
}

Mechanism driven_by_parts(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
                          const FrictionParts& parts, std::vector<bool> implied) {
  return Attempt(mechanism, frictions, parts, nullptr, std::move(implied)).driven().mechanism;
}

Standstill stand_still_by_parts(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
                                const FrictionParts& parts, std::span<const CoordinateReference> at_rest) {
  return Attempt(mechanism, frictions, parts).driven(at_rest);
}

} // namespace flyball
