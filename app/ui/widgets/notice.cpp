#include "app/ui/widgets/notice.hpp"

#include "app/session/session.hpp"

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

float notice_strength(const Session& session, const NoticeAge& age) {
  if (is_error(session) || session.notice != age.of) return 1;
  const double left = notice_life(session.notice) - age.seconds;
  return static_cast<float>(std::clamp(left / notice_fade, 0.0, 1.0));
}

void keep_notice(const Session& session, NoticeLog& log) {

  if (session.notice == log.last) return;
  log.last = session.notice;
  if (session.notice.empty()) return;
  log.past.push_back({session.notice, is_error(session), std::chrono::system_clock::now()});
  if (log.past.size() > most_past_notices) log.past.erase(log.past.begin());
}

void age_notice(Session& session, NoticeAge& age, double seconds) {

  if (age.of != session.notice) {
    age.of = session.notice;
    age.seconds = 0;
    return;
  }
  if (session.notice.empty() || is_error(session)) return;
  age.seconds += seconds;
  if (age.pointed) age.seconds = std::min(age.seconds, notice_life(session.notice) - notice_fade);
  if (age.seconds < notice_life(session.notice)) return;
  session.notice.clear();
  session.failure.clear();
  age = {};
}

double next_notice_change(const Session& session, const NoticeAge& age) {
  if (session.notice.empty() || is_error(session)) return std::numeric_limits<double>::infinity();
  if (session.notice != age.of) return 0;
  if (age.pointed) return std::numeric_limits<double>::infinity();
  const double until_fade = notice_life(session.notice) - notice_fade - age.seconds;
  return std::max(until_fade, frame);
}

} // namespace flyball
