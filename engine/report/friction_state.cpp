#include "engine/report/friction_state.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/holding.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace flyball {
namespace {

constexpr std::size_t most_tried = 3; // joints that may slip: each forwards, backwards or not at all

enum class Part { as_it_is, holds, slips_forwards, slips_backwards };

std::size_t place(int i) {
  return static_cast<std::size_t>(i);
}

// Of one axis, along which it may go on and on.
bool may_slip(const Mechanism& mechanism, CoordinateReference at) {
  const Joint& joint = mechanism.joints[place(at.joint)];
  const Coordinate& c = joint.coordinates[place(at.coordinate)];
  return !is_rotation_vector(joint.type, at.coordinate) && !c.spring && !c.stop;
}

// Of drives at given speeds, rad/s or m/s; 1 where none turns.
double usual_speed(const Mechanism& mechanism) {
  double fastest = 0;
  for (const Joint& joint : mechanism.joints)
    for (const Coordinate& c : joint.coordinates)
      if (c.drive) fastest = std::max(fastest, std::abs(c.drive->speed));
  return fastest > 0 ? fastest : 1;
}

// The friction of each coordinate played by its part.
class Attempt {
 public:
  // `holding`: what holding takes, where all hold and springs and stops of their own help.
  Attempt(const Mechanism& mechanism, const std::vector<CoordinateReference>& frictions,
          std::vector<Part> parts, const Holding* holding = nullptr)
      : mechanism_(mechanism), frictions_(frictions), parts_(std::move(parts)), holding_(holding) {}

  // Nothing where there is no such state, or it contradicts the parts.
  std::optional<FrictionState> solve(const SolveOptions& options) const try {
    auto changed = std::make_shared<const Mechanism>(driven());
    FrictionState out{Analysis(changed), {}};
    SolveOptions inner = options;
    inner.friction = inner.warm = false;
    inner.details = true; // what holding takes
    std::erase_if(inner.start, [&](const auto& named) { return plays(named.first); });
    out.solution = out.analysis.solve(inner);
    if (out.solution.status != Status::converged || !tell(out.solution)) return std::nullopt;
    return out;
  } catch (const SceneError&) { // drives that close a loop, say
    return std::nullopt;
  }

 private:
  bool slips(std::size_t i) const {
    return parts_[i] == Part::slips_forwards || parts_[i] == Part::slips_backwards;
  }
  // Positive where it slips backwards.
  double slipping_force(std::size_t i) const {
    const double limit = friction_limit(friction_at(mechanism_, frictions_[i]));
    return parts_[i] == Part::slips_forwards ? -limit : limit;
  }

  bool plays(const std::string& name) const {
    const CoordinateReference named = find_coordinate(mechanism_, name);
    for (std::size_t i = 0; i < frictions_.size(); ++i)
      if (parts_[i] != Part::as_it_is && frictions_[i].joint == named.joint &&
          frictions_[i].coordinate == named.coordinate)
        return true;
    return false;
  }

  Mechanism driven() const {
    std::vector<CoordinateReference> held;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i] == Part::holds) held.push_back(frictions_[i]);
    Mechanism out = standing_still(mechanism_, held);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (!slips(i)) continue;
      Joint& joint = out.joints[place(frictions_[i].joint)];
      Coordinate& c = joint.coordinates[place(frictions_[i].coordinate)];
      joint.cut = false;
      c.friction.reset();
      c.drive = Drive{.speed = usual_speed(mechanism_) * (parts_[i] == Part::slips_forwards ? 1 : -1),
                      .torque = slipping_force(i),
                      .load = 0};
    }
    out.sliders.clear();
    out.measures.clear();
    for (const NamedMeasure& measure : mechanism_.measures) {
      out.measures.push_back(measure);
      try {
        const MeasurePlan known(out);
      } catch (const SceneError&) { // of the spring of a joint that stands still, say
        out.measures.pop_back();
      }
    }
    return out;
  }

  static double largest(const DriveTorque& drive) {
    if (!drive.range) return drive.value;
    return std::abs(drive.range->most) > std::abs(drive.range->least) ? drive.range->most
                                                                      : drive.range->least;
  }

  // Puts what was found of drives into the words of friction. False where it does not go with the parts.
  bool tell(Solution& s) const {
    bool slipping = false;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i] == Part::as_it_is) continue;
      const Joint& joint = mechanism_.joints[place(frictions_[i].joint)];
      const auto is_it = [&](const auto& x) {
        return x.joint == joint.name && x.index == frictions_[i].coordinate;
      };
      const auto c = std::ranges::find_if(s.coordinates, is_it);
      const auto drive = std::ranges::find_if(s.drive_torques, is_it);
      if (c == s.coordinates.end()) return false;
      FrictionForce& force = s.frictions.emplace_back();
      force.joint = joint.name;
      force.index = c->index;
      force.count = c->count;
      force.angle = c->angle;
      force.limit = friction_limit(friction_at(mechanism_, frictions_[i]));
      force.slips = slips(i);
      if (force.slips) {
        slipping = true;
        force.value = slipping_force(i);
        if (!c->speed || !(*c->speed * *force.value < 0) || std::abs(*c->speed) <= c->speed_error)
          return false;
      } else {
        c->driven = false;
        c->error = 0;
        if (holding_) {
          force.value = holding_->joints[i].force;
        } else {
          if (drive == s.drive_torques.end() || drive->nonunique || (drive->varying && !drive->range))
            return false;
          force.value = largest(*drive);
          if (!(std::abs(*force.value) <= force.limit)) return false;
        }
      }
      if (drive != s.drive_torques.end()) s.drive_torques.erase(drive);
    }
    for (CoordinateSolution& c : s.coordinates) // what closes a loop with those that are held stands
      if (c.dependent && c.speed && std::abs(*c.speed) <= c.speed_error) {
        c.driven = false;
        c.speed.reset();
      }
    if (slipping) s.at_constant_speed.reset(); // which prescribes the rates of what slips, too
    order_measures(s);
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
};

std::string names_of(const std::vector<FrictionForce>& frictions, bool slipping) {
  std::vector<std::string> names;
  for (const FrictionForce& force : frictions)
    if (force.slips == slipping) names.push_back(coordinate_label(force));
  return word_list(std::vector<std::string_view>(names.begin(), names.end()), "and");
}

void add_message(FrictionState& state, std::string text) {
  constexpr std::string_view plain = "Converged.";
  std::string& message = state.solution.message;
  const std::string rest = message.starts_with(plain) ? message.substr(plain.size()) : " " + message;
  message = std::move(text) + rest;
}

std::optional<FrictionState> held(const Mechanism& mechanism,
                                  const std::vector<CoordinateReference>& frictions,
                                  const SolveOptions& options) {
  const Holding holding = find_holding(mechanism, options.start, options.cancel);
  if (!holding.takes || !(*holding.takes <= 1)) return std::nullopt;
  std::vector<Part> parts(frictions.size(), Part::as_it_is);
  for (const std::size_t i : holding.independent)
    parts[i] = Part::holds;
  auto state = Attempt(mechanism, frictions, parts, &holding).solve(options);
  if (state)
    add_message(*state, "Without friction there is no steady state. Friction holds " +
                            names_of(state->solution.frictions, false) + " as drawn: that takes " +
                            rounded_text(100 * *holding.takes, 3) + " % of what it can give.");
  return state;
}

std::optional<FrictionState> slipping(const Mechanism& mechanism,
                                      const std::vector<CoordinateReference>& frictions,
                                      SolveOptions options) {
  std::vector<std::size_t> tried;
  for (std::size_t i = 0; i < frictions.size(); ++i)
    if (may_slip(mechanism, frictions[i])) tried.push_back(i);
  if (tried.size() > most_tried) return std::nullopt;
  std::vector<std::vector<Part>> all{std::vector<Part>(frictions.size(), Part::as_it_is)};
  for (const std::size_t i : tried) {
    std::vector<std::vector<Part>> longer;
    for (const std::vector<Part>& parts : all)
      for (const Part part : {Part::holds, Part::slips_forwards, Part::slips_backwards}) {
        longer.push_back(parts);
        longer.back()[i] = part;
      }
    all = std::move(longer);
  }
  const auto held_among = [](const std::vector<Part>& parts) {
    return std::ranges::count(parts, Part::holds);
  };
  std::ranges::stable_sort(all, std::greater(), held_among);
  options.search = 0;
  std::optional<FrictionState> unstable;
  for (const std::vector<Part>& parts : all) {
    if (held_among(parts) == static_cast<std::ptrdiff_t>(tried.size())) continue;
    auto state = Attempt(mechanism, frictions, parts).solve(options);
    if (!state) continue;
    const std::vector<FrictionForce>& forces = state->solution.frictions;
    const std::string holding = names_of(forces, false);
    add_message(*state, "Without friction there is no steady state. " + names_of(forces, true) +
                            (std::ranges::count(forces, true, &FrictionForce::slips) > 1
                                 ? " slip at constant rates, against which friction gives its limits"
                                 : " slips at a constant rate, against which friction gives its limit") +
                            (holding.empty() ? "." : "; it holds " + holding + "."));
    if (state->solution.stable != false) return state;
    if (!unstable) unstable = std::move(state);
  }
  return unstable;
}

} // namespace

std::optional<FrictionState> find_friction_state(const Mechanism& mechanism, const SolveOptions& options) {
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  // Joints that it holds stand as drawn.
  for (const auto& [name, value] : options.start) {
    const CoordinateReference named = find_coordinate(mechanism, name);
    if (named.joint < 0) continue;
    const Coordinate& c = mechanism.joints[place(named.joint)].coordinates[place(named.coordinate)];
    if (c.friction && c.drawn != value) return std::nullopt;
  }
  if (auto state = held(mechanism, frictions, options)) return state;
  return slipping(mechanism, frictions, options);
}

} // namespace flyball
