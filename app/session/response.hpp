// The response curve: what is wanted and what was found. Nothing of it is made before a person asks for it.
#pragma once

#include "app/live/background.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/response_quantity.hpp"
#include "engine/study/design.hpp"

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace flyball {

struct Session;

// What a curve is followed for; while it stays the same nothing is computed.
struct ResponseRequest {
  // With the varied number at `from`, and nothing that changes no equilibrium.
  std::shared_ptr<const Mechanism> mechanism;
  std::string address;
  double from = 0, to = 1; // of the number, in its unit
  bool logarithmic = false;
  bool all = false;       // disconnected branches, too
  bool reactions = false; // and drive torques
  bool operator==(const ResponseRequest& o) const {
    const auto choices = [](const ResponseRequest& r) {
      return std::tie(r.address, r.from, r.to, r.logarithmic, r.all, r.reactions);
    };
    return choices(*this) == choices(o) && (mechanism == o.mechanism || *mechanism == *o.mechanism);
  }
};

// A branch with its special points in their places.
struct ResponseLine {
  std::vector<ResponsePoint> points;
  std::vector<char> special; // of each point, whether it is one
  bool connected = true;
};

struct ResponseResult {
  ResponseRequest of;
  ResponseDiagram diagram; // its branches are in `lines`
  std::vector<ResponseLine> lines;
};

// "Find the parameter so that the coordinate is this": design mode.
struct ResponseDesign {
  std::string coordinate; // "joint" or "joint.index"; empty: not chosen
  double value = 0;       // rad or m
  struct Answer {
    ResponseRequest of;
    std::string coordinate;
    double value = 0;
    DesignAnswer found;
  };
  std::unique_ptr<Background<Answer>> task; // made when it is first asked for
  std::optional<Answer> answer;
  std::string problem;
};

struct ResponseState {
  // Chosen by the person; empty at first, see choose_response().
  std::string address;
  double from = 0, to = 0;
  bool logarithmic = false;
  std::string quantity; // see response_quantities()
  bool all = false;
  ResponseQuantity shown; // the quantity, as last offered

  std::unique_ptr<Background<ResponseResult>> task; // there while the panel is open
  std::optional<ResponseRequest> asked;             // what the newest task is for
  std::uint64_t asked_revision = 0;                 // of the document, then
  std::uint64_t through = 0;                        // ticket of the answer that it starts from
  std::optional<ResponseResult> result;
  std::string problem; // why there is no curve
  ResponseDesign design;

  std::uint64_t version = 1; // of result, quantity and design
  std::uint64_t chosen = 0;  // how often a parameter, a range or a quantity was chosen
};

// Takes what was computed and asks for what is wanted now; nothing unless the panel is open.
void update_response(Session& session);
// Everything of it goes but what was chosen.
void close_response(Session& session);
bool computing_response(const Session& session);

// The parameter that is varied, with the range of its slider.
void choose_response(Session& session, const std::string& address);
// One end of its range, `from` or `to`.
void choose_response_end(Session& session, double ResponseState::*end, double value);
// The control of the varied parameter; null: there is none.
const ParameterControl* response_control(const Session& session);
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

// Looks for the parameter at which the design's coordinate has its value; the solution then becomes present.
void find_design(Session& session);
void go_to_design(Session& session, const DesignSolution& solution);

// A diagram's branches with their special points in their places. Takes them out of it.
std::vector<ResponseLine> response_lines(ResponseDiagram& diagram);

} // namespace flyball
