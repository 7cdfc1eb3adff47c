// The point of the response curve at which the steady state is, pulled to where the curve should go.
#pragma once

#include <optional>
#include <string>

namespace flyball {

struct Session;

// What the plot shows, as a goal: a free coordinate or a measure; empty where it is neither.
std::string pulled_goal(const Session& session);
// What a pull of it does, in words; begins with why not where it cannot be.
std::string pull_words(const Session& session);

// The quantity goes to `value` (of its unit) by the pinned numbers that are not held, and the varied number
// to `parameter` where one is given, unless it is held. Where no other may move the varied number does, if it
// is pinned: the point goes along the curve.
void pull_response(Session& session, std::optional<double> parameter, double value);

} // namespace flyball
