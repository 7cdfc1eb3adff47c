#include "app/session/studies.hpp"

#include "app/session/session.hpp"

#include <limits>

namespace flyball {

void open_study(Session& session, StudyKind study) {
  if (study != StudyKind::none && study == session.study.open) {
    if (session.mode == Mode::build) return set_mode(session, Mode::explore); // it was out of sight
    study = StudyKind::none;
  }
  if (study != StudyKind::none) set_mode(session, Mode::explore);
  // The motion goes with its panel.
  if (session.study.open == StudyKind::motion && study != StudyKind::motion) show_motion(session, false);
  // A search goes on behind another study's tab, and what it found is there when one comes back.
  if (study == StudyKind::none) {
    session.study.states = {};
    session.study.compare.measured.stop(); // see update_comparison()
  }
  if (study != StudyKind::modes) close_modes(session);
  if (study != StudyKind::map) close_map(session);
  if (study != StudyKind::response) close_response(session);
  if (study != StudyKind::spread) close_spread(session);
  if (study != StudyKind::transfer) close_transfer(session);
  session.study.open = study;
  if (study == StudyKind::motion) show_motion(session, true);
}

bool study_shown(const Session& session, StudyKind study) {
  return session.mode == Mode::explore && session.study.open == study;
}

void update_studies(Session& session) {
  update_states(session);
  update_modes(session);
  update_map(session);
  update_response(session);
  update_band(session);
  update_friction(session);
  update_periodic(session);
  update_spread(session);
  update_transfer(session);
  update_comparison(session);
}

bool studying(const Session& session) {
  const StudyState& study = session.study;
  return computing_motion(session) || computing_response(session) || comparing(session) ||
         study.states.running() || finding_modes(session) || computing_map(session) ||
         study.spread.samples.running() || study.transfer.found.running() || study.band.computed.running() ||
         study.friction.report.running() || study.friction.ribbon.running() ||
         study.periodic.search.running() || study.periodic.cycle.running();
}

double next_progress(const Session& session) {
  constexpr double beat = 0.2;
  return studying(session) ? beat : std::numeric_limits<double>::infinity();
}

} // namespace flyball
