#include "engine/solve/solution.hpp"

#include "engine/mechanism/text.hpp"

namespace flyball {

std::string_view word(Status status) {
  switch (status) {
  case Status::converged: return "converged";
  case Status::not_converged: return "not_converged";
  case Status::no_steady_state: return "no_steady_state";
  case Status::infeasible: return "infeasible";
  }
  return "";
}

std::string_view word(Fallback fallback) {
  switch (fallback) {
  case Fallback::stops: return "stops";
  case Fallback::damped: return "damped";
  case Fallback::homotopy: return "homotopy";
  case Fallback::descent: return "descent";
  case Fallback::slow_motion: return "slow_motion";
  case Fallback::search: return "search";
  }
  return "";
}

std::string_view word(SearchEnd end) {
  switch (end) {
  case SearchEnd::settled: return "settled";
  case SearchEnd::starts: return "starts";
  case SearchEnd::budget: return "budget";
  case SearchEnd::time: return "time";
  case SearchEnd::cancelled: return "cancelled";
  }
  return "";
}

std::string_view word(StabilityReason reason) {
  switch (reason) {
  case StabilityReason::minimum: return "minimum";
  case StabilityReason::asymptotic: return "asymptotic";
  case StabilityReason::gyroscopic_only: return "gyroscopic_only";
  case StabilityReason::neutral: return "neutral";
  case StabilityReason::marginal: return "marginal";
  case StabilityReason::unstable: return "unstable";
  case StabilityReason::floquet: return "floquet";
  case StabilityReason::varying: return "varying";
  }
  return "";
}

std::optional<FoundNumber> found_number(const CoordinateSolution& c) {
  if (!is_found(c)) return std::nullopt;
  if (!c.speed) return FoundNumber{coordinate_label(c), c.value, c.error, c.angle ? "rad" : "m"};
  return FoundNumber{coordinate_label(c) + ".speed", *c.speed, c.speed_error, c.angle ? "rad/s" : "m/s"};
}

} // namespace flyball
