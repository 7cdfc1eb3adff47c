#include "app/document/backlash.hpp"

#include "app/document/create.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/references.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace flyball {
namespace {

bool turns(const Joint& joint) {
  return joint.type == JointType::revolute;
}

class Backlash {
 public:
  Backlash(Mechanism& mechanism, const std::string& gear) : m_(mechanism), gear_(gear) {
    if (at(gear).type != JointType::gear) throw SceneError("joints." + gear, "expected a gear");
  }

  std::string run() {
    const std::array<std::string, 2> ends = at(gear_).joints;
    const bool first = is_driven_beyond(ends[0]), second = is_driven_beyond(ends[1]);
    if (first && second)
      refuse("Drives turn both of its sides: what lies on one of them is to be turned by the gear alone.");
    const std::string& wheel = ends[second ? 0 : 1];
    passed_ = {gear_};
    const std::string play = hang_in_rim(wheel, "play");
    const std::string name = free_name(m_, "backlash");
    const bool angle = turns(at(play));
    const UsualMesh& mesh = angle ? usual_mesh_of_angles : usual_mesh_of_slides;
    m_.parameters.push_back({name, "play of " + gear_, mesh.play, angle ? "rad" : "m", {}});
    Joint& joint = at(play);
    joint.coordinates[0].stop = Stop{-mesh.play / 2, mesh.play / 2, mesh.stiffness, ""};
    joint.coordinates[0].damping = mesh.damping;
    joint.formulas = {{"stop.lower", "-" + name + "/2"}, {"stop.upper", name + "/2"}};
    follow_beyond(wheel, play);
    return play;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw SceneError("joints." + gear_, why); }

  Joint& at(const std::string& name) const {
    const int j = joint_index(m_, name);
    if (j < 0) throw SceneError("joints." + name, "there is no such joint");
    return m_.joints[static_cast<std::size_t>(j)];
  }

  // Gears at a coordinate, but for those that have been passed.
  std::vector<std::string> gears_at(const std::string& coordinate,
                                    const std::set<std::string>& passed) const {
    std::vector<std::string> names;
    for (const Joint& joint : m_.joints)
      if (joint.type == JointType::gear && !passed.contains(joint.name) &&
          std::ranges::find(joint.joints, coordinate) != joint.joints.end())
        names.push_back(joint.name);
    return names;
  }
  static const std::string& other_end(const Joint& gear, const std::string& end) {
    return gear.joints[gear.joints[0] == end ? 1 : 0];
  }

  // Whether there is a drive at the coordinate, or at one that gears beyond it tie to it.
  bool is_driven_beyond(const std::string& coordinate) const {
    std::set<std::string> passed{gear_}, seen;
    std::vector<std::string> open{coordinate};
    while (!open.empty()) {
      const std::string one = open.back();
      open.pop_back();
      if (!seen.insert(one).second) continue;
      const auto [joint, i] = find_coordinate(m_, one);
      if (joint >= 0 &&
          m_.joints[static_cast<std::size_t>(joint)].coordinates[static_cast<std::size_t>(i)].drive)
        return true;
      for (const std::string& gear : gears_at(one, passed)) {
        passed.insert(gear);
        open.push_back(other_end(at(gear), one));
      }
    }
    return false;
  }

  // Hangs the child of a hinge or slide in a rim, which the joint then holds in its place; the name of the
  // joint between the two.
  std::string hang_in_rim(const std::string& coordinate, std::string_view stem) {
    const std::string name = joint_of_end(coordinate);
    const Joint before = at(name);
    if (before.type != JointType::revolute && before.type != JointType::prismatic)
      refuse(name + " is no hinge and no slide, in which its wheel could have play.");
    const Coordinate& c = before.coordinates[0];
    if (c.drive || c.spring || c.stop || c.friction || c.damping != 0 || c.damping_force)
      refuse("The drive, spring, damper, stop or friction of " + name +
             " would act on the rim instead of the wheel.");
    if (before.bodies[1] == ground_name) refuse("The child of " + name + " is the ground.");
    Body rim;
    rim.name = unused_name(m_, PartKind::body, "rim");
    rim.position = before.at;
    m_.bodies.push_back(rim);
    Joint made;
    made.name = unused_name(m_, PartKind::joint, stem);
    made.type = before.type;
    made.bodies = {rim.name, before.bodies[1]};
    made.at = before.at;
    made.axis = before.axis;
    made.coordinates.resize(1);
    for (const Formula& formula : before.formulas)
      if (formula.key.starts_with("at.") || formula.key.starts_with("axis."))
        made.formulas.push_back(formula);
    m_.joints.push_back(made);
    at(name).bodies[1] = rim.name;
    return made.name;
  }

  // Of what is geared to the coordinate: it turns in its rim as `inner` does.
  void follow_beyond(const std::string& coordinate, const std::string& inner) {
    for (const std::string& name : gears_at(coordinate, passed_)) {
      passed_.insert(name);
      const std::string beyond = other_end(at(name), coordinate);
      if (!followed_.insert(beyond).second) refuse("The gears beyond it make a ring.");
      const std::string follower = hang_in_rim(beyond, "follow");
      Joint again = at(name);
      again.name = unused_name(m_, PartKind::joint, name);
      again.description.clear();
      for (std::string& end : again.joints)
        end = end == coordinate ? inner : follower;
      again.offset.reset();
      std::erase_if(again.formulas, [](const Formula& formula) { return formula.key == "offset"; });
      m_.joints.push_back(again);
      passed_.insert(again.name);
      follow_beyond(beyond, follower);
    }
  }

  Mechanism& m_;
  const std::string gear_;
  std::set<std::string> passed_, followed_; // gears, coordinates
};

} // namespace

std::string backlash_refused(const Mechanism& mechanism, const std::string& gear) {
  try {
    Mechanism copy = mechanism;
    give_backlash(copy, gear);
    return {};
  } catch (const SceneError& error) {
    return error.expected();
  }
}

std::string give_backlash(Mechanism& mechanism, const std::string& gear) {
  Mechanism next = mechanism;
  const std::string play = Backlash(next, gear).run();
  mechanism = std::move(next);
  return play;
}

} // namespace flyball
