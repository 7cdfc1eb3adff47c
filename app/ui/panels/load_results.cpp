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

// A component of a vector; what is round-off beside the largest of all is zero.
std::string component_text(double value, double largest, int digits) {
  return std::abs(value) <= 1e-9 * largest ? "0" : short_text(value, digits);
}

std::string vector_text(const Vec3& v, double largest, int digits) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += std::string(i ? "  " : "") + "xyz"[i] + " " + component_text(v[i], largest, digits);
  return text;
}

// Three columns of digits, right below their heads, as wide as the panel leaves behind the names.
struct VectorColumns {
  float label = 0, each = 0, unit = 0; // pixels

  explicit VectorColumns(const Ui& ui) {
    const float room = ImGui::GetContentRegionAvail().x;
    unit = ImGui::CalcTextSize("N m").x + 5 * ui.scale;
    label = std::clamp(0.25f * room, 60 * ui.scale, 140 * ui.scale);
    each = std::max((room - label - unit) / 3, 30 * ui.scale);
  }
  // As many digits as there is room for, with a sign or without.
  std::string fitting(const Ui& ui, double value, double largest, const std::string& before) const {
    constexpr int most = 9, fewest = 3;
    const ImFont* font = ui.fonts.digits;
    int digits = most;
    for (; digits > fewest; --digits) {
      const std::string longest = before + component_text(-std::abs(value), largest, digits);
      if (font->CalcTextSizeA(font->FontSize, 1e9f, 0, longest.c_str()).x <= each - 8 * ui.scale) break;
    }
    return before + component_text(value, largest, digits);
  }
  void cell(const Ui& ui, float start, int column, const std::string& text, const ImVec4& color) const {
    const ImFont* font = ui.fonts.digits;
    const float width = font->CalcTextSizeA(font->FontSize, 1e9f, 0, text.c_str()).x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float right = start + label + static_cast<float>(column + 1) * each;
    ImGui::GetWindowDrawList()->AddText(ui.fonts.digits, font->FontSize,
                                        {std::round(right - width), at.y + digits_drop(ui)}, packed(color),
                                        text.c_str());
  }
};

void vector_heads(const Ui& ui, const VectorColumns& columns) {
  const float start = ImGui::GetCursorScreenPos().x;
  for (int i = 0; i < 3; ++i)
    columns.cell(ui, start, i, std::string(1, "xyz"[i]), colors_of(ui).dim);
  ImGui::Dummy({0, ImGui::GetTextLineHeight()});
}

// With all digits, the size and what else there is to say over the row.
void vector_row(const Ui& ui, const VectorColumns& columns, const std::string& label, const Vec3& v,
                double largest, const char* unit, const std::string& help, const OpenDirections& open = {}) {
  const UiColors& colors = colors_of(ui);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  std::string copied;
  for (int i = 0; i < 3; ++i) {
    columns.cell(ui, from.x, i, columns.fitting(ui, v[i], largest, open.component(i) ? "≈" : ""),
                 colors.text);
    copied += component_text(v[i], largest, 12) + "\t";
  }
  const float unit_at = from.x + columns.label + 3 * columns.each + 5 * ui.scale;
  ImGui::GetWindowDrawList()->AddText({unit_at, from.y}, packed(colors.dim), unit);
  ImGui::BeginGroup();
  ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
  clipped_text(label, columns.label - 4 * ui.scale);
  ImGui::PopStyleColor();
  ImGui::SetCursorScreenPos(from);
  ImGui::Dummy({columns.label + 3 * columns.each + columns.unit, height});
  ImGui::EndGroup();
  offer_copy(copied + unit);
  std::string told = vector_text(v, largest, 12) + " " + unit + "\nSize " +
                     short_text(v.stableNorm() <= 1e-9 * largest ? 0 : v.stableNorm(), 12) + " " + unit;
  if (!help.empty()) told += "\n" + help;
  help_on_hover(told.c_str());
}

// Help over a vector of which the loops leave something open; empty where they do not.
std::string open_help(const Vec3& v, double largest, const OpenDirections& open) {
  if (!open.any()) return "";
  std::string text = "The loops hold more than they need; of many possible ones the smallest.";
  if (open.along_axes() && !(open.component(0) && open.component(1) && open.component(2)))
    text += "\nComponents without ≈ are unique.";
  if (!open.along_axes()) text += "\nIts unique part: " + vector_text(open.unique_part(v), largest, 6) + ".";
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
void bearing_forces(const Session& session, const Ui& ui, const VectorColumns& columns, double force,
                    double torque) {
  const std::vector<BearingForce>& all = session.answer.solution.bearings;
  const bool torques = torque > 1e-9 * force;
  const std::size_t rows = torques ? 2 : 1;
  visible_rows(rows * all.size(), [&](std::size_t i) {
    const BearingForce& b = all[i / rows];
    if (i % rows == 1)
      return vector_row(ui, columns, "", b.torque, torque, "N m", "About the bearing's point.");
    vector_row(ui, columns, b.bearing + (b.varying ? " (varies)" : ""), b.force, force, "N",
               b.varying ? "The bearing on its second body. Changes as the drives turn; at the drawn phase."
                         : "The bearing on its second body.");
  });
}

void reactions(const Session& session, Ui& ui, ResultSections& open) {
  const Solution& solution = session.answer.solution;
  if (solution.reactions.empty() && solution.bearings.empty()) return;
  if (!section(ui, "results/reactions", "Reactions", open.reactions)) return;
  paragraph(solution.reactions_nonunique
                ? "Parent on child, along the world's axes. The loops hold more than "
                  "they need; of what is marked ≈ these are the smallest that do it."
                : "Parent on child, along the world's axes.",
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
  const VectorColumns columns(ui);
  vector_heads(ui, columns);
  note_widget(ui.widgets, "results/reactions/heads");
  visible_rows(rows * solution.reactions.size(), [&](std::size_t i) {
    const Reaction& r = solution.reactions[i / rows];
    if (i % rows == 1)
      return vector_row(ui, columns, "", r.torque, torque, "N m", open_help(r.torque, torque, r.open.torque),
                        r.open.torque);
    std::string help = r.varying ? "Changes as the drives turn; at the drawn phase." : "";
    if (const std::string more = open_help(r.force, force, r.open.force); !more.empty())
      help += (help.empty() ? "" : "\n") + more;
    vector_row(ui, columns, r.joint + (r.varying ? " (varies)" : ""), r.force, force, "N", help,
               r.open.force);
    note_widget(ui.widgets, "results/reaction/" + r.joint, KeyUse::none);
  });
  bearing_forces(session, ui, columns, force, torque);
  gear_reactions(session, ui, force, torque);
}

} // namespace

void load_results(const Session& session, Ui& ui, ResultSections& open) {
  drive_torques(session, ui, open);
  reactions(session, ui, open);
}

} // namespace flyball
