// The motion's choices, its transport and its plots.
#include "app/render/icons.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr float motion_choices_width = 292; // points

constexpr std::array<std::string_view, 4> start_names{"Drawn, carried along", "Drawn, standing still",
                                                      "Steady, with a kick", "The kept state"};
constexpr std::array<std::string_view, 4> method_names{"Automatic", "BDF (implicit)", "Adams",
                                                       "Runge-Kutta 8"};
constexpr std::array<std::string_view, 2> change_names{"Begins anew", "Goes on"};

// Changes of choices begin a new run, after this frame.
void anew(Session& session, Ui& ui) {
  later(ui, [&session] { restart_motion(session); });
}

void start_choice(Session& session, Ui& ui) {
  MotionState& motion = session.motion;
  const bool kept = !motion.saved.coordinates.empty();
  const std::span<const std::string_view> offered(start_names.data(), kept ? 4 : 3);
  if (const auto chosen =
          choice_row(ui, "motion/start", "Start", offered, static_cast<std::size_t>(motion.start),
                     "Where the motion begins: the drawn pose carried along by the drives, the drawn "
                     "pose at rest in the world, the steady state pushed, or a state kept before.")) {
    motion.start = static_cast<Start>(*chosen);
    anew(session, ui);
  }
  if (motion.start != Start::equilibrium) return;
  const std::vector<std::string> names = free_coordinates(session);
  if (names.empty()) return;
  const bool known = std::ranges::find(names, motion.kicked) != names.end();
  const std::string& kicked = known ? motion.kicked : names.front();
  bool angle = true;
  std::vector<std::string> words; // as `names`
  std::size_t present = 0;
  for (const CoordinateSolution& c : session.answer.summary.coordinates) {
    if (c.driven || c.dependent) continue;
    if (names[words.size()] == kicked) {
      angle = c.angle;
      present = words.size();
    }
    words.push_back(coordinate_words(c));
  }
  if (const auto chosen = name_choice_row(ui, "motion/kicked", "Kick", words, words[present],
                                          "The coordinate that gets a speed.")) {
    motion.kicked = names[static_cast<std::size_t>(std::ranges::find(words, *chosen) - words.begin())];
    anew(session, ui);
  }
  if (plain_quantity_field(session, ui, "motion/kick", "Speed", angle ? "rad/s" : "m/s", "The speed it gets.",
                           motion.kick))
    anew(session, ui);
}

void integration_choices(Session& session, Ui& ui) {
  MotionState& motion = session.motion;
  if (plain_quantity_field(session, ui, "motion/duration", "Duration", "s", "How long a motion is computed.",
                           motion.duration, Least::above_zero))
    anew(session, ui);
  if (const auto chosen =
          choice_row(ui, "motion/method", "Integrator", method_names, static_cast<std::size_t>(motion.method),
                     "Implicit steps where fast motions die out early, explicit ones for gentle "
                     "scenes; automatic judges by the linearised motion.")) {
    motion.method = static_cast<Integrator>(*chosen);
    anew(session, ui);
  }
  double tolerance = motion.tolerance;
  if (plain_quantity_field(
          session, ui, "motion/tolerance", "Tolerance", "",
          "Of the error of a step: angles in rad, lengths as parts of the mechanism's size; 1e-3 to 1e-14.",
          tolerance, Least::above_zero)) {
    motion.tolerance = std::clamp(tolerance, 1e-14, 1e-3);
    anew(session, ui);
  }
  if (const auto chosen =
          choice_row(ui, "motion/on_change", "On a change", change_names, motion.go_on ? 1 : 0,
                     "Whether a change of a number begins the motion anew or goes on from the "
                     "moment that is shown."))
    motion.go_on = *chosen == 1;
}

// A tick and its word; returns whether it was clicked.
bool tick(Ui& ui, const char* name, const char* text, bool on, const char* help) {
  ImGui::PushID(name);
  const bool clicked = ImGui::Checkbox(text, &on);
  ImGui::PopID();
  note_widget(ui.widgets, name);
  help_on_hover(help);
  return clicked;
}

void run_choices(Session& session, Ui& ui) {
  MotionState& motion = session.motion;
  if (has_dampers(session.mechanism())) {
    const std::array<const char*, 2> names{"motion/damped", "motion/undamped"}, labels{"Damped", "Undamped"};
    const std::array<const char*, 2> help{"The motion with the dampers.", "The motion with all dampers off."};
    for (std::size_t i = 0; i < 2; ++i) {
      // One of the two has to be shown.
      const bool last = motion.runs[i].wanted && !motion.runs[1 - i].wanted;
      ImGui::BeginDisabled(last);
      if (tick(ui, names[i], labels[i], motion.runs[i].wanted, help[i])) {
        motion.runs[i].wanted = !motion.runs[i].wanted;
        anew(session, ui);
      }
      ImGui::EndDisabled();
      ImGui::SameLine();
    }
  }
  if (tick(ui, "motion/beside", "Beside", motion.beside,
           "The motion in a view of its own beside the steady state; or else in the same, in amber."))
    motion.beside = !motion.beside;
}

double greatest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values)
    most = std::max(most, std::abs(v));
  return most;
}

// Whether it has settled, or why it ended.
void outcome(Session& session, Ui& ui) {
  const UiColors& colors = colors_of(ui);
  for (const std::string& problem : motion_problems(session))
    paragraph(problem, colors.bad);
  if (!shown_motion(session)) return;
  if (session.motion.elsewhere) {
    paragraph(elsewhere_words(session), colors.text);
    note_widget(ui.widgets, "motion/elsewhere");
    if (text_button(ui, "motion/go elsewhere", "Show that steady state"))
      later(ui, [&session] { go_elsewhere(session); });
    help_on_hover("The view, the results and the studies are of the steady state that the motion runs into.");
  } else if (session.motion.settled) {
    const bool arrived = session.motion.settled->time.has_value();
    paragraph(settled_words(session), arrived ? colors.good : colors.text);
    note_widget(ui.widgets, "motion/settled");
  } else if (!converged(session) && !solving(session)) {
    paragraph("There is no steady state to settle in.", colors.dim);
  }
}

// What the run's numbers are worth and what they cost.
void accuracy(const Session& session, Ui& ui) {
  const UiColors& colors = colors_of(ui);
  const NumberStyle& numbers = session.options.numbers;
  const MotionRun* shown = shown_motion(session);
  if (!shown) return;
  const Run& run = *shown->run;
  heading(ui, "Accuracy");
  const EnergyTracks& e = run.energy;
  row(ui, "Energy balance", "± " + magnitude_text(greatest(e.balance), numbers), "J",
      "Stored and dissipated energy less what the drives delivered: what the integrator has lost or made.");
  row(ui, "Largest energy", short_text(std::max(greatest(e.kinetic), greatest(e.delivered)), 2), "J",
      "The largest kinetic or delivered energy, beside which the balance is to be seen.");
  for (const MotionRun& motion : session.motion.runs)
    if (motion.wanted && motion.run && !motion.run->damped && !motion.run->energy.jacobi.empty()) {
      const auto [least, most] = std::ranges::minmax(motion.run->energy.jacobi);
      row(ui, "Jacobi integral", "± " + magnitude_text(most - least, numbers), "J",
          "How far T₂ + V - T₀ of the undamped motion has drifted; it is conserved.");
    }
  const RunStatistics& s = run.statistics;
  if (s.position_drift > 0)
    row(ui, "Loops open by", magnitude_text(s.position_drift, numbers), "",
        "The worst equation of the loops over all samples: lengths in m, angles in rad, directions as "
        "numbers.");
  paragraph(run.method_reason, colors.dim);
  for (const std::string& note : run.notes)
    paragraph(note, colors.dim);
  row(ui, "Steps", std::to_string(s.steps), "");
  if (numbers.run_times) row(ui, "Run time", duration_text(s.run_time_s, numbers), "");
}

// "0.12 of 5 s", in the room beside the buttons.
void progress_bar(const Session& session, Ui& ui) {
  const double whole = session.motion.duration, done = computed_motion(session).value_or(0);
  const std::string words = short_text(done, 2) + " of " + short_text(whole, 4) + " s";
  bar_with_words(ui, static_cast<float>(std::clamp(done / whole, 0., 1.)),
                 std::max(ImGui::GetContentRegionAvail().x, 1.f), words);
  note_widget(ui.widgets, "motion/progress");
  help_on_hover(("Computed so far: " + words + ".").c_str());
}

void run_settings(Session& session, Ui& ui) {
  outcome(session, ui);
  run_choices(session, ui);
  start_choice(session, ui);
  integration_choices(session, ui);
  accuracy(session, ui);
}

void motion_choices(Session& session, Ui& ui, const CommandRunner& commands) {
  const bool computing = computing_motion(session);
  if (text_button(ui, "motion/run", computing ? "Restart" : "Run again", true)) anew(session, ui);
  if (computing) {
    ImGui::SameLine();
    if (text_button(ui, "motion/stop", "Stop")) stop_motion(session);
    ImGui::SameLine();
    progress_bar(session, ui);
  } else if (shown_motion(session)) {
    ImGui::SameLine();
    if (text_button(ui, "motion/keep", "Keep state")) keep_motion_state(session);
    help_on_hover("Keeps the state that is shown, to start from.");
    ImGui::SameLine();
    if (text_button(ui, "motion/export", "Export…")) commands.run("study.export");
    help_on_hover("Saves the run as MP4, GIF or numbered pictures.");
  }
  run_settings(session, ui);
}

// The combo above a plot.
void quantity_choice(Ui& ui, MotionPlot& plot, const std::vector<MotionQuantity>& all,
                     const std::string& name, float width) {
  const auto chosen = std::ranges::find(all, plot.quantity, &MotionQuantity::key);
  ImGui::SetNextItemWidth(std::min(width, 220 * ui.scale));
  ImGui::PushID(name.c_str());
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(ui).raised);
  const bool open = ImGui::BeginCombo("##quantity", chosen == all.end() ? "" : chosen->title.c_str(),
                                      ImGuiComboFlags_HeightLarge);
  ImGui::PopStyleColor();
  if (open) {
    std::string group;
    for (const MotionQuantity& each : all) {
      if (each.group != group) ImGui::TextDisabled("%s", (group = each.group).c_str());
      ImGui::PushID(each.key.c_str());
      if (ImGui::Selectable(each.title.c_str(), each.key == plot.quantity)) {
        plot.quantity = each.key;
        fit_plot(plot.view);
      }
      ImGui::PopID();
      note_widget(ui.widgets, name + "/" + each.key);
      if (each.key == plot.quantity) mark_chosen(ui.widgets);
    }
    ImGui::EndCombo();
  } else {
    note_widget(ui.widgets, name);
  }
  ImGui::PopID();
}

// Where the play head stands on the first curve that is shown.
std::optional<PlotMarker> play_head(const Session& session, const Plot& plot, const PlotLook& look) {
  const PlotCurve* shown = nullptr;
  for (const PlotCurve& curve : plot.curves)
    if (is_shown(curve, look) && curve.points.size() > 1) shown = &curve; // the last lies on top
  if (!shown) return std::nullopt;
  const double time = std::clamp(session.playback.time, shown->points.front()[0], shown->points.back()[0]);
  auto after = std::ranges::lower_bound(shown->points, time, {}, [](const auto& p) { return p[0]; });
  if (after == shown->points.begin()) ++after;
  const auto &b = *after, &a = *(after - 1);
  const double part = (time - a[0]) / (b[0] - a[0]);
  return PlotMarker{time, a[1] + part * (b[1] - a[1]), ""};
}

// What a plot shows at first: the first coordinate, and the last, for those between are often its like; where
// there is but one, its speed. Of what goes on and on its speed, which the steady state is solved for.
std::string first_shown(const Session& session, const std::vector<MotionQuantity>& all, std::size_t plot) {
  const auto count =
      static_cast<std::size_t>(std::ranges::count(all, std::string("Coordinates"), &MotionQuantity::group));
  const auto goes_on = [&](const std::string& key) {
    return std::ranges::any_of(session.answer.solution.coordinates, [&](const CoordinateSolution& c) {
      return c.speed && key == "value " + coordinate_label(c);
    });
  };
  std::size_t chosen = plot == 0 ? 0 : count > 1 ? count - 1 : 1;
  if (plot > 0 && count == 1 && goes_on(all[0].key)) chosen = 2; // its speed is in the first plot
  if (chosen >= all.size()) return "";
  const std::string& key = all[chosen].key;
  return goes_on(key) ? "rate" + key.substr(key.find(' ')) : key;
}

void draw_plots(Session& session, Ui& ui, std::array<MotionPlot, 2>& shown_plots) {
  const MotionRun* shown = shown_motion(session);
  if (!shown) {
    paragraph(computing_motion(session) ? "Computing…" : "No motion.", colors_of(ui).dim);
    return;
  }
  const std::vector<MotionQuantity> all = motion_quantities(*shown->run);
  for (std::size_t i = 0; i < shown_plots.size(); ++i) {
    const bool known = std::ranges::find(all, shown_plots[i].quantity, &MotionQuantity::key) != all.end();
    if (!known) shown_plots[i].quantity = first_shown(session, all, i);
  }
  const float gap = 10 * ui.scale, whole = ImGui::GetContentRegionAvail().x;
  const bool narrow = whole < 520 * ui.scale;
  const std::size_t count = narrow ? 1 : shown_plots.size();
  const float width = std::floor((whole - gap * static_cast<float>(count - 1)) / static_cast<float>(count));
  for (std::size_t i = 0; i < count; ++i) {
    MotionPlot& each = shown_plots[i];
    if (i > 0) ImGui::SameLine(0, gap);
    ImGui::BeginGroup();
    const std::string name = "motion/plot" + std::to_string(i + 1);
    quantity_choice(ui, each, all, name, width);
    const auto run = [&](std::size_t k) {
      return session.motion.runs[k].wanted ? session.motion.runs[k].run : nullptr;
    };
    const MotionPlot::Of of{{run(0), run(1)}, each.quantity, session.answer.ticket, session.units};
    if (each.of != of) {
      each.of = of;
      replace_plot(each.plot, motion_plot(session, each.quantity));
    }
    each.plot.marker = play_head(session, each.plot, each.view.look);
    const PlotEvents events = plot_view(session, ui, name, each.view, each.plot,
                                        {width, std::max(ImGui::GetContentRegionAvail().y, 40.f)});
    if (events.dragged_to) {
      session.playback.playing = false;
      seek_motion(session, events.dragged_to->x);
    }
    ImGui::EndGroup();
  }
}

} // namespace

void motion_transport(Session& session, Ui& ui, float width) {
  const float right = ImGui::GetCursorPosX() + width, top = ImGui::GetCursorPosY();
  const MotionRun* shown = shown_motion(session);
  ImGui::BeginDisabled(!shown);
  const bool playing = session.playback.playing;
  const auto next = [&] { ImGui::SameLine(0, 2 * ui.scale); };
  const double from = shown ? shown->run->time.front() : 0, last = shown ? shown->run->time.back() : 1;
  if (icon_button(ui, "motion/first", icon::step_backward, "Back to the beginning"))
    seek_motion(session, from);
  next();
  if (icon_button(ui, "motion/back", icon::chevron_left, "One sample back")) step_motion(session, -1);
  next();
  if (icon_button(ui, "motion/play", playing ? icon::pause : icon::play,
                  playing ? "Pause (Space)" : "Play (Space)", playing))
    play(session, !playing);
  next();
  if (icon_button(ui, "motion/forward", icon::chevron_right, "One sample on")) step_motion(session, 1);
  next();
  if (icon_button(ui, "motion/loop", icon::refresh, "Begin again at the end", session.motion.loop))
    session.motion.loop = !session.motion.loop;
  ImGui::SameLine();
  factor_combo(session, ui, "motion/factor", 58 * ui.scale);
  ImGui::SameLine();
  double time = session.playback.time;
  const double end = std::max(last, from + session.motion.duration);
  const std::string text = short_text(std::round(time * 1000) / 1000, 6) + " s";
  const float room = ImGui::CalcTextSize("0000.000 s").x + 8 * ui.scale;
  ImGui::SetNextItemWidth(std::max(right - ImGui::GetCursorPosX() - room, 40.f));
  ImGui::SetCursorPosY(top + ui.scale);
  const bool dragged = ImGui::SliderScalar("##scrub", ImGuiDataType_Double, &time, &from, &end, "");
  note_widget(ui.widgets, "motion/scrub", KeyUse::slide);
  if (nudge_value(ui, "motion/scrub", time, from, end) || dragged) {
    session.playback.playing = false;
    seek_motion(session, time);
  }
  ImGui::SameLine();
  ImGui::SetCursorPosY(top + ui.scale + digits_drop(ui)); // words begin lower beside frames as it is
  ImGui::PushFont(ui.fonts.digits);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
  ImGui::EndDisabled();
}

void motion_panel(Session& session, Ui& ui, std::array<MotionPlot, 2>& plots, const CommandRunner& commands,
                  bool with_transport) {
  const float s = ui.scale;
  ImGui::BeginChild("choices", {motion_choices_width * s, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  motion_choices(session, ui, commands);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plots", {0, 0}, false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (session.motion.on) {
    if (with_transport) motion_transport(session, ui, ImGui::GetContentRegionAvail().x);
    draw_plots(session, ui, plots);
  } else {
    paragraph("Run again shows the motion.", colors_of(ui).dim);
  }
  ImGui::EndChild();
}

} // namespace flyball
