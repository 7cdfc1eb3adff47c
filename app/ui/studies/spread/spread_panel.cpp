// How the steady state scatters: which numbers have tolerances, what comes of them, and the histogram.
#include "app/plot/spread_plot.hpp"
#include "app/render/icons.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/task_bar.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace flyball {

namespace {

constexpr float spread_choices_width = 392, spread_words_width = 262; // points
constexpr double most_samples = 1e6;
constexpr std::array distributions{Distribution::normal, Distribution::uniform, Distribution::triangular};

const char* width_help(Distribution distribution) {
  return distribution == Distribution::normal ? "Its standard deviation." : "Half of its whole width.";
}

void distribution_choice(Ui& ui, const std::string& name, ChosenTolerance& chosen, float width) {
  ImGui::SetNextItemWidth(width);
  ImGui::PushStyleColor(ImGuiCol_Button, colors_of(ui).raised);
  const bool open = ImGui::BeginCombo(("##" + name).c_str(), std::string(word(chosen.distribution)).c_str());
  ImGui::PopStyleColor();
  if (!open) {
    note_widget(ui.widgets, name);
    help_on_hover("How the number is distributed about its value.");
    return;
  }
  for (const Distribution each : distributions) {
    const std::string text(word(each));
    if (ImGui::Selectable(text.c_str(), each == chosen.distribution)) chosen.distribution = each;
    note_widget(ui.widgets, name + "/" + text);
    if (each == chosen.distribution) mark_chosen(ui.widgets);
  }
  ImGui::EndCombo();
}

// "speed of spin   normal   1 %   in rad/s   x".
void tolerance_row(Session& session, Ui& ui, std::size_t i) {
  ChosenTolerance& chosen = session.study.spread.choice.tolerances[i];
  const float s = ui.scale, gap = 5 * s, start = ImGui::GetCursorPosX();
  const std::string name = "spread/" + chosen.address;
  const std::string unit = parameter_unit(session.mechanism(), chosen.address),
                    shown = shown_unit(unit, session.units).text;
  ImGui::AlignTextToFramePadding();
  clipped_text(number_phrase(session.mechanism(), chosen.address), 112 * s);
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + 116 * s);
  distribution_choice(ui, name + "/distribution", chosen, 92 * s);
  ImGui::SameLine(0, gap);
  quantity_field(session, ui,
                 {.name = name + "/width",
                  .value = chosen.width,
                  .unit = chosen.percent ? "%" : unit,
                  .help = width_help(chosen.distribution),
                  .least = Least::above_zero,
                  .set =
                      [&session, address = chosen.address](double typed) {
                        for (ChosenTolerance& each : session.study.spread.choice.tolerances)
                          if (each.address == address) each.width = typed;
                      },
                  .at_once = true},
                 70 * s);
  ImGui::SameLine(0, gap);
  const float remove = start + (spread_choices_width - 34) * s;
  const float room = remove - ImGui::GetCursorPosX() - 2 * ImGui::GetStyle().FramePadding.x;
  std::string other = chosen.percent ? (shown.empty() ? "plain" : "in " + shown) : "in %";
  if (ImGui::CalcTextSize(other.c_str()).x > room) other = cut_to(shown, room); // "N m/rad"
  if (text_button(ui, name + "/unit", other.c_str())) tell_in_percent(session, i, !chosen.percent);
  help_on_hover(("Tells the width in " +
                 (!chosen.percent ? "%"
                  : shown.empty() ? "plain numbers"
                                  : shown) +
                 "; it stays what it is.")
                    .c_str());
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(remove);
  if (margin_button(ui, name + "/remove", icon::close, "No tolerance."))
    later(ui, [&session, address = chosen.address] {
      std::erase_if(session.study.spread.choice.tolerances,
                    [&](const ChosenTolerance& each) { return each.address == address; });
    });
  if (chosen.percent && get_parameter(session.mechanism(), chosen.address) == 0)
    paragraph("It is zero, of which a part is nothing.", colors_of(ui).warn);
}

void another_tolerance(Session& session, Ui& ui) {
  if (const auto other = number_choice_row(
          session.mechanism(), ui, "spread/add", "Add", [&] { return numbers_without_tolerance(session); },
          "another number…", "A number that is to have a tolerance, too."))
    later(ui, [&session, address = *other] { add_tolerance(session, address); });
}

void output_choice(Session& session, Ui& ui) {
  const auto& found = session.study.spread.samples.found;
  if (!found) return;
  const std::vector<SpreadOutput>& outputs = found->result.outputs;
  std::vector<std::string> titles;
  for (const SpreadOutput& output : outputs)
    titles.push_back(label_words(session.mechanism(), output.name));
  if (const auto other = name_choice_row(ui, "spread/output", "Show", titles,
                                         label_words(session.mechanism(), session.study.spread.output),
                                         "The coordinate or measure whose samples are shown."))
    session.study.spread.output =
        outputs[static_cast<std::size_t>(std::ranges::find(titles, *other) - titles.begin())].name;
}

void samples_field(Session& session, Ui& ui) {
  const float width = row_label(ui, "Samples", "How many steady states are solved.");
  quantity_field(session, ui,
                 {.name = "spread/samples",
                  .value = static_cast<double>(session.study.spread.choice.samples),
                  .unit = "",
                  .help = "How many steady states are solved. What is told by them is as exact as one over "
                          "the root of their number.",
                  .least = Least::above_zero,
                  .set =
                      [&session](double typed) {
                        session.study.spread.choice.samples =
                            static_cast<std::size_t>(std::clamp(std::round(typed), 2., most_samples));
                      },
                  .at_once = true},
                 width);
}

void copy_samples_button(Session& session, Ui& ui, const char* text, bool stale) {
  if (!text_button(ui, "spread/copy", text)) return;
  const auto& found = *session.study.spread.samples.found;
  ImGui::SetClipboardText(spread_csv(found.result, found.of.tolerances, found.of.seed).c_str());
  session.notice = stale ? "The samples, which are out of date, are on the clipboard, as CSV."
                         : "The samples are on the clipboard, as CSV.";
}

// What is done with the samples, or how far they are, or that they are of other numbers by now: on top, in
// sight however many tolerances there are.
void spread_samples_line(Session& session, Ui& ui) {
  SpreadState& state = session.study.spread;
  const float below = ImGui::GetCursorPosY() + ImGui::GetFrameHeightWithSpacing();
  const bool long_wait = state.samples.running() && (state.samples.seconds() > 0.25 || !state.samples.found);
  const bool stale = state.stale && !state.samples.quick() && !state.samples.running();
  if (long_wait) {
    if (text_button(ui, "spread/cancel", "Cancel")) state.samples.stop();
    ImGui::SameLine();
    task_bar(ui, "spread/progress", state.samples.progress(), state.samples.seconds(),
             std::max(ImGui::GetContentRegionAvail().x - margin_width(ui), 20 * ui.scale));
  } else if (stale || !state.samples.problem.empty()) {
    if (text_button(ui, "spread/again", "Make again", true)) sample_spread(session);
    if (stale && state.samples.found) {
      ImGui::SameLine();
      ImGui::AlignTextToFramePadding();
      ImGui::TextColored(colors_of(ui).warn, "Out of date");
      note_widget(ui.widgets, "spread/stale", KeyUse::none);
      ImGui::SameLine();
      copy_samples_button(session, ui, "Copy", true);
      help_on_hover("Copies the samples as they are, of the numbers that stood when they were made.");
    }
  } else if (state.samples.found) {
    copy_samples_button(session, ui, "Copy the samples", false);
    ImGui::SameLine();
    if (text_button(ui, "spread/band", "Band on the response"))
      later(ui, [&session] {
        session.study.band.wanted = true;
        open_study(session, StudyKind::response);
      });
    help_on_hover("Shows the response curve with the band in which the middle 90 % of samples lie.");
  }
  ImGui::SetCursorPosY(below);
}

// Why there is nothing, or not what was asked for.
void spread_problems(Session& session, Ui& ui) {
  const SpreadState& state = session.study.spread;
  const UiColors& colors = colors_of(ui);
  if (!state.samples.problem.empty()) paragraph(state.samples.problem, colors.bad);
  if (!session.mistakes.empty())
    paragraph("There is nothing to solve until what is missing is mended.", colors.warn);
  else if (!converged(session) && !solving(session))
    paragraph("There is no steady state that could scatter.", colors.warn);
  else if (chosen_tolerances(session).empty())
    paragraph("No number has a tolerance.", colors.dim);
}

void spread_choices(Session& session, Ui& ui) {
  spread_samples_line(session, ui);
  spread_problems(session, ui);
  output_choice(session, ui);
  samples_field(session, ui);
  heading(ui, "Tolerances");
  // A number may be gone since the session was updated, by an undo in this frame.
  for (std::size_t i = 0; i < session.study.spread.choice.tolerances.size(); ++i)
    if (has_number(session.mechanism(), session.study.spread.choice.tolerances[i].address))
      tolerance_row(session, ui, i);
  another_tolerance(session, ui);
}

// With as many digits as its standard error leaves, and with that where it is more than rounding.
void estimated_row(const Session& session, const Ui& ui, const char* label, double value, double error,
                   const ShownUnit& unit, const char* help) {
  const NumberStyle& numbers = session.options.numbers;
  std::string text = value_text(value * unit.factor, error * unit.factor, numbers);
  if (error * unit.factor >= numbers.noise) text += " ± " + size_text(error * unit.factor, numbers);
  row(ui, label, text, unit.text.c_str(), help);
}

// Nothing scatters but rounding, of which nothing has a share.
bool is_unmoved(const SpreadOutput& output) {
  return !output.linear_shares.empty() && output.linear_deviation == 0 &&
         output.followed.deviation <= 1e-12 * std::abs(output.nominal);
}

void statistics_rows(const Session& session, Ui& ui, const SpreadOutput& output) {
  const SpreadStatistics& s = output.followed;
  const ShownUnit unit = shown_unit(output.unit, session.units);
  const NumberStyle& numbers = session.options.numbers;
  const auto plain = [&](const char* label, double value, double error, const char* help) {
    row(ui, label, value_text(value * unit.factor, error * unit.factor, numbers), unit.text.c_str(), help);
  };
  ImGui::PushFont(ui.fonts.strong);
  const std::string name = label_words(session.mechanism(), output.name),
                    cut = cut_to(name, ImGui::GetContentRegionAvail().x);
  ImGui::PopFont();
  heading(ui, cut.c_str());
  note_widget(ui.widgets, "spread/of", KeyUse::none);
  if (cut != name) help_on_hover(name.c_str());
  plain("Nominal", output.nominal, s.mean_error > 0 ? s.mean_error / 10 : 0, "The state that is shown.");
  if (s.count > 1) {
    estimated_row(session, ui, "Mean", s.mean, s.mean_error, unit,
                  "Of the samples that followed, with its standard error: chance of the samples.");
    note_widget(ui.widgets, "spread/mean");
    estimated_row(session, ui, "Deviation", s.deviation, s.deviation_error, unit,
                  "Standard deviation of the samples that followed, with its standard error.");
    note_widget(ui.widgets, "spread/deviation");
  }
  if (!output.linear_shares.empty())
    plain("by the rates", output.linear_deviation, output.linear_deviation / 1000,
          "What the rates of the nominal state promise, to first order.");
  if (s.count > 1) {
    plain("95 % from", s.lowest, s.deviation_error, "2.5 % of the samples that followed are below.");
    plain("to", s.highest, s.deviation_error, "2.5 % of the samples that followed are above.");
  }
  if (is_unmoved(output)) {
    paragraph("None of the tolerances moves it.", colors_of(ui).dim);
    note_widget(ui.widgets, "spread/unmoved", KeyUse::none);
  }
}

void fate_rows(const Session& session, Ui& ui, const SpreadAnswer& answer, const SpreadOutput& output) {
  heading(ui, (std::to_string(answer.samples) + " samples").c_str());
  const auto count = [&](SampleFate fate, const char* label, const char* help) {
    const std::size_t n = answer.counts[static_cast<std::size_t>(fate)];
    if (n == 0 && fate != SampleFate::followed) return;
    row(ui, label, std::to_string(n), "", help);
    note_widget(ui.widgets, "spread/fate/" + std::string(word(fate)));
  };
  count(SampleFate::followed, "followed", "The nominal state's branch leads there.");
  count(SampleFate::unstable, "to an unstable state", "They followed, to a state that is not stable.");
  count(
      SampleFate::elsewhere, "in another state",
      "The nominal state's branch does not lead there, as beyond a fold: the state that the drawn pose then "
      "leads to.");
  count(SampleFate::none, "without a state", "They have no steady state.");
  count(SampleFate::no_mechanism, "no mechanism",
        "Their numbers make none: a mass below zero, a loop that cannot be closed.");
  if (const SpreadStatistics& e = output.elsewhere; e.count > 0) {
    const ShownUnit unit = shown_unit(output.unit, session.units);
    const auto text = [&](double value) { return short_text(unit.shown(value), 5); };
    row(ui, "mean of the others", text(e.mean), unit.text.c_str(), "Of the samples in another steady state.");
    row(ui, "they lie from", text(e.least), unit.text.c_str(), "Of the samples in another steady state.");
    row(ui, "to", text(e.most), unit.text.c_str(), "Of the samples in another steady state.");
  }
  if (session.options.numbers.run_times)
    row(ui, "Run time", duration_text(answer.run_time_s, session.options.numbers), "");
}

// Digits that end at `right` (pixels of the window's contents).
void digits_to(const Ui& ui, const std::string& text, float right) {
  ImGui::PushFont(ui.fonts.digits);
  ImGui::SameLine();
  ImGui::SetCursorPosX(right - ImGui::CalcTextSize(text.c_str()).x);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopFont();
}

void share_rows(Ui& ui, const std::vector<Tolerance>& tolerances, const SpreadOutput& output) {
  heading(ui, "Shares of the variance");
  help_on_hover(
      "By the rates of the nominal state, and by a linear regression of the samples. What the latter "
      "leave of 100 % is not linear, or chance.");
  const float first = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - 86 * ui.scale,
              second = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - 6 * ui.scale;
  const UiColors& colors = colors_of(ui);
  const auto title = [&](const char* text, float right) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(right - ImGui::CalcTextSize(text).x);
    ImGui::TextColored(colors.dim, "%s", text);
  };
  ImGui::TextUnformatted("");
  title("by rates", first);
  title("by samples", second);
  const auto share = [&](const std::vector<double>& shares, std::size_t k) {
    return shares.empty() || is_unmoved(output) ? std::string("–")
                                                : rounded_text(std::round(1000 * shares[k]) / 10, 4) + " %";
  };
  for (std::size_t k = 0; k < tolerances.size(); ++k) {
    ImGui::PushStyleColor(ImGuiCol_Text, colors.dim);
    clipped_text(parameter_phrase(tolerances[k].address), first - ImGui::GetCursorPosX() - 56 * ui.scale);
    ImGui::PopStyleColor();
    digits_to(ui, share(output.linear_shares, k), first);
    digits_to(ui, share(output.sampled_shares, k), second);
    note_widget(ui.widgets, "spread/share/" + tolerances[k].address);
  }
}

void spread_words(Session& session, Ui& ui) {
  const SpreadOutput* output = shown_output(session);
  if (!output) return;
  const auto& found = *session.study.spread.samples.found;
  statistics_rows(session, ui, *output);
  share_rows(ui, found.of.tolerances, *output);
  fate_rows(session, ui, found.result, *output);
}

void draw_histogram(Session& session, Ui& ui, SpreadView& drawn) {
  const SpreadState& state = session.study.spread;
  const SpreadOutput* output = shown_output(session);
  if (!output) return;
  const SpreadView::Of of{state.samples.found, state.output, session.units};
  if (drawn.of != of) {
    const auto& all = state.samples.found->result.outputs;
    Plot plot = histogram_plot(state.samples.found->result, static_cast<std::size_t>(output - all.data()));
    plot.x.label = label_words(session.mechanism(), output->name);
    show_axis(plot, 0, output->unit, session.units);
    if (drawn.of.output != of.output) fit_plot(drawn.view);
    replace_plot(drawn.plot, std::move(plot));
    drawn.of = of;
  }
  const ImVec2 room = ImGui::GetContentRegionAvail();
  plot_view(session, ui, "spread", drawn.view, drawn.plot, {std::max(room.x, 40.f), std::max(room.y, 40.f)});
}

} // namespace

void spread_panel(Session& session, Ui& ui, SpreadView& drawn) {
  const float s = ui.scale;
  const auto column = [&](const char* name, float width, auto contents) {
    const float room = std::max(ImGui::GetContentRegionAvail().x, 40 * s); // in a narrow window
    ImGui::BeginChild(name, {std::min(width, room), 0});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
    contents(session, ui);
    ImGui::PopStyleVar();
    ImGui::EndChild();
    ImGui::SameLine(0, 14 * s);
  };
  column("choices", spread_choices_width * s, spread_choices);
  column("words", spread_words_width * s, spread_words);
  ImGui::BeginChild("plot", {0, 0}, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  draw_histogram(session, ui, drawn);
  ImGui::EndChild();
}

} // namespace flyball
