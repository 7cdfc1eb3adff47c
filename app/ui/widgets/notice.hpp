// What was last done, in words, fades after a while; what went wrong stays until it is put away (see
// show_error()).
#pragma once

#include <string>

namespace flyball {

struct App;

struct NoticeAge {
  std::string of; // the notice that is growing old
  double seconds = 0;
};

// s that a notice is shown, the last of them fading. Long ones stay longer.
double notice_life(const std::string& notice);
inline constexpr double notice_fade = 0.4;

// 1, less while it fades.
float notice_strength(const App& app);

// Once a frame, `seconds` after the last.
void age_notice(App& app, double seconds);
// s until age_notice() has something to do; infinite while there is nothing that fades.
double next_notice_change(const App& app);

} // namespace flyball
