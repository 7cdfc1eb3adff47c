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
  case Kink::Of::cut_damper: {
    const CutDamperElement& e =
        system.cut_dampers[static_cast<std::size_t>(system.cut_damper_laws[kink.entry].at)];
    return {coordinate_name(mechanism.joints[static_cast<std::size_t>(e.joint)], e.coordinate), e.angular};
  }
  case Kink::Of::vane: return force(system.body_forces[kink.entry].force);
  case Kink::Of::vane_in_turning_air: return force(system.turning_air[kink.entry].force);
  case Kink::Of::drive: {
    const Link& link = system.links[static_cast<std::size_t>(system.torques[kink.entry].link)];
    const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    return {coordinate_label(joint, link.coordinate), is_angle(joint.type, link.coordinate)};
  }
  case Kink::Of::coordinate:
  case Kink::Of::stop: break;
  }
  const bool stop = kink.of == Kink::Of::stop;
  const Link& link =
      system.links[stop ? kink.entry : static_cast<std::size_t>(system.coordinate_laws[kink.entry].at)];
  const TreeJoint& joint = system.tree_joints[static_cast<std::size_t>(link.tree_joint)];
  const int i =
      link.coordinate + (stop ? static_cast<int>(kink.input) : system.coordinate_laws[kink.entry].component);
  return {coordinate_name(mechanism.joints[static_cast<std::size_t>(joint.joint)], i),
          is_angle(joint.type, i)};
}

struct Words {
  std::string law, slope, unit;
};

// Of a drive's law: the slope is that with one of its inputs.
Words words_of_drive(const System& system, const Mechanism& mechanism, const Kink& kink, bool angle) {
  const DriveTorqueElement& e = system.torques[kink.entry];
  const bool torque = kink.law == Kink::Law::torque;
  const DriveLaw::Input& input = (torque ? e.torque : e.load).inputs[kink.input];
  const std::string_view unit = result_unit(input.quantity);
  const bool rate = unit.ends_with("/s");
  return {torque ? angle ? "torque" : "force" : "load",
          "slope with " + quantity_text(mechanism, input.quantity),
          std::string(fields::force_unit(angle)) + (rate ? " s/" : "/") +
              std::string(unit.substr(0, unit.find('/')))};
}

Words words_of(const System& system, const Mechanism& mechanism, const Kink& kink, bool angle) {
  switch (kink.law) {
  case Kink::Law::spring: return {"spring", "stiffness", std::string(fields::stiffness_unit(angle))};
  case Kink::Law::damper: return {"damper", "damping", std::string(fields::damping_unit(angle))};
  case Kink::Law::lift: return {"lift", "slope", "1/rad"};
  case Kink::Law::drag: return {"drag", "slope", "1/rad"};
  case Kink::Law::torque:
  case Kink::Law::load: return words_of_drive(system, mechanism, kink, angle);
  }
  return {};
}

} // namespace

std::string kink_message(const System& system, const Mechanism& mechanism, const Stability& stability) {
  std::string out;
  for (const Kink& kink : stability.kinks) {
    const Owner owner = owner_of(system, mechanism, kink);
    const Words words = words_of(system, mechanism, kink, owner.angle);
    const std::string where = kink.of == Kink::Of::stop ? owner.name + " stands just at its stop, where its "
                                                        : "The " + words.law + " of " + owner.name +
                                                              " stands on a kink of its law, where its ";
    out += std::string(out.empty() ? "" : " ") + where + words.slope + " jumps from " +
           rounded_text(kink.slopes[0], 4) + " to " + rounded_text(kink.slopes[1], 4) + " " + words.unit +
           ": " + (kink.law == Kink::Law::damper ? "eigenvalues hold" : "rates and eigenvalues hold") +
           " on one side of it" +
           (stability.kinks_leave_open ? ", and whether it is stable stays open." : ".");
  }
  return out;
}

} // namespace flyball
