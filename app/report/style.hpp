// How the page looks: on light and dark ground, on narrow screens and on paper.
#pragma once

#include <string_view>

namespace flyball {

// A style sheet that refers to nothing outside.
std::string_view report_style();

} // namespace flyball
