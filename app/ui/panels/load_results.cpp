// What the drives and joints bear.
#include "app/session/coordinate_words.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"

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
std::string vector_text(const Vec3& v, double largest, const OpenDirections& open = {}) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += std::string(i ? "  " : "") + (open.component(i) ? "≈" : "") +
            (std::abs(v[i]) <= 1e-9 * largest ? "0" : short_text(v[i], 5));
  return text;
}

// Help over a vector of which the loops leave something open; empty where they do not.
std::string open_help(const Vec3& v, double largest, const OpenDirections& open) {
  if (!open.any()) return "";
  std::string text = "The loops hold more than they need; of many possible ones the smallest.";
  if (open.along_axes() && !(open.component(0) && open.component(1) && open.component(2)))
    text += "\nComponents without ≈ are unique.";
  if (!open.along_axes()) text += "\nIts unique part: " + vector_text(open.unique_part(v), largest) + ".";
  return text;
}

void drive_torques(const Session& session, Ui& ui, ResultSections& open) {
  const std::vector<DriveTorque>& torques = session.answer.solution.drive_torques;
  if (torques.empty()) return;
  ImGui::Dummy({0, 2 * ui.scale});
  if (!section(ui, "results/torques", "Drive torques", open.torques)) return;
  double largest = 0;
  enum class Part { whole, range, torque, load }; // of the last three one a line below the first
  struct Row {
    const DriveTorque* torque;
    Part part;
  };
  std::vector<Row> rows;
  for (const DriveTorque& t : torques) {
    largest = std::max({largest, std::abs(t.value), t.range ? t.range->most - t.range->least : 0,
                        t.given ? std::max(std::abs(t.given->torque), std::abs(t.given->load)) : 0});
    if (t.given) {
      rows.push_back({&t, Part::torque});
      rows.push_back({&t, Part::load});
    }
    rows.push_back({&t, Part::whole});
    if (t.range) rows.push_back({&t, Part::range});
  }
  visible_rows(rows.size(), [&](std::size_t i) {
    const DriveTorque& t = *rows[i].torque;
    const char* unit = t.angle ? "N m" : "N";
    const auto text = [&](double value) { return force_text(value, largest, session.options.numbers); };
    if (rows[i].part == Part::torque)
      return row(ui, coordinate_words(t), text(t.given->torque), unit,
                 "What the drive gives, positive along its coordinate.");
    if (rows[i].part == Part::load)
      return row(ui, "   load", text(t.given->load), unit, "What acts against it.");
    if (rows[i].part == Part::range)
      return row(ui, "   least … greatest", text(t.range->least) + " … " + text(t.range->most), unit,
                 "Over all phases of the drives.");
    std::string help = t.given ? "The drive's torque less its load: what turning takes."
                               : "By the drive, positive along its coordinate.";
    if (t.varying)
      help += "\nChanges as the drives turn; at the drawn phase " + text(t.value) + " " + unit + ".";
    if (t.nonunique) help += "\nThe loops share it among several drives: the smallest that do it.";
    const std::string name = t.given ? "   torque less load" : coordinate_words(t);
    row(ui,
        !t.varying ? name
        : t.range  ? name + " (mean)"
                   : name + " (varies)",
        text(t.range ? t.range->mean : t.value), unit, help.c_str());
  });
}

// What gears do along the coordinates of their joints, whose reactions include it.
void gear_reactions(const Session& session, const Ui& ui, double force, double torque) {
  const std::vector<GearReaction>& gears = session.answer.solution.gears;
  const NumberStyle& numbers = session.options.numbers;
  visible_rows(2 * gears.size(), [&](std::size_t i) {
    const GearReaction& g = gears[i / 2];
    const bool second = i % 2 == 1, angle = second ? g.angle_b : g.angle_a;
    row(ui,
        second      ? ""
        : g.varying ? g.joint + " (varies)"
                    : g.joint,
        force_text(second ? g.b : g.a, angle ? torque : force, numbers), angle ? "N m" : "N",
        second ? "The gear on its second joint's child, along that joint's coordinate; part of its reaction."
               : "The gear on its first joint's child, along that joint's coordinate; part of its reaction.");
  });
}

// What bearings exert on their second bodies.
void bearing_forces(const Session& session, const Ui& ui, double force, double torque) {
  const std::vector<BearingForce>& all = session.answer.solution.bearings;
  const bool torques = torque > 1e-9 * force;
  const std::size_t rows = torques ? 2 : 1;
  visible_rows(rows * all.size(), [&](std::size_t i) {
    const BearingForce& b = all[i / rows];
    if (i % rows == 1) return row(ui, "", vector_text(b.torque, torque), "N m", "About the bearing's point.");
    row(ui, b.bearing + (b.varying ? " (varies)" : ""), vector_text(b.force, force), "N",
        b.varying ? "The bearing on its second body. Changes as the drives turn; at the drawn phase."
                  : "The bearing on its second body.");
  });
}

void reactions(const Session& session, Ui& ui, ResultSections& open) {
  const Solution& solution = session.answer.solution;
  if (solution.reactions.empty() && solution.bearings.empty()) return;
  if (!section(ui, "results/reactions", "Reactions", open.reactions)) return;
  paragraph(solution.reactions_nonunique ? "Parent on child: x, y, z of the world. The loops hold more than "
                                           "they need; of what is marked ≈ these are the smallest that do it."
                                         : "Parent on child: x, y, z of the world.",
            colors_of(ui).dim);
  double force = 0, torque = 0;
  for (const Reaction& r : solution.reactions) {
    force = std::max(force, r.force.lpNorm<Eigen::Infinity>());
    torque = std::max(torque, r.torque.lpNorm<Eigen::Infinity>());
  }
  for (const BearingForce& b : solution.bearings) {
    force = std::max(force, b.force.lpNorm<Eigen::Infinity>());
    torque = std::max(torque, b.torque.lpNorm<Eigen::Infinity>());
  }
  // Torques of a mechanism that has none are round-off of its forces.
  const bool torques = torque > 1e-9 * force;
  const std::size_t rows = torques ? 2 : 1;
  visible_rows(rows * solution.reactions.size(), [&](std::size_t i) {
    const Reaction& r = solution.reactions[i / rows];
    std::string help;
    if (i % rows == 1) {
      help = open_help(r.torque, torque, r.open.torque);
      return row(ui, "", vector_text(r.torque, torque, r.open.torque), "N m",
                 help.empty() ? nullptr : help.c_str());
    }
    help = r.varying ? "Changes as the drives turn; at the drawn phase." : "";
    if (const std::string more = open_help(r.force, force, r.open.force); !more.empty())
      help += (help.empty() ? "" : "\n") + more;
    row(ui, r.joint + (r.varying ? " (varies)" : ""), vector_text(r.force, force, r.open.force), "N",
        help.empty() ? nullptr : help.c_str());
  });
  bearing_forces(session, ui, force, torque);
  gear_reactions(session, ui, force, torque);
}

} // namespace

void load_results(const Session& session, Ui& ui, ResultSections& open) {
  drive_torques(session, ui, open);
  reactions(session, ui, open);
}

} // namespace flyball
