// What the drives and joints bear.
#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

std::string force_text(double value, double largest, const NumberStyle& numbers) {
  // Digits of the largest: a component that ought to vanish is not told to twelve digits of round-off.
  if (std::abs(value) <= 1e-12 * std::max(largest, 1.0)) return "0";
  return value_text(value, largest * 1e-6, {6, numbers.noise, numbers.run_times});
}

// Five digits of each component; what is round-off beside the largest of all is zero.
std::string vector_text(const Vec3& v, double largest) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i ? "  " : "") + (std::abs(v[i]) <= 1e-9 * largest ? "0" : short_text(v[i], 5));
  return text;
}

void drive_torques(App& app) {
  const std::vector<DriveTorque>& torques = app.answer.solution.drive_torques;
  if (torques.empty()) return;
  ImGui::Dummy({0, 2 * app.scale});
  if (!section(app, "results/torques", "Drive torques", app.panels.torques)) return;
  double largest = 0;
  for (const DriveTorque& t : torques)
    largest = std::max(largest, std::abs(t.value));
  visible_rows(torques.size(), [&](std::size_t i) {
    const DriveTorque& t = torques[i];
    const std::string name = coordinate_label(t);
    row(app, t.varying ? name + " (varies)" : name, force_text(t.value, largest, app.options.numbers),
        t.angle ? "N m" : "N",
        t.varying ? "Changes as the drives turn; at the drawn phase."
                  : "By the drive, positive along its coordinate.");
  });
}

void reactions(App& app) {
  const Solution& solution = app.answer.solution;
  if (solution.reactions.empty()) return;
  if (!section(app, "results/reactions", "Reactions", app.panels.reactions)) return;
  paragraph(solution.reactions_nonunique ? "Parent on child: x, y, z of the world. The loops hold more than "
                                           "they need; these are the smallest "
                                           "reactions that do it."
                                         : "Parent on child: x, y, z of the world.",
            colors_of(app).dim);
  double force = 0, torque = 0;
  for (const Reaction& r : solution.reactions) {
    force = std::max(force, r.force.lpNorm<Eigen::Infinity>());
    torque = std::max(torque, r.torque.lpNorm<Eigen::Infinity>());
  }
  // Torques of a mechanism that has none are round-off of its forces.
  const bool torques = torque > 1e-9 * force;
  const std::size_t rows = torques ? 2 : 1;
  visible_rows(rows * solution.reactions.size(), [&](std::size_t i) {
    const Reaction& r = solution.reactions[i / rows];
    if (i % rows == 1) return row(app, "", vector_text(r.torque, torque), "N m");
    row(app, r.varying ? r.joint + " (varies)" : r.joint, vector_text(r.force, force), "N",
        r.varying ? "Changes as the drives turn; at the drawn phase." : nullptr);
  });
}

} // namespace

void load_results(App& app) {
  drive_torques(app);
  reactions(app);
}

} // namespace flyball
