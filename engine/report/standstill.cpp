#include "engine/report/standstill.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/turns_in_place.hpp"
#include "engine/system/elastic_force.hpp"

#include <algorithm>
#include <functional>

namespace flyball {
namespace {

constexpr std::array<std::string_view, 2> torque_and_load_keys{"torque", "load"};
constexpr std::size_t most_that_may_rest = 3;

void drive_at_rest(Coordinate& c) {
  c = {.drawn = c.drawn, .spring = {}, .damping = 0, .stop = {}, .friction = {}, .drive = Drive{}};
}

void fix(Joint& joint) {
  joint.type = JointType::fixed;
  joint.coordinates.clear();
  joint.formulas.clear();
  joint.cut.reset();
}

// Of these coordinates those that close a loop of joints that are driven or held: they cannot be driven, too.
std::vector<bool> closing_driven_loops(const Mechanism& mechanism, std::span<const Standing> held) {
  const BodyNumbers numbers(mechanism);
  BodyGroups driven(numbers);
  for (const Joint& joint : mechanism.joints)
    if (joint.type != JointType::gear &&
        std::ranges::any_of(joint.coordinates, [](const Coordinate& c) { return c.drive.has_value(); }))
      driven.join(joint.bodies);
  std::vector<bool> out;
  for (const Standing& x : held) {
    const Joint& joint = joint_of(mechanism, x.at);
    const bool one_axis = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    const bool geared = gear_train(mechanism, x.at).size() > 1;
    out.push_back(!driven.join(joint.bodies) && one_axis && !geared);
  }
  return out;
}

// What a law asks of a coordinate that stands still, in numbers.
std::string standing_number(const Mechanism& mechanism, Result result, const Standing& x) {
  const Joint& joint = joint_of(mechanism, x.at);
  const bool angle = is_angle(joint.type, x.at.coordinate);
  if (result == Result::rate) return angle ? "(0 rad/s)" : "(0 m/s)";
  if (result == Result::coordinate) return "(" + number_text(x.value) + (angle ? " rad)" : " m)");
  const double free = joint.coordinates[static_cast<std::size_t>(x.at.coordinate)].spring->free;
  const ElasticForce spring = elastic_force(mechanism, joint, x.at.coordinate, x.value - free);
  return "(" + number_text(-spring.force) + (angle ? " N m)" : " N)");
}

// A law with its measures in their places, and each call for a coordinate as `replace` says, if anything.
using ReplaceCall = std::function<std::optional<std::string>(const ResultCall&, CoordinateReference)>;
std::string with_calls_replaced(const Mechanism& mechanism, std::string_view law,
                                const ReplaceCall& replace) {
  std::string text = with_measures(mechanism, law);
  const Expression read(text, Expression::Results::allowed);
  for (auto call = read.results().rbegin(); call != read.results().rend(); ++call) {
    if (!asks_for_coordinate(*call)) continue; // of places: the same where the coordinate is held
    const std::optional<std::string> by = replace(*call, find_coordinate(mechanism, *call));
    if (!by) continue;
    const ResultCall::Argument& last = call->arguments.back();
    const std::size_t end = text.find(')', last.begin + last.length);
    text.replace(call->begin, end + 1 - call->begin, *by);
  }
  return text;
}

std::string without_standing(const Mechanism& mechanism, std::string_view law,
                             std::span<const Standing> standing) {
  return with_calls_replaced(
      mechanism, law, [&](const ResultCall& call, CoordinateReference asked) -> std::optional<std::string> {
        const auto found = std::ranges::find_if(standing, [&](const Standing& x) { return x.at == asked; });
        if (found == standing.end()) return std::nullopt;
        return standing_number(mechanism, call.result, *found);
      });
}

// The laws of all drives with these in numbers: they cannot ask for what is driven.
void put_into_laws(Mechanism& mechanism, std::span<const Standing> standing) {
  for (Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
      for (const std::string_view which : torque_and_load_keys) {
        const Formula* law = drive_law(mechanism, joint, static_cast<int>(i), which);
        if (!law) continue;
        const std::string text = without_standing(mechanism, law->text, standing);
        Formula& now = joint.formulas[static_cast<std::size_t>(law - joint.formulas.data())];
        now.text = text;
        if (is_of_state(mechanism, text)) continue;
        Drive& drive = *joint.coordinates[i].drive;
        (which == "torque" ? drive.torque : drive.load) = evaluate_expression(
            mechanism, text, fields::force_unit(is_angle(joint.type, static_cast<int>(i))), now.key);
        std::erase_if(joint.formulas, [key = now.key](const Formula& each) { return each.key == key; });
      }
}

std::string_view unit_along(const Joint& joint, int i) {
  return fields::force_unit(is_angle(joint.type, i));
}

// Torque and load of a drive as texts, with what stands in numbers.
std::array<std::string, 2> laws_at_rest(const Mechanism& mechanism, CoordinateReference at,
                                        std::span<const Standing> standing) {
  const Joint& joint = joint_of(mechanism, at);
  const Drive& drive = *coordinate_of(mechanism, at).drive;
  std::array<std::string, 2> out;
  for (const std::size_t k : {0u, 1u}) {
    const Formula* law = drive_law(mechanism, joint, at.coordinate, torque_and_load_keys[k]);
    const double number = (k == 0 ? drive.torque : drive.load).value_or(0);
    out[k] = law ? without_standing(mechanism, law->text, standing)
                 : number_text(number) + " " + std::string(unit_along(joint, at.coordinate));
  }
  return out;
}

void remove_drive(Mechanism& mechanism, CoordinateReference at) {
  Joint& joint = joint_of(mechanism, at);
  const std::string key = coordinate_key(joint, static_cast<std::size_t>(at.coordinate), "drive") + ".";
  std::erase_if(joint.formulas, [&](const Formula& each) { return each.key.starts_with(key); });
  coordinate_of(mechanism, at).drive.reset();
}

bool has_torque(const Mechanism& mechanism, CoordinateReference at) {
  const std::optional<Drive>& drive = coordinate_of(mechanism, at).drive;
  return drive && drive->torque;
}

class Stopper {
 public:
  Stopper(const Mechanism& mechanism, std::span<const Standing> held, std::span<const Standing> others)
      : mechanism_(mechanism), held_(held), standing_(held.begin(), held.end()) {
    standing_.insert(standing_.end(), others.begin(), others.end());
    out_.mechanism = mechanism;
  }

  Standstill run(std::span<const CoordinateReference> at_rest) {
    find_trains();
    for (const CoordinateReference& at : at_rest)
      add_standing(at);
    for (TorqueAtRest& torque : out_.carried)
      remove_drive(out_.mechanism, torque.at);
    for (const CoordinateReference& at : at_rest)
      let_rest(at);
    put_into_laws(out_.mechanism, standing_);
    out_.mechanism.sliders.clear();
    out_.mechanism.measures.clear();
    for (TorqueAtRest& torque : out_.carried)
      find_values(torque);
    out_.fixed = closing_driven_loops(out_.mechanism, held_);
    for (std::size_t i = 0; i < held_.size(); ++i) {
      Joint& joint = joint_of(out_.mechanism, held_[i].at);
      if (out_.fixed[i]) {
        fix(joint);
        continue;
      }
      joint.cut = false; // what it takes is told of a drive in the tree
      drive_at_rest(coordinate_of(out_.mechanism, held_[i].at));
    }
    return std::move(out_);
  }

 private:
  void add_standing(CoordinateReference at) {
    if (std::ranges::none_of(standing_, [&](const Standing& x) { return x.at == at; }))
      standing_.push_back({at, coordinate_of(mechanism_, at).drawn});
  }

  // What gears make stand still with the held coordinates; each torque acts on the first of them.
  void find_trains() {
    for (const Standing& x : held_)
      for (const GearedCoordinate& geared : gear_train(mechanism_, x.at)) {
        if (has_torque(mechanism_, geared.at) &&
            std::ranges::none_of(out_.carried,
                                 [&](const TorqueAtRest& known) { return known.at == geared.at; }))
          out_.carried.push_back({.at = geared.at, .held = x.at, .ratio = geared.ratio});
        add_standing(geared.at);
      }
  }

  // Of what is carried: a number, or a measure of the state.
  void find_values(TorqueAtRest& torque) {
    const Joint& joint = joint_of(mechanism_, torque.at);
    const std::array<std::string, 2> laws = laws_at_rest(mechanism_, torque.at, standing_);
    const std::string unit(unit_along(joint, torque.at.coordinate));
    for (const std::size_t k : {0u, 1u}) {
      if (!is_of_state(mechanism_, laws[k])) {
        torque.value[k] = evaluate_expression(mechanism_, laws[k], unit, joint.name);
        continue;
      }
      torque.measure[k] = std::string(torque_and_load_keys[k]) + " of " +
                          coordinate_name(joint, torque.at.coordinate) + " at rest";
      out_.mechanism.measures.push_back(
          {.name = torque.measure[k], .description = {}, .text = laws[k], .unit = unit});
    }
  }

  // In the place of the drive a constant force, and a damper that says how that changes with the rate.
  void let_rest(CoordinateReference at) {
    const Joint& before = joint_of(mechanism_, at);
    const Coordinate& c = coordinate_of(mechanism_, at);
    const std::string unit(unit_along(before, at.coordinate));
    TorqueAtRest torque{.at = at, .held = at};
    std::array<std::string, 2> moving;
    for (const std::size_t k : {0u, 1u}) {
      const std::string rest = laws_at_rest(mechanism_, at, standing_)[k];
      if (is_of_state(mechanism_, rest))
        throw SceneError("joints." + before.name + ".drive",
                         "comes to rest with a torque that depends on where others stand");
      torque.value[k] = evaluate_expression(mechanism_, rest, unit, before.name);
      const Formula* law = drive_law(mechanism_, before, at.coordinate, torque_and_load_keys[k]);
      if (!law) continue;
      moving[k] = with_calls_replaced(
          mechanism_, law->text,
          [&](const ResultCall& call, CoordinateReference asked) -> std::optional<std::string> {
            if (call.result == Result::rate && asked == at) return std::string(damper_variable);
            const auto found =
                std::ranges::find_if(standing_, [&](const Standing& x) { return x.at == asked; });
            return standing_number(mechanism_, call.result, *found);
          });
    }
    remove_drive(out_.mechanism, at);
    Joint& joint = joint_of(out_.mechanism, at);
    const auto index = static_cast<std::size_t>(at.coordinate);
    joint.coordinates[index].spring = CoordinateSpring{.force = 0};
    joint.formulas.push_back({coordinate_key(joint, index, "spring") + ".force",
                              number_text(torque.value[1] - torque.value[0]) + " " + unit});
    std::string damper;
    if (!moving[0].empty())
      damper += "(" + number_text(torque.value[0]) + " " + unit + ")-(" + moving[0] + ")";
    if (!moving[1].empty())
      damper += std::string(damper.empty() ? "" : "+") + "(" + moving[1] + ")-(" +
                number_text(torque.value[1]) + " " + unit + ")";
    if (!damper.empty()) {
      const std::string key = coordinate_key(joint, index, "damping_force");
      if (const Formula* own = damper_law(before, at.coordinate)) {
        damper += "+(" + own->text + ")";
        std::erase_if(joint.formulas, [&](const Formula& each) { return each.key == key; });
      } else if (c.damping != 0) {
        damper += "+(" + number_text(c.damping) + " " + unit + ")/(1 " +
                  (is_angle(before.type, at.coordinate) ? "rad/s" : "m/s") + ")*rate";
      }
      joint.formulas.push_back({key, damper});
      joint.coordinates[index].damping = 0;
      joint.coordinates[index].damping_force = 0;
    }
    out_.resting.push_back(std::move(torque));
  }

  const Mechanism& mechanism_;
  const std::span<const Standing> held_;
  std::vector<Standing> standing_;
  Standstill out_;
};

} // namespace

Standstill stand_still(const Mechanism& mechanism, std::span<const Standing> held,
                       std::span<const Standing> others, std::span<const CoordinateReference> at_rest) {
  return Stopper(mechanism, held, others).run(at_rest);
}

std::vector<std::vector<CoordinateReference>> may_rest(const Mechanism& mechanism,
                                                       std::span<const CoordinateReference> held) {
  const bool in_place = turns_in_place(mechanism);
  std::vector<CoordinateReference> drives;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i) {
      const CoordinateReference at{static_cast<int>(j), static_cast<int>(i)};
      if (!has_torque(mechanism, at) || (in_place && !is_tied(mechanism, held, at))) continue;
      const std::vector<GearedCoordinate> train = gear_train(mechanism, at);
      if (std::ranges::none_of(
              train, [&](const GearedCoordinate& x) { return std::ranges::find(held, x.at) != held.end(); }))
        drives.push_back(at);
    }
  std::vector<std::vector<CoordinateReference>> sets{{}};
  if (drives.empty()) return sets;
  if (drives.size() > most_that_may_rest) {
    sets.push_back(drives);
    return sets;
  }
  for (std::size_t set = 1; set < std::size_t(1) << drives.size(); ++set) {
    std::vector<CoordinateReference>& some = sets.emplace_back();
    for (std::size_t k = 0; k < drives.size(); ++k)
      if (set >> k & 1) some.push_back(drives[k]);
  }
  return sets;
}

std::optional<std::array<double, 2>> values_at_rest(const TorqueAtRest& torque,
                                                    std::span<const MeasureSolution> measures) {
  std::array<double, 2> out = torque.value;
  for (const std::size_t k : {0u, 1u}) {
    if (torque.measure[k].empty()) continue;
    const auto found = std::ranges::find(measures, torque.measure[k], &MeasureSolution::name);
    if (found == measures.end() || !found->value) return std::nullopt;
    out[k] = *found->value;
  }
  return out;
}

std::optional<double> carried_torque(const Standstill& still, CoordinateReference held,
                                     std::span<const MeasureSolution> measures) {
  double sum = 0;
  for (const TorqueAtRest& torque : still.carried) {
    if (torque.held != held) continue;
    const std::optional<std::array<double, 2>> value = values_at_rest(torque, measures);
    if (!value) return std::nullopt;
    sum += torque.ratio * ((*value)[0] - (*value)[1]);
  }
  return sum;
}

bool is_speed_at_rest(const Mechanism& mechanism, const Standstill& still, std::string_view name) {
  const auto is_it = [&](const TorqueAtRest& torque) {
    return name == coordinate_name(joint_of(mechanism, torque.at), torque.at.coordinate) + ".speed";
  };
  return std::ranges::any_of(still.carried, is_it) || std::ranges::any_of(still.resting, is_it);
}

double holding_force(const Joint& joint, const Reaction& reaction, const Mat3& turned) {
  const Vec3 axis = turned * joint.axis.normalized();
  return axis.dot(joint.type == JointType::revolute ? reaction.torque : reaction.force);
}

} // namespace flyball
