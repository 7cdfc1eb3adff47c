// Every number of a part that has an address.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flyball {

struct Number {
  std::string key;             // the address after the part's name: "drive.speed", "at.0"
  std::string unit;            // as shown to a person, "" where it has none
  double value = 0;            // or, for an optional field that is absent, what it stands for
  const void* place = nullptr; // what its rate is kept under (number_rates.hpp); valid as long as the part
  std::function<void(double)> set; // likewise
};

std::vector<Number> numbers_of(Body& body);
// The mechanism tells what absent fields stand for.
std::vector<Number> numbers_of(const Mechanism& mechanism, Joint& joint);
std::vector<Number> numbers_of(const Mechanism& mechanism, Force& force);
std::vector<Number> numbers_of(NamedParameter& parameter); // "value" alone
std::vector<Number> numbers_of(NamedPoint& point);         // "0", "1", "2"
// With those that expressions may give, though they have no address.
std::vector<Number> all_numbers_of(Body& body);                     // "rotation.0"
std::vector<Number> all_numbers_of(Shape& shape, const Body& body); // "at.0" also where it is absent
// The parts without a name, whose keys are whole addresses.
std::vector<Number> numbers_of_gravity(Vec3& gravity);
std::vector<Number> numbers_of(Air& air);
std::vector<Number> numbers_of(Simulation& simulation);

} // namespace flyball
