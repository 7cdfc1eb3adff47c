// Bad input, reported so that a person can mend it.
#pragma once

#include <stdexcept>
#include <string>

namespace flyball {

// Thrown for a scene or an address that cannot be used. `where` is the path inside the scene by names
// ("joints.spin.axis") or by JSON position for parts without a name ("joints[2].type"); `expected` says
// what would be right. The command line and the panels put the file before it.
class SceneError : public std::runtime_error {
 public:
  SceneError(std::string where, std::string expected)
      : std::runtime_error(where.empty() ? expected : where + ": " + expected), where_(std::move(where)),
        expected_(std::move(expected)) {}
  const std::string& where() const { return where_; }
  const std::string& expected() const { return expected_; }

 private:
  std::string where_, expected_;
};

} // namespace flyball
