// The studies of a steady state: which one is open, and what they have found.
#pragma once

#include "app/session/compare.hpp"
#include "app/session/friction.hpp"
#include "app/session/map.hpp"
#include "app/session/modes.hpp"
#include "app/session/periodic.hpp"
#include "app/session/response.hpp"
#include "app/session/spread.hpp"
#include "app/session/spread_band.hpp"
#include "app/session/states.hpp"
#include "app/session/transfer.hpp"

namespace flyball {

struct Session;

enum class StudyKind { none, motion, compare, response, states, modes, map, spread, transfer };

struct StudyState {
  StudyKind open = StudyKind::none;
  CompareState compare;
  ResponseState response;
  StatesStudy states;
  ModesState modes;
  MapState map;
  SpreadState spread;
  TransferState transfer;
  BandState band; // around the response curve
  FrictionState friction;
  PeriodicStudy periodic; // in the steady state's place, whatever study is open
};

// Shows a study, in the explore mode; the one that is shown again, or none, closes it.
void open_study(Session& session, StudyKind study);
// Whether it is to be seen: while building none is.
bool study_shown(const Session& session, StudyKind study);
// Takes what studies have found in the background, and asks for what is missing.
void update_studies(Session& session);
// Whether one computes.
bool studying(const Session& session);
// s, until its progress is worth another look; infinite where none computes.
double next_progress(const Session& session);

} // namespace flyball
