#include "app/ui/panels/legend.hpp"

#include "app/ui/camera_glide.hpp"
#include "app/ui/choices.hpp"
#include "app/ui/panels/load_legend.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

std::string motion_words(const Session& session) {
  if (moving_mode(session)) return "Swinging in mode " + std::to_string(*session.study.modes.chosen + 1);
  return motion_words(session, shown_motion(session));
}

// A dashed frame, as the drawn pose has.
void dashes(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color, float scale) {
  const float step = 5 * scale, on = 3 * scale, thick = 1.4f * scale;
  for (float x = from.x; x < to.x; x += step)
    for (const float y : {from.y, to.y})
      list.AddLine({x, y}, {std::min(x + on, to.x), y}, color, thick);
  for (float y = from.y; y < to.y; y += step)
    for (const float x : {from.x, to.x})
      list.AddLine({x, y}, {x, std::min(y + on, to.y)}, color, thick);
}

void draw_mark(const Session& session, const Ui& ui, LegendMark mark, ImVec2 from, ImVec2 to) {
  const Palette& colors = palette(ui.theme);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const BodyHues& hues = session.document.hues();
  const Color body = colors.bodies[hues.empty() ? 0 : hues.front() % colors.bodies.size()];
  const auto fill = [&](Color color, float alpha) {
    color.a = alpha;
    list.AddRectFilled(from, to, packed(to_imgui(color)), 2 * ui.scale);
  };
  if (mark == LegendMark::solid || mark == LegendMark::outlined) fill(body, 1);
  if (mark == LegendMark::glass) fill(body, 0.45f);
  if (mark == LegendMark::motion) fill(colors.motion, colors.motion.a);
  if (mark == LegendMark::outlined || mark == LegendMark::dashed)
    dashes(list, from, to, packed(to_imgui(colors.drawn)), ui.scale);
}

} // namespace

namespace {

std::vector<LegendRow> pose_rows(const Session& session, const ToolState& tool, const ViewState& view) {
  if (session.mechanism().bodies.empty() || !view.scene.scene) return {};
  const ViewScene& scene = *view.scene.scene;
  const bool apart = !scene.drawn.empty(); // the two poses differ
  const bool periodic = !converged(session) && periodic_motion(session);
  const std::string found = periodic ? "Periodic motion" : "Steady state";
  std::vector<LegendRow> rows;
  if (tool.assembly) {
    rows.push_back({LegendMark::solid, "Drawn pose"});
    if (apart) rows.push_back({LegendMark::dashed, "Before the pull"});
    return rows;
  }
  if (session.mode == Mode::build) {
    rows.push_back({apart ? LegendMark::outlined : LegendMark::solid, "Drawn pose"});
    if (apart)
      rows.push_back({LegendMark::glass, found});
    else if (converged(session) && view.ghost && !solving(session))
      rows.front().words = "Drawn pose = steady state";
    return rows;
  }
  const bool moves = !view.scene.source.poses.empty();
  if (converged(session) || periodic)
    rows.push_back({LegendMark::solid, found});
  else
    rows.push_back({LegendMark::solid, moves ? motion_words(session) : std::string("Drawn pose")});
  if (apart) rows.push_back({LegendMark::dashed, "Drawn pose"});
  if (!scene.motion.empty()) rows.push_back({LegendMark::motion, motion_words(session)});
  return rows;
}

} // namespace

std::vector<LegendRow> legend_rows(const ViewContext& context) {
  std::vector<LegendRow> rows = pose_rows(context.session, context.tool, context.view);
  if (rows.empty()) return rows;
  if (const std::size_t hidden = context.view.scene.source.hidden.size())
    rows.push_back({.mark = LegendMark::note,
                    .words = std::to_string(hidden) + (hidden == 1 ? " part hidden" : " parts hidden"),
                    .help = "View, Show all brings hidden parts back (Ctrl+Shift+H)."});
  add_load_rows(context, rows);
  return rows;
}

namespace {

constexpr float largest_share = 0.2f, // of the view, that an open legend takes unasked
    least_height = 220;               // points, of a view in which it is open unasked

// How much of the loads' arrows, of the drawn pose's outline and of the bodies lies in each of two parts of
// the view, of the same size, with their upper left corners there: as many solids, and of arrows a hundredth
// of the view's height counts as one.
std::array<float, 2> shown_within(const ViewState& state, const PanelRect& view,
                                  const std::array<ImVec2, 2>& corners, ImVec2 part) {
  const ShownScene& shown = state.scene;
  std::array<float, 2> within{};
  if (!shown.scene) return within;
  const Projection project =
      state.camera.projection({static_cast<double>(view.width), static_cast<double>(view.height)});
  using Inside = std::array<bool, 2>;
  const auto inside_which = [&](const Vec2& at) {
    Inside inside{};
    for (const std::size_t k : {0u, 1u}) {
      const float x = view.x + static_cast<float>(at.x()) - corners[k].x,
                  y = view.y + static_cast<float>(at.y()) - corners[k].y;
      inside[k] = x > 0 && x < part.x && y > 0 && y < part.y;
    }
    return inside;
  };
  for (const LoadArrow& arrow : shown.scene->arrows.arrows) {
    const auto from = project(arrow.from), to = project(arrow.to);
    if (!from || !to) continue;
    const Vec2 along = *to - *from;
    const float fifth = 20 * static_cast<float>(along.norm()) / view.height;
    for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Inside inside = inside_which(*from + share * along);
      for (const std::size_t k : {0u, 1u})
        if (inside[k]) within[k] += fifth;
    }
  }
  const auto add_solid = [&](const Instance& solid) {
    Inside touched{};
    const Vec3 reach = solid.extent + Vec3::Constant(solid.round);
    const auto look = [&](const Vec3& share) {
      const auto at = project(solid.position + solid.rotation * reach.cwiseProduct(share));
      if (!at) return;
      const Inside inside = inside_which(*at);
      for (const std::size_t k : {0u, 1u})
        touched[k] = touched[k] || inside[k];
    };
    // Along its axes, since a long bar lies across a part with both of its ends outside, and around them.
    for (int axis = 0; axis < 3; ++axis) {
      for (const double along : {-1., -0.75, -0.5, -0.25, 0., 0.25, 0.5, 0.75, 1.})
        look(along * Vec3::Unit(axis));
      for (const double side : {-0.7, 0.7})
        for (const double other : {-0.7, 0.7})
          look(side * Vec3::Unit(axis) + other * Vec3::Unit((axis + 1) % 3));
    }
    for (const std::size_t k : {0u, 1u})
      if (touched[k]) within[k] += 1;
  };
  constexpr std::size_t many = 300; // solids; of more, some: they are looked at in every frame
  const auto& solids = shown.scene->solid.instances;
  const std::size_t step = 1 + (shown.scene->drawn.size() + solids.size()) / many;
  for (std::size_t i = 0; i < shown.scene->drawn.size(); i += step)
    add_solid(shown.scene->drawn[i]);
  for (std::size_t i = 0; i < solids.size(); i += step)
    if (solids[i].part.kind == PartKind::body) add_solid(solids[i]);
  return within;
}

} // namespace

// The corner of the view that it is in, the upper one at first, until a legend of this size hides something
// there and less in the other. It does not jump while the view is turned or something moves in it,
// nor while the wheel zooms, which brings one thing after another under both.
float Legend::top(const ViewContext& context, const PanelRect& view, ImVec2 size, std::size_t rows) {
  const Ui& ui = context.ui;
  const ViewState& state = context.view;
  const float s = ui.scale, left = view.x + view.width - 10 * s - size.x;
  // Chips at the bottom: the status, which may take several lines, and above it what is explored.
  const auto explored = ui.widgets.find("explored"), status = ui.widgets.find("status");
  float bottom = view.y + view.height - 44 * s;
  if (explored != ui.widgets.end())
    bottom = explored->second.from.y - 14 * s;
  else if (status != ui.widgets.end())
    bottom = std::min(bottom, status->second.from.y - 8 * s);
  float upper = view.y + 10 * s;
  const float lower = bottom - size.y;
  for (const char* words : {"view/name", "view/time"}) // of the caption, at the left
    if (const auto at = ui.widgets.find(words); at != ui.widgets.end() && at->second.to.x > left - 6 * s)
      upper = std::max(upper, at->second.to.y + 6 * s);
  if (lower <= upper) return upper;
  if (ImGui::GetIO().MouseWheel != 0) zoomed_ = {state.camera, rows};
  const bool zooms = zoomed_ && *zoomed_ == std::pair(state.camera, rows);
  if (!zooms && !ImGui::IsAnyMouseDown() && !in_motion(context.session, state) && state.legend) {
    const float clear = 6 * s; // about it
    // In steps, so that a font a little wider or narrower does not decide.
    const float step = 16 * s, width = step * std::floor((size.x + 2 * clear) / step),
                height = step * std::floor((size.y + 2 * clear) / step), from = left + size.x + clear - width;
    const auto hidden = shown_within(
        state, view, {ImVec2(from, upper - clear), ImVec2(from, lower + size.y + clear - height)},
        {width, height});
    if (hidden[low_ ? 0 : 1] < hidden[low_ ? 1 : 0]) low_ = !low_;
  }
  return low_ ? lower : upper;
}

void Legend::draw(const ViewContext& context, const PanelRect& view, bool folds) {
  if (!folds && !context.view.legend) return;
  const std::vector<LegendRow> rows = legend_rows(context);
  if (rows.empty() || view.width < 260 * context.ui.scale || view.height < 160 * context.ui.scale) return;
  const UiColors& colors = colors_of(context.ui);
  const float s = context.ui.scale;
  const float line = ImGui::GetTextLineHeight(), side = std::round(0.55f * line);
  const float mark = std::round(1.4f * line);
  float width = mark; // of the widest mark
  for (const LegendRow& row : rows)
    width = std::max(width, row.length + 2 * s);
  const ImVec2 padding(8 * s, 4 * s);
  const float gap = 2 * s;
  float room = 0;
  const auto size_of = [&](const std::vector<LegendRow>& these) {
    room = ImGui::CalcTextSize("Shown").x + 16 * s;
    for (const LegendRow& row : these)
      room = std::max(room, (row.mark == LegendMark::note ? s : width + 7 * s) +
                                ImGui::CalcTextSize(row.words.c_str()).x);
    const auto lines = static_cast<float>(these.size());
    return ImVec2(room + 2 * padding.x, (lines + 1) * line + lines * gap + 2 * padding.y);
  };
  const ImVec2 whole = size_of(rows);
  // Over the tools it would hide and be hidden.
  const auto tools = context.ui.widgets.find("tool strip");
  const bool over_tools = tools != context.ui.widgets.end() &&
                          view.x + view.width - 10 * s - whole.x < tools->second.to.x + 4 * s;
  const bool crowded = over_tools || view.height < least_height * s ||
                       whole.x * whole.y > largest_share * view.width * view.height;
  const bool open = !folds || (crowded ? anyway_ : context.view.legend);
  const std::vector<LegendRow> shown = open ? rows : std::vector<LegendRow>();
  const ImVec2 size = size_of(shown);
  ImGui::SetNextWindowPos(
      {std::round(view.x + view.width - 10 * s), std::round(top(context, view, size, shown.size()))},
      ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSize(size); // a window that finds its own is a frame behind what is in it
  ImGui::SetNextWindowBgAlpha(0.88f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 5 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(s)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {6 * s, gap});
  ImGui::Begin("legend", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  const ImVec2 corner = ImGui::GetWindowPos();
  context.ui.widgets["legend frame"] = {corner, {corner.x + size.x, corner.y + size.y}};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("title", {room, line})) {
    if (crowded)
      anyway_ = !open;
    else
      open_legend(context.session, context.ui, context.view, !open);
  }
  note_widget(context.ui.widgets, "legend");
  const bool lit = ImGui::IsItemHovered();
  help_on_hover(open ? "Fold the legend" : "What is drawn how");
  const ImU32 ink = packed(lit ? colors.text : colors.dim);
  list.AddText({from.x, from.y}, ink, "Shown");
  const float r = 3.5f * s, cx = from.x + room - r, cy = from.y + line / 2;
  if (!folds) {
    // nothing to press
  } else if (open)
    list.AddTriangleFilled({cx - r, cy - r / 2}, {cx + r, cy - r / 2}, {cx, cy + r / 1.5f}, ink);
  else
    list.AddTriangleFilled({cx + r / 2, cy - r}, {cx + r / 2, cy + r}, {cx - r / 1.5f, cy}, ink);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float top = at.y + std::round((line - side) / 2);
    const bool note = shown[i].mark == LegendMark::note;
    if (shown[i].mark == LegendMark::load || shown[i].mark == LegendMark::scale)
      draw_load_mark(context.ui, shown[i], {at.x + s, at.y}, line);
    else if (!note)
      draw_mark(context.session, context.ui, shown[i].mark, {at.x + s, top}, {at.x + mark, top + side});
    list.AddText({at.x + (note ? s : width + 7 * s), at.y}, packed(note ? colors.dim : colors.text),
                 shown[i].words.c_str());
    if (shown[i].chooses) {
      const std::string name = "row" + std::to_string(i);
      if (ImGui::InvisibleButton(name.c_str(), {room, line})) {
        context.view.load_lengths = shown[i].chooses;
        context.view.fit_loads = true;
      }
    } else {
      ImGui::Dummy({room, line});
    }
    if (!shown[i].help.empty()) help_on_hover(shown[i].help.c_str());
    note_widget(context.ui.widgets, "legend/" + std::to_string(i));
  }
  ImGui::End();
  ImGui::PopStyleVar(5);
}

} // namespace flyball
