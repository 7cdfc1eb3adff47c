// The parts of find_mistakes.
#pragma once

#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace flyball {

class Mistakes {
 public:
  void add(std::string where, std::string expected) {
    all_.emplace_back(std::move(where), std::move(expected));
  }
  // Adds a mistake unless it is all right; texts are made only then.
  void expect(bool right, std::string_view where, const char* expected) {
    expect(right, where, "", expected);
  }
  void expect(bool right, std::string_view where, std::string_view key, const char* expected) {
    if (!right) add(std::string(where) + std::string(key), expected);
  }
  const std::vector<SceneError>& all() const { return all_; }

 private:
  std::vector<SceneError> all_;
};

// "joints.spin", or "joints[2]" where the name is no use.
std::string part_path(std::string_view list, std::size_t i, std::string_view name);
std::string joint_path(const Mechanism& mechanism, std::size_t joint);
// "joints.spin.spring", or "joints.x.spring[1]" where the joint has several coordinates.
std::string coordinate_path(const Mechanism& mechanism, std::size_t joint, std::string_view key,
                            std::size_t i);

void find_body_mistakes(const Mechanism& mechanism, Mistakes& mistakes);
void find_body_warnings(const Mechanism& mechanism, Mistakes& warnings);
void find_belt_warnings(const Mechanism& mechanism, Mistakes& warnings);
void find_joint_mistakes(const Mechanism& mechanism, Mistakes& mistakes);
void find_force_mistakes(const Mechanism& mechanism, Mistakes& mistakes);
void find_air_mistakes(const Mechanism& mechanism, Mistakes& mistakes);
// Of one of them by itself, whatever the names of other parts; of a joint without the laws of its drives,
// which no number can make wrong.
void find_mistakes_of(const Body& body, const std::string& path, Mistakes& mistakes);
void find_mistakes_of_joint(const Mechanism& mechanism, std::size_t joint, Mistakes& mistakes);
void find_mistakes_of(const Mechanism& mechanism, const Force& force, const std::string& path,
                      Mistakes& mistakes);
void find_mistakes_of(const Air& air, Mistakes& mistakes);
// Of a force or joint between two bodies.
void find_two_body_mistakes(const Mechanism& mechanism, const BodyNumbers& numbers,
                            const std::array<std::string, 2>& bodies, const std::string& path,
                            Mistakes& mistakes);
// Says of a name that it is no body's.
void add_unknown_body(const Mechanism& mechanism, std::string_view name, bool ground_too,
                      const std::string& where, Mistakes& mistakes);

// The following take for granted that all names are right.

// Bodies connected to nothing, and cuts that would leave a body so.
void find_connection_mistakes(const Mechanism& mechanism, Mistakes& mistakes);
// Drives that contradict each other, and what may not act on a driven coordinate.
void find_drive_mistakes(const Mechanism& mechanism, Mistakes& mistakes);

} // namespace flyball
