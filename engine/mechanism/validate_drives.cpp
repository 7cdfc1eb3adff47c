#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>

namespace flyball {
namespace {

// What drives a coordinate, directly or through gears.
struct Driven {
  bool is = false;
  double speed = 0;
  bool found = false; // the speed
  bool keeps_momentum = false;
  std::size_t joint = 0; // whose drive it is
  int gear = -1;         // the last gear on the way, -1 where it is driven directly
};

// Of every coordinate, numbered through all joints.
class DrivenCoordinates {
 public:
  DrivenCoordinates(const Mechanism& mechanism, Mistakes& mistakes) : mechanism_(mechanism) {
    for (const Joint& joint : mechanism.joints) {
      first_.push_back(all_.size());
      all_.resize(all_.size() + joint.coordinates.size());
    }
    neighbours_.resize(all_.size());
    for (std::size_t g = 0; g < mechanism.joints.size(); ++g)
      if (mechanism.joints[g].type == JointType::gear) add_gear(g);
    std::deque<std::size_t> waiting;
    for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
      for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i)
        if (const std::optional<Drive>& drive = mechanism.joints[j].coordinates[i].drive) {
          all_[first_[j] + i] = {
              true, drive->speed, finds_speed(*drive), drive->keeps == DriveKeeps::momentum, j, -1};
          waiting.push_back(first_[j] + i);
        }
    for (; !waiting.empty(); waiting.pop_front())
      spread(waiting.front(), waiting, mistakes);
  }

  const Driven& operator()(std::size_t joint, std::size_t i) const { return all_[first_[joint] + i]; }

  bool every_one_at_given_speed(std::size_t joint) const {
    const std::size_t count = mechanism_.joints[joint].coordinates.size();
    for (std::size_t i = 0; i < count; ++i)
      if (!(*this)(joint, i).is || (*this)(joint, i).found) return false;
    return true;
  }

  // Whether a coordinate of the joint has a drive or is at a given speed, so that no loop is cut there.
  bool is_kept(std::size_t joint) const {
    const std::vector<Coordinate>& coordinates = mechanism_.joints[joint].coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      if (const Driven& d = (*this)(joint, i); coordinates[i].drive || (d.is && !d.found)) return true;
    return false;
  }

 private:
  struct Mesh {
    std::size_t other;
    double ratio; // speed of the other over this one's
    std::size_t gear;
  };

  void add_gear(std::size_t g) {
    const Joint& gear = mechanism_.joints[g];
    std::array<std::size_t, 2> ends{};
    for (std::size_t end = 0; end < 2; ++end) {
      const auto [joint, i] = find_coordinate(mechanism_, gear.joints[end]);
      ends[end] = first_[static_cast<std::size_t>(joint)] + static_cast<std::size_t>(i);
    }
    const double ratio = gear_ratio(gear);
    neighbours_[ends[0]].push_back({ends[1], ratio, g});
    neighbours_[ends[1]].push_back({ends[0], 1 / ratio, g});
  }

  void spread(std::size_t from, std::deque<std::size_t>& waiting, Mistakes& mistakes) {
    const Driven source = all_[from];
    for (const auto& [other, ratio, g] : neighbours_[from]) {
      Driven& target = all_[other];
      const double speed = source.speed * ratio;
      if (!target.is) {
        target = {true, speed, source.found, source.keeps_momentum, source.joint, static_cast<int>(g)};
        waiting.push_back(other);
        continue;
      }
      if (source.found && target.found) continue; // torques add up
      if (source.found != target.found) {
        if (is_reported(g)) continue;
        reported_.push_back(g);
        const Joint& found = mechanism_.joints[source.found ? source.joint : target.joint];
        const Joint& given = mechanism_.joints[source.found ? target.joint : source.joint];
        mistakes.add(joint_path(mechanism_, g),
                     "expected drives of one kind: the " + std::string(type_name(mechanism_.joints[g].kind)) +
                         " determines the speed of " + found.name + " by that of " + given.name +
                         ", so that none is to be found; what " + found.name +
                         " gives would only load the drive of " + given.name);
        continue;
      }
      constexpr double round_off = 1e-9;
      const double largest = std::max(std::abs(speed), std::abs(target.speed));
      if (std::abs(speed - target.speed) <= round_off * largest || is_reported(g)) continue;
      reported_.push_back(g);
      const std::string& a = mechanism_.joints[source.joint].name;
      const std::string& b = mechanism_.joints[target.joint].name;
      mistakes.add(joint_path(mechanism_, g),
                   "expected drives that agree: the drive of " + a + " asks for a speed of " +
                       number_text(speed) + " where the drive of " + b + (a == b ? ", by another way," : "") +
                       " asks for " + number_text(target.speed));
    }
  }

  bool is_reported(std::size_t gear) const {
    return std::find(reported_.begin(), reported_.end(), gear) != reported_.end();
  }

  const Mechanism& mechanism_;
  std::vector<std::size_t> first_; // number of each joint's first coordinate
  std::vector<Driven> all_;
  std::vector<std::vector<Mesh>> neighbours_;
  std::vector<std::size_t> reported_; // gears
};

void find_springs_on_driven(const Mechanism& mechanism, const DrivenCoordinates& driven, Mistakes& mistakes) {
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j)
    for (std::size_t i = 0; i < mechanism.joints[j].coordinates.size(); ++i) {
      if (!driven(j, i).is) continue;
      const Coordinate& coordinate = mechanism.joints[j].coordinates[i];
      const int gear = driven(j, i).gear;
      const std::string by =
          gear < 0 ? "" : " through the gear " + mechanism.joints[static_cast<std::size_t>(gear)].name;
      const std::string reason =
          " on this coordinate, which is driven" + by + ": its torque or force never settles";
      if (coordinate.spring)
        mistakes.add(coordinate_path(mechanism, j, "spring", i), "expected no spring" + reason);
      if (coordinate.stop)
        mistakes.add(coordinate_path(mechanism, j, "stop", i), "expected no stop" + reason);
      if (coordinate.friction && driven(j, i).keeps_momentum)
        mistakes.add(coordinate_path(mechanism, j, "friction", i),
                     "expected no friction on this coordinate, which is driven" + by +
                         ": where friction acts no momentum is kept");
      else if (coordinate.friction && !driven(j, i).found && coordinate.friction->share != 0)
        mistakes.add(coordinate_path(mechanism, j, "friction", i) + ".share",
                     "expected 0 on this coordinate, which is driven" + by +
                         ": at a given speed friction gives all of its limit against it");
    }
}

// A gear passes on momentum, which is then not that of the drive alone.
void find_gears_on_momenta(const Mechanism& mechanism, Mistakes& mistakes) {
  for (std::size_t g = 0; g < mechanism.joints.size(); ++g) {
    const Joint& gear = mechanism.joints[g];
    if (gear.type != JointType::gear) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      const auto [joint, i] = find_coordinate(mechanism, gear.joints[end]);
      const auto& drive =
          mechanism.joints[static_cast<std::size_t>(joint)].coordinates[static_cast<std::size_t>(i)].drive;
      if (drive && drive->keeps == DriveKeeps::momentum)
        mistakes.add(joint_path(mechanism, g) + ".joints[" + std::to_string(end) + "]",
                     "expected a coordinate without a drive that keeps its momentum: through a gear it "
                     "passes to others");
    }
  }
}

// The joints on the path between two bodies (as BodyNumbers has them) among `joints`, which form no loop.
std::vector<std::size_t> path_between(const Mechanism& mechanism, const BodyNumbers& numbers,
                                      const std::vector<std::size_t>& joints, std::size_t from,
                                      std::size_t to) {
  constexpr std::size_t unseen = static_cast<std::size_t>(-1);
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> steps(mechanism.bodies.size() +
                                                                      1); // body, joint
  for (const std::size_t j : joints) {
    const std::size_t a = numbers[mechanism.joints[j].bodies[0]];
    const std::size_t b = numbers[mechanism.joints[j].bodies[1]];
    steps[a].emplace_back(b, j);
    steps[b].emplace_back(a, j);
  }
  std::vector<std::pair<std::size_t, std::size_t>> came(steps.size(), {unseen, unseen});
  std::deque<std::size_t> waiting{to};
  came[to].first = to;
  for (; !waiting.empty(); waiting.pop_front())
    for (const auto& [next, joint] : steps[waiting.front()])
      if (came[next].first == unseen) {
        came[next] = {waiting.front(), joint};
        waiting.push_back(next);
      }
  std::vector<std::size_t> path;
  for (std::size_t body = from; body != to; body = came[body].first)
    path.push_back(came[body].second);
  return path;
}

// Calls `closes` with every joint that closes a loop of `joints`, in their order, and the others of that
// loop.
void find_loops(const Mechanism& mechanism, const BodyNumbers& numbers,
                const std::vector<std::size_t>& joints,
                const std::function<void(std::size_t, const std::vector<std::size_t>&)>& closes) {
  BodyGroups groups(numbers);
  std::vector<std::size_t> joined;
  for (const std::size_t j : joints) {
    const auto& bodies = mechanism.joints[j].bodies;
    if (groups.join(bodies))
      joined.push_back(j);
    else
      closes(j, path_between(mechanism, numbers, joined, numbers[bodies[0]], numbers[bodies[1]]));
  }
}

// "shaft", or "disc on shaft" where neither is the ground.
std::string what_it_moves(const Joint& joint) {
  const auto& [parent, child] = joint.bodies;
  if (parent == ground_name) return child;
  return child == ground_name ? parent : child + " on " + parent;
}

void add_loop(const Mechanism& mechanism, std::size_t j, const std::vector<std::size_t>& others,
              const char* contradiction, Mistakes& mistakes) {
  const Joint& joint = mechanism.joints[j];
  const std::string where = joint_path(mechanism, j) + ".drive";
  const Joint& other = mechanism.joints[others.front()];
  if (others.size() == 1)
    return mistakes.add(where, joint.name + " drives " + what_it_moves(joint) + ", which " + other.name +
                                   (other.type == JointType::fixed
                                        ? " holds: expected no drive"
                                        : " drives already: expected one drive for both"));
  std::vector<std::string_view> names{joint.name};
  for (const std::size_t k : others)
    names.push_back(mechanism.joints[k].name);
  mistakes.add(where, "expected a joint that is neither driven nor fixed in the loop of " +
                          word_list(names, "and") + ": " + contradiction);
}

// A loop in which every joint is driven at a given speed or fixed moves as the drives say, or not at all. One
// in which every joint has a drive, of whatever kind, leaves none to be cut.
void find_driven_loops(const Mechanism& mechanism, const DrivenCoordinates& driven, Mistakes& mistakes) {
  const BodyNumbers numbers(mechanism);
  std::vector<std::size_t> fixed, given, finding;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    if (joint.type == JointType::gear || joint.type == JointType::distance) continue;
    if (joint.type == JointType::fixed)
      fixed.push_back(j);
    else if (driven.every_one_at_given_speed(j))
      given.push_back(j);
    else if (driven.is_kept(j))
      finding.push_back(j);
  }
  const auto followed_by = [](std::vector<std::size_t> first, const std::vector<std::size_t>& then) {
    first.insert(first.end(), then.begin(), then.end());
    return first;
  };
  find_loops(mechanism, numbers, followed_by(fixed, given), [&](std::size_t j, const auto& others) {
    if (mechanism.joints[j].type != JointType::fixed) // a loop of fixed joints alone is only redundant
      add_loop(mechanism, j, others, "these drives contradict each other", mistakes);
  });
  find_loops(mechanism, numbers, followed_by(given, finding), [&](std::size_t j, const auto& others) {
    if (!driven.every_one_at_given_speed(j)) // else it is told already
      add_loop(mechanism, j, others, "a joint that is driven cannot be cut to close it", mistakes);
  });
}

} // namespace

void find_drive_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  const DrivenCoordinates driven(mechanism, mistakes);
  find_springs_on_driven(mechanism, driven, mistakes);
  find_gears_on_momenta(mechanism, mistakes);
  find_driven_loops(mechanism, driven, mistakes);
}

} // namespace flyball
