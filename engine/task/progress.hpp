// How far a long computation has come, reported by whoever computes to whoever waits. What asks for one to
// stop is a flag beside it: `cancel` of the options of solving, following, searching and simulating.
#pragma once

#include <functional>

namespace flyball {

struct Progress {
  const char* phase = ""; // what is being done, in a few words: a literal
  double part = -1;       // of the whole, 0 to 1; negative: not known
};
// Called on the thread that computes, often; it must be quick.
using ReportProgress = std::function<void(const Progress&)>;

inline void report_progress(const ReportProgress& progress, const char* phase, double part = -1) {
  if (progress) progress({phase, part});
}

} // namespace flyball
