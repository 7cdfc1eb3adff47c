// The response where drives make the balance turn: periodic motions over the number in the place of steady
// states. It grows point by point while it is computed.
#pragma once

#include "app/session/response.hpp"

namespace flyball {

struct Session;

// Whether the state that is shown is such a motion, or was before one that is not decided yet.
bool is_resonance(const Session& session);
// Takes what was computed and asks for what is wanted now.
void update_resonance(Session& session, const std::optional<ResponseRequest>& wanted);

// Whether the person has stopped it, so that it is a part.
bool resonance_stopped(const Session& session);
// Makes what is missing then.
void go_on_with_resonance(Session& session);

// What the curve can show; of its first point that tells, or of the motion that is shown.
std::vector<ResponseQuantity> resonance_quantities(const Session& session);
// Of a quantity's key: "value up", "measure whirl", "drive spin", "force pin", "motion period".
struct ResonanceKey {
  OutputKind kind = OutputKind::coordinate;
  std::string name;
};
std::optional<ResonanceKey> resonance_key(const std::string& quantity);

// The motion that is shown, or the steady state, as a point of the curve; none: neither.
std::optional<ResonancePoint> present_resonance(const Session& session, const std::string& address);
// "65 points, 3 without a motion"; empty while there is no curve.
std::string resonance_words(const Session& session);
// Why nothing can be drawn, a sentence; empty where something can, or may still come.
std::string resonance_refusal(const Session& session);

} // namespace flyball
