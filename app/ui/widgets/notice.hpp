// What was last done, in words, fades after a while; what went wrong stays until it is put away (see
// show_error()).
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace flyball {

struct Session;

struct NoticeAge {
  std::string of; // the notice that is growing old
  double seconds = 0;
  bool pointed = false; // at: it stays while it is
};

// What was told before.
struct PastNotice {
  std::string text;
  bool error = false;
  std::chrono::system_clock::time_point when;
};
struct NoticeLog {
  std::vector<PastNotice> past; // the latest last
  std::string last;             // that was shown in the last frame
  bool showing = false;         // the list of them
};
inline constexpr std::size_t most_past_notices = 200;

// s that a notice is shown, the last of them fading. Long ones stay longer.
double notice_life(const std::string& notice);
inline constexpr double notice_fade = 0.4;

// 1, less while it fades.
float notice_strength(const Session& session, const NoticeAge& age);

// Once a frame, wherever it is drawn: the present notice becomes one of the past.
void keep_notice(const Session& session, NoticeLog& log);
// Once a frame, `seconds` after the last.
void age_notice(Session& session, NoticeAge& age, double seconds);
// s until age_notice() has something to do; infinite while there is nothing that fades.
double next_notice_change(const Session& session, const NoticeAge& age);

} // namespace flyball
