#include "engine/study/brake_band.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/gear_train.hpp"
#include "engine/mechanism/measure_plan.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_attempt.hpp"
#include "engine/report/standstill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

using Part = FrictionPart;
using Values = std::vector<std::pair<std::string, double>>;

// From the least to the largest that is found of a number over a band.
struct Extent {
  double low = 0, high = 0;
};

bool is_turned_by_torque(const Mechanism& mechanism, CoordinateReference at) {
  return std::ranges::any_of(gear_train(mechanism, at), [&](const GearedCoordinate& geared) {
    const std::optional<Drive>& drive = coordinate_of(mechanism, geared.at).drive;
    return drive && drive->torque;
  });
}

class BandBesideBrakes {
 public:
  BandBesideBrakes(const Mechanism& mechanism, FrictionParts parts, const Values& state,
                   const std::atomic<bool>* cancel)
      : mechanism_(mechanism), frictions_(find_frictions(mechanism)), given_(std::move(parts)),
        parts_(given_), state_(state), cancel_(cancel) {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i] == Part::holds && !is_turned_by_torque(mechanism_, frictions_[i])) parts_[i] = Part::none;
  }

  bool any() const { return count(Part::none) < std::ssize(parts_); }

  FrictionBand find() {
    FrictionBand out;
    while (true) {
      std::vector<CoordinateReference> held;
      for (std::size_t i = 0; i < parts_.size(); ++i)
        if (parts_[i] == Part::holds) held.push_back(frictions_[i]);
      bool again = false;
      for (const std::vector<CoordinateReference>& at_rest : may_rest(mechanism_, held)) {
        Standstill still = stand_still_by_parts(mechanism_, frictions_, parts_, at_rest);
        name_torques(still);
        const Solution found = solve(still);
        if (found.status != Status::converged) {
          if (out.message.empty())
            out.message = "Nothing is steady " + meanwhile() + ", but for the friction of others.";
          continue;
        }
        again = hold_what_goes_on(found);
        if (again) break;
        return band_of(still, found);
      }
      if (!again) return out;
    }
  }

 private:
  std::ptrdiff_t count(Part part) const { return std::ranges::count(parts_, part); }

  std::string label(std::size_t i) const {
    return coordinate_name(joint_of(mechanism_, frictions_[i]), frictions_[i].coordinate);
  }

  // "while a slips and b stands".
  std::string meanwhile() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i] != Part::none)
        names.push_back(label(i) + (is_slipping(parts_[i]) ? " slips" : " stands"));
    return "while " + word_list(std::vector<std::string_view>(names.begin(), names.end()), "and");
  }

  Solution solve(const Standstill& still) const {
    SolveOptions options;
    options.start = state_;
    std::erase_if(options.start, [&](const auto& named) {
      const auto at = std::ranges::find(frictions_, find_coordinate(mechanism_, named.first));
      const bool plays =
          at != frictions_.end() && parts_[static_cast<std::size_t>(at - frictions_.begin())] != Part::none;
      return plays || is_speed_at_rest(mechanism_, still, named.first);
    });
    options.nearest = true;
    options.friction = options.explain = false;
    options.cancel = cancel_;
    return Analysis(still.mechanism).solve(options);
  }

  // By names that a scene could have.
  static void name_torques(Standstill& still) {
    int count = 0;
    for (TorqueAtRest& torque : still.carried)
      for (std::string& name : torque.measure) {
        if (name.empty()) continue;
        NamedMeasure& measure = *std::ranges::find(still.mechanism.measures, name, &NamedMeasure::name);
        measure.name = name = "torque_at_rest_" + std::to_string(count++);
      }
  }

  // What would go on without a part, as a clutch does that holds two shafts to each other. Whether there is
  // any.
  bool hold_what_goes_on(const Solution& found) {
    bool any = false;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i] == given_[i]) continue;
      const auto c = std::ranges::find_if(found.coordinates, [&](const CoordinateSolution& x) {
        return x.joint == joint_of(mechanism_, frictions_[i]).name && x.index == frictions_[i].coordinate;
      });
      if (c == found.coordinates.end() || !(std::abs(c->speed.value_or(0)) > c->speed_error)) continue;
      parts_[i] = given_[i];
      any = true;
    }
    return any;
  }

  FrictionBand band_of(const Standstill& still, const Solution& found) const {
    FrictionBand none;
    Mechanism beside = still.mechanism;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i] == Part::none && is_at_given_speed(beside, frictions_[i])) {
        none.message =
            "No band is told: gears tie " + label(i) + " to what stands, of which it may bear a share.";
        return none;
      }
      const auto drive = std::ranges::find_if(found.drive_torques, [&](const DriveTorque& d) {
        return d.joint == joint_of(mechanism_, frictions_[i]).name && d.index == frictions_[i].coordinate;
      });
      if (parts_[i] == Part::holds &&
          (drive == found.drive_torques.end() || drive->nonunique || drive->varying || is_sprung(i))) {
        none.message = "No band is told: what holding " + label(i) + " takes over it is not determined.";
        return none;
      }
      if (parts_[i] != Part::none) beside.measures.push_back(part_measure(still, i));
    }
    if (find_frictions(beside).empty()) {
      none.message = "No other joint has friction that would make a band " + meanwhile() + ".";
      return none;
    }
    FrictionBand band =
        find_friction_band(beside, {.start = start_values(found.coordinates), .cancel = cancel_});
    if (!band.found) {
      band.message = "No band is found " + meanwhile() + ": " + band.message;
      return band;
    }
    if (band.at_least) {
      none.message = "No band is told: whether it holds " + meanwhile() + " all over it was not found out.";
      return none;
    }
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (const std::string why = leaving(band, i); !why.empty()) {
        none.message = "No band is told: " + why;
        return none;
      }
    std::erase_if(band.extents, [&](const BandExtent& extent) {
      return measure_index(beside, extent.name) >= 0 && measure_index(mechanism_, extent.name) < 0;
    });
    for (BandExtent& extent : band.extents) {
      extent.shares_low.clear();
      extent.shares_high.clear();
    }
    band.message = "It is the band " + meanwhile() + "." + (band.message.empty() ? "" : " ") + band.message;
    return band;
  }

  // Whether springs or stops act on what gears tie to it: no balance has these where it stands.
  bool is_sprung(std::size_t i) const {
    return std::ranges::any_of(gear_train(mechanism_, frictions_[i]), [&](const GearedCoordinate& geared) {
      const Coordinate& c = coordinate_of(mechanism_, geared.at);
      return c.spring || c.stop;
    });
  }

  static std::string measure_name(std::size_t i) { return "friction_part_" + std::to_string(i); }

  // Its rate where it slips, or what holds all that gears tie to it, along it (N m or N): one measure, as
  // what torques give on several of these may cancel.
  NamedMeasure part_measure(const Standstill& still, std::size_t i) const {
    const auto unit = [&](CoordinateReference at, const char* angle, const char* length) {
      return std::string(is_angle(joint_of(mechanism_, at).type, at.coordinate) ? angle : length);
    };
    if (is_slipping(parts_[i]))
      return {.name = measure_name(i),
              .description = {},
              .text = "rate(" + coordinate_argument(label(i)) + ")",
              .unit = unit(frictions_[i], "rad/s", "m/s")};
    std::string sum = "0";
    for (const GearedCoordinate& geared : gear_train(mechanism_, frictions_[i])) {
      const auto found = std::ranges::find(frictions_, geared.at);
      if (found == frictions_.end()) continue;
      const auto add = [&](double ratio, CoordinateReference of, const std::string& text) {
        sum += "+(" + number_text(geared.ratio * ratio) + ")*(" + text + ")/(1 " + unit(of, "N m", "N") + ")";
      };
      add(1, geared.at,
          "torque(" + coordinate_argument(label(static_cast<std::size_t>(found - frictions_.begin()))) + ")");
      for (const TorqueAtRest& torque : still.carried)
        for (const std::size_t k : {0u, 1u})
          if (torque.held == geared.at)
            add(k == 0 ? -torque.ratio : torque.ratio, torque.at,
                torque.measure[k].empty() ? number_text(torque.value[k]) + " " + unit(torque.at, "N m", "N")
                                          : torque.measure[k]);
    }
    return {.name = measure_name(i), .description = {}, .text = sum, .unit = {}};
  }

  static std::optional<Extent> extent_of(const FrictionBand& band, const std::string& name) {
    const auto found = std::ranges::find(band.extents, name, &BandExtent::name);
    if (found == band.extents.end()) return std::nullopt;
    return Extent{found->low, found->high};
  }

  // Why it does not play its part all over the band; empty where it does.
  std::string leaving(const FrictionBand& band, std::size_t i) const {
    if (parts_[i] == Part::none) return {};
    const std::optional<Extent> extent = extent_of(band, measure_name(i));
    if (is_slipping(parts_[i])) {
      const bool goes = extent && (parts_[i] == Part::slips_forwards ? extent->low > 0 : extent->high < 0);
      return goes ? "" : label(i) + " comes to rest within it.";
    }
    if (!extent) return "what holding " + label(i) + " takes over it is not determined.";
    // Gears make all that have friction in a train hold together.
    double limit = 0;
    for (const GearedCoordinate& geared : gear_train(mechanism_, frictions_[i]))
      if (std::ranges::find(frictions_, geared.at) != frictions_.end())
        limit += std::abs(geared.ratio) * friction_limit(friction_at(mechanism_, geared.at));
    const bool holds = extent->high <= limit && extent->low >= -limit;
    return holds ? "" : "within it " + label(i) + " may have to hold more than its limit, and slip.";
  }

  const Mechanism& mechanism_;
  const std::vector<CoordinateReference> frictions_;
  const FrictionParts given_; // of the state
  FrictionParts parts_;       // that are kept over the band
  const Values& state_;
  const std::atomic<bool>* cancel_;
};

} // namespace

std::optional<FrictionBand> find_band_beside_brakes(const Mechanism& mechanism, const FrictionParts& parts,
                                                    const Values& state, const std::atomic<bool>* cancel) {
  BandBesideBrakes band(mechanism, parts, state, cancel);
  if (!band.any()) return std::nullopt;
  try {
    return band.find();
  } catch (const SceneError& error) { // drives that close a loop, say
    FrictionBand none;
    none.message = "No band is told beside what slips or stands: " + std::string(error.what()) + ".";
    return none;
  }
}

} // namespace flyball
