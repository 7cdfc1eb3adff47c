// The bands of dry friction along a response curve: between which values each coordinate and measure may
// stand at every value of the varied number. About what is stable it goes along the lower edge as the
// quantity rises, along the upper as it falls. About what is not friction holds it, too, but over an edge it
// runs away.
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
  std::vector<BandExtent> extents; // empty where there is no band
  // By extent, of several joints with friction that move by themselves (slow_change.hpp); else empty.
  std::vector<HysteresisPoint> slow{};
  std::string no_way{}; // of the first point of a stretch (slow_stretches()): why several joints have none
  // Of a single joint with friction: it passes folds of the balance, beyond which friction alone holds, and
  // may so reach from one branch to another.
  bool folds = false;
  bool meets = false;    // its band does not go on from that of the point before: see add_meetings()
  std::string message{}; // a sentence or more on the band, or why there is none
};

// The band at one place. Throws SceneError for a number that the mechanism does not take.
RibbonPoint ribbon_point(const Mechanism& mechanism, const std::string& address, const RibbonPlace& place,
                         const std::atomic<bool>* cancel);

// `progress`: places done. Cancelled, points are missing at the end. Throws SceneError for a number that the
// mechanism does not take.
std::vector<RibbonPoint> friction_ribbon(const Mechanism& mechanism, const std::string& address,
                                         std::span<const RibbonPlace> places,
                                         const std::atomic<bool>* cancel = nullptr,
                                         const std::function<void(std::size_t done)>& progress = {});

// Adds to the points at all places the way that several joints with friction go, along each stretch.
void add_slow_change(const Mechanism& mechanism, const std::string& address,
                     std::span<const RibbonPlace> places, std::vector<RibbonPoint>& points,
                     const std::atomic<bool>* cancel);

std::vector<RibbonPlace> ribbon_places(const ResponseBranch& branch);

// Bands at all points of each branch that was followed over this number.
std::vector<std::vector<RibbonPoint>>
friction_ribbons(const Mechanism& mechanism, const std::string& address, const ResponseDiagram& diagram,
                 const std::atomic<bool>* cancel = nullptr,
                 const std::function<void(std::size_t done, std::size_t all)>& progress = {});

// Some of the points that follow one another.
struct RibbonStretch {
  std::size_t begin = 0, end = 0; // of the points; the last is before `end`
};

// Those along which a slow change of the number leads without a jump, as far as is known: of two points or
// more, about what is not unstable, with bands that pass no folds and go on from each other, and in one
// direction.
std::vector<RibbonStretch> slow_stretches(std::span<const RibbonPoint> points);

// Of a single motion that has friction, in one joint or in several that loops tie to it: where the coordinate
// of such a joint stands as the varied number goes slowly over the points of a stretch. It stays until an end
// of the band comes to it, and goes on with that (a play operator: Krasnoselskii and Pokrovskii, Systems with
// Hysteresis, 1989). Of several motions what was found of any coordinate or measure (RibbonPoint::slow). By
// point; empty where they are no one stretch, or have no such band.
std::vector<HysteresisPoint> hysteresis(std::span<const RibbonPoint> points, std::string_view name);

// Null where it has none of this name.
const BandExtent* find_extent(const RibbonPoint& point, std::string_view name);

// The ends of all extents by number, lower ones first: `e` below twice their count. May be infinite.
double ribbon_edge(const RibbonPoint& point, std::size_t e);

} // namespace flyball
