// The transfer function of one input and one output: what is chosen, what it says, Bode's plots, poles and
// zeros.
#include "app/plot/transfer_plot.hpp"
#include "app/report/linear_model_file.hpp"
#include "app/session/periodic.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/stability_words.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace flyball {

namespace {

constexpr float transfer_words_width = 330; // points
constexpr double transfer_patience = 0.25;  // s: a shorter wait is not worth a bar

// Addresses as phrases, each once; what is no address stays as it is written.
std::vector<std::string> signal_phrases(const Session& session, const std::vector<std::string>& signals) {
  std::vector<std::string> phrases;
  std::set<std::string> taken;
  for (const std::string& signal : signals) {
    std::string phrase = signal_phrase(session, signal);
    phrases.push_back(taken.insert(phrase).second ? std::move(phrase) : signal);
  }
  return phrases;
}

void signal_row(const Session& session, Ui& ui, const char* name, const char* label,
                const std::vector<std::string>& signals, std::string& chosen, const char* help) {
  const std::vector<std::string> phrases = signal_phrases(session, signals);
  const auto at = std::ranges::find(signals, chosen);
  const std::string shown =
      at == signals.end() ? chosen : phrases[static_cast<std::size_t>(at - signals.begin())];
  if (const auto other = name_choice_row(ui, name, label, phrases, shown, help))
    chosen = signals[static_cast<std::size_t>(std::ranges::find(phrases, *other) - phrases.begin())];
}

std::string root_text(std::complex<double> s) {
  if (std::abs(s.imag()) <= 1e-9 * std::abs(s)) return short_text(s.real(), 5);
  return short_text(s.real(), 5) + " ± " + short_text(std::abs(s.imag()), 5) + " i";
}

void root_rows(Ui& ui, const char* title, const char* name, const std::vector<std::complex<double>>& roots,
               const char* help) {
  heading(ui, title);
  help_on_hover(help);
  std::size_t number = 0;
  for (const std::complex<double> s : roots) {
    if (s.imag() < 0) continue;
    row(ui, std::to_string(++number), root_text(s), "1/s");
  }
  note_widget(ui.widgets, name);
  if (number == 0) paragraph("None.", colors_of(ui).dim);
}

void transfer_words(Session& session, Ui& ui, TransferView& drawn, const CommandRunner& commands) {
  TransferState& state = session.study.transfer;
  const UiColors& colors = colors_of(ui);
  signal_row(session, ui, "transfer/input", "Input", transfer_inputs(session), state.choice.input,
             "What acts: a number, or a torque or force that is added.");
  signal_row(session, ui, "transfer/output", "Output", transfer_outputs(session), state.choice.output,
             "What is looked at.");
  for (const bool hertz : {true, false}) {
    if (text_button(ui, hertz ? "transfer/hertz" : "transfer/radians", hertz ? "Hz" : "rad/s",
                    drawn.hertz == hertz))
      drawn.hertz = hertz;
    help_on_hover("The unit of frequencies.");
    ImGui::SameLine(0, (hertz ? 2 : 8) * ui.scale);
  }
  const bool any = has_transfer(session);
  ImGui::BeginDisabled(!any);
  if (text_button(ui, "transfer/save", "Export the model…")) commands.run("file.model");
  ImGui::EndDisabled();
  help_on_hover("A, B, C, D for MATLAB, Python or NumPy, or as JSON.");
  if (state.found.running() && state.found.seconds() > transfer_patience) {
    if (text_button(ui, "transfer/cancel", "Cancel")) state.found.stop();
    ImGui::SameLine();
    task_bar(ui, "transfer/progress", state.found.progress(), state.found.seconds(),
             std::max(ImGui::GetContentRegionAvail().x - margin_width(ui), 20 * ui.scale));
  }
  if (!state.found.problem.empty()) {
    paragraph(transfer_problem(session), colors.warn);
    note_widget(ui.widgets, "transfer/problem");
  } else if (!session.mistakes.empty())
    paragraph("There is nothing to solve until what is missing is mended.", colors.warn);
  else if (!converged(session) && !solving(session))
    paragraph(periodic_motion(session)
                  ? "A linear model is about a steady state, and there is none: it moves periodically with "
                    "the drives. Response shows that over a number."
                  : "There is no steady state to make a model about.",
              colors.warn);
  if (!any) return;
  const FoundTransfer& found = state.found.found->result;
  const LinearModel& model = found.model;
  if (has_friction(session.mechanism())) {
    const std::string text = friction_text(model); // of what it holds
    paragraph(text.empty() ? friction_left_out : text, colors.warn);
    note_widget(ui.widgets, "transfer/friction");
  }
  const NumberStyle& numbers = session.options.numbers;
  const std::string unit = written_unit(transfer_unit(model.outputs[0], model.inputs[0]));
  const bool effect =
      std::ranges::any_of(found.response, [](const BodePoint& point) { return point.magnitude != 0; });
  heading(ui, "Transfer function");
  if (!effect) {
    paragraph("It is 0: about this state the input has no effect on the output.", colors.dim);
    note_widget(ui.widgets, "transfer/no effect");
  } else if (model.gain) {
    const double gain = (*model.gain)(0, 0);
    row(ui, "Static gain", value_text(gain, std::abs(gain) * 1e-6, numbers), unit.c_str(),
        "What a lasting change of the input by one unit comes to in the end, where the state is stable.");
    note_widget(ui.widgets, "transfer/gain");
  } else {
    paragraph("Something integrates: there is no static gain.", colors.dim);
  }
  if (effect) {
    row(ui, "0 dB stands for", "1", unit.c_str(),
        "Of the magnitude: one SI unit of the output by one of the input.");
    note_widget(ui.widgets, "transfer/reference");
  }
  row(ui, "States", std::to_string(model.states.size()), "", "Coordinates and their rates.");
  if (model.output_error[0] > 0)
    row(ui, "Relative error", magnitude_text(model.output_error[0], numbers), "",
        "Estimated, of the output's rows C and D; A and B are exact to rounding.");
  if (numbers.run_times)
    row(ui, "Run time", duration_text(model.steady.run_time_s + model.run_time_s, numbers), "");
  root_rows(ui, "Poles", "transfer/poles", model.poles, "Of the whole mechanism: its eigenvalues.");
  if (found.has_zeros)
    root_rows(ui, "Zeros", "transfer/zeros", found.zeros,
              "Where the output does not feel the input; one that a pole equals cancels it.");
}

// The frequency at which a plot is read, by the pointer or by keys.
std::optional<double> read_place(const PlotView& view) {
  return view.keyed ? std::optional((*view.keyed)[0]) : view.cursor;
}

void draw_transfer(Session& session, Ui& ui, TransferView& drawn) {
  const TransferState& state = session.study.transfer;
  if (!has_transfer(session)) return;
  const FoundTransfer& found = state.found.found->result;
  if (drawn.of != TransferView::Of{state.found.found, drawn.hertz}) {
    const bool other = drawn.fitted != state.found.found->of.choice || drawn.of.hertz != drawn.hertz;
    drawn.of = {state.found.found, drawn.hertz};
    drawn.fitted = state.found.found->of.choice;
    replace_plot(drawn.magnitude, magnitude_plot(found.response, drawn.hertz));
    replace_plot(drawn.phase, phase_plot(found.response, drawn.hertz));
    replace_plot(drawn.roots, pole_zero_plot(found.model.poles, found.zeros));
    if (other)
      for (PlotView* view : {&drawn.magnitude_view, &drawn.phase_view, &drawn.roots_view})
        fit_plot(*view);
  }
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = 8 * ui.scale, left = std::max(0.62f * (room.x - gap), 40.f),
              right = std::max(room.x - gap - left, 40.f), high = std::max((room.y - gap) / 2, 40.f);
  PlotView &gain = drawn.magnitude_view, &phase = drawn.phase_view;
  const float numbers = 2.4f * ImGui::GetFontSize(); // of the frequency, below the lower frame
  const ImVec2 upper(left, std::max(high - numbers / 2, 40.f)),
      lower(left, std::max(high + numbers / 2, 40.f));
  align_plots(ui, {{gain, drawn.magnitude, upper}, {phase, drawn.phase, lower}});
  const PlotLook before = gain.look;
  ImGui::BeginGroup();
  gain.followed = read_place(phase);
  plot_view(session, ui, "transfer magnitude", gain, drawn.magnitude, upper);
  phase.followed = read_place(gain);
  plot_view(session, ui, "transfer phase", phase, drawn.phase, lower);
  // Zoomed along the frequency together, too.
  for (const PlotLook& look : {gain.look, phase.look})
    if (look.range[0] != before.range[0] || look.logarithmic[0] != before.logarithmic[0])
      for (PlotLook* own : {&gain.look, &phase.look}) {
        own->range[0] = look.range[0];
        own->logarithmic[0] = look.logarithmic[0];
      }
  ImGui::EndGroup();
  ImGui::SameLine(0, gap);
  plot_view(session, ui, "poles and zeros", drawn.roots_view, drawn.roots, {right, std::max(room.y, 40.f)});
}

} // namespace

void transfer_panel(Session& session, Ui& ui, TransferView& drawn, const CommandRunner& commands) {
  const float s = ui.scale;
  ImGui::BeginChild("words", {transfer_words_width * s, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  transfer_words(session, ui, drawn, commands);
  ImGui::PopStyleVar();
  ImGui::EndChild();
  ImGui::SameLine(0, 14 * s);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  draw_transfer(session, ui, drawn);
  ImGui::EndChild();
}

} // namespace flyball
