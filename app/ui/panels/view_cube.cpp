#include "app/ui/panels/view_cube.hpp"

#include "app/session/session.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace flyball {

namespace {

constexpr double quarter_turn = std::numbers::pi / 2;
constexpr double inner_share = 0.62;                  // half the width of a face's own part, in half edges
constexpr float cube_side = 104, cube_half_edge = 25; // points: of the square it takes, of the cube
constexpr float gravity_ends = 1.45f, gravity_named = 1.76f; // half edges from the middle
constexpr float letter_half = 7;                             // points
static_assert(gravity_named * cube_half_edge + letter_half < cube_side / 2, "the letter is within the view");

struct CubeFace {
  const char* name;
  CubeDirection normal;
  int u, v;           // the axes of its letters: to the right and up
  int u_sign, v_sign; // along or against them
};
constexpr std::array cube_faces{
    CubeFace{"Right", {1, 0, 0}, 2, 1, -1, 1}, CubeFace{"Left", {-1, 0, 0}, 2, 1, 1, 1},
    CubeFace{"Top", {0, 1, 0}, 0, 2, 1, -1},   CubeFace{"Bottom", {0, -1, 0}, 0, 2, 1, 1},
    CubeFace{"Front", {0, 0, 1}, 0, 1, 1, 1},  CubeFace{"Back", {0, 0, -1}, 0, 1, -1, 1}};

// Right, up and front of the mechanism as the camera sees them: each to the right, up and towards the eye.
Mat3 seen_cube_axes(const ViewCamera& camera) {
  ViewCamera front = camera;
  front.azimuth = front.elevation = 0;
  Mat3 own, seen;
  own << front.right(), camera.up, front.backward();
  seen << camera.right(), camera.screen_up(), camera.backward();
  return seen.transpose() * own;
}

Vec3 cube_vector(const CubeDirection& d) {
  return {double(d[0]), double(d[1]), double(d[2])};
}

struct CubeDrawing {
  const Ui& ui;
  const ViewState& state;
  ImVec2 middle;
  float edge; // pixels, half of the cube's
  Mat3 axes;
  ImDrawList& list;

  ImVec2 at(const Vec3& point) const { // in half edges
    const Vec3 seen = axes * point;
    return {middle.x + edge * static_cast<float>(seen.x()), middle.y - edge * static_cast<float>(seen.y())};
  }
};

ImVec2 cube_middle(const Ui& ui, const PanelRect& view) {
  const float half = cube_side / 2 * ui.scale;
  return {std::round(view.x + half + 2 * ui.scale), std::round(view.y + view.height - half - 2 * ui.scale)};
}

// Dear ImGui smooths the edges of what goes round clockwise.
std::array<ImVec2, 4> clockwise(std::array<ImVec2, 4> p) {
  const float area = (p[2].x - p[0].x) * (p[3].y - p[1].y) - (p[3].x - p[1].x) * (p[2].y - p[0].y);
  if (area < 0) std::swap(p[1], p[3]);
  return p;
}

void fill_quad(ImDrawList& list, const std::array<ImVec2, 4>& corners, ImU32 color) {
  const std::array<ImVec2, 4> p = clockwise(corners);
  list.AddQuadFilled(p[0], p[1], p[2], p[3], color);
}

// Letters lie on the face: they turn and shorten with it.
void draw_face_letters(const CubeDrawing& d, const CubeFace& face, ImU32 color) {
  const ImFont& font = *d.ui.fonts.text;
  const float size = font.FontSize;
  const double scale = 0.62 * 2 / static_cast<double>(font.CalcTextSizeA(size, 1e9f, 0, "Bottom").x) * 1.25;
  const ImVec2 text = font.CalcTextSizeA(size, 1e9f, 0, face.name);
  double pen = -0.5 * static_cast<double>(text.x);
  d.list.PushTextureID(font.ContainerAtlas->TexID);
  for (const char* c = face.name; *c; ++c) {
    const ImFontGlyph* glyph = font.FindGlyph(static_cast<ImWchar>(*c));
    if (!glyph) continue;
    const auto corner = [&](float x, float y) {
      Vec3 p = cube_vector(face.normal);
      p[face.u] += face.u_sign * scale * (pen + static_cast<double>(x));
      p[face.v] += face.v_sign * scale * (0.5 * static_cast<double>(size) - static_cast<double>(y));
      return d.at(p);
    };
    d.list.PrimReserve(6, 4);
    d.list.PrimQuadUV(corner(glyph->X0, glyph->Y0), corner(glyph->X1, glyph->Y0),
                      corner(glyph->X1, glyph->Y1), corner(glyph->X0, glyph->Y1), {glyph->U0, glyph->V0},
                      {glyph->U1, glyph->V0}, {glyph->U1, glyph->V1}, {glyph->U0, glyph->V1}, color);
    pen += static_cast<double>(glyph->AdvanceX);
  }
  d.list.PopTextureID();
}

// The part of a face that stands for the direction: the middle, a strip at an edge, or a square at a corner.
void light_patch(const CubeDrawing& d, const CubeFace& face, const CubeDirection& direction, ImU32 color) {
  const auto range = [&](int axis) -> std::array<double, 2> {
    const int sign = direction[static_cast<std::size_t>(axis)];
    if (sign == 0) return {-inner_share, inner_share};
    return sign > 0 ? std::array{inner_share, 1.} : std::array{-1., -inner_share};
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (face.normal[a] != 0 && face.normal[a] != direction[a]) return;
  }
  const auto [u0, u1] = range(face.u);
  const auto [v0, v1] = range(face.v);
  std::array<ImVec2, 4> corners;
  const std::array<std::array<double, 2>, 4> places{{{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    Vec3 p = cube_vector(face.normal);
    p[face.u] = places[i][0];
    p[face.v] = places[i][1];
    corners[i] = d.at(p);
  }
  fill_quad(d.list, corners, color);
}

ImVec4 cube_edge_color(const UiColors& colors) {
  ImVec4 color = colors.dim;
  color.w *= 0.7f;
  return color;
}

void draw_cube_face(const CubeDrawing& d, const CubeFace& face) {
  const double facing = (d.axes * cube_vector(face.normal)).z();
  if (facing <= 1e-3) return;
  const UiColors& colors = colors_of(d.ui);
  const auto corner = [&](int u, int v) {
    Vec3 p = cube_vector(face.normal);
    p[face.u] = u;
    p[face.v] = v;
    return d.at(p);
  };
  const std::array corners{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
  const auto share = static_cast<float>(0.35 + 0.65 * facing);
  ImVec4 shade = colors.border;
  shade.x += (colors.panel.x - shade.x) * share;
  shade.y += (colors.panel.y - shade.y) * share;
  shade.z += (colors.panel.z - shade.z) * share;
  shade.w = 0.94f;
  fill_quad(d.list, corners, packed(shade));
  if (d.state.cube.hovered) {
    ImVec4 lit = colors.accent;
    lit.w = 0.45f;
    light_patch(d, face, *d.state.cube.hovered, packed(lit));
  }
  d.list.AddPolyline(corners.data(), 4, packed(cube_edge_color(colors)), ImDrawFlags_Closed,
                     std::max(1.f, d.ui.scale));
  ImVec4 ink = colors.text;
  ink.w *= static_cast<float>(std::clamp((facing - 0.15) / 0.35, 0., 1.));
  if (ink.w > 0) draw_face_letters(d, face, packed(ink));
}

// From the corner at the left, below and behind, as far as one sees them beside the cube.
void draw_cube_axes(const CubeDrawing& d, bool behind) {
  const ViewCamera& camera = d.state.camera;
  const float s = d.ui.scale;
  const Vec3 corner = d.axes * Vec3(-1, -1, -1);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 world = Vec3::Unit(axis);
    const Vec3 seen(world.dot(camera.right()), world.dot(camera.screen_up()), world.dot(camera.backward()));
    const Vec3 tip = corner + 2.55 * seen;
    if ((corner.z() + tip.z() < 0) != behind) continue;
    const auto place = [&](const Vec3& p) {
      return ImVec2(d.middle.x + d.edge * static_cast<float>(p.x()),
                    d.middle.y - d.edge * static_cast<float>(p.y()));
    };
    const ImU32 color = packed(axis_color(d.ui.theme, axis), 1);
    d.list.AddLine(place(corner), place(tip), color, 2 * s);
    const char name[2] = {"XYZ"[axis], 0};
    const ImFont& font = *d.ui.fonts.text;
    const float size = 0.85f * font.FontSize;
    const ImVec2 text = font.CalcTextSizeA(size, 1e9f, 0, name);
    const ImVec2 end = place(tip + 0.28 * seen);
    d.list.AddText(d.ui.fonts.text, size, {std::round(end.x - text.x / 2), std::round(end.y - text.y / 2)},
                   color, name);
  }
}

} // namespace

bool has_view_cube(const Ui& ui, const ViewState& state, const PanelRect& view) {
  return !state.alone && view.width > 3.2f * cube_side * ui.scale &&
         view.height > 2.6f * cube_side * ui.scale;
}

std::optional<CubeDirection> cube_direction_at(const ViewCamera& camera, double right, double up) {
  const Mat3 axes = seen_cube_axes(camera);
  for (const CubeFace& face : cube_faces) {
    const Vec3 normal = axes * cube_vector(face.normal);
    if (normal.z() <= 1e-3) continue;
    // The point of the face's plane that is seen there.
    const double depth = (1 - normal.x() * right - normal.y() * up) / normal.z();
    const Vec3 p = axes.transpose() * Vec3(right, up, depth);
    if (std::abs(p[face.u]) > 1 || std::abs(p[face.v]) > 1) continue;
    CubeDirection direction = face.normal;
    for (const int axis : {face.u, face.v})
      if (std::abs(p[axis]) > inner_share) direction[static_cast<std::size_t>(axis)] = p[axis] > 0 ? 1 : -1;
    return direction;
  }
  return std::nullopt;
}

std::array<double, 2> cube_angles(const CubeDirection& direction, double azimuth) {
  const double across = std::hypot(direction[0], direction[2]);
  const double elevation = std::atan2(direction[1], across);
  if (across == 0) return {quarter_turn * std::round(azimuth / quarter_turn), elevation};
  return {std::atan2(direction[0], direction[2]), elevation};
}

void use_view_cube(Ui& ui, ViewState& state, const PanelRect& view) {
  ViewCubeState& cube = state.cube;
  cube.hovered.reset();
  if (!has_view_cube(ui, state, view)) return;
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 middle = cube_middle(ui, view), before = ImGui::GetCursorScreenPos();
  const float edge = cube_half_edge * ui.scale, reach = 1.75f * edge;
  ImGui::SetCursorScreenPos({middle.x - reach, middle.y - reach});
  const bool clicked = ImGui::InvisibleButton("cube", {2 * reach, 2 * reach});
  note_widget(ui.widgets, "view/cube");
  const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
  const auto under = cube_direction_at(state.camera, static_cast<double>((io.MousePos.x - middle.x) / edge),
                                       static_cast<double>((middle.y - io.MousePos.y) / edge));
  constexpr float click_slack = 4; // points
  const float slack = click_slack * ui.scale;
  const bool dragged = io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= slack * slack;
  if (hovered && !(active && dragged)) cube.hovered = under;
  if (active && dragged && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    stop_glide(state);
    state.camera.orbit(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y),
                       {static_cast<double>(view.width), static_cast<double>(view.height)});
  } else if (clicked && !dragged && under) {
    const auto [azimuth, elevation] = cube_angles(*under, state.camera.azimuth);
    look_from(state, azimuth, elevation);
  }
  help_on_hover("Click a face, an edge or a corner to look from there; drag to orbit. Keys 1 to 4: front, "
                "right, above, isometric.");
  ImGui::SetCursorScreenPos(before);
}

namespace {

// Downwards, where there is gravity.
void draw_cube_gravity(const CubeDrawing& d) {
  const float s = d.ui.scale;
  const ImVec2 from = d.at({0, -1, 0}), to = d.at({0, -gravity_ends, 0});
  if (std::hypot(to.x - from.x, to.y - from.y) < 3 * s) return;
  const ImU32 color = packed(colors_of(d.ui).dim);
  d.list.AddLine(from, to, color, 1.5f * s);
  d.list.AddCircleFilled(to, 2.2f * s, color);
  const ImVec2 end = d.at({0, -gravity_named, 0});
  const ImFont& font = *d.ui.fonts.text;
  const float size = 0.85f * font.FontSize;
  const ImVec2 text = font.CalcTextSizeA(size, 1e9f, 0, "g");
  d.list.AddText(d.ui.fonts.text, size, {std::round(end.x - text.x / 2), std::round(end.y - text.y / 2)},
                 color, "g");
}

} // namespace

void draw_view_cube(const Session& session, const Ui& ui, const ViewState& state, const PanelRect& view) {
  if (!has_view_cube(ui, state, view)) return;
  const CubeDrawing d{ui,
                      state,
                      cube_middle(ui, view),
                      cube_half_edge * ui.scale,
                      seen_cube_axes(state.camera),
                      *ImGui::GetWindowDrawList()};
  const bool falls = session.mechanism().gravity.stableNorm() > 0, above = state.camera.elevation > 0;
  draw_cube_axes(d, true);
  if (falls && above) draw_cube_gravity(d);
  for (const CubeFace& face : cube_faces)
    draw_cube_face(d, face);
  if (falls && !above) draw_cube_gravity(d);
  draw_cube_axes(d, false);
}

} // namespace flyball
