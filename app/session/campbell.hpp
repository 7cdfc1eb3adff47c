// The Campbell diagram: the frequencies of the modes over a drive's speed, along the branch of the state that
// is shown. Nothing of it is made before a person asks.
#pragma once

#include "app/session/study.hpp"
#include "app/session/varied_mechanism.hpp"
#include "engine/study/campbell.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

struct CampbellRequest {
  std::string drive;       // address of the number along the axis, the speed of a drive or what sets it
  double from = 0, to = 0; // its range
  std::vector<double> orders;
  SharedMechanism mechanism; // with that number 0
  bool operator==(const CampbellRequest&) const = default;
};

struct CampbellState {
  Study<CampbellRequest, CampbellDiagram> diagram;
  // As chosen. An empty drive is the first; both ends 0: as its slider.
  std::string drive;
  double from = 0, to = 0;
  std::vector<double> orders{1, 2}; // oscillations a turn that something excites
  VariedMechanism varied;
  bool current = false;           // the diagram is of the mechanism as it is
  std::uint64_t asked_ticket = 0; // of the answer when it was asked for
  // Whether the diagram holds the branch of the state that is shown, and of which two that was found.
  bool on_branch = true;
  std::shared_ptr<const void> judged;
  std::uint64_t judged_ticket = 0;
};

// Addresses of the numbers that set the speed of a drive, alone or in an expression, each once; of an
// expression's speeds first.
std::vector<std::string> drive_speeds(const Mechanism& mechanism);
// Which of these is chosen, or the first; "" where there are none.
std::string campbell_drive(const Session& session, const std::vector<std::string>& drive_speeds);
// Of that number: as it was chosen, or as its slider has it or would.
std::array<double, 2> campbell_range(const Session& session, const std::string& drive);

void follow_campbell(Session& session);
// Takes what was followed; follows anew after changes of anything but the speed where that takes no time to
// speak of.
void update_campbell(Session& session);
// Where the state lies on a branch of the diagram: between its points `after` and `after + 1`.
struct CampbellPlace {
  std::size_t branch = 0, after = 0;
};
std::optional<CampbellPlace> campbell_place(const Session& session);
// What the lines of the branch there are called: by the list's number of the mode that lies on each at the
// present speed, "mode 3, tilt.1", and "line 2, tilt.0" where that is none of the list.
std::vector<std::string> campbell_names(const Session& session, const CampbellPlace& place);

} // namespace flyball
