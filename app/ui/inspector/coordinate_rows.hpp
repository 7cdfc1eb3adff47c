// One coordinate of a joint, or the same of several joints that are edited together, and the rows of its
// numbers.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct CoordinateRows {
  Session& session;
  Ui& ui;
  const Joint& joint;
  int i;
  std::vector<const Joint*> others{}; // that are edited with it

  const Coordinate& coordinate() const { return joint.coordinates[static_cast<std::size_t>(i)]; }
  bool angle() const { return is_angle(joint.type, i); }
  std::string value_unit() const { return angle() ? "rad" : "m"; }
  std::string stiffness_unit() const { return angle() ? "N m/rad" : "N/m"; }
  std::string damping_unit() const { return angle() ? "N m s/rad" : "N s/m"; }
  std::string force_unit() const { return angle() ? "N m" : "N"; }
  // "spring.1" where there are several coordinates.
  std::string key(const std::string& word) const;
  // Of a widget for the number or thing at this address.
  static std::string widget(std::string address);

  // Of how many of them it is so: of all, or of some.
  bool all_have(bool (*has)(const Coordinate&)) const;
  bool some_have(bool (*has)(const Coordinate&)) const;
  // Why the first of them that cannot be given something cannot.
  const char* refused_of_any(const char* (*refused)(const CoordinateRows&)) const;

  const CoordinateSolution* solution() const;
  // An edit of all of them.
  void change(const std::string& step, const std::function<void(Coordinate&)>& edit) const;

  void number(const std::string& label, const std::string& address, double value, const std::string& unit,
              const char* help, Least least = Least::any, const std::function<void()>& reset = {}) const;
  // Of an expression of the state the value that it has there, where that is known; else the expression
  // stands in its place.
  void number_or_law(const std::string& label, const std::string& address, const Formula* law,
                     const std::optional<double>& in_state, double value, const std::string& unit,
                     const char* help) const;
};

} // namespace flyball
