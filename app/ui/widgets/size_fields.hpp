// The size of a picture in pixels: two numbers, and buttons for usual ones.
#pragma once

#include <span>

namespace flyball {

struct Ui;

struct PictureSize {
  const char* name; // of the button's widget, after the dialog's
  const char* text;
  int width, height; // pixels
};

// Labels stand before `column` (points).
void size_fields(Ui& ui, const std::string& name, std::span<const PictureSize> usual, float column,
                 int& width, int& height);

} // namespace flyball
