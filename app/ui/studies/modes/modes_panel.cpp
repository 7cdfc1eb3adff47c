// The modes of the state that is shown: a list, what moves in the view, and the Campbell diagram beside it.
#include "app/render/icons.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/studies/modes/campbell_plot.hpp"
#include "app/ui/studies/modes/critical_speeds.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/stability_words.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/frictions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr float list_width = 392;       // points; the table of critical speeds fits into it
constexpr double modes_patience = 0.25; // s: a shorter wait is not worth a bar
constexpr ImGuiTableFlags table_flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerH |
                                        ImGuiTableFlags_NoSavedSettings | ImGuiTableFlags_SizingFixedFit;

void verdict(const Session& session, Ui& ui, const FoundModes& found) {
  const UiColors& colors = colors_of(ui);
  const Solution& solution = session.answer.solution;
  const StabilityWords words = stability_words(solution.stable, solution.stability_reason, colors);
  ImGui::TextColored(words.color, "%s", words.icon);
  ImGui::SameLine(0, 6 * ui.scale);
  const bool disagree = found.evidence && !found.evidence->agree;
  std::string text = std::string("The state is ") + words.word + ". ";
  text += found.evidence ? found.evidence->reason : words.sentence;
  paragraph(text, disagree ? colors.warn : colors.dim);
  note_widget(ui.widgets, "modes/verdict");
  if (has_friction(session.mechanism()) && solution.frictions.empty()) {
    paragraph(friction_left_out, colors.warn);
    note_widget(ui.widgets, "modes/friction");
  }
}

// A number of the list: four digits of what is not rounding.
std::string some_digits(double value, double size, int digits) {
  return std::abs(value) < 1e-7 * size ? "0" : short_text(value, digits);
}

std::string whirl_words(const Whirl& whirl, double frequency) {
  const WhirlDirection direction = whirl.direction();
  if (direction == WhirlDirection::straight) return "\nSwings straight to and fro: no whirl.";
  constexpr double little = 0.01; // of a circle: nobody sees it go round
  if (std::abs(whirl.value) < little) return "\nSwings all but straight to and fro: no whirl to speak of.";
  const bool forward = direction == WhirlDirection::forward;
  std::string text =
      forward ? "\nWhirls forward, as the drive turns" : "\nWhirls backward, against the drive";
  const double round = std::abs(whirl.value); // of a circle
  text +=
      round > 0.999 ? ", in circles" : ", in ellipses (" + short_text(round, 3) + ", where 1 is a circle)";
  if (!whirl.turning) return text + ".";
  const double seen = standing_frequencies(whirl, frequency)[forward ? 0 : 1];
  return text + ", as seen from what turns with it; from the ground at " + short_text(hertz(seen), 6) +
         " Hz.";
}

std::string mode_help(const VibrationMode& mode, const std::optional<Whirl>& whirl) {
  std::string text;
  if (mode.oscillates()) {
    text = "Swings at " + short_text(hertz(mode.frequency), 6) + " Hz (" + short_text(mode.frequency, 6) +
           " rad/s)";
    if (mode.natural_frequency > mode.frequency * (1 + 1e-6))
      text += ", undamped at " + short_text(hertz(mode.natural_frequency), 6) + " Hz";
    text += ".";
  } else {
    text = "Does not swing.";
  }
  const double rate = std::abs(mode.eigenvalue.real());
  if (rate > 1e-7 * std::max(1., mode.natural_frequency))
    text += (grows(mode) ? "\nGrows to e times as much in " : "\nDies out to 1/e in ") +
            short_text(1 / rate, 4) + " s.";
  if (whirl) text += whirl_words(*whirl, mode.frequency);
  return text;
}

// The list's columns after the number, in their order.
enum class ModeColumn { hertz, radians, damping, growth };

std::string mode_text(const VibrationMode& mode, ModeColumn column, double largest) {
  if (column == ModeColumn::growth) return some_digits(mode.eigenvalue.real(), largest, 4);
  if (!mode.oscillates()) return "–";
  if (column == ModeColumn::damping) return some_digits(mode.damping_ratio, 1, 3);
  return short_text(column == ModeColumn::hertz ? hertz(mode.natural_frequency) : mode.natural_frequency, 4);
}

void mode_row(Session& session, Ui& ui, std::size_t index, const FoundModes& found, double largest,
              const std::vector<ModeColumn>& listed) {
  const VibrationMode& mode = found.modes[index];
  const UiColors& colors = colors_of(ui);
  const bool chosen = session.study.modes.chosen == index, bad = grows(mode);
  ImGui::TableNextRow();
  if (chosen) {
    ImVec4 tint = colors.accent;
    tint.w = 0.16f;
    ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, packed(tint));
  }
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorPos();
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::Selectable("##mode", false, ImGuiSelectableFlags_SpanAllColumns))
    later(ui,
          [&session, index, chosen] { choose_mode(session, chosen ? std::nullopt : std::optional(index)); });
  note_widget(ui.widgets, "modes/row/" + std::to_string(index + 1), KeyUse::row);
  if (chosen) mark_chosen(ui.widgets);
  help_on_hover(mode_help(mode, found.whirls[index]).c_str());
  ImGui::PopID();
  ImGui::SetCursorPos(at);
  ImGui::TextColored(bad      ? colors.bad
                     : chosen ? colors.accent
                              : colors.dim,
                     "%s",
                     bad      ? icon::warning
                     : chosen ? icon::eye
                              : std::to_string(index + 1).c_str());
  const ImVec4& color = bad ? colors.bad : colors.text;
  for (const ModeColumn column : listed)
    if (ImGui::TableNextColumn()) right_digits(ui, mode_text(mode, column, largest), color);
}

void list(Session& session, Ui& ui, const FoundModes& found, float height) {
  const UiColors& colors = colors_of(ui);
  struct Shown {
    ModeColumn column;
    const char *title, *help;
    float width; // points
  };
  constexpr std::array all{
      Shown{ModeColumn::hertz, "Natural [Hz]", "Of the undamped motion with this shape.", 78},
      Shown{ModeColumn::radians, "[rad/s]", "Of the undamped motion with this shape.", 70},
      Shown{ModeColumn::damping, "Damping",
            "The damping ratio: 0 swings for ever, 1 does not swing at all, below 0 it grows.", 70},
      Shown{ModeColumn::growth, "Real part [1/s]",
            "Of the eigenvalue: disturbances go as e to this times the time. Growing ones are marked.", 88}};
  constexpr float number_width = 20, cell_padding = 4; // points
  float needed = number_width + 2 * cell_padding;
  for (const Shown& each : all)
    needed += each.width + 2 * cell_padding;
  // Of a narrow list the same frequency once more is what can be spared: pointing at the row tells it.
  const bool narrow = ImGui::GetContentRegionAvail().x < needed * ui.scale + ImGui::GetStyle().ScrollbarSize;
  std::vector<ModeColumn> listed;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {cell_padding * ui.scale, 2 * ui.scale});
  ImGui::PushStyleColor(ImGuiCol_TableHeaderBg, colors.panel);
  ImGui::PushStyleColor(ImGuiCol_TableBorderLight, colors.border);
  if (ImGui::BeginTable("modes", narrow ? 4 : 5, table_flags, {0, height})) {
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, number_width * ui.scale);
    for (const Shown& each : all) {
      if (narrow && each.column == ModeColumn::radians) continue;
      ImGui::TableSetupColumn(each.title, ImGuiTableColumnFlags_WidthFixed, each.width * ui.scale);
      listed.push_back(each.column);
    }
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (std::size_t i = 0; i < listed.size(); ++i) {
      const Shown& shown = *std::ranges::find(all, listed[i], &Shown::column);
      if (!ImGui::TableSetColumnIndex(static_cast<int>(i) + 1)) continue;
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.f, ImGui::GetContentRegionAvail().x -
                                                                      ImGui::CalcTextSize(shown.title).x));
      ImGui::TextColored(colors.dim, "%s", shown.title);
      note_widget(ui.widgets, std::string("modes/title/") + shown.title, KeyUse::none);
      help_on_hover(shown.help);
    }
    double largest = 0;
    for (const VibrationMode& mode : found.modes)
      largest = std::max(largest, mode.natural_frequency);
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found.modes.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        mode_row(session, ui, static_cast<std::size_t>(i), found, largest, listed);
    ImGui::EndTable();
  }
  ImGui::PopStyleColor(2);
  ImGui::PopStyleVar();
}

// "swing ± 8.6°": the coordinate that moves most.
std::string largest_movement(const Session& session, const VibrationMode& mode) {
  const ModeAmplitude* most = mode.leading();
  if (!most) return {};
  const double movement = session.study.modes.amplitude * std::abs(most->value);
  const ShownUnit unit = coordinate_unit(most->angle, session.units);
  return coordinate_words(*most) + " ± " + short_text(unit.shown(movement), 3) +
         (unit.text == "°" ? "" : " ") + unit.text;
}

std::string slowing_words(const VibrationMode& mode) {
  const std::optional<double> slower = shown_slower(mode);
  if (!slower) return "Shown swaying: no swing";
  if (*slower == 1) return "In real time";
  return "Shown " + short_text(*slower > 1 ? *slower : 1 / *slower, 3) +
         (*slower > 1 ? "× slower" : "× faster");
}

void transport(Session& session, Ui& ui, const CommandRunner& commands) {
  ModesState& modes = session.study.modes;
  const UiColors& colors = colors_of(ui);
  const VibrationMode* mode = moving_mode(session);
  if (!mode) {
    ImGui::AlignTextToFramePadding();
    paragraph(modes.list.found && modes.list.found->result.modes.empty() ? ""
                                                                         : "Click a mode to see it move.",
              colors.dim);
    return;
  }
  if (icon_button(ui, "modes/play", modes.playing ? icon::pause : icon::play,
                  modes.playing ? "Pause (Space)" : "Play (Space)", modes.playing))
    modes.playing = !modes.playing;
  ImGui::SameLine();
  if (icon_button(ui, "modes/export", icon::save, "Export as MP4, GIF or numbered pictures…"))
    commands.run("study.export_mode");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(110 * ui.scale);
  constexpr double least = 0.01, most = 0.6;
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + ui.scale);
  ImGui::SliderScalar("##amplitude", ImGuiDataType_Double, &modes.amplitude, &least, &most, "");
  note_widget(ui.widgets, "modes/amplitude", KeyUse::slide);
  nudge_value(ui, "modes/amplitude", modes.amplitude, least, most);
  help_on_hover("How far it is shown swinging; the linearised motion is for small swings.");
  ImGui::SameLine();
  ImGui::BeginGroup();
  clipped_text(largest_movement(session, *mode), ImGui::GetContentRegionAvail().x);
  ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
  clipped_text(slowing_words(*mode), ImGui::GetContentRegionAvail().x);
  ImGui::PopStyleColor();
  ImGui::EndGroup();
  note_widget(ui.widgets, "modes/speed");
}

bool turns_with_drives(const Session& session) {
  return session.answer.ticket && !session.answer.error &&
         session.answer.solution.status == Status::no_steady_state;
}

std::string without_modes(const Session& session) {
  const std::string none = "Modes are of a steady state, and there is none now";
  if (!turns_with_drives(session)) return none + ".";
  return none +
         ": the balance turns with the drives, by weight or by a mass centre beside the axis. With mass "
         "centres on it, and gravity along it or turned off, there is one; its modes and critical speeds "
         "are those that unbalance excites. The response shows how far it swings with them as they are.";
}

// Of a drive by torque, which finds its speed: a number that sets the torque, or the load against it; ""
// where none does.
std::string torque_number(const Mechanism& mechanism) {
  for (const Joint& joint : mechanism.joints)
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      if (const auto& drive = joint.coordinates[i].drive; !drive || !drive->torque) continue;
      const std::string speed = drive_speed_address(joint, i);
      for (const char* key : {"torque", "load"}) {
        const std::string address = speed.substr(0, speed.rfind('.') + 1) + key;
        const std::optional<std::string> formula = formula_at(mechanism, address);
        if (!formula) return address;
        if (const auto sources = sources_of(mechanism, *formula); !sources.empty()) return sources.front();
      }
    }
  return {};
}

// Where it swings instead of standing still: how far, over the speed where that is given, else over what
// makes it.
void offer_response(Session& session, Ui& ui) {
  const std::vector<std::string> speeds = drive_speeds(session.mechanism());
  const std::string over = speeds.empty() ? torque_number(session.mechanism()) : speeds.front();
  const std::string words = !speeds.empty() ? "the speed" : parameter_phrase(over);
  if (!text_button(ui, "modes/response", over.empty() ? "Response" : ("Response over " + words).c_str(),
                   true))
    return;
  later(ui, [&session, over, speeds] {
    if (std::ranges::find(speeds, session.study.response.choice.address) == speeds.end())
      choose_response(session, over);
    open_study(session, StudyKind::response);
  });
}

// Where no steady state was found of what torques drive: perhaps its speed swings with every turn.
void offer_cycle(Session& session, Ui& ui) {
  paragraph("What a torque drives may move in a limit cycle, its speed swinging with every turn.",
            colors_of(ui).dim);
  if (!session.study.periodic.cycle_wanted && text_button(ui, "modes/cycle", "Find the limit cycle", true))
    later(ui, [&session] { find_cycle(session, true); });
}

float table_line(const Ui& ui) {
  return std::max(ImGui::GetTextLineHeight(), ui.fonts.digits->FontSize) + 4 * ui.scale;
}

// How high the table of critical speeds is below a list of so many modes, where the diagram then has all the
// width beside them; 0 where there is no room for some of its rows (pixels).
float critical_height(const Session& session, const Ui& ui, const CampbellView& drawn, std::size_t modes,
                      float foot) {
  constexpr std::size_t fewest = 3; // rows
  if (!session.study.modes.campbell.diagram.found || !drawn.critical || drawn.critical->empty()) return 0;
  if (ImGui::GetContentRegionAvail().x < critical_table_width(ui)) return 0;
  const float line = table_line(ui), gap = ImGui::GetStyle().ItemSpacing.y;
  const std::size_t rows = drawn.critical->size();
  const float room = ImGui::GetContentRegionAvail().y - line * static_cast<float>(1 + modes) - foot - 2 * gap;
  if (room < line * static_cast<float>(1 + std::min(rows, fewest))) return 0;
  return std::min(room, line * static_cast<float>(1 + rows));
}

// Where the critical speeds do not stand below the list of modes: beside the diagram or below it, `room`
// being that of all three (pixels).
struct BesideDiagram {
  static constexpr float least_width = 520, least_height = 200; // points, of the diagram with its legend
  static constexpr std::size_t fewest = 1, most_below = 3;      // rows
  bool beside = false;
  float below = 0; // pixels, of the table; 0: no room

  BesideDiagram(const Ui& ui, std::size_t rows, ImVec2 room) {
    const float gap = 10 * ui.scale;
    beside = room.x >= critical_table_width(ui) + gap + least_width * ui.scale;
    if (beside) return;
    // As many rows as leave the diagram its height; its circles tell the others.
    const float space = room.y - least_height * ui.scale - gap; // the same in whatever style it is asked
    for (std::size_t count = std::min(rows, most_below); count >= fewest; --count)
      if (const float height =
              table_line(ui) * static_cast<float>(1 + count) + critical_table_bar(ui, room.x);
          height <= space) {
        below = height;
        return;
      }
  }
};

// Whether there is room for the critical speeds or for the list of modes alone: then one chooses.
bool one_table(const Session& session, const Ui& ui, const CampbellView& drawn, ImVec2 beside_list) {
  if (!session.study.modes.campbell.diagram.found || !drawn.critical || drawn.critical->empty()) return false;
  beside_list.y -= drawn.head > 0 ? drawn.head : ImGui::GetFrameHeightWithSpacing();
  const BesideDiagram place(ui, drawn.critical->size(), beside_list);
  return !place.beside && place.below == 0;
}

void choose_table(Ui& ui, CampbellView& drawn) {
  for (const bool critical : {false, true}) {
    if (critical) ImGui::SameLine(0, 2 * ui.scale);
    const std::string words =
        critical ? "Critical speeds (" + std::to_string(drawn.critical->size()) + ")" : std::string("Modes");
    if (text_button(ui, critical ? "modes/show_critical" : "modes/show_list", words.c_str(),
                    drawn.critical_for_modes == critical))
      drawn.critical_for_modes = critical;
  }
}

// Modes, or the critical speeds, as there is room; returns whether the latter are told. `beside`: pixels of
// the panel beside the list.
bool mode_tables(Session& session, Ui& ui, const FoundModes& found, CampbellView& drawn, ImVec2 beside,
                 const CommandRunner& commands) {
  const float foot = 2 * ImGui::GetTextLineHeightWithSpacing() + 12 * ui.scale;
  const float critical = critical_height(session, ui, drawn, found.modes.size(), foot);
  const auto& diagram = session.study.modes.campbell.diagram.found;
  const std::string drive = diagram ? diagram->of.drive : std::string();
  if (critical <= 0 && one_table(session, ui, drawn, beside)) {
    choose_table(ui, drawn);
    if (drawn.critical_for_modes) {
      critical_table(session, ui, *drawn.critical, drawn.unit, drive,
                     std::max(ImGui::GetContentRegionAvail().y, 60 * ui.scale));
      return true;
    }
  }
  const float all = table_line(ui) * static_cast<float>(1 + found.modes.size());
  list(session, ui, found,
       critical > 0 ? all : std::max(ImGui::GetContentRegionAvail().y - foot, 60 * ui.scale));
  transport(session, ui, commands);
  if (critical <= 0) return false;
  ImGui::SetCursorPosY(ImGui::GetWindowHeight() - critical);
  critical_table(session, ui, *drawn.critical, drawn.unit, drive, critical);
  return true;
}

// Returns whether the critical speeds are told here. `beside`: pixels of the panel beside the list.
bool modes_list(Session& session, Ui& ui, CampbellView& drawn, ImVec2 beside, const CommandRunner& commands) {
  ModesState& modes = session.study.modes;
  const UiColors& colors = colors_of(ui);
  auto& search = modes.list;
  if (!search.problem.empty()) {
    paragraph(search.problem, colors.bad);
    return false;
  }
  if (!converged(session)) {
    paragraph(without_modes(session), colors.dim);
    if (turns_with_drives(session))
      offer_response(session, ui);
    else if (may_cycle(session))
      offer_cycle(session, ui);
    return false;
  }
  const bool finding = search.running();
  if (finding && (!search.found || search.seconds() > modes_patience)) {
    if (text_button(ui, "modes/cancel", "Cancel")) search.stop();
    ImGui::SameLine();
    task_bar(ui, "modes/progress", search.progress(), search.seconds());
  }
  if (!search.found) return false;
  const FoundModes& found = search.found->result;
  if (!modes_are_current(session) && !finding) {
    paragraph("Of the state before the last changes.", colors.warn);
    if (text_button(ui, "modes/again", "Find again", true)) find_modes_again(session);
  }
  // Of a low panel the words would take all: they stand below what they are about.
  constexpr float low = 170; // points
  const bool words_first = found.modes.empty() || ImGui::GetContentRegionAvail().y >= low * ui.scale;
  if (words_first) verdict(session, ui, found);
  if (found.modes.empty()) {
    paragraph(found.singular_loops ? std::string(singular_loops_message) : "No coordinate is free to swing.",
              colors.dim);
    return false;
  }
  const bool told = mode_tables(session, ui, found, drawn, beside, commands);
  if (!words_first) verdict(session, ui, found);
  return told;
}

// Drive, range and unit, in one line where there is room for it.
void campbell_choices(Session& session, Ui& ui, CampbellView& drawn, const std::vector<std::string>& speeds,
                      const std::string& drive) {
  CampbellState& campbell = session.study.modes.campbell;
  const float s = ui.scale;
  constexpr float others = 360, least = 70; // points, of the range and the units; of the drive
  const float room = ImGui::GetContentRegionAvail().x;
  const bool narrow = room < (others + least) * s; // then "from" goes without saying
  // Then the only drive does so, too; one of several is chosen in a line of its own.
  const bool tight = room < others * s, choice = !tight || speeds.size() > 1;
  if (choice) ImGui::SetNextItemWidth(tight ? room : std::clamp(room - others * s, least * s, 140 * s));
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(ui).raised);
  if (choice && ImGui::BeginCombo("##drive", parameter_phrase(drive).c_str())) {
    for (const std::string& speed : speeds) {
      if (ImGui::Selectable(parameter_phrase(speed).c_str(), speed == drive) && speed != drive) {
        campbell.drive = speed;
        campbell.from = campbell.to = 0;
        fit_plot(drawn.view);
      }
      note_widget(ui.widgets, "campbell/drive/" + speed);
      if (speed == drive) mark_chosen(ui.widgets);
    }
    ImGui::EndCombo();
  } else if (choice) {
    note_widget(ui.widgets, "campbell/drive");
  }
  ImGui::PopStyleColor();
  if (choice)
    help_on_hover("The number along the axis: the speed of a drive, or a number that its expression uses.");
  const PlotRange range = campbell_range(session, drive);
  const std::string unit = parameter_unit(session.mechanism(), drive);
  const auto end = [&](const char* name, const char* word, std::size_t which) {
    if (which > 0 || !tight) ImGui::SameLine(0, 10 * s);
    if (*word) {
      ImGui::AlignTextToFramePadding();
      ImGui::TextColored(colors_of(ui).dim, "%s", word);
      ImGui::SameLine(0, 6 * s);
    }
    quantity_field(session, ui,
                   {.name = name,
                    .value = range[which],
                    .unit = unit,
                    .help = "The end of the axis.",
                    .set =
                        [&session, &drawn, range, which](double typed) {
                          PlotRange ends = range;
                          ends[which] = typed;
                          if (ends[0] == ends[1]) return;
                          CampbellState& changed = session.study.modes.campbell;
                          changed.from = std::min(ends[0], ends[1]);
                          changed.to = std::max(ends[0], ends[1]);
                          fit_plot(drawn.view);
                        }},
                   (narrow ? 80 : 84) * s);
  };
  end("campbell/from", narrow ? "" : "from", 0);
  end("campbell/to", "to", 1);

  for (const bool hertz : {true, false}) {
    ImGui::SameLine(0, hertz ? 14 * s : 2 * s);
    if (text_button(ui, hertz ? "campbell/hertz" : "campbell/radians", hertz ? "Hz" : "rad/s",
                    drawn.hertz == hertz)) {
      drawn.hertz = hertz;
      drawn.view.look.range[1].reset();
    }
  }
  auto& diagram = campbell.diagram;
  if (diagram.running()) { // in a row of its own, where it is in sight
    if (diagram.found && diagram.seconds() < modes_patience) return;
    if (text_button(ui, "campbell/cancel", "Cancel")) diagram.stop();
    ImGui::SameLine();
    task_bar(ui, "campbell/progress", diagram.progress(), diagram.seconds());
  } else if (!campbell.current || !campbell.on_branch) {
    const float button = ImGui::CalcTextSize("Follow again").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(0, 14 * s);
    if (ImGui::GetContentRegionAvail().x < button) ImGui::NewLine();
    if (text_button(ui, "campbell/again", "Follow again", true)) follow_campbell(session);
  }
}

// Where the table of critical speeds is if not below the list of modes: beside the plot where there is room
// for both, else below it.
struct CampbellPlaces {
  ImVec2 plot;     // pixels
  float below = 0; // pixels, of the table; 0: none there
};

// Beyond the range, a round speed before which the slowest mode may well be excited once a turn; none where
// the axis is no speed or goes that far.
std::optional<double> farther_end(const Session& session, const std::string& drive, double end) {
  const auto& list = session.study.modes.list.found;
  if (!list || parameter_unit(session.mechanism(), drive) != "rad/s") return {};
  double slowest = std::numeric_limits<double>::infinity();
  for (const VibrationMode& mode : list->result.modes)
    if (mode.oscillates()) slowest = std::min(slowest, mode.frequency);
  constexpr double margin = 1.25; // frequencies move with the speed
  if (!std::isfinite(slowest) || margin * slowest <= end) return {};
  const double decade = std::pow(10, std::floor(std::log10(margin * slowest)));
  for (const double times : {1., 2., 5.})
    if (times * decade >= margin * slowest) return times * decade;
  return 10 * decade;
}

CampbellPlaces show_critical(Session& session, Ui& ui, CampbellView& drawn, const std::string& drive,
                             bool told) {
  const ImVec2 before = ImGui::GetContentRegionAvail();
  if (!drawn.critical || told) return {before};
  const std::vector<CriticalRow>& rows = *drawn.critical;
  if (rows.empty()) {
    paragraph("No critical speed in this range.", colors_of(ui).dim);
    note_widget(ui.widgets, "campbell/no_critical");
    const PlotRange range = campbell_range(session, drive);
    if (const auto end = farther_end(session, drive, range[1])) {
      const ShownUnit unit = shown_unit("rad/s", session.units);
      ImGui::SameLine(0, 10 * ui.scale);
      if (text_button(ui, "campbell/farther",
                      ("Follow to " + short_text(unit.shown(*end), 4) + " " + unit.text).c_str()))
        later(ui, [&session, &drawn, from = range[0], to = *end] {
          session.study.modes.campbell.from = from;
          session.study.modes.campbell.to = to;
          fit_plot(drawn.view);
        });
    }
    return {ImGui::GetContentRegionAvail()};
  }
  const float width = critical_table_width(ui), gap = 10 * ui.scale;
  const BesideDiagram place(ui, rows.size(), {before.x, before.y + ImGui::GetCursorPosY() - drawn.head});
  if (place.beside) {
    const ImVec2 at = ImGui::GetCursorPos();
    ImGui::SetCursorPos({at.x + before.x - width, at.y});
    critical_table(session, ui, rows, drawn.unit, drive, before.y);
    ImGui::SetCursorPos(at);
    return {{before.x - width - gap, before.y}};
  }
  if (place.below <= 0) return {before};
  return {{before.x, before.y - place.below - ImGui::GetStyle().ItemSpacing.y}, place.below};
}

// `told`: the critical speeds are, elsewhere.
void show_campbell(Session& session, Ui& ui, CampbellView& drawn, bool told) {
  CampbellState& campbell = session.study.modes.campbell;
  const UiColors& colors = colors_of(ui);
  const std::vector<std::string> speeds = drive_speeds(session.mechanism());
  const std::string drive = campbell_drive(session, speeds);
  if (drive.empty())
    return paragraph("A Campbell diagram is over the given speed of a drive, or a number that sets it, and "
                     "there is none here.",
                     colors.dim);
  if (!modes_refusal(session).empty()) return; // the list says it
  // Then axes without lines would say nothing; the list says why.
  const bool turns = turns_with_drives(session);
  if (!turns) campbell_choices(session, ui, drawn, speeds, drive);
  const auto& diagram = campbell.diagram;
  if (const std::string problem = campbell_problem(session); !problem.empty()) {
    paragraph(problem, colors.bad);
    note_widget(ui.widgets, "campbell/problem");
  }
  if (!diagram.found || turns) return;
  draw_campbell(session, drawn);
  if (!drawn.without_modes.empty()) {
    paragraph(drawn.without_modes, colors.dim);
    note_widget(ui.widgets, "campbell/without");
  }
  if (!campbell.on_branch && converged(session) && !solving(session) && !diagram.running())
    paragraph("The state that is shown lies on none of the branches followed over this range.", colors.warn);
  // What stands above only while it is followed does not change where the tables are.
  if (!diagram.running() || drawn.head <= 0) drawn.head = ImGui::GetCursorPosY();
  const CampbellPlaces places = show_critical(session, ui, drawn, diagram.found->of.drive, told);
  const PlotEvents events = plot_view(session, ui, "campbell", drawn.view, drawn.plot,
                                      {std::max(places.plot.x, 40.f), std::max(places.plot.y, 40.f)});
  if (places.below > 0)
    critical_table(session, ui, *drawn.critical, drawn.unit, diagram.found->of.drive, places.below);
  const auto set = [&](double value) {
    later(ui, [&session, drive, value] { change_parameter(session, drive, value); });
  };
  if (diagram.found->of.drive != drive) return;
  if (events.clicked_at) set((*events.clicked_at)[0]);
  if (events.dragged_at) set((*events.dragged_at)[0]);
}

} // namespace

void modes_panel(Session& session, Ui& ui, CampbellView& drawn, const CommandRunner& commands) {
  const float s = ui.scale;
  const float width = std::min(list_width * s, std::floor(0.48f * ImGui::GetContentRegionAvail().x));
  const ImVec2 room = ImGui::GetContentRegionAvail(),
               beside(std::floor(room.x - width - 14 * s), std::floor(room.y)); // as a child window's
  ImGui::BeginChild("modes", {width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 4 * s});
  const bool told = modes_list(session, ui, drawn, beside, commands);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("campbell", {0, 0}, false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  show_campbell(session, ui, drawn, told);
  ImGui::EndChild();
}

} // namespace flyball
