#include "app/ui/tools/gizmo_drawing.hpp"

#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/aim.hpp"
#include "app/ui/tools/typed_size.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr const char* letters_of_axes = "xyz";

Color color_of(const Ui& ui, Handle handle) {
  const int axis = axis_of(handle);
  if (axis >= 0) return axis_color(ui.theme, axis);
  const ImVec4& text = colors_of(ui).text;
  return {text.x, text.y, text.z, 1};
}

std::vector<ImVec2> on_screen(const ViewInput& input, const std::vector<Vec2>& line) {
  std::vector<ImVec2> points;
  points.reserve(line.size());
  for (const Vec2& p : line)
    points.push_back(input.on_screen(p));
  return points;
}

void draw_arrow(const Ui& ui, ImVec2 from, ImVec2 to, const Color& color, float width, float alpha) {
  const float dx = to.x - from.x, dy = to.y - from.y, length = std::max(std::hypot(dx, dy), 1e-3f);
  const float head = std::min(13 * ui.scale, 0.6f * length), half = 0.36f * head + width * ui.scale / 4;
  const ImVec2 along(dx / length, dy / length), neck(to.x - head * along.x, to.y - head * along.y);
  draw_line(ui, from, {neck.x + along.x, neck.y + along.y}, color, width, alpha);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto corner = [&](float side, float more) {
    return ImVec2(neck.x - more * along.x - side * (half + more) * along.y,
                  neck.y - more * along.y + side * (half + more) * along.x);
  };
  const float more = 1.5f * ui.scale;
  list.AddTriangleFilled(corner(1, more), {to.x + 2 * more * along.x, to.y + 2 * more * along.y},
                         corner(-1, more), packed(palette(ui.theme).background_top, 0.7f * alpha));
  list.AddTriangleFilled(corner(1, 0), to, corner(-1, 0), packed(color, alpha));
}

void draw_ball(const Ui& ui, ImVec2 at, bool lit, float alpha) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = ui.scale, radius = static_cast<float>(ball_radius - 1) * s;
  const Palette& colors = palette(ui.theme);
  list.AddCircleFilled(at, radius + (lit ? 1.5f : 0) * s,
                       packed(lit ? colors.accent : colors.background_top));
  list.AddCircle(at, radius, packed(color_of(ui, Handle::plane), alpha), 0, 1.8f * s);
}

void draw_handle(const Ui& ui, const ViewInput& input, const HandleShape& shape, bool lit, float alpha) {
  const Color color = color_of(ui, shape.handle);
  const std::vector<ImVec2> line = on_screen(input, shape.line);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  switch (shape.form) {
  case HandleForm::arrow: return draw_arrow(ui, line[0], line[1], color, lit ? 4 : 2.6f, alpha);
  case HandleForm::patch:
    list.AddConvexPolyFilled(line.data(), static_cast<int>(line.size()),
                             packed(color, lit ? 0.7f : 0.3f * alpha));
    return draw_lines(ui, line, color, 1.2f, true, alpha);
  case HandleForm::ball: return draw_ball(ui, line[0], lit, alpha);
  case HandleForm::ring: {
    const std::vector<ImVec2> far = on_screen(input, shape.far);
    if (far.size() > 1)
      list.AddPolyline(far.data(), static_cast<int>(far.size()), packed(color, 0.3f * alpha), 0,
                       1.2f * ui.scale);
    return draw_lines(ui, line, color, lit ? 4 : 2.4f, false, alpha);
  }
  }
}

// Through the whole picture, as far as the perspective has it.
void draw_axis(const Ui& ui, const ViewInput& input, const Vec3& through, int axis) {
  const double far = 0.9 * input.camera.distance;
  const auto from = input.on_screen(Vec3(through - far * Vec3::Unit(axis)));
  const auto to = input.on_screen(Vec3(through + far * Vec3::Unit(axis)));
  const auto middle = input.on_screen(through);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = packed(axis_color(ui.theme, axis), 0.75f);
  if (middle && from) list.AddLine(*middle, *from, ink, 1.2f * ui.scale);
  if (middle && to) list.AddLine(*middle, *to, ink, 1.2f * ui.scale);
}

// The angle, as a sector from where the hand took hold.
void draw_sector(const Ui& ui, const ViewInput& input, const Grab& grab) {
  const int axis = axis_of(grab.handle);
  const Vec3 n = Vec3::Unit(axis);
  const WorkPlane plane{grab.centre, axis};
  const auto hit = meet(plane, grab.from);
  Vec3 start = Vec3::Unit((axis + 1) % 3);
  if (hit && (*hit - grab.centre).norm() > 0) start = (*hit - grab.centre).normalized();
  const double radius = 68 * input.point * metres_per_pixel(input.camera, grab.centre, input.size);
  const Color color = axis_color(ui.theme, axis);
  const auto center = input.on_screen(grab.centre);
  if (!center) return;
  const auto rim = [&](double angle) {
    return input.on_screen(Vec3(grab.centre + radius * (Eigen::AngleAxisd(angle, n) * start)));
  };
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<ImVec2> circle;
  for (int i = 0; i < 72; ++i)
    if (const auto p = rim(2 * std::numbers::pi * i / 72)) circle.push_back(*p);
  draw_lines(ui, circle, color, 1.4f, true, 0.8f);
  // Triangles without smooth edges: they must not show where they meet.
  const ImDrawListFlags flags = list.Flags;
  list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
  const double full = std::remainder(grab.angle, 2 * std::numbers::pi);
  const double shown = std::abs(grab.angle) > std::numbers::pi ? grab.angle : full;
  const int steps = std::clamp(static_cast<int>(std::abs(shown) / 0.05), 1, 200);
  for (int i = 0; i < steps; ++i) {
    const auto p = rim(shown * i / steps), q = rim(shown * (i + 1) / steps);
    if (p && q) list.AddTriangleFilled(*center, *p, *q, packed(color, 0.22f));
  }
  list.Flags = flags;
  for (const double angle : {0.0, shown})
    if (const auto p = rim(angle)) draw_line(ui, *center, *p, color, angle == 0 && shown != 0 ? 1.2f : 2.4f);
}

std::string moved_text(const Grab& grab, double step, const DisplayUnits& units) {
  const auto free = free_coordinates(grab.handle, grab.normal);
  if (!grab.typed.empty() && std::ranges::count(free, true) > 1)
    return (grab.point ? "length " : "distance ") + typed_text(grab.typed, shown_unit("m", units).text);
  std::string text;
  for (int i = 0; i < 3; ++i) {
    if (!free[static_cast<std::size_t>(i)]) continue;
    text += std::string(text.empty() ? "" : "  ") + "Δ" + letters_of_axes[i] + " ";
    if (!grab.typed.empty()) return text + typed_text(grab.typed, shown_unit("m", units).text);
    text += length_text(grab.by[i], step, units);
  }
  return text + " " + shown_unit("m", units).text;
}

} // namespace

void draw_handles(const Ui& ui, const ViewInput& input, const std::vector<HandleShape>& shapes, Handle lit) {
  for (const HandleShape& shape : shapes)
    draw_handle(ui, input, shape, shape.handle == lit,
                lit == Handle::none || shape.handle == lit ? 1.f : 0.6f);
}

void draw_grabbed(const Session& session, const Ui& ui, const ToolState& tool, const ViewInput& input) {
  const Grab& grab = *tool.grab;
  if (is_ring(grab.handle)) {
    draw_sector(ui, input, grab);
    const ShownUnit unit = shown_unit("rad", session.units);
    const std::string space = unit.text == "°" ? "" : " ";
    draw_tag(ui, input, input.cursor, "",
             grab.typed.empty() ? short_text(unit.shown(grab.angle), 4) + space + unit.text
                                : typed_text(grab.typed, unit.text));
    return;
  }
  const Vec3 now = grab.centre + grab.by;
  const auto free = free_coordinates(grab.handle, grab.normal);
  for (int i = 0; i < 3; ++i)
    if (free[static_cast<std::size_t>(i)]) draw_axis(ui, input, now, i);
  const auto from = input.on_screen(grab.centre), to = input.on_screen(now);
  if (from && to) {
    draw_dot(ui, *from, 3);
    draw_line(ui, *from, *to, color_of(ui, grab.handle), 2);
    if (!grab.what.empty()) draw_dot(ui, *to, 7, true);
    if (!grab.point) draw_ball(ui, *to, true, 1);
  }
  draw_tag(ui, input, input.cursor, grab.what,
           moved_text(grab, snaps(tool, input) ? grid_step(input) : 0, session.units));
}

} // namespace flyball
