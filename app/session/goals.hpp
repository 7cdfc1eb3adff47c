// Sliders in reverse: where the steady state is wanted, and the pinned numbers that go where it is. Those
// that a person holds stay.
#pragma once

#include "app/document/explored.hpp"
#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/study/goals.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct Session;

struct GoalRequest {
  SharedMechanism mechanism; // of the document, perhaps with measures of the hand's own
  std::vector<FreeNumber> free;
  std::vector<Goal> goals;
  std::vector<std::pair<std::string, double>> start; // the state it sets out from
  Explored set;     // what the hand itself has set in the mechanism, which goes along
  std::string step; // of the history
  bool operator==(const GoalRequest&) const = default;
};

struct GoalState {
  std::vector<std::string> held; // addresses of pinned numbers that stay where they are
  // Of the document that what is sought is for: what comes for another, as after an undo, is not taken.
  std::uint64_t revision = 0;
  std::string told;                                      // the notice of what came last
  std::uint64_t gesture = 0;                             // of the hand that seeks, and
  std::vector<std::pair<std::string, double>> reference; // where the numbers were when it began
  Study<GoalRequest, GoalAnswer> seeking;
};

// Whether a pinned number may move, and whether it stays from now on.
bool is_held(const Session& session, const std::string& address);
void hold_number(Session& session, const std::string& address, bool held);

// Whether a pinned number beside this address may move.
bool another_may_move(const Session& session, const std::string& but);

// Why no goal can be sought, a sentence; empty where one can.
std::string goal_refusal(const Session& session);

// Seeks in the background; what is found becomes the present state, as a step `step` of the history. Asked
// again and again while a hand moves, which is one gesture: the numbers go the least way from where it began.
// `but`: an address that stays, beside those that are held. A refusal becomes the notice.
void seek(Session& session, const std::string& step, std::vector<Goal> goals, const std::string& but = {});
// The same for goals of measures that another mechanism has, like the document's else.
void seek(Session& session, const std::string& step, std::vector<Goal> goals, const std::string& but,
          SharedMechanism mechanism);
// The same with one number where the hand has it, which stays there.
void seek_beside(Session& session, const std::string& step, std::vector<Goal> goals,
                 const ExploredValue& number);
// What is sought is not taken any more.
void stop_seeking(Session& session);
// What came last for the present gesture; null where there is nothing.
const GoalAnswer* sought(const Session& session);

// Takes what was found.
void update_goals(Session& session);

} // namespace flyball
