#include "app/ui/widgets/quantity_field.hpp"

#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/render/icons.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/quantity.hpp"
#include "app/session/units.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/number_menu.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <optional>

namespace flyball {

namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string too_small(double value, Least least) {
  if (least == Least::zero && value < 0) return "Expected zero or more.";
  if (least == Least::above_zero && !(value > 0)) return "Expected more than zero.";
  return {};
}

// The field's number as it is shown and typed, in the unit that the person has chosen.
struct ShownNumber {
  ShownUnit unit;
  double value = 0;

  ShownNumber(const Session& session, const QuantityField& field)
      : unit(shown_unit(field.unit, session.units)), value(unit.shown(field.value)) {}
};

// A double click selects the number alone, and whoever types another with its unit over it leaves the former
// unit behind that: "1 kg kg". Then it gives way.
Quantity typed_quantity(std::string_view text, const std::string& unit, const std::string& shown) {
  const Quantity typed = parse_quantity(text, unit, shown);
  if (typed || shown.empty() || !text.ends_with(" " + shown)) return typed;
  const Quantity without = parse_quantity(text.substr(0, text.size() - shown.size()), unit, shown);
  return without ? without : typed;
}

Quantity typed_quantity(const Session& session, const std::string& text, const QuantityField& field) {
  return typed_quantity(text, field.unit, shown_unit(field.unit, session.units).text);
}

struct NumberWithUnit {
  double value = 0;
  std::string unit;
};

// The same unit without prefixes and the like, symbol by symbol: "N/m" of "N/mm", "rad/s" of "rpm"; empty
// where that has no name.
std::string si_unit_of(std::string_view text) {
  constexpr std::array bases{"m", "kg", "s", "rad", "rad/s", "N", "N m", "W", "Pa"};
  std::string si;
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && (std::isalpha(static_cast<unsigned char>(text[i])) != 0 ||
                               static_cast<unsigned char>(text[i]) >= 0x80);
  };
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (is_letter(end))
      ++end;
    if (end == i) {
      si += text[i++];
      continue;
    }
    const std::optional<Unit> symbol = find_unit(text.substr(i, end - i));
    if (!symbol) return {};
    const auto* const base = std::ranges::find_if(
        bases, [&](const char* each) { return parse_unit(each)->dimension == symbol->dimension; });
    si += symbol->factor == 1 ? symbol->name : base != bases.end() ? *base : "";
    i = end;
  }
  const std::optional<Unit> named = parse_unit(si), meant = parse_unit(text);
  return named && meant && named->factor == 1 && named->dimension == meant->dimension ? si : "";
}

// "3 N m s", "12 mm" where the field's unit is open: in SI units; nothing for what else is typed.
std::optional<NumberWithUnit> with_own_unit(const QuantityField& field, const std::string& typed) {
  if (!field.set_with_unit) return {};
  const std::string text = plain_signs(typed);
  for (std::size_t i = 1; i < text.size(); ++i) {
    const std::size_t begin = text.find_first_not_of(' ', i);
    if (begin == std::string::npos) break;
    const std::string unit = text.substr(begin);
    const std::optional<Unit> read = parse_unit(unit);
    const Quantity number = read ? parse_quantity(text.substr(0, i), "") : Quantity{0, "No unit."};
    std::string si = number ? si_unit_of(unit) : "";
    if (!si.empty()) return NumberWithUnit{times_unit(number.value, read->factor), std::move(si)};
  }
  return {};
}

bool is_expression(const QuantityField& field, std::string_view text) {
  return !place_of(field).empty() && text.starts_with('=');
}

// "60 rpm", "2*3": it rests on nothing that could change.
bool is_of_numbers_alone(const std::string& text) {
  try {
    const Expression expression(text, Expression::Results::allowed);
    return expression.names().empty() && expression.results().empty();
  } catch (const ExpressionError&) {
    return false;
  }
}

// "2*3", "exp(2)": of numbers alone, without a unit.
bool is_plain(const std::string& numbers) {
  try {
    return Expression(numbers).dimension({}).plain;
  } catch (const ExpressionError&) {
    return false;
  }
}

// "60 mm", "(2*3)*1 mm"; the unit as in files ("deg").
std::string times_one(const std::string& numbers, const std::string& unit) {
  const std::size_t begin = numbers.find_first_not_of(' '), end = numbers.find_last_not_of(' ') + 1;
  const std::string trimmed = numbers.substr(begin, end - begin);
  const bool single = trimmed.find_first_not_of("0123456789.") == std::string::npos;
  return (single ? trimmed : "(" + trimmed + ")*1") + " " + unit;
}

// An expression of numbers alone has the value that it has without the "=": "=60" is 60 mm where these are
// shown. In the mechanism numbers without a unit are in SI units, so theirs is written behind them.
std::string with_field_unit(const Session& session, const QuantityField& field, const std::string& typed) {
  const std::string text = plain_signs(typed);
  const ShownUnit shown = shown_unit(field.unit, session.units);
  const std::optional<Unit> unit = parse_unit(field.unit);
  if (shown.text.empty() || !unit || !is_of_numbers_alone(text)) return text;
  std::string written = plain_signs(shown.text);
  if (written.starts_with("°")) written.replace(0, std::string("°").size(), "deg");
  const std::string united = times_one(text, written);
  const Quantity value = typed_quantity(session, text, field);
  if (!value) return is_plain(text) ? united : text; // "exp(2)"; "2 kg" of a length
  const double meant = times_unit(value.value, unit->factor);
  const auto means = [&](const std::string& numbers) { // all of it in SI units and radians
    return std::abs(Expression(numbers).evaluate({}).value - meant) <= 1e-12 * std::abs(meant);
  };
  if (means(text)) return text;
  if (means(united)) return united;
  return number_text(shown.shown(value.value)) + " " + written; // "10 + 5 mm"
}

// The expression that is kept, to be typed at: with the unit that it has in files where the field's is
// another.
std::string typed_again(const Session& session, const QuantityField& field, const std::string& kept) {
  if (with_field_unit(session, field, kept) == kept || !is_plain(kept)) return kept;
  return times_one(kept, field.unit == "deg" ? "rad" : field.unit);
}

// What a typed expression does; a point's name alone gives all three numbers of a vector.
void set_typed_expression(Mechanism& mechanism, const QuantityField& field, const std::string& text) {
  for (const std::string& place : field.also)
    set_expression(mechanism, place, text);
  const std::string vector = vector_of(field);
  if (!vector.empty() && point_index(mechanism, text) >= 0)
    stand_at_point(mechanism, vector, text);
  else
    set_expression(mechanism, place_of(field), text);
}

std::string mistake_in(const Session& session, const std::string& text, const QuantityField& field) {
  if (is_expression(field, text)) {
    if (text.find_first_not_of(' ', 1) == std::string::npos) return "Expected an expression after the \"=\".";
    try {
      Mechanism copy = session.document.stored();
      set_typed_expression(copy, field, with_field_unit(session, field, text.substr(1)));
      if (field.least == Least::any) return {}; // a law may stand in the number's place
      return too_small(expressed_value(copy, place_of(field)), field.least);
    } catch (const SceneError& error) {
      return error.expected();
    }
  }
  if (with_own_unit(field, text)) return {};
  const Quantity typed = typed_quantity(session, text, field);
  if (!typed && field.set_with_unit)
    return "Expected a number, by itself or with a unit, e.g. 2, 12 mm or 3 N m s.";
  constexpr double largest = 1e30; // as in a scene
  if (typed && std::abs(typed.value) > largest) return "Expected no more than 1e30 in size.";
  return typed ? too_small(typed.value, field.least) : typed.mistake;
}

bool has_slider(const Session& session, const std::string& address) {
  return !address.empty() && std::ranges::find(session.parameters, address, &ParameterControl::address) !=
                                 session.parameters.end();
}

std::string set_step(const QuantityField& field) {
  return "Set " + parameter_phrase(place_of(field)) + and_more(field.also.size());
}

// A number without the dust of binary arithmetic.
double rounded(double value) {
  return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
}

// The number, and those that are edited with it, are by themselves this value (in the field's unit).
void set_all_by_themselves(Session& session, const QuantityField& field, double value) {
  edit(session, set_step(field), [&](Mechanism& mechanism, Selection&) {
    const std::optional<Unit> unit = parse_unit(field.unit); // SI, or degrees
    const double number = unit ? times_unit(value, unit->factor) : value;
    set_by_itself(mechanism, place_of(field), number);
    for (const std::string& place : field.also)
      set_by_itself(mechanism, place, number);
    if (field.follow) field.follow(session.document.stored(), mechanism);
  });
}

// What was typed: an expression, with the parameter that is made for it, or a number by itself.
void take_typed(Session& session, const QuantityField& field, const std::string& typed,
                const std::optional<NamedParameter>& made = {}) {
  if (is_expression(field, typed)) {
    const std::string text = with_field_unit(session, field, typed.substr(1)), place = place_of(field);
    if (field.slider && is_of_numbers_alone(text))
      return field.set(evaluate_expression(session.mechanism(), text, field.unit, place));
    const bool slid = has_slider(session, place);
    edit(session, set_step(field) + " by an expression", [&](Mechanism& mechanism, Selection&) {
      if (made) mechanism.parameters.push_back(*made);
      set_typed_expression(mechanism, field, text);
      if (field.follow) field.follow(session.document.stored(), mechanism);
      std::erase_if(mechanism.sliders,
                    [&](const Slider& each) { return formula_at(mechanism, each.parameter).has_value(); });
    });
    if (session.mode == Mode::explore && slid && !has_slider(session, place))
      session.notice = "The " + parameter_phrase(place) +
                       " is given by an expression now and has no slider; it stands in the inspector, and "
                       "Undo brings the slider back.";
    return;
  }
  if (const std::optional<NumberWithUnit> own = with_own_unit(field, typed))
    return field.set_with_unit(own->value, own->unit);
  const double value = typed_quantity(session, typed, field).value;
  const auto is_given = [&](const std::string& place) {
    return expression_at(session.mechanism(), place).has_value();
  };
  // Of several, one that an expression gives would not take what is set beside it.
  const bool some_given =
      !field.also.empty() && (is_given(place_of(field)) || std::ranges::any_of(field.also, is_given));
  if (some_given || formula_of(session, field)) return set_all_by_themselves(session, field, value);
  if (field.set) return field.set(value);
  if (!field.also.empty()) return set_all_by_themselves(session, field, value);
  set_number(session, field.address, value);
}

FieldOffer add_parameter(Session& session, const QuantityField& field, const std::string& typed) {
  if (!is_expression(field, typed)) return {};
  const std::optional<NamedParameter> lacking = lacking_parameter(
      session.document.stored(), place_of(field), with_field_unit(session, field, typed.substr(1)));
  if (!lacking) return {};
  return {"Add the parameter " + lacking->name, [&session, field, typed, lacking] {
            take_typed(session, field, typed, lacking);
            const ShownUnit unit = shown_unit(lacking->unit, session.units);
            session.notice = lacking->name + " is a parameter of the scene now, " +
                             with_unit(number_text(unit.shown(lacking->value)), unit.text) +
                             " at first, with a slider.";
          }};
}

void set(Session& session, Ui& ui, const QuantityField& field, double value) {
  if (field.at_once) return field.set(value);
  later(ui, [&session, field, value] {
    if (field.set)
      field.set(value);
    else if (!field.also.empty())
      set_all_by_themselves(session, field, value);
    else
      set_number(session, field.address, value);
  });
}

struct Stepping {
  const QuantityField& field;
  const ShownNumber& shown;
  Typing& typing;
  bool stepped = false;
};

// A double click selects the number, which is typed over then, and not the word under the cursor, which may
// be its unit.
void select_number(ImGuiInputTextCallbackData* data, Typing& typing) {
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) typing.by_number = true;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) typing.by_number = false;
  if (!typing.by_number) return;
  const auto [from, to] = number_at({data->Buf, static_cast<std::size_t>(data->BufTextLen)},
                                    static_cast<std::size_t>(std::max(data->CursorPos, 0)));
  data->SelectionStart = static_cast<int>(from);
  data->SelectionEnd = data->CursorPos = static_cast<int>(to);
}

// The arrow keys and the mouse, while the number is typed in.
int step_typed(ImGuiInputTextCallbackData* data) {
  auto& stepping = *static_cast<Stepping*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackAlways) {
    select_number(data, stepping.typing);
    return 0;
  }
  const QuantityField& field = stepping.field;
  const ShownUnit& unit = stepping.shown.unit;
  const Quantity typed =
      typed_quantity({data->Buf, static_cast<std::size_t>(data->BufTextLen)}, unit.text, unit.text);
  if (!typed) return 0;
  const double step = hand_step(stepping.shown.value, unit.text);
  const double next = rounded(typed.value + (data->EventKey == ImGuiKey_UpArrow ? step : -step));
  if (!too_small(next, field.least).empty()) return 0;
  const std::string text = with_unit(number_text(next), unit.text);
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, text.c_str());
  data->SelectAll();
  stepping.stepped = true;
  return 0;
}

float digits_width(const Ui& ui, const std::string& text) {
  const ImFont* digits = ui.fonts.digits;
  return digits->CalcTextSizeA(digits->FontSize, 1e9f, 0, text.c_str()).x;
}

constexpr float rounding = 0.5f; // pixels, of a room that was made for a text

float field_padding(const Ui& ui) {
  return 6 * ui.scale;
}

// Of the unit behind the number, with the gap between them.
float unit_width(const Ui& ui, const std::string& unit) {
  return unit.empty() ? 0 : ImGui::CalcTextSize(unit.c_str()).x + 5 * ui.scale;
}

// The number over the field at rest.
void draw_resting(const Ui& ui, const QuantityField& field, const ShownNumber& shown, float padding,
                  bool given) {
  const UiColors& colors = colors_of(ui);
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const float right = to.x - padding, gap = 5 * ui.scale;
  const float behind = unit_width(ui, shown.unit.text);
  const float sign = given ? ImGui::CalcTextSize("=").x + gap : 0; // of an expression
  const float room = right - from.x - padding - behind - sign;
  const std::string& words = field.law.empty() ? field.various : field.law;
  const std::string text = words.empty() ? fitting_text(ui, shown.value, room) : std::string();
  const float words_width = ImGui::CalcTextSize(words.c_str()).x;
  const float y = from.y + (to.y - from.y - ImGui::GetFontSize()) / 2;
  const float x = field.framed ? from.x + padding + sign : right - behind - digits_width(ui, text);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(from, to, true);
  const ImVec4& color = field.standard ? colors.dim : colors.text;
  if (given) list.AddText({x - sign, y}, packed(colors.accent), "=");
  const bool fits = words.empty() ? digits_width(ui, text) <= room + rounding : words_width <= room;
  if (!words.empty())
    list.AddText({x, y}, packed(colors.dim), cut_to(words, fits ? room : room + behind).c_str());
  else
    list.AddText(ui.fonts.digits, ui.fonts.digits->FontSize, {x, y + digits_drop(ui)}, packed(color),
                 text.c_str());
  if (behind > 0 && (!field.framed || fits)) // else they have its place
    list.AddText({right - behind + gap, y}, packed(colors.dim), shown.unit.text.c_str());
  list.PopClipRect();
}

std::string tooltip(const Session& session, const QuantityField& field, const ShownNumber& shown,
                    const std::optional<std::string>& formula) {
  std::string text = field.help;
  const auto line = [&](const std::string& more) { text += (text.empty() ? "" : "\n") + more; };
  if (field.various.empty() && field.law.empty()) {
    constexpr double degrees = 180 / std::numbers::pi;
    std::string exact = with_unit(number_text(shown.value), shown.unit.text);
    if (const std::string own = written_unit(field.unit); shown.unit.text != own)
      exact += " = " + with_unit(number_text(field.value), own);
    else if (field.unit == "rad")
      exact += " = " + short_text(field.value * degrees, 9) + "°";
    else if (field.unit == "rad/s")
      exact += " = " + short_text(field.value * degrees / 6, 9) + " rpm";
    line(exact + (field.standard ? ", as the scene does not say otherwise" : ""));
  }
  if (formula)
    line("=" + typed_again(session, field, *formula) +
         "\nBeside names, numbers without a unit are in SI units and radians.");
  if (!field.address.empty()) line(field.address);
  return text;
}

void pin_button(Session& session, Ui& ui, const QuantityField& field, bool row_hovered) {
  if (field.address.empty()) return;
  const float side = ImGui::GetFrameHeight(), width = margin_width(ui);
  // What it rests on has the slider; of several parts each has its own.
  if (formula_of(session, field) || !field.also.empty()) return ImGui::Dummy({width, side});
  const bool pinned = is_pinned(session.mechanism(), field.address);
  const UiColors& colors = colors_of(ui);
  const std::string name = "inspector/pin/" + field.address;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::InvisibleButton("pin", {width, side});
  ImGui::PopID();
  note_widget(ui.widgets, name, KeyUse::aside);
  const bool hovered = ImGui::IsItemHovered() || has_keyboard(ui, name);
  help_on_hover(pinned ? "Pinned as a slider; click to take it off the sliders."
                       : "Pin this number as a slider.");
  if (pressed) later(ui, [&session, address = field.address, pinned] { pin(session, address, !pinned); });
  if (!pinned && !hovered && !row_hovered) return;
  const ImVec2 size = ImGui::CalcTextSize(icon::pin);
  const ImVec4& color = pinned ? colors.accent : hovered ? colors.text : colors.dim;
  ImGui::GetWindowDrawList()->AddText({from.x + (width - size.x) / 2, from.y + (side - size.y) / 2},
                                      packed(color), icon::pin);
}

// The label, by which the number can be dragged.
void scrub_label(Session& session, Ui& ui, const std::string& label, const QuantityField& field,
                 float width) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetFrameHeight();
  const std::string name = field.name + "/label";
  ImGui::InvisibleButton(name.c_str(), {std::max(width, 1.f), height});
  note_widget(ui.widgets, name, KeyUse::none); // the field does all of it
  const bool active = ImGui::IsItemActive(), draggable = field.various.empty() && field.law.empty();
  const bool lit = draggable && (active || ImGui::IsItemHovered());
  if (lit) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const ShownNumber shown(session, field);
  if (!active) help_on_hover(tooltip(session, field, shown, formula_of(session, field)).c_str());
  if (const auto dragged = dragged_number(ui, name, shown.value, shown.unit.text); dragged && draggable) {
    const double next = shown.unit.si(*dragged);
    if (next != field.value && too_small(next, field.least).empty()) set(session, ui, field, next);
  }
  const UiColors& colors = colors_of(ui);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(from, {from.x + width - 3 * ui.scale, from.y + height}, true);
  list.AddText({from.x, from.y + ImGui::GetStyle().FramePadding.y}, packed(lit ? colors.text : colors.dim),
               label.c_str());
  list.PopClipRect();
}

void draw_letter(const Ui& ui, int axis, const ImVec2& at) {
  const Palette& colors = palette(ui.theme);
  const std::array letters{colors.axis_x, colors.axis_y, colors.axis_z};
  constexpr std::array names{"x", "y", "z"};
  const auto i = static_cast<std::size_t>(axis);
  ImGui::GetWindowDrawList()->AddText({at.x, at.y + ImGui::GetStyle().FramePadding.y},
                                      packed(to_imgui(letters[i])), names[i]);
}

} // namespace

std::optional<double> dragged_number(Ui& ui, const std::string& name, double shown, const std::string& unit) {
  constexpr float pixels_a_step = 4; // points the hand travels
  Scrub& scrub = ui.fields.scrub;
  if (ImGui::IsItemActivated()) scrub = {name, shown, hand_step(shown, unit), 0};
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsItemActive() || scrub.name != name || io.MouseDelta.x == 0) return {};
  scrub.travelled += io.MouseDelta.x;
  const double steps = std::round(static_cast<double>(scrub.travelled / (pixels_a_step * ui.scale)));
  return rounded(scrub.start + steps * (io.KeyShift ? scrub.step / 10 : scrub.step));
}

double hand_step(double value, const std::string& unit) {
  if (value != 0) return std::pow(10, std::floor(std::log10(std::abs(value)) + 1e-9) - 2);
  if (unit == "m") return 1e-3;
  if (unit == "rad/s" || unit == "m/s²" || unit == "rad") return 0.1;
  constexpr std::array<std::string_view, 8> by_one{"deg", "°", "°/s", "rpm", "mm", "mm/s", "N/m", "N"};
  if (std::ranges::find(by_one, unit) != by_one.end()) return 1;
  return 0.01;
}

float margin_width(const Ui& ui) {
  return 20 * ui.scale;
}

bool margin_button(Ui& ui, const std::string& name, const char* icon, const char* help) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y});
  ImGui::PushStyleColor(ImGuiCol_Text, colors_of(ui).dim);
  ImGui::PushID(name.c_str());
  const bool pressed = ImGui::Button(icon, {margin_width(ui), 0});
  ImGui::PopID();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  note_widget(ui.widgets, name, KeyUse::aside);
  help_on_hover(help);
  return pressed;
}

float label_width(const Ui& ui) {
  return std::clamp(0.34f * ImGui::GetContentRegionAvail().x, 76 * ui.scale, 130 * ui.scale);
}

std::string fitting_text(const Ui& ui, double value, float room) {
  std::string shortest = short_text(value, 9);
  for (int digits = 9; digits >= 3; --digits) {
    std::string text = short_text(value, digits);
    if (digits_width(ui, text) <= room + rounding) return text;
    if (text.size() < shortest.size()) shortest = std::move(text);
  }
  return shortest;
}

float resting_width(const Session& session, const Ui& ui, double value, const std::string& unit) {
  const ShownUnit shown = shown_unit(unit, session.units);
  return digits_width(ui, short_text(shown.shown(value), 6)) + unit_width(ui, shown.text) +
         2 * field_padding(ui);
}

void quantity_field(Session& session, Ui& ui, const QuantityField& field, float width) {
  const UiColors& colors = colors_of(ui);
  const float height = ImGui::GetFrameHeight(), padding = field_padding(ui);
  const ShownNumber shown(session, field);
  const std::optional<std::string> formula = formula_of(session, field);
  if (const std::string naming = naming_field(field.name); formula && typing_in(ui, naming)) {
    text_field(session, ui, name_text_field(session, naming, *formula, rename_parameter), width);
    return;
  }
  Stepping stepping{field, shown, ui.fields.typing};
  TextField text{
      .name = field.name,
      .text = formula                 ? "=" + typed_again(session, field, *formula)
              : field.various.empty() ? with_unit(number_text(shown.value), shown.unit.text)
                                      : "",
      .check = [&session, field](const std::string& typed) { return mistake_in(session, typed, field); },
      .take = [&session, field](const std::string& typed) { take_typed(session, field, typed); },
      .offer = [&session, field](const std::string& typed) { return add_parameter(session, field, typed); },
      .at_once = field.at_once,
      .drawn_here = false,
      .expression = true,
      .flags = ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackAlways,
      .callback = step_typed,
      .callback_data = &stepping};
  const bool bare = !field.framed && !typing_in(ui, field.name);
  if (bare) ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
  if (bare) ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, colors.raised);
  ImGui::PushFont(ui.fonts.digits);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {padding, (height - ui.fonts.digits->FontSize) / 2});
  const bool typing = text_field(session, ui, text, width);
  if (field.name != "parameters/" + field.address + "/value")
    note_number(ui, field.name, field.also.empty() ? field.address : "");
  ImGui::PopStyleVar();
  ImGui::PopFont();
  if (bare) ImGui::PopStyleColor(2);
  const bool asked = ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right);
  if (!typing) {
    draw_resting(ui, field, shown, padding, formula.has_value());
    help_on_hover(tooltip(session, field, shown, formula).c_str());
  } else if (stepping.stepped) {
    if (const Quantity typed = typed_quantity(session, ui.fields.typing.text, field))
      set(session, ui, field, typed.value);
  }
  number_menu(session, ui, field, asked);
}

void quantity_row(Session& session, Ui& ui, const std::string& label, const QuantityField& field,
                  const std::function<void()>& reset) {
  const float labels = label_width(ui), margin = margin_width(ui);
  const float width = ImGui::GetContentRegionAvail().x, start = ImGui::GetCursorPosX();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const bool hovered = ImGui::IsWindowHovered() &&
                       ImGui::IsMouseHoveringRect(from, {from.x + width, from.y + ImGui::GetFrameHeight()});
  const float letter = field.axis < 0 ? 0 : 14 * ui.scale;
  if (typing_in(ui, field.name) && ui.fields.typing.text.starts_with('=')) // the whole row for an expression
    return quantity_field(session, ui, field, std::max(width - margin, 20 * ui.scale));
  scrub_label(session, ui, label, field, labels - letter - (reset ? margin : 0));
  if (reset) {
    ImGui::SameLine(0, 0);
    if (margin_button(ui, field.name + "/reset", icon::undo, "Leave it to the drawn pose.")) later(ui, reset);
  }
  if (field.axis >= 0) draw_letter(ui, field.axis, {from.x + labels - letter, from.y});
  ImGui::SameLine(0, 0);
  ImGui::SetCursorPosX(start + labels);
  quantity_field(session, ui, field, std::max(width - labels - margin, 20 * ui.scale));
  if (!field.address.empty()) {
    ImGui::SameLine(0, 0);
    pin_button(session, ui, field, hovered);
  }
}

bool plain_quantity_field(Session& session, Ui& ui, const std::string& name, const char* label,
                          const char* unit, const char* help, double& value, Least least) {
  ui.fields.plain.reset();
  quantity_row(session, ui, label,
               {.name = name,
                .value = value,
                .unit = unit,
                .help = help,
                .least = least,
                .set = [&ui](double typed) { ui.fields.plain = typed; },
                .at_once = true});
  if (!ui.fields.plain || *ui.fields.plain == value) return false;
  value = *ui.fields.plain;
  return true;
}

std::string and_more(std::size_t parts) {
  return parts == 0 ? "" : ", and " + std::to_string(parts) + " more";
}

void set_number(Session& session, const std::string& address, double value) {
  edit_parameter(session, address, value);
}

bool is_pinned(const Mechanism& mechanism, const std::string& address) {
  return std::ranges::find(mechanism.sliders, address, &Slider::parameter) != mechanism.sliders.end();
}

void pin(Session& session, const std::string& address, bool pinned) {
  if (pinned == is_pinned(session.mechanism(), address)) return;
  edit(session, (pinned ? "Pin " : "Unpin ") + parameter_phrase(address),
       [&](Mechanism& mechanism, Selection&) {
         if (pinned)
           mechanism.sliders.push_back(slider_for(mechanism, address, session.units));
         else
           std::erase_if(mechanism.sliders,
                         [&](const Slider& slider) { return slider.parameter == address; });
       });
}

} // namespace flyball
