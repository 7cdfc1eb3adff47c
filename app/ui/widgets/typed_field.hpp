// A field for text, in which one types at once after a click or Tab. Enter takes it and so does leaving;
// Escape puts the old text back. Text that cannot be taken turns red and says why; Enter then stays in the
// field.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"

#include <string>

namespace flyball {

struct TextField {
  std::string name; // of the widget
  std::string text; // that typing starts from
  TextCheck check;  // may be empty
  TextTaker take;   // called after the panels are drawn, if the text was changed
  std::function<FieldOffer(const std::string&)> offer{}; // of a text that cannot be taken; may be empty
  bool at_once = false;                                  // `take` is called while drawing instead
  bool drawn_here = true;  // the text at rest; otherwise the caller draws something in its place
  const char* hint = "";   // shown while there is no text
  bool expression = false; // of what begins with "=" the names that could follow are offered
  int flags = 0;           // of ImGui's InputText
  int (*callback)(ImGuiInputTextCallbackData*) = nullptr;
  void* callback_data = nullptr;
};

// Whether it is being typed in. In the present font.
bool text_field(Session& session, Ui& ui, const TextField& field, float width);
bool typing_in(const Ui& ui, const std::string& name);
// As if it had been clicked; for a field that is drawn only while it is typed in.
void start_typing(Session& session, Ui& ui, const std::string& name, const std::string& text);

// Leaves the field that is typed in, before anything is drawn: what was typed is taken at once. False where
// it cannot be, which is said.
bool finish_typing(Session& session, Ui& ui);

// To be done after the panels are drawn.
void later(Ui& ui, std::function<void()> edit);
// After the panels: leaves a field that is not shown any more and does what was put off.
void settle_fields(Session& session, Ui& ui);

} // namespace flyball
