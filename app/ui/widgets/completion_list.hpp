// Names and functions below a field in which an expression is typed, as in a spreadsheet: arrows go through
// them, Tab, Enter after an arrow and a click put one in the place of the word.
#pragma once

#include "app/session/completions.hpp"

#include <imgui.h>

#include <string>

struct ImGuiInputTextCallbackData;

namespace flyball {

struct Ui;

struct CompletionState {
  Completions found;
  std::string text;       // that they are of
  std::size_t cursor = 0; // in it, bytes
  int marked = -1;        // that Tab takes; -1: none
  bool by_arrow = false;  // which Enter takes, too
  ImVec2 from{}, to{};    // of the rows, where they were drawn last (pixels)
  int first = 0;          // row that is drawn first
  int cursor_wanted = -1; // to be put there without a selection
  int taken = -1;         // to be put into the text by the field's callback
};

// Of the text with its cursor there; `original`: what typing started from, which asks for nothing.
void find_completions(CompletionState& state, const Mechanism& mechanism, const std::string& text,
                      const std::string& original);
// Whether Tab takes the marked one rather than goes to the next widget.
bool completes(const CompletionState& state);
// Up and Down, in a frame of the field.
void move_mark(CompletionState& state);
// The rows, in the present window; nothing where there are none.
void draw_completions(Ui& ui, CompletionState& state, const std::string& name);
// The row under the mouse; -1: none.
int row_at(const CompletionState& state, ImVec2 at);
// The text with that one in it; the cursor goes behind it.
std::string completed(CompletionState& state, const std::string& text, int row);
// Of a field's callback, whenever it is called: keeps account of the cursor and does what is wanted.
void steer_cursor(CompletionState& state, ImGuiInputTextCallbackData* data);

} // namespace flyball
