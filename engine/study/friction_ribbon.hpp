// The bands of dry friction along a response curve: between which values each coordinate and measure may
// stand at every value of the varied number. As the quantity rises it goes along the lower edge, as it falls
// along the upper.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/study/friction_band.hpp"

#include <functional>

namespace flyball {

struct RibbonPlace {
  double number = 0;                                 // value of the varied number, in its unit
  std::vector<std::pair<std::string, double>> start; // the state there, as of SolveOptions
};

// Where something stands as the varied number goes slowly from the first point to the last and back, again
// and again.
struct HysteresisPoint {
  double forth = 0, back = 0; // rad, m, or the measure's unit
};

struct RibbonPoint {
  double number = 0;
  std::vector<BandExtent> extents; // empty where there is no band, or none with bounds
  // By extent, of several joints with friction that move by themselves (slow_change.hpp); else empty.
  std::vector<HysteresisPoint> slow{};
  std::string no_way{}; // of the first point: why several such joints have none
  // Of a single joint with friction: it passes folds of the balance, beyond which friction alone holds, and
  // may so reach from one branch to another.
  bool folds = false;
  bool meets = false; // its band does not go on from that of the point before: see add_meetings()
};

// `progress`: places done. Cancelled, points are missing at the end. Throws SceneError for a number that the
// mechanism does not take.
std::vector<RibbonPoint> friction_ribbon(const Mechanism& mechanism, const std::string& address,
                                         std::span<const RibbonPlace> places,
                                         const std::atomic<bool>* cancel = nullptr,
                                         const std::function<void(std::size_t done)>& progress = {});

// Adds to the points at all places two where bands meet between them: at numbers that no one tells apart in a
// picture, one with the band of several branches and one with that of one of them.
void add_meetings(const Mechanism& mechanism, const std::string& address, std::span<const RibbonPlace> places,
                  std::vector<RibbonPoint>& points, const std::atomic<bool>* cancel = nullptr);

// The same at some of the places, and at those between where an edge bends or the band ends: until a line
// between neighbours leaves out no more than a hundredth of an edge's height, as far as there are places; and
// where bands meet.
// `first`: with which it begins, ascending, both ends among them.
std::vector<RibbonPoint> friction_ribbon_at_bends(const Mechanism& mechanism, const std::string& address,
                                                  std::span<const RibbonPlace> places,
                                                  std::span<const std::size_t> first,
                                                  const std::atomic<bool>* cancel = nullptr);

std::vector<RibbonPlace> ribbon_places(const ResponseBranch& branch);

// Bands at all points of each branch that was followed over this number.
std::vector<std::vector<RibbonPoint>>
friction_ribbons(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 const std::atomic<bool>* cancel = nullptr,
                 const std::function<void(std::size_t done, std::size_t all)>& progress = {});

// Of a single motion that has friction, in one joint or in several that loops tie to it: where the coordinate
// of such a joint stands as the varied number goes slowly. It stays until an end of the band comes to it, and
// goes on with that (a play operator: Krasnoselskii and Pokrovskii, Systems with Hysteresis, 1989). Of
// several motions what was found of any coordinate or measure (RibbonPoint::slow). By point; empty where the
// points have no such band, or one that passes folds, where it jumps, and where they go back in the number.
std::vector<HysteresisPoint> hysteresis(std::span<const RibbonPoint> points, std::string_view name);

// Null where it has none of this name.
const BandExtent* find_extent(const RibbonPoint& point, std::string_view name);

} // namespace flyball
