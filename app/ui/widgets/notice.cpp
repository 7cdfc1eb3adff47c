#include "app/ui/widgets/notice.hpp"

#include "app/ui/app.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace flyball {

namespace {

constexpr double shortest = 5, longest = 12, by_letter = 0.08; // s
constexpr double frame = 0.04;                                 // s, of the fading

} // namespace

double notice_life(const std::string& notice) {
  return std::clamp(by_letter * static_cast<double>(notice.size()), shortest, longest) + notice_fade;
}

float notice_strength(const App& app) {
  if (is_error(app) || app.notice != app.notice_age.of) return 1;
  const double left = notice_life(app.notice) - app.notice_age.seconds;
  return static_cast<float>(std::clamp(left / notice_fade, 0.0, 1.0));
}

void keep_notice(App& app) {
  NoticeLog& log = app.notice_log;
  if (app.notice == log.last) return;
  log.last = app.notice;
  if (app.notice.empty()) return;
  log.past.push_back({app.notice, is_error(app), std::chrono::system_clock::now()});
  if (log.past.size() > most_past_notices) log.past.erase(log.past.begin());
}

void age_notice(App& app, double seconds) {
  NoticeAge& age = app.notice_age;
  if (age.of != app.notice) {
    age.of = app.notice;
    age.seconds = 0;
    return;
  }
  if (app.notice.empty() || is_error(app)) return;
  age.seconds += seconds;
  if (age.pointed) age.seconds = std::min(age.seconds, notice_life(app.notice) - notice_fade);
  if (age.seconds < notice_life(app.notice)) return;
  app.notice.clear();
  app.failure.clear();
  age = {};
}

double next_notice_change(const App& app) {
  if (app.notice.empty() || is_error(app)) return std::numeric_limits<double>::infinity();
  if (app.notice != app.notice_age.of) return 0;
  if (app.notice_age.pointed) return std::numeric_limits<double>::infinity();
  const double until_fade = notice_life(app.notice) - notice_fade - app.notice_age.seconds;
  return std::max(until_fade, frame);
}

} // namespace flyball
