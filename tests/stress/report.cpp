#include "tests/stress/report.hpp"

#include "tests/stress/numbers.hpp"

#include <algorithm>

namespace flyball::stress {
namespace {

std::string_view word(Outcome outcome) {
  switch (outcome) {
  case Outcome::solved: return "solved";
  case Outcome::refused: return "refused";
  case Outcome::unclear: return "reference unclear";
  case Outcome::failed: return "FAILED";
  }
  return "";
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

std::string time_text(double seconds) {
  return seconds < 1e-3 ? digits(seconds * 1e6) + " us"
         : seconds < 1  ? digits(seconds * 1e3) + " ms"
                        : digits(seconds) + " s";
}

std::string share_text(const Summary& s, double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f %%", 100 * share);
  return s.judged == 0 ? "" : text;
}

std::string row(const std::string& name, const Summary& s) {
  const auto n = [](int x) { return std::to_string(x); };
  return "| " + name + " | " + n(s.cases) + " | " + n(s.solved) + " | " + n(s.refused) + " | " +
         n(s.unclear) + " | " + n(s.failed) + " | " + digits(s.true_error) + " | " + digits(s.worst) + " | " +
         share_text(s, s.share()) + " | " + digits(s.caution) + " | " + share_text(s, s.cautious) + " | " +
         time_text(s.slowest) + " |\n";
}

} // namespace

Summary summarize(const std::vector<Result>& results, const std::string& family) {
  Summary out;
  std::vector<double> caution;
  for (const Result& r : results) {
    if (!family.empty() && r.family != family) continue;
    const Verdict& v = r.verdict;
    ++out.cases;
    out.solved += v.outcome == Outcome::solved;
    out.refused += v.outcome == Outcome::refused;
    out.unclear += v.outcome == Outcome::unclear;
    out.failed += v.outcome == Outcome::failed;
    out.judged += v.judged;
    out.bounded += v.bounded;
    out.true_error = std::max(out.true_error, v.true_error);
    out.worst = std::max(out.worst, v.worst);
    out.slowest = std::max(out.slowest, v.time_s);
    caution.insert(caution.end(), v.caution.begin(), v.caution.end());
  }
  if (!caution.empty()) {
    const auto middle = caution.begin() + static_cast<std::ptrdiff_t>(caution.size() / 2);
    std::ranges::nth_element(caution, middle);
    out.caution = *middle;
    out.cautious = static_cast<double>(std::ranges::count_if(caution, [](double x) { return x > 100; })) /
                   static_cast<double>(caution.size());
  }
  return out;
}

std::string csv(const std::vector<Result>& results) {
  std::string out =
      "family,case,outcome,true_error,estimated_error,worst_ratio,coordinates,bounded,iterations,"
      "net,run_time_s,wall_s,remark\n";
  const auto full = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return std::string(text);
  };
  for (const Result& r : results) {
    const Verdict& v = r.verdict;
    out += quoted(r.family) + "," + quoted(r.name) + "," + std::string(word(v.outcome)) + "," +
           full(v.true_error) + "," + full(v.estimate) + "," + full(v.worst) + "," +
           std::to_string(v.judged) + "," + std::to_string(v.bounded) + "," + std::to_string(v.iterations) +
           "," + v.net + "," + full(v.time_s) + "," + full(r.wall_s) + "," + quoted(v.remark) + "\n";
  }
  return out;
}

std::string markdown(const std::vector<Result>& results) {
  std::string out =
      "| family | cases | solved | refused | unclear | failed | largest true error | worst true / estimate "
      "| bounded | median estimate / true | over 100 | slowest |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<std::string> families;
  for (const Result& r : results)
    if (std::ranges::find(families, r.family) == families.end()) families.push_back(r.family);
  for (const std::string& family : families)
    out += row(family, summarize(results, family));
  return out + row("all", summarize(results));
}

std::string failures(const std::vector<Result>& results) {
  std::string out;
  for (const Result& r : results)
    if (r.verdict.outcome == Outcome::failed || r.verdict.outcome == Outcome::unclear)
      out += std::string(word(r.verdict.outcome)) + " " + r.family + ": " + r.name + ": " + r.verdict.remark +
             "\n";
  return out;
}

bool good(const Summary& s) {
  return s.failed == 0 && s.share() >= 0.99 && s.worst <= 100;
}

} // namespace flyball::stress
