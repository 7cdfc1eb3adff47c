#include "app/ui/panels/load_labels.hpp"

#include "app/ui/load_view.hpp"
#include "app/ui/panels/load_legend.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/picking.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace flyball {

namespace {

struct LabelBox {
  ImVec2 from, to;
  bool meets(const LabelBox& other) const {
    return from.x < other.to.x && other.from.x < to.x && from.y < other.to.y && other.from.y < to.y;
  }
};

std::string load_part_name(const Mechanism& mechanism, const Load& load) {
  return part_of(mechanism, load.part).name;
}

std::string load_value_text(const Load& load) {
  return short_text(load.vector.stableNorm(), 4) + (load.moment ? " N m" : " N");
}

// "reaction in arm1", "weight of ball1".
std::string long_load_name(const Mechanism& mechanism, const Load& load) {
  const std::string name = load_part_name(mechanism, load);
  switch (load.kind) {
  case LoadKind::reaction: return "Reaction in " + name;
  case LoadKind::drive: return "Drive of " + name;
  case LoadKind::spring: return "Spring of " + name;
  case LoadKind::damper: return "Damper or friction of " + name;
  case LoadKind::gear: return "Mesh of " + name;
  case LoadKind::weight: return "Weight of " + name;
  case LoadKind::applied: return load.part.kind == PartKind::joint ? "Load on " + name : name;
  case LoadKind::air: return "Air on " + name;
  case LoadKind::inertia: return "Inertial load of " + name;
  }
  return name;
}

// In the body's own diagram.
std::string short_load_name(const Mechanism& mechanism, const Load& load) {
  if (load.kind == LoadKind::weight) return "weight";
  if (load.kind == LoadKind::inertia) return load.moment ? "inertia" : "inertial load";
  if (load.part.kind == PartKind::joint) {
    if (load.kind == LoadKind::drive) return "drive of " + load_part_name(mechanism, load);
    if (load.kind == LoadKind::spring) return "spring of " + load_part_name(mechanism, load);
    if (load.kind == LoadKind::applied) return "load on " + load_part_name(mechanism, load);
    if (load.kind == LoadKind::damper) return "damper of " + load_part_name(mechanism, load);
  }
  return load_part_name(mechanism, load);
}

std::string load_components_text(const Load& load) {
  const double size = load.vector.lpNorm<Eigen::Infinity>();
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += std::string(i ? "  " : "") + "xyz"[i] + " " +
            (std::abs(load.vector[i]) <= 1e-9 * size ? "0" : short_text(load.vector[i], 5));
  return text + (load.moment ? " N m" : " N");
}

// Whether it is of a reaction that redundant loops share out in many ways, and not by its unique part alone.
bool is_one_of_many(const Solution& solution, const std::string& part, const Load& load) {
  if (load.kind != LoadKind::reaction || load.part.kind != PartKind::joint) return false;
  const auto reaction = std::ranges::find(solution.reactions, part, &Reaction::joint);
  if (reaction == solution.reactions.end()) return false;
  const OpenDirections& open = load.moment ? reaction->open.torque : reaction->open.force;
  const Vec3& whole = load.moment ? reaction->torque : reaction->force;
  return (open.projector * whole).norm() > 1e-9 * whole.norm();
}

// What else is drawn over the view.
std::vector<LabelBox> taken_by_others(const Ui& ui, const ViewState& view, const PanelRect& rect) {
  std::vector<LabelBox> taken;
  if (const ImGuiWindow* legend = ImGui::FindWindowByName("legend"); legend && legend->WasActive)
    taken.push_back({legend->Pos, {legend->Pos.x + legend->Size.x, legend->Pos.y + legend->Size.y}});
  if (has_view_cube(ui, view, rect)) {
    const WidgetRect cube = ui.widgets.at("view/cube");
    taken.push_back({cube.from, cube.to});
  }
  return taken;
}

// Where there is room for a label, as near as can be to where it would be best; nothing where all is taken.
std::optional<LabelBox> free_place(ImVec2 best, ImVec2 half, const LabelBox& room,
                                   const std::vector<LabelBox>& taken) {
  constexpr int reach = 6; // labels to each side
  std::optional<LabelBox> found;
  float nearest = 0;
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      ImVec2 at(best.x + static_cast<float>(column) * half.x,
                best.y + static_cast<float>(row) * 2.1f * half.y);
      at.x = std::clamp(at.x, room.from.x + half.x, std::max(room.from.x + half.x, room.to.x - half.x));
      const float away = std::hypot(at.x - best.x, at.y - best.y);
      const LabelBox box{{std::round(at.x - half.x), std::round(at.y - half.y)},
                         {std::round(at.x + half.x), std::round(at.y + half.y)}};
      if ((found && away >= nearest) || box.from.y < room.from.y || box.to.y > room.to.y ||
          std::ranges::any_of(taken, [&](const LabelBox& other) { return box.meets(other); }))
        continue;
      found = box;
      nearest = away;
    }
  return found;
}

} // namespace

void load_labels(Ui& ui, const ViewState& view, const PanelRect& rect) {
  if (!shows_diagram(view)) return;
  const ShownScene& shown = view.scene;
  const ViewScene& scene = *shown.scene;
  const ViewCamera& camera = view.camera;
  const ViewSize size{static_cast<double>(rect.width), static_cast<double>(rect.height)};
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, pad = 4 * s;
  const ImFont& font = *ui.fonts.text;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float above = view.alone ? pad : 32 * s,
              below = view.alone ? pad : 44 * s; // the view's own lines
  const LabelBox room{{rect.x + pad, rect.y + above},
                      {rect.x + rect.width - pad, rect.y + rect.height - below}};
  std::vector<LabelBox> taken = taken_by_others(ui, view, rect);
  for (const LoadArrow& arrow : scene.arrows.arrows) {
    const Load& load = scene.loads[arrow.load];
    const auto tail = camera.project(arrow.from, size), tip = camera.project(arrow.to, size);
    if (!tail || !tip) continue;
    const std::string words = short_load_name(*shown.mechanism, load) + " " + load_value_text(load);
    const ImVec2 text = font.CalcTextSizeA(font.FontSize, 1e9f, 0, words.c_str());
    const ImVec2 half(text.x / 2 + pad + 2 * s, text.y / 2 + s);
    Vec2 away = *tip - *tail;
    away = away.norm() > 1 ? Vec2(away.normalized()) : Vec2(0, -1);
    const double clear = std::min(static_cast<double>(half.x) / std::max(std::abs(away.x()), 1e-9),
                                  static_cast<double>(half.y) / std::max(std::abs(away.y()), 1e-9));
    const Vec2 middle = *tip + away * (clear + 5 * static_cast<double>(s));
    const ImVec2 best(rect.x + static_cast<float>(middle.x()), rect.y + static_cast<float>(middle.y()));
    if (const auto found = free_place(best, half, room, taken)) {
      const LabelBox& box = *found;
      ImVec4 plate = colors.panel;
      plate.w = 0.85f;
      list.AddRectFilled(box.from, box.to, packed(plate), 3 * s);
      list.AddRectFilled(box.from, {box.from.x + 3 * s, box.to.y},
                         packed(load_color(load.kind, palette(ui.theme)), 1), 2 * s);
      list.AddText(ui.fonts.text, font.FontSize, {box.from.x + pad + 2 * s, box.from.y + s},
                   packed(colors.text), words.c_str());
      ui.widgets["load/" + words.substr(0, words.find(' ')) + (load.moment ? "/moment" : "/force")] = {
          box.from, box.to};
      taken.push_back(box);
    }
  }
}

bool load_tooltip(const ViewContext& context, const ViewInput& input) {
  if (!input.hovered || places(context.tool.tool)) return false;
  const ShownScene& shown = context.view.scene;
  if (!shown.scene || shown.scene->arrows.solids.empty()) return false;
  const ViewScene& scene = *shown.scene;
  const auto hit = pick(scene.arrows.solids, input.ray(), 3 * input.point);
  if (!hit) return false;
  const Load& load = scene.loads[scene.arrows.arrows[scene.arrows.arrow_of[hit->instance]].load];
  ImGui::BeginTooltip();
  ImGui::PushFont(context.ui.fonts.strong);
  ImGui::TextUnformatted(long_load_name(*shown.mechanism, load).c_str());
  ImGui::PopFont();
  ImGui::SameLine();
  ImGui::TextUnformatted(load_value_text(load).c_str());
  note_widget(context.ui.widgets, "load/pointed");
  ImGui::TextDisabled("%s", load_components_text(load).c_str());
  if (is_one_of_many(context.session.answer.solution, load_part_name(*shown.mechanism, load), load)) {
    ImGui::TextUnformatted("The loops hold more than they need: the smallest of many.");
    note_widget(context.ui.widgets, "load/nonunique");
  }
  ImGui::EndTooltip();
  return true;
}

} // namespace flyball
