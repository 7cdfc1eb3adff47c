// A number with its unit that can be typed (see quantity.hpp), stepped with the arrow keys, dragged by its
// label, and, where it has an address, pinned as a slider.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

enum class Least { any, zero, above_zero }; // what a number may be

struct QuantityField {
  std::string name; // of the widget
  double value = 0; // in `unit`; shown and typed in what the person has chosen for that
  std::string unit; // "" where it has none
  std::string help; // one sentence
  Least least = Least::any;
  std::string address{};             // "" where it has none
  std::string expression{};          // where its expression is kept, if it has no address
  std::vector<std::string> also{};   // the same of other parts, which are given what this one is
  std::function<void(double)> set{}; // an edit; if empty, of the number at the address
  std::string various{};             // shown instead of the value: several parts differ
  std::string law{};                 // likewise: an expression of the state, which has no value by itself
  bool standard = false;             // the value stands for an absent one: shown faintly
  int axis = -1;                     // 0 to 2: its label ends in x, y or z
  bool framed = true;                // or plain digits to the right until it is pointed at
  // What else follows where an expression is typed, or a number over one.
  std::function<void(const Mechanism& before, Mechanism& next)> follow{};
  // Where its unit is open, "": takes a number with a unit of its own, in SI units: 0.012 and "m" of "12 mm".
  std::function<void(double value, const std::string& unit)> set_with_unit{};
  bool at_once = false; // `set` is called while drawing: for a number outside the document
  // It is a slider's, where numbers are tried: an expression of numbers alone is taken as its value.
  bool slider = false;
};

// Pixels that a field needs for its number at rest with up to six digits; with less room it drops digits.
float resting_width(const Session& session, const Ui& ui, double value, const std::string& unit);
// As many digits as there is room for (pixels), nine at most; where there is room for none, the shortest,
// which may have more digits ("1000", "1e+03").
std::string fitting_text(const Ui& ui, double value, float room);
// Without a label.
void quantity_field(Session& session, Ui& ui, const QuantityField& field, float width);
// With its label, the pin, and for an optional number that is given a way back: `reset` then makes it absent.
void quantity_row(Session& session, Ui& ui, const std::string& label, const QuantityField& field,
                  const std::function<void()>& reset = {});
// A number outside the document, in a dialog; returns whether it was changed.
bool plain_quantity_field(Session& session, Ui& ui, const std::string& name, const char* label,
                          const char* unit, const char* help, double& value, Least least = Least::any);

// Edits the number at the address, see edit_parameter(): what is typed or dragged in the inspector is meant.
void set_number(Session& session, const std::string& address, double value);
// ", and 2 more", behind what is done to one part; nothing for none.
std::string and_more(std::size_t parts);
// Makes the number a slider, or none.
void pin(Session& session, const std::string& address, bool pinned);
bool is_pinned(const Mechanism& mechanism, const std::string& address);

// What one step of the hand changes a number by: about a hundredth of it, a power of ten.
double hand_step(double value, const std::string& unit);
// What a hand that drags the last item sideways makes of the number it shows, in the shown unit: by such
// steps, with Shift by tenths. Nothing where it does not drag.
std::optional<double> dragged_number(Ui& ui, const std::string& name, double shown, const std::string& unit);

// Pixels that labels take in rows of the present width.
float label_width(const Ui& ui);
// Pixels at the right end of rows, for pins and small buttons.
float margin_width(const Ui& ui);
// A small button of an icon as wide as the margin.
bool margin_button(Ui& ui, const std::string& name, const char* icon, const char* help);

} // namespace flyball
