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

constexpr float longest_sample = 46, shortest_sample = 9; // points

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
  case LoadKind::applied: return "Forces and torques that are given";
  case LoadKind::air: return "What the air exerts";
  case LoadKind::inertia:
    return moment ? "Minus the rate of the angular momentum about the mass centre"
                  : "Minus mass times acceleration, at the mass centre";
  }
  return "";
}

std::string load_size_words(double size, bool moment) {
  return short_text(size, 4) + (moment ? " N m" : " N");
}

LegendRow load_row(const Ui& ui, const LoadScales& scales, LoadKind kind, bool moment, double pixel,
                   bool diagram) {
  const double largest = scales.largest(kind, moment);
  const double fits = scales.size(kind, moment, static_cast<double>(longest_sample * ui.scale) * pixel);
  const double sample = round_below(std::min(fits, largest));
  LegendRow row;
  row.mark = LegendMark::load;
  row.load = kind;
  row.moment = moment;
  row.length =
      std::max(static_cast<float>(scales.length(kind, moment, sample) / pixel), shortest_sample * ui.scale);
  row.words = load_size_words(sample, moment) + ": " + load_name(kind) + ", up to " +
              load_size_words(largest, moment);
  row.help = load_help(kind, moment, diagram);
  row.help += scales.in_proportion() ? ".\nAll forces are to one scale, and so are all moments."
                                     : ".\nEach kind has a scale of its own; lengths grow with the cube "
                                       "root: eight times the load is twice as long.";
  return row;
}

} // namespace

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
  const bool diagram = shown.source.loads_body >= 0;
  const double pixel = context.view.camera.pixel_size(context.view.size);
  if (diagram)
    note("Free body: " + shown.mechanism->bodies[static_cast<std::size_t>(shown.source.loads_body)].name +
         ", adds up to zero");
  const std::size_t before = rows.size();
  for (const LoadKind kind :
       {LoadKind::reaction, LoadKind::drive, LoadKind::spring, LoadKind::damper, LoadKind::gear,
        LoadKind::weight, LoadKind::applied, LoadKind::air, LoadKind::inertia})
    for (const bool moment : {false, true})
      if (scene.arrows.scales.largest(kind, moment) > 0)
        rows.push_back(load_row(context.ui, scene.arrows.scales, kind, moment, pixel, diagram));
  if (rows.size() == before)
    note("No forces act");
  else if (!diagram)
    note("Twice as long: eight times as much");
  if (rows.size() > before && shows_moment(context.session)) note("Of this moment; without inertial loads");
}

void draw_load_mark(const Ui& ui, const LegendRow& row, ImVec2 from, float height) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale, middle = std::round(from.y + height / 2), head = 7 * s, half = 3.2f * s;
  const float tip = from.x + row.length;
  const ImU32 color = packed(load_color(row.load, palette(ui.theme)), 1);
  const auto cone = [&](float at) {
    list.AddTriangleFilled({at - head, middle - half}, {at, middle}, {at - head, middle + half}, color);
  };
  list.AddLine({from.x, middle}, {tip - head, middle}, color, 2 * s);
  cone(tip);
  if (row.moment) cone(tip - 0.6f * head);
}

} // namespace flyball
