#include "app/document/copies.hpp"

#include "app/document/coordinate_image.hpp"
#include "app/document/image.hpp"
#include "app/document/law_image.hpp"
#include "app/document/names.hpp"
#include "app/document/references.hpp"
#include "engine/mechanism/drive_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

namespace flyball {
namespace {

// What a selection copies, as it was before the first copy.
class Copier {
 public:
  Copier(Mechanism& mechanism, const Selection& selection)
      : mechanism_(mechanism), before_(mechanism), selection_(selection),
        body_names_(mechanism, PartKind::body), joint_names_(mechanism, PartKind::joint),
        force_names_(mechanism, PartKind::force) {
    find_parts();
  }

  // Adds one copy of everything; returns the copies of the parts that were selected.
  Selection copy(const Isometry& isometry) {
    Names bodies, joints, forces;
    for (const Body* body : bodies_)
      bodies[body->name] = body_names_.take_next(body->name);
    for (const Joint* joint : joints_)
      joints[joint->name] = joint_names_.take_next(joint->name);
    for (const Force* force : forces_)
      forces[force->name] = force_names_.take_next(force->name);
    for (const Body* body : bodies_) {
      mechanism_.bodies.push_back(image_of(*body, isometry));
      mechanism_.bodies.back().name = bodies[body->name];
    }
    const auto copied = [](const Names& names) {
      return [&names](const std::string& name) {
        const auto copy = names.find(name);
        return copy == names.end() ? name : copy->second;
      };
    };
    const CopiedNames copied_names{copied(bodies), copied(joints), copied(forces)};
    for (const Joint* joint : joints_) {
      mechanism_.joints.push_back(joint->type == JointType::gear ? gear_image(*joint, isometry, joints)
                                                                 : image_of(*joint, isometry));
      mechanism_.joints.back().name = joints[joint->name];
      follow(bodies_of(mechanism_.joints.back()), bodies);
      follow_in_laws(mechanism_.joints.back(), isometry, copied_names);
    }
    for (const Force* force : forces_) {
      const int b = body_index(before_, force->body);
      const Quat axes = b < 0 ? Quat::Identity() : before_.bodies[static_cast<std::size_t>(b)].rotation;
      mechanism_.forces.push_back(image_of(*force, isometry, axes, bodies.contains(force->body)));
      mechanism_.forces.back().name = forces[force->name];
      follow(bodies_of(mechanism_.forces.back()), bodies);
    }
    Selection copies;
    const auto add = [&](const Part& part, const Names& names) {
      if (const auto copy = names.find(part.name); copy != names.end()) copies.add({part.kind, copy->second});
    };
    for (const Part& part : selection_.parts)
      add(part, part.kind == PartKind::body ? bodies : part.kind == PartKind::joint ? joints : forces);
    return copies;
  }

 private:
  using Names = std::unordered_map<std::string, std::string>; // of the copies, by those of the originals

  // Of parts with one name, a mistake that a document may hold, the first is the one that is meant.
  void find_parts() {
    std::unordered_set<std::string> bodies, joints, forces;
    for (const Body& body : before_.bodies)
      if (selection_.has({PartKind::body, body.name}) && bodies.insert(body.name).second)
        bodies_.push_back(&body);
    const auto body_copied = [&](const std::string& body) { return bodies.contains(body); };
    const auto joint_copied = [&](const std::string& end) { return joints.contains(joint_of_end(end)); };
    for (const Joint& joint : before_.joints)
      if ((selection_.has({PartKind::joint, joint.name}) ||
           std::ranges::any_of(bodies_of(joint), body_copied)) &&
          joints.insert(joint.name).second)
        joints_.push_back(&joint);
    for (const Joint& gear : before_.joints)
      if (gear.type == JointType::gear && std::ranges::all_of(gear.joints, joint_copied) &&
          joints.insert(gear.name).second)
        joints_.push_back(&gear);
    for (const Force& force : before_.forces)
      if ((selection_.has({PartKind::force, force.name}) ||
           std::ranges::any_of(bodies_of(force), body_copied)) &&
          forces.insert(force.name).second)
        forces_.push_back(&force);
  }

  static void follow(std::span<std::string> names, const Names& copies) {
    for (std::string& name : names)
      if (const auto copy = copies.find(name); copy != copies.end()) name = copy->second;
  }

  // The torque of a copied drive is one of the copies' state, and along the coordinate of the copy.
  void follow_in_laws(Joint& image, const Isometry& isometry, const CopiedNames& copies) {
    const std::vector<CoordinateImage> images = images_of_coordinates(image.type, isometry);
    for (std::size_t i = 0; i < image.coordinates.size(); ++i)
      for (const char* which : {"torque", "load"}) {
        const Formula* law = drive_law(before_, image, static_cast<int>(i), which);
        if (!law) continue;
        Formula& followed = image.formulas[static_cast<std::size_t>(law - image.formulas.data())];
        followed.text = law_image(before_, law->text, isometry, copies, mechanism_);
        if (images[i].sign < 0) followed.text = "-(" + followed.text + ")";
      }
  }

  Joint gear_image(const Joint& gear, const Isometry& isometry, const Names& joints) const {
    Joint image = gear;
    for (std::size_t end = 0; end < 2; ++end) {
      const auto copy = joints.find(joint_of_end(gear.joints[end]));
      if (copy == joints.end()) continue;
      image.joints[end] = end_at(gear.joints[end], copy->second);
      const auto [joint, coordinate] = find_coordinate(before_, gear.joints[end]);
      if (joint < 0) continue;
      Joint other = before_.joints[static_cast<std::size_t>(joint)];
      other.name = copy->second;
      const std::vector<CoordinateImage> images = images_of_coordinates(other.type, isometry);
      move_end(image, end, other, coordinate, images[static_cast<std::size_t>(coordinate)]);
    }
    return image;
  }

  Mechanism& mechanism_;
  const Mechanism before_;
  const Selection selection_;
  UsedNames body_names_, joint_names_, force_names_;
  std::vector<const Body*> bodies_;
  std::vector<const Joint*> joints_;
  std::vector<const Force*> forces_;
};

} // namespace

Selection duplicate_parts(Mechanism& mechanism, const Selection& selection, const Vec3& by) {
  if (!by.allFinite()) return {};
  return Copier(mechanism, selection).copy(translation(by));
}

Selection mirror_parts(Mechanism& mechanism, const Selection& selection, const Vec3& point,
                       const Vec3& normal) {
  const auto isometry = reflection(point, normal);
  return isometry ? Copier(mechanism, selection).copy(*isometry) : Selection{};
}

Selection circular_copy(Mechanism& mechanism, const Selection& selection, const Vec3& point, const Vec3& axis,
                        int count) {
  Selection all;
  Copier copier(mechanism, selection);
  for (int i = 1; i < count; ++i) {
    const auto isometry = rotation_about(point, axis, 2 * std::numbers::pi * i / count);
    if (!isometry) break;
    for (Part& part : copier.copy(*isometry).parts)
      all.add(std::move(part));
  }
  return all;
}

} // namespace flyball
