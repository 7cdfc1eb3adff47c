// How small disturbances of the steady state behave.
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// In the order of the list: round-off leaves parts that ought to vanish at a tiny fraction of the largest.
std::string part_text(double value, double largest) {
  return value_text(value, std::max(largest * 1e-5, 1e-12), {6, 1e-16, false});
}

void lines_of(const Ui& ui, const std::vector<std::complex<double>>& eigenvalues) {
  double largest = 0;
  for (const std::complex<double>& z : eigenvalues)
    largest = std::max(largest, std::abs(z));
  for (const std::complex<double>& z : eigenvalues) {
    if (z.imag() < 0) continue; // its conjugate stands for both
    const bool pair = z.imag() > 1e-5 * largest;
    const double frequency = z.imag() / 6.283185307179586;
    const std::string label = pair ? value_text(frequency, largest * 1e-4, {4, 1e-16, false}) + " Hz" : "";
    const std::string imaginary = pair ? " ± " + part_text(z.imag(), largest) + " i" : "";
    row(ui, label, part_text(z.real(), largest) + imaginary, "1/s");
  }
}

// Where the linearised motion turns with the drives: what a period makes of a disturbance.
void multiplier_results(Ui& ui, ResultSections& open, const Floquet& floquet) {
  if (!section(ui, "results/eigenvalues", "Floquet multipliers", open.eigenvalues)) return;
  paragraph("The linearised motion turns with the drives. In a period a disturbance becomes a multiplier "
            "times what it was: above 1 in size it grows.",
            colors_of(ui).dim);
  row(ui, "Period", value_text(floquet.period, 1e-4 * floquet.period, {6, 1e-16, false}), "s");
  floquet_rows(ui, floquet);
}

} // namespace

void floquet_rows(Ui& ui, const Floquet& floquet) {
  for (std::size_t i = 0; i < floquet.growth.size(); ++i) {
    const std::complex<double> mu = floquet.multipliers[i];
    if (mu.imag() < 0) continue; // its conjugate stands for both
    const double size = std::abs(floquet.multipliers.front());
    const std::string imaginary = mu.imag() > 1e-9 * size ? " ± " + part_text(mu.imag(), size) + " i" : "";
    row(ui, "Multiplier", part_text(mu.real(), size) + imaginary, "");
    row(ui, "Growth", value_text(floquet.growth[i], 1e-6 / floquet.period, {6, 1e-16, false}), "1/s");
  }
}

void eigenvalue_results(const Session& session, Ui& ui, ResultSections& open) {
  if (const PeriodicState* motion = periodic_motion(session); motion && !motion->floquet.multipliers.empty())
    return multiplier_results(ui, open, motion->floquet);
  if (session.answer.solution.floquet) return multiplier_results(ui, open, *session.answer.solution.floquet);
  const auto& eigenvalues = session.answer.solution.eigenvalues;
  if (!eigenvalues || eigenvalues->empty()) return;
  if (!section(ui, "results/eigenvalues", "Eigenvalues", open.eigenvalues)) return;
  paragraph("Disturbances grow or die out with the real part and swing with the imaginary part.",
            colors_of(ui).dim);
  lines_of(ui, *eigenvalues);
  const auto& at = session.answer.solution.at_constant_speed;
  if (!at || !at->eigenvalues || at->eigenvalues->empty()) return;
  paragraph("That is with its speeds free. The same state with its speeds prescribed:", colors_of(ui).dim);
  lines_of(ui, *at->eigenvalues);
}

} // namespace flyball
