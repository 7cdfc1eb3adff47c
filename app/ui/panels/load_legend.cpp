#include "app/ui/panels/load_legend.hpp"

#include "app/ui/load_view.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr float longest_sample = 46, kind_sample = 18; // points

// The largest of 1, 2, 5, 10, ... that is no larger.
double round_below(double value) {
  const double decade = std::pow(10., std::floor(std::log10(value)));
  for (const double digit : {5., 2.})
    if (digit * decade <= value) return digit * decade;
  return decade;
}

const char* load_help(LoadKind kind, bool moment, bool diagram) {
  switch (kind) {
  case LoadKind::reaction:
    return diagram
               ? "What the guides of joints, and bearings, exert on the body; of ball, universal, planar and "
                 "free joints with their springs, dampers and drives"
               : "What each joint's parent exerts on its child, springs, dampers and drives included, and "
                 "each bearing on its second body";
  case LoadKind::drive:
    return diagram ? "What drives exert on the body"
                   : "What drives exert on their joint's child; part of the reactions";
  case LoadKind::spring:
    return diagram ? "What springs and stops exert on the body"
                   : "Springs between bodies, and springs and stops of joints (part of the reactions)";
  case LoadKind::damper:
    return diagram ? "What dampers and friction of joints exert on the body"
                   : "Dampers and friction of joints, on their child; part of the reactions";
  case LoadKind::gear:
    return diagram
               ? "What gears, belts, racks and screws exert along the coordinates of the body's joints"
               : "What gears, belts, racks and screws exert along coordinates, on the joint's child; part of "
                 "the reactions";
  case LoadKind::weight: return "Mass times gravity, at the mass centre";
  case LoadKind::applied: return "Forces and torques that are given, and loads against drives";
  case LoadKind::air: return "What the air exerts";
  case LoadKind::inertia:
    return moment ? "Minus the rate of the angular momentum about the mass centre"
                  : "Minus mass times acceleration, at the mass centre";
  }
  return "";
}

std::string load_size_words(double size, bool moment, int digits = 4) {
  return short_text(size, digits) + (moment ? " N m" : " N");
}

const char* load_name(LoadKind kind) {
  switch (kind) {
  case LoadKind::reaction: return "reactions";
  case LoadKind::drive: return "drives";
  case LoadKind::spring: return "springs";
  case LoadKind::damper: return "dampers, friction";
  case LoadKind::gear: return "gears";
  case LoadKind::weight: return "weight";
  case LoadKind::applied: return "applied";
  case LoadKind::air: return "air";
  case LoadKind::inertia: return "inertial loads";
  }
  return "";
}

LegendRow load_row(const Ui& ui, double largest, LoadKind kind, bool moment, bool diagram) {
  LegendRow row;
  row.mark = LegendMark::load;
  row.load = kind;
  row.moment = moment;
  row.length = kind_sample * ui.scale;
  row.words = std::string(load_name(kind)) + ", up to " + load_size_words(largest, moment);
  row.help = load_help(kind, moment, diagram);
  return row;
}

// An arrow that stands for a round number. `pixel`: m.
LegendRow scale_row(const Ui& ui, const LoadScales& scales, bool moment, double pixel) {
  const double sample =
      round_below(scales.size(moment, static_cast<double>(longest_sample * ui.scale) * pixel));
  LegendRow row;
  row.mark = LegendMark::scale;
  row.moment = moment;
  row.length = static_cast<float>(scales.length(moment, sample) / pixel);
  row.words = load_size_words(sample, moment);
  row.help =
      scales.lengths() == LoadLengths::in_proportion
          ? "So long is an arrow of this size; all others are in proportion."
          : "So long is an arrow of this size. Lengths grow with the cube root: eight times the load is "
            "twice as long. View, Forces by the cube root shows them in proportion again.";
  if (moment) row.help = "Moments have two heads. " + row.help;
  return row;
}

} // namespace

void add_load_rows(const ViewContext& context, std::vector<LegendRow>& rows) {
  const auto note = [&](std::string words) {
    rows.push_back({.mark = LegendMark::note, .words = std::move(words)});
  };
  if (const std::string missing = loads_missing(context.session, context.tool, context.view);
      !missing.empty())
    return note(missing);
  const ShownScene& shown = context.view.scene;
  if (!shown.scene || !shown.source.loads) return;
  const ViewScene& scene = *shown.scene;
  const bool diagram = scene.diagram;
  const double pixel = context.view.camera.pixel_size(context.view.size);
  if (diagram)
    note("Free body: " + shown.mechanism->bodies[static_cast<std::size_t>(shown.source.loads_body)].name +
         ", adds up to zero");
  const LoadArrows& arrows = scene.arrows;
  const std::size_t before = rows.size();
  for (const bool moment : {false, true}) {
    if (!(arrows.scales.size(moment, pixel) > 0)) continue;
    rows.push_back(scale_row(context.ui, arrows.scales, moment, pixel));
    for (std::size_t kind = 0; kind < load_kinds; ++kind)
      if (const double largest = arrows.scales.largest(static_cast<LoadKind>(kind), moment); largest > 0)
        rows.push_back(load_row(context.ui, largest, static_cast<LoadKind>(kind), moment, diagram));
    if (const int left_out = arrows.left_out[moment ? 1 : 0]; left_out > 0) {
      note(std::to_string(left_out) + " below " + load_size_words(arrows.least[moment ? 1 : 0], moment, 2) +
           " not drawn");
      rows.back().chooses = LoadLengths::by_cube_root;
      rows.back().help = "Too short to be seen. A click shows them: lengths by the cube root (View). With a "
                         "body chosen they are drawn to the scale of that body's loads.";
    }
  }
  if (rows.size() == before) {
    note("No forces act");
  } else if (!diagram) {
    const bool roots = arrows.scales.lengths() == LoadLengths::by_cube_root;
    note(roots ? "Twice as long: eight times as much" : "Lengths in proportion");
    rows.back().help =
        roots
            ? "By the cube root small ones are seen beside large ones. A click has them in proportion (View)."
            : "A click has them by the cube root, which shows small ones beside large ones (View).";
    rows.back().chooses = roots ? LoadLengths::in_proportion : LoadLengths::by_cube_root;
  }
  if (rows.size() == before || !shows_moment(context.session)) return;
  note(diagram ? "Of this moment" : "Of this moment; without inertial loads");
  if (!diagram && shown.source.loads_body >= 0) {
    note("No free-body diagram here");
    rows.back().help =
        "Where bodies have no mass their accelerations are not known, and of more than 50 bodies "
        "finding them takes too long: without them the arrows would not add up to zero.";
  }
}

void draw_load_mark(const Ui& ui, const LegendRow& row, ImVec2 from, float height) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale, middle = std::round(from.y + height / 2), head = 7 * s, half = 3.2f * s;
  const float tip = from.x + row.length;
  const ImU32 color = row.mark == LegendMark::scale ? packed(colors_of(ui).text)
                                                    : packed(load_color(row.load, palette(ui.theme)), 1);
  const auto cone = [&](float at) {
    list.AddTriangleFilled({at - head, middle - half}, {at, middle}, {at - head, middle + half}, color);
  };
  list.AddLine({from.x, middle}, {tip - head, middle}, color, 2 * s);
  cone(tip);
  if (row.moment) cone(tip - 0.6f * head);
}

} // namespace flyball
