#include "app/ui/widgets/sensitivity_line.hpp"

#include "app/document/drawn_size.hpp"
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr double answer_patience = 0.15; // s: what was told a moment ago stays while the next is solved
constexpr float small_text = 0.87f;      // of the panel's
// Round-off: of the rate that moves most, and over a change of the number by as much as itself (rad or parts
// of the reach).
constexpr double nothing = 1e-9;

std::string per(const std::string& of, const std::string& unit) {
  if (unit.empty()) return of;
  const bool compound = unit.find_first_of(" /") != std::string::npos;
  return of + (compound ? "/(" + unit + ")" : "/" + unit);
}

// "−0.42": a sign always, for it is what one wants to know first.
std::string signed_text(double value) {
  return (value > 0 ? "+" : "") + short_text(value, 3);
}

bool has_rates(const Session& session) {
  return converged(session) && (!solving(session) || session.waited <= answer_patience);
}

const std::vector<ShownRate>& kept_rates(const Session& session, ShownRates& all,
                                         const ParameterControl& control) {
  KeptRates& kept = all[control.address];
  if (kept.ticket != session.answer.ticket || kept.value != control.value || kept.from != control.from ||
      kept.to != control.to || kept.units != session.units)
    kept = {session.answer.ticket, control.value,
            control.from,          control.to,
            session.units,         shown_rates(session, control.address)};
  return kept.rates;
}

} // namespace

std::vector<ShownRate> shown_rates(const Session& session, const std::string& address) {
  std::vector<ShownRate> out;
  if (!has_rates(session)) return out;
  const Solution& solution = session.answer.solution;
  const auto found = std::ranges::find(solution.sensitivities, address, &Sensitivity::address);
  const auto control = std::ranges::find(session.parameters, address, &ParameterControl::address);
  if (found == solution.sensitivities.end() || control == session.parameters.end()) return out;
  const double size = drawn_size(*session.answer.mechanism);
  // Rates come in the order of the coordinates: each is looked for from where the last was found.
  auto from = solution.coordinates.begin();
  for (const Sensitivity::Rate& rate : found->rates) {
    const auto same = [&](const CoordinateSolution& each) {
      return each.joint == rate.joint && each.index == rate.index;
    };
    auto c = std::find_if(from, solution.coordinates.end(), same);
    if (c == solution.coordinates.end()) c = std::find_if(solution.coordinates.begin(), from, same);
    if (c == solution.coordinates.end() || c->driven) continue;
    from = c;
    ShownRate shown;
    shown.name = found_words(*c);
    const ShownUnit of = coordinate_unit(c->angle, session.units),
                    by = shown_unit(control->unit, session.units);
    shown.value = rate.value * of.factor / by.factor;
    shown.unit = per(of.text, by.text);
    shown.share = std::abs(rate.value) / (c->angle ? 1 : size);
    out.push_back(std::move(shown));
  }
  // Rounding alone shall not decide between the two sides of a mechanism, and change its mind.
  std::ranges::stable_sort(out, std::greater<>(),
                           [](const ShownRate& rate) { return static_cast<float>(rate.share); });
  const double size_of_number = std::max(std::abs(control->value), std::abs(control->to - control->from));
  for (ShownRate& rate : out)
    if (rate.share <= nothing * out.front().share || rate.share * size_of_number <= nothing) rate.value = 0;
  return out;
}

float sensitivity_height(const Ui& ui) {
  return std::round(small_text * ui.fonts.text->FontSize);
}

void sensitivity_line(const Session& session, Ui& ui, ShownRates& all, const ParameterControl& control) {
  const float width = ImGui::GetContentRegionAvail().x, height = sensitivity_height(ui);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy({std::max(width, 1.f), height});
  if (!has_rates(session)) return;
  const std::vector<ShownRate>& rates = kept_rates(session, all, control);
  if (rates.empty()) return;
  const std::string name = "parameters/" + control.address + "/rate";
  note_widget(ui.widgets, name);
  const UiColors& colors = colors_of(ui);
  const ShownRate& most = rates.front();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImFont *text = ui.fonts.text, *digits = ui.fonts.digits;
  const float size = small_text * text->FontSize, digit_size = small_text * digits->FontSize;
  const std::string number = signed_text(most.value), unit = " " + most.unit;
  const float unit_width = text->CalcTextSizeA(size, 1e9f, 0, unit.c_str()).x;
  const float number_width = digits->CalcTextSizeA(digit_size, 1e9f, 0, number.c_str()).x;
  const float margin = 28 * ui.scale; // in line with the value above
  float x = from.x + width - margin - unit_width;
  list.PushClipRect(from, {from.x + width, from.y + height}, true);
  list.AddText(text, size, {x, from.y}, packed(colors.dim), unit.c_str());
  x -= number_width;
  list.AddText(digits, digit_size, {x, from.y + digits_drop(ui) * small_text}, packed(colors.dim),
               number.c_str());
  const float room = std::max(0.f, x - 6 * ui.scale - from.x);
  const std::string label = cut_to(most.name, room / small_text);
  x = from.x + room - text->CalcTextSizeA(size, 1e9f, 0, label.c_str()).x;
  list.AddText(text, size, {x, from.y}, packed(colors.dim), label.c_str());
  ui.widgets[name + "/name"] = {{x, from.y}, {from.x + room, from.y + height}};
  list.PopClipRect();
  if (!ImGui::IsItemHovered()) return;
  constexpr std::size_t most_lines = 12;
  std::string help = "What moves with it, at this steady state:";
  for (std::size_t i = 0; i < rates.size() && i < most_lines; ++i)
    help += "\n" + rates[i].name + "  " + signed_text(rates[i].value) + " " + rates[i].unit;
  if (rates.size() > most_lines) help += "\nand " + std::to_string(rates.size() - most_lines) + " more";
  help_on_hover(help.c_str());
}

} // namespace flyball
