// The response curve: what is wanted, what was found, and how it is drawn. Nothing of it is made before a
// person asks for it.
#pragma once

#include "app/live/background.hpp"
#include "app/session/response_quantity.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "engine/study/design.hpp"

#include <memory>
#include <tuple>

namespace flyball {

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

// Which points of a line a plot's curve goes through.
struct ResponsePiece {
  std::size_t line = 0, first = 0;
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

  PlotView view;
  Plot plot;                         // of the result, with the answer's marker
  std::vector<ResponsePiece> pieces; // by curve of the plot
  std::uint64_t version = 1;         // of result, quantity and design
  std::uint64_t plotted = 0;         // the version that the plot shows
  std::uint64_t plots_made = 0;
  std::uint64_t plot_gesture = 0; // of the hand, when the plot's range of y was last fitted
  double waiting_since = -1;      // s, ImGui's clock; negative: nothing runs
};

} // namespace flyball
