// What is being typed or dragged in a field, and the edits that wait.
#pragma once

#include "app/document/part.hpp"
#include "app/ui/widgets/wide_characters.hpp"

#include <imgui.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// Why a text cannot be taken, as a sentence; empty where it can.
using TextCheck = std::function<std::string(const std::string&)>;
using TextTaker = std::function<void(const std::string&)>;

// What would make a text that cannot be taken one that can.
struct FieldOffer {
  std::string words;          // "Add the parameter gain"; empty: nothing is offered
  std::function<void()> take; // does that and takes the text
};

// The one field that is being typed in.
struct Typing {
  std::string name{}; // of the widget; empty: there is none
  std::string text{}, original{};
  std::string mistake{}, checked{};    // why `checked` cannot be taken
  FieldOffer offer{};                  // of `checked`
  ImVec2 offered_from{}, offered_to{}; // where it was drawn last, pixels
  TextCheck check{};
  TextTaker take{};
  bool wants_focus = false; // to be given the keyboard when it is drawn next
  int idle = 0;             // frames in which it had not the keyboard
  bool by_number = false;   // a double click selects the number, until the button is up again
};

// A number that is dragged by its label.
struct Scrub {
  std::string name;
  double start = 0, step = 0; // in the field's unit
  float travelled = 0;        // pixels
};

// What is sought in a long list of names that is open.
struct ChoiceSearch {
  std::string text;
  int marked = -1;         // row that Enter takes; none before something is typed or an arrow pressed
  bool wants_keys = false; // to be given the keyboard when it is drawn next
};

struct FieldState {
  // The parts that the inspector edits together, at least two: the first is the one whose numbers are drawn.
  // Empty where it edits one.
  std::vector<Part> together;
  Typing typing;
  Scrub scrub;
  // Edits wait until the panels are drawn, which refer to the mechanism as it was before.
  std::vector<std::function<void()>> later;
  std::optional<double> plain; // what was typed in a field outside the document
  ChoiceSearch choice_search;
  std::string picking;   // address of the vector for which the view is asked to pick a named point
  WideCharacters wide{}; // that texts in fields have had
};

} // namespace flyball
