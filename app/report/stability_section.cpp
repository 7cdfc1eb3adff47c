#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "app/session/state_words.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

constexpr std::size_t most_named = 3; // coordinates of a mode

Html eigenvalue(std::complex<double> e) {
  Html out = quantity(e.real(), "", 6);
  if (e.imag() != 0) out += Html(" ± ") + quantity(std::abs(e.imag()), "", 6) + " i";
  return out + "\u00a01/s";
}

// How long a motion takes to grow or to die out by the factor e.
Html time_constant(double real) {
  return real == 0 ? Html("–") : quantity(1 / std::abs(real), "s", 4) + (real > 0 ? " (grows)" : "");
}

// Of a shape whose largest entry is 1.
Html amplitudes(const VibrationMode& mode) {
  std::vector<const ModeAmplitude*> largest;
  for (const ModeAmplitude& a : mode.amplitudes)
    if (std::abs(a.value) > 1e-6) largest.push_back(&a);
  std::ranges::stable_sort(largest, std::greater<>(),
                           [](const ModeAmplitude* a) { return std::abs(a->value); });
  Html out;
  for (std::size_t i = 0; i < largest.size() && i < most_named; ++i) {
    const ModeAmplitude& a = *largest[i];
    if (i > 0) out += "; ";
    out += Html(coordinate_label(a)) + " " + quantity(std::abs(a.value), coordinate_unit_of(a.angle), 3);
    const double phase = std::arg(a.value) * 180 / std::numbers::pi;
    if (mode.oscillates()) out += Html(" at ") + quantity(std::abs(phase) < 5e-4 ? 0 : phase, "°", 3);
  }
  if (largest.size() > most_named) out += "; …";
  return out;
}

Html modes_tables(const std::vector<VibrationMode>& modes) {
  HtmlTable table({{"Mode", false},
                   {"Eigenvalue"},
                   {"Frequency"},
                   {"Undamped frequency"},
                   {"Damping ratio"},
                   {"Time constant"}});
  HtmlTable shapes({{"Mode", false}, {"Largest amplitudes", false}});
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const VibrationMode& m = modes[i];
    const std::string number = std::to_string(i + 1);
    table.row({number, eigenvalue(m.eigenvalue),
               m.oscillates() ? quantity(hertz(m.frequency), "Hz", 5) : Html("no oscillation"),
               m.oscillates() ? quantity(hertz(m.natural_frequency), "Hz", 5) : Html("–"),
               quantity(100 * m.damping_ratio, "%", 4), time_constant(m.eigenvalue.real())});
    shapes.row({number, amplitudes(m)});
  }
  return heading_of("Modes of the linearised motion") + table.html() + heading_of("Their shapes") +
         shapes.html() +
         element(
             "p",
             "The largest amplitude is 1 rad, or as many metres as the mechanism reaches; angles after “at” "
             "are phases.",
             {{"class", "note"}}) +
         "\n";
}

Html eigenvalues_table(const std::vector<std::complex<double>>& all) {
  HtmlTable table({{"Eigenvalue", false}, {"Frequency"}, {"Damping ratio"}, {"Time constant"}});
  for (const auto& e : all)
    if (e.imag() >= 0)
      table.row({eigenvalue(e),
                 e.imag() > 0 ? quantity(hertz(damped_frequency(e)), "Hz", 5) : Html("no oscillation"),
                 quantity(100 * damping_ratio(e), "%", 4), time_constant(e.real())});
  return table.html();
}

Html floquet_table(const Floquet& f) {
  HtmlTable table({{"Multiplier", false}, {"Size"}, {"Growth"}});
  for (std::size_t i = 0; i < f.multipliers.size(); ++i) {
    const auto& mu = f.multipliers[i];
    Html value = quantity(mu.real(), "", 9);
    if (mu.imag() != 0)
      value += Html(mu.imag() < 0 ? " − " : " + ") + quantity(std::abs(mu.imag()), "", 9) + " i";
    table.row({value, quantity(std::abs(mu), "", 9),
               i < f.growth.size() ? quantity(f.growth[i], "1/s") : Html("–")});
  }
  return heading_of("Floquet multipliers") +
         paragraph_of(Html("The linearised motion turns with the drives; their common period is ") +
                      quantity(f.period, "s", 10) +
                      ", and the multipliers, plain numbers, are known to about " + magnitude(f.error, "") +
                      ".") +
         table.html();
}

} // namespace

ReportVerdict verdict(const Solution& s) {
  if (s.status != Status::converged) return {"No steady state", s.message, "bad"};
  std::string reason = undamped_words(s);
  if (reason.empty() && s.stability_reason) reason = reason_text(*s.stability_reason);
  if (!s.stable) return {"Stability open", reason, "open"};
  return *s.stable ? ReportVerdict{"Stable", reason, "good"} : ReportVerdict{"Unstable", reason, "bad"};
}

OptionalSection stability_section(const ReportContents& contents) {
  const Solution& s = contents.solution;
  if (s.status != Status::converged) return std::nullopt;
  const ReportVerdict v = verdict(s);
  Html body = element("p", element("strong", v.word + ".", {{"class", v.color}}) + " " + v.sentence,
                      {{"class", "lead"}}) +
              "\n";
  if (contents.evidence && !contents.evidence->reason.empty()) {
    HtmlTerms terms;
    terms.term("By potential and eigenvalues", contents.evidence->reason);
    body += terms.html();
  }
  if (const auto& at = s.at_constant_speed; at && at->stability_reason) {
    body += paragraph_of("That is with its speeds free. The same state with its speeds prescribed: " +
                         std::string(at->stable == true    ? "stable. "
                                     : at->stable == false ? "unstable. "
                                                           : "stability open. ") +
                         reason_text(*at->stability_reason));
    if (at->eigenvalues && !at->eigenvalues->empty())
      body += heading_of("Eigenvalues at constant speed") + eigenvalues_table(*at->eigenvalues);
  }
  if (!s.neutral.empty()) body += paragraph_of("Nothing resists some motion of:") + list_of(s.neutral);
  if (s.floquet) body += floquet_table(*s.floquet);
  if (!s.floquet && !contents.modes.empty()) {
    body += modes_tables(contents.modes);
  } else if (s.eigenvalues && !s.eigenvalues->empty()) {
    body += heading_of(s.floquet ? "Floquet exponents" : "Eigenvalues of the linearised motion") +
            eigenvalues_table(*s.eigenvalues);
  }
  return ReportSection{"stability", "Stability and modes", body};
}

} // namespace flyball
