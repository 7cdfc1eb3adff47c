// The response curve: what is wanted and what was found. Nothing of it is made before a person asks for it.
#pragma once

#include "app/session/parameter_list.hpp"
#include "app/session/response_quantity.hpp"
#include "app/session/study.hpp"
#include "app/session/varied_mechanism.hpp"
#include "engine/study/design.hpp"
#include "engine/study/resonance_curve.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

struct Session;

// What a curve is followed for; while it stays the same nothing is computed.
struct ResponseRequest {
  SharedMechanism mechanism; // with the varied number at `from`
  std::string address;
  double from = 0, to = 1; // of the number, in its unit
  bool logarithmic = false;
  bool all = false;       // disconnected branches, too
  bool reactions = false; // and drive torques
  bool operator==(const ResponseRequest&) const = default;
};

// A branch with its special points in their places.
struct ResponseLine {
  std::vector<ResponsePoint> points;
  std::vector<char> special; // of each point, whether it is one
  bool connected = true;
};

struct ResponseResult {
  ResponseDiagram diagram; // its branches are in `lines`
  std::vector<ResponseLine> lines;
};
using ResponseCurve = Study<ResponseRequest, ResponseResult>;
using ResonanceStudy = Study<ResponseRequest, ResonanceCurve>;

// What can be wanted somewhere: a coordinate, a speed that is found, a measure, what a drive gives or a joint
// bears.
struct DesignGoal {
  std::string key;             // of the goal: "slide", "spin.speed", a measure's name, or "torque(spin)"
  std::string title;           // as Show lists it, under the key
  std::string quantity;        // of it
  std::string unit;            // SI
  std::optional<double> value; // now
  bool place = false;          // an angle or a length, of a coordinate
  std::string expression{};    // where only a measure tells it
};

struct DesignRequest {
  ResponseRequest of;
  DesignGoal goal;
  double value = 0;
};

// What can be wanted of an answer, see design_goals().
struct DesignGoals {
  std::vector<DesignGoal> goals;
  std::vector<std::string> titles; // theirs
  // What they are of.
  std::shared_ptr<const Mechanism> mechanism;
  std::uint64_t answer = 0; // its ticket
};

// "Find the parameter so that the coordinate is this": design mode.
struct ResponseDesign {
  DesignGoals offered;
  std::string coordinate; // key of the goal; empty: not chosen
  double value = 0;       // rad or m, or in the goal's unit
  Study<DesignRequest, DesignAnswer> answer;
};

// What a person has chosen to see; empty at first, see choose_response().
struct ResponseChoice {
  std::string address;
  double from = 0, to = 0;
  bool logarithmic = false;
  std::string quantity; // see response_quantities()
  bool all = false;
  bool operator==(const ResponseChoice&) const = default;
};

struct ResponseState {
  ResponseChoice choice;
  ResponseQuantity shown; // the quantity, as last offered

  ResponseCurve curve;
  // Where the balance turns with the drives, in the place of `curve`: see resonance.hpp.
  bool resonates = false;
  ResonanceStudy resonance;
  VariedMechanism varied;
  std::uint64_t through = 0; // ticket of the answer whose state the curve was to go through
  ResponseDesign design;
};

// Takes what was computed and asks for what is wanted now; nothing unless the panel is open.
void update_response(Session& session);
// Everything of it goes but what was chosen.
void close_response(Session& session);
bool computing_response(const Session& session);

// The number that is varied, with the range of its slider, or one that suits it.
void choose_response(Session& session, const std::string& address);
// One end of its range, `from` or `to`.
void choose_response_end(Session& session, double ResponseChoice::*end, double value);
// The control of the varied number, with a slider or without; none: there is no such number.
std::optional<ParameterControl> response_control(const Session& session);
// Why there is no curve, a sentence; empty where there is one.
std::string response_refusal(const Session& session);

// What is drawn over the parameter.
void choose_quantity(Session& session, const ResponseQuantity& quantity);
// What there is to choose from: of the present answer, or else of the curve.
std::vector<ResponseQuantity> offered_quantities(const Session& session);

// The state at a place of a line (the index of a point, with a fraction) becomes the present one, along with
// the parameter, which is rounded to `step`. `dragged`: every frame anew, while the hand holds the marker.
void go_to_response(Session& session, std::size_t line, double at, double step, bool dragged);
// The answer as a point of a curve over the number; none where its mechanism has no such number.
std::optional<ResponsePoint> present_point(const Session& session, const std::string& address);

// What the present choices ask for; none where there is nothing to follow.
std::optional<ResponseRequest> response_wanted(Session& session);
// The largest step along its branches, scaled.
double response_step(const ResponseRequest& of);

// A diagram's branches with their special points in their places. Takes them out of it.
std::vector<ResponseLine> response_lines(ResponseDiagram& diagram);

} // namespace flyball
