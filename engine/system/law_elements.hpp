// Laws of drives, springs and dampers as elements of the system, their coordinates and springs found in it.
#pragma once

#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/system.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace flyball {

// Hands on what the "torque" or "load" of a joint's drive is read as, where it is a law of the state. What
// `take` throws as ExpressionError becomes a SceneError at its place.
template <class Take>
void read_drive_law_of(const Mechanism& mechanism, const Joint& of, int coordinate, std::string_view which,
                       Take take) {
  const Formula* law = drive_law(mechanism, of, coordinate, which);
  if (!law) return;
  try {
    take(read_drive_law(mechanism, law->text));
  } catch (const ExpressionError& error) {
    throw SceneError("joints." + of.name + ".drive." + std::string(which),
                     "\"=" + law->text + "\": " + error.what());
  }
}

// A law of one variable; null for none. Throws SceneError at the part's number.
std::shared_ptr<const ForceLaw> read_force_law(const Formula* law, std::string_view variable,
                                               const std::string& part);

// Of drives by torque, or left to their momentum, at these links. After the coordinates and springs.
void add_drive_torques(const Mechanism& mechanism, const std::vector<int>& links, System& system);
// Of springs and dampers, in joints and between points.
void add_force_laws(const Mechanism& mechanism, System& system);

} // namespace flyball
