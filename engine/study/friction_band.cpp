#include "engine/study/friction_band.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/referred_to.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/holding.hpp"
#include "engine/study/followed_band.hpp"
#include "engine/study/placed_band.hpp"
#include "engine/study/share_box.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t most_outputs = 128;

std::vector<FreeNumber> all_shares(const Mechanism& mechanism) {
  std::vector<FreeNumber> free;
  for (const CoordinateReference& at : find_frictions(mechanism))
    free.push_back({share_address(mechanism, at), -1, 1});
  return free;
}

// Names of what is told of a solution: numbers that are found, then measures.
std::vector<std::string> told(const Mechanism& mechanism, const Solution& solution) {
  std::vector<std::string> names;
  for (const CoordinateSolution& c : solution.coordinates)
    if (const auto number = found_number(c); number && !c.dependent) names.push_back(number->name);
  for (const NamedMeasure& measure : mechanism.measures)
    names.push_back(measure.name);
  return names;
}

// Takes out what jumps: it has values between its extremes that no state has, or more than one.
void drop_jumping(const std::vector<std::string>& jumping, FrictionBand& band) {
  if (jumping.empty()) return;
  std::erase_if(band.extents, [&](const BandExtent& extent) {
    return std::ranges::find(jumping, extent.name) != jumping.end();
  });
  band.message += std::string(band.message.empty() ? "" : " ") + "No extent is told of " +
                  word_list(std::vector<std::string_view>(jumping.begin(), jumping.end()), "and") +
                  ", which jumps within the band.";
}

// That nothing resists, not even friction.
std::string loose_joints(const Mechanism& mechanism, const Solution& state) {
  std::vector<std::string_view> names;
  const std::vector<CoordinateReference> frictions = find_frictions(mechanism);
  for (const std::string& name : state.neutral)
    if (std::ranges::none_of(frictions, [&](CoordinateReference at) {
          return friction_limit(friction_at(mechanism, at)) > 0 &&
                 (joint_of(mechanism, at).name == name ||
                  coordinate_name(joint_of(mechanism, at), at.coordinate) == name);
        }))
      names.push_back(name);
  return word_list(names, "and");
}

FrictionBand no_band(std::string why) {
  FrictionBand out;
  out.message = std::move(why);
  return out;
}

// About one state that needs no friction.
class BandAbout {
 public:
  BandAbout(const Mechanism& mechanism, const Solution& state, const FrictionBandOptions& options)
      : mechanism_(mechanism), state_(state), options_(options), shares_(all_shares(mechanism)),
        names_(told(mechanism, state)) {}

  // By the method that does for it: over the box of shares where nothing folds in it, along the curve of a
  // single share, or by where the joints stand.
  FrictionBand find() {
    if (names_.empty()) return no_band("There is nothing that could move.");
    if (names_.size() > most_outputs)
      return no_band("Bands of more than " + std::to_string(most_outputs) +
                     " coordinates and measures are not looked for.");
    if (shares_.size() > 1 || state_.stable == false) {
      const Holding holding = find_holding(mechanism_, start_values(state_.coordinates), options_.cancel);
      if (state_.stable == false && holding.rest_stable == false)
        return no_band("Friction does not hold it: it is unstable, and what is free beside the joints that "
                       "have friction leaves it.");
      independent_ = holding.independent;
    }
    ShareBox box(mechanism_, shares_, names_, options_.cancel);
    if (!box.begin(start_values(state_.coordinates))) {
      if (FrictionBand placed = by_places(box); placed.found) return placed;
      const std::string loose = loose_joints(mechanism_, state_);
      return no_band(loose.empty()
                         ? "The state is singular, so that nothing tells how far friction would "
                           "let it be moved."
                         : "No band is told: nothing resists " + loose + ", whatever friction does.");
    }
    look_over(box);
    // Folds about an unstable state may lie between all ways that are gone.
    if (!one_motion() && state_.stable == false)
      if (FrictionBand placed = by_places(box); placed.found) return placed;
    FrictionBand band = over_box(box);
    if (band.whole) return band;
    if (shares_.size() == 1)
      if (const auto jumping = follow_band(mechanism_, shares_.front(), state_, options_.cancel, band)) {
        band.folds = true;
        drop_jumping(*jumping, band);
        return band;
      }
    if (FrictionBand placed = by_places(box); placed.found) return placed;
    FrictionBand none =
        no_band("Within the limits of friction the balance folds: beyond that the band" +
                std::string(shares_.size() > 1 ? " of several joints" : "") + " is not followed.");
    none.whole = false;
    return none;
  }

 private:
  // Loops tie all joints with friction to one.
  bool one_motion() const { return independent_.size() == 1; }

  FrictionBand by_places(const ShareBox& box) const {
    if (!options_.past_folds) return {};
    return find_placed_band(mechanism_, state_, names_, independent_, box.reach(), options_.cancel);
  }

  Index count() const { return static_cast<Index>(names_.size()); }

  bool is_measured(const ShareBox& box, Index i) const {
    const auto& name = names_[static_cast<std::size_t>(i)];
    const auto measure = std::ranges::find(state_.measures, name, &MeasureSolution::name);
    if (measure != state_.measures.end() && !measure->value) return false;
    return std::isfinite(box.first().state.values[i]) && box.first().rates.row(i).allFinite();
  }

  void look_over(ShareBox& box) const {
    for (Index i = 0; i < count(); ++i)
      for (const double sense : {1., -1.})
        if (is_measured(box, i)) box.go_to_corner(i, sense);
    if (!one_motion()) box.look_around();
  }

  // Whole where nothing folds.
  FrictionBand over_box(ShareBox& box) const {
    FrictionBand band;
    std::vector<std::string> frictional, jumping;
    for (const CoordinateReference& at : find_frictions(mechanism_))
      frictional.push_back(coordinate_name(joint_of(mechanism_, at), at.coordinate));
    const auto shares = [](const VectorXd& p) { return std::vector<double>(p.begin(), p.end()); };
    for (Index i = 0; i < count(); ++i) {
      if (!is_measured(box, i)) continue;
      double below = 0, above = 0;
      const ShareBox::Place low = box.climb(i, -1, below), high = box.climb(i, 1, above);
      const std::string& name = names_[static_cast<std::size_t>(i)];
      if (box.jumps(i)) jumping.push_back(name);
      std::optional<double> error;
      if (options_.errors)
        if (const double worst = std::max(box.errors(low)[i] + below, box.errors(high)[i] + above);
            std::isfinite(worst))
          error = worst;
      const bool stands = one_motion() && std::ranges::find(frictional, name) != frictional.end();
      band.extents.push_back({name, box.unit(i), box.first().state.values[i], low.state.values[i],
                              high.state.values[i], error, shares(low.state.p), shares(high.state.p), stands,
                              state_.stable, state_.stable});
    }
    band.found = true;
    band.whole = !box.lost();
    if (shares_.size() > 1) band.message = "Each extent is an extremum nearby: rates tell of none beyond.";
    if (band.whole) drop_jumping(jumping, band);
    return band;
  }

  const Mechanism& mechanism_;
  const Solution& state_;
  const FrictionBandOptions& options_;
  std::vector<FreeNumber> shares_;
  std::vector<std::string> names_;          // what is told
  std::vector<std::size_t> independent_{0}; // as of Holding
};

} // namespace

FrictionBand find_friction_band(const Mechanism& mechanism, const FrictionBandOptions& options) {
  const Interruptible scope(options.cancel);
  try {
    const Solution state = steady_state_near(mechanism, options.start, options.cancel);
    if (state.status != Status::converged || !state.frictions.empty()) return no_band(state.message);
    return BandAbout(mechanism, state, options).find();
  } catch (const Interrupted&) {
    return no_band("Cancelled.");
  }
}

} // namespace flyball
