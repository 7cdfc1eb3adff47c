// Periodic motions: the one that takes the steady state's place where a drive makes the balance turn, and,
// where a person asks for it, the limit cycle: beside a steady state that swings more and more, or of what
// torques drive and no steady state is found of.
#pragma once

#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/periodic/periodic_state.hpp"

namespace flyball {

struct Session;

struct PeriodicRequest {
  SharedMechanism mechanism;
  bool operator==(const PeriodicRequest&) const = default;
};

struct PeriodicStudy {
  Study<PeriodicRequest, PeriodicState> search;
  // What the poses that the session shows are of.
  struct Posed {
    std::shared_ptr<const Run> motion;
    double time = 0; // s
    bool operator==(const Posed&) const = default;
  } posed;
  bool cycle_wanted = false;
  Study<PeriodicRequest, PeriodicState> cycle;
};

void update_periodic(Session& session);
// Of the answer that is shown, or of the one before while that is looked for; null: none, or not asked.
const PeriodicState* periodic_state(const Session& session);
// The same where one was found.
const PeriodicState* periodic_motion(const Session& session);
// The motion's run begins in it and lasts for two periods, so that the plots have it.
void show_periodic_motion(Session& session, const PeriodicState& state);

// Whether the steady state that is shown is left by swings that grow.
bool hunts(const Session& session);
// Whether a limit cycle can be asked for: where it hunts, and where what torques drive has no steady state,
// as a crank whose speed swings with every turn.
bool may_cycle(const Session& session);
void find_cycle(Session& session, bool wanted);
// Of the state that is shown, or of the one before while that is looked for; null: not asked. One that is not
// found says why.
const PeriodicState* limit_cycle(const Session& session);
// The same where one was found and no steady state was: it is what the mechanism comes to.
const PeriodicState* cycle_instead(const Session& session);

} // namespace flyball
