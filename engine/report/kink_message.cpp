#include "engine/report/kink_message.hpp"

#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/text.hpp"

namespace flyball {
namespace {

struct Owner {
  std::string name;
  bool angle = false;
};

Owner owner_of(const System& system, const Mechanism& mechanism, const Kink& kink) {
  const auto force = [&](int f) { return Owner{mechanism.forces[static_cast<std::size_t>(f)].name, false}; };
  switch (kink.of) {
  case Kink::Of::spring:
    return force(system.springs[static_cast<std::size_t>(system.spring_laws[kink.entry].at)].force);
  case Kink::Of::vane: return force(system.body_forces[kink.entry].force);
  case Kink::Of::vane_in_turning_air: return force(system.turning_air[kink.entry].force);
  case Kink::Of::coordinate: break;
  }
  const ForceLawElement& e = system.coordinate_laws[kink.entry];
  const Link& link = system.links[static_cast<std::size_t>(e.at)];
  const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
  const int i = link.coordinate + e.component;
  return {coordinate_name(mechanism.joints[static_cast<std::size_t>(joint.joint)], i),
          is_angle(joint.type, i)};
}

struct Words {
  std::string_view law, slope, unit;
};

Words words_of(Kink::Law law, bool angle) {
  switch (law) {
  case Kink::Law::spring: return {"spring", "stiffness", fields::stiffness_unit(angle)};
  case Kink::Law::damper: return {"damper", "damping", fields::damping_unit(angle)};
  case Kink::Law::lift: return {"lift", "slope", "1/rad"};
  case Kink::Law::drag: return {"drag", "slope", "1/rad"};
  }
  return {};
}

} // namespace

std::string kink_message(const System& system, const Mechanism& mechanism, const Stability& stability) {
  std::string out;
  for (const Kink& kink : stability.kinks) {
    const Owner owner = owner_of(system, mechanism, kink);
    const Words words = words_of(kink.law, owner.angle);
    out += std::string(out.empty() ? "" : " ") + "The " + std::string(words.law) + " of " + owner.name +
           " stands on a kink of its law, where its " + std::string(words.slope) + " jumps from " +
           rounded_text(kink.slopes[0], 4) + " to " + rounded_text(kink.slopes[1], 4) + " " +
           std::string(words.unit) + ": " +
           (kink.law == Kink::Law::damper ? "eigenvalues hold" : "rates and eigenvalues hold") +
           " on one side of it" +
           (stability.kinks_leave_open ? ", and whether it is stable stays open." : ".");
  }
  return out;
}

} // namespace flyball
