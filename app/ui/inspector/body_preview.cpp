#include "app/ui/inspector/body_preview.hpp"

#include "app/ui/panels/view_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr int round_steps = 48;

std::vector<Vec3> circle(const Vec3& center, const Vec3& axis, double radius) {
  const Vec3 a = axis.unitOrthogonal(), b = axis.cross(a);
  std::vector<Vec3> points;
  for (int i = 0; i < round_steps; ++i) {
    const double angle = 2 * std::numbers::pi * i / round_steps;
    points.push_back(center + radius * (std::cos(angle) * a + std::sin(angle) * b));
  }
  return points;
}

// The rim of a ball as it is seen: nearer to the eye than its middle.
std::vector<Vec3> rim(const ViewCamera& camera, const Vec3& center, double radius) {
  if (camera.orthographic) return circle(center, camera.backward(), radius);
  const Vec3 toward = camera.eye() - center;
  const double distance = std::max(toward.norm(), 1.001 * radius);
  const Vec3 axis = toward.stableNormalized();
  const double sine = radius / distance;
  return circle(center + radius * sine * axis, axis, radius * std::sqrt(1 - sine * sine));
}

std::vector<Vec3> corners(const Vec3& center, const Vec3& size) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(center +
                     Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5).cwiseProduct(size));
  return points;
}

// Counter-clockwise, by Andrew's monotone chain.
std::vector<ImVec2> convex_hull(std::vector<ImVec2> points) {
  std::ranges::sort(points, [](ImVec2 a, ImVec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  const auto turns = [](ImVec2 a, ImVec2 b, ImVec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<ImVec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const ImVec2& p : points) {
      while (hull.size() >= base + 2 && !turns(hull[hull.size() - 2], hull.back(), p))
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

std::vector<ImVec2> on_screen(const ViewInput& input, const std::vector<Vec3>& points) {
  std::vector<ImVec2> pixels;
  for (const Vec3& p : points)
    if (const auto pixel = input.on_screen(p)) pixels.push_back(*pixel);
  return pixels;
}

} // namespace

void draw_body_outline(const Ui& ui, const ViewInput& input, const NewBody& body) {
  std::vector<Vec3> points;
  std::vector<std::vector<Vec3>> edges;
  const Vec3 axis = (body.to - body.from).stableNormalized();
  switch (body.form) {
  case BodyForm::ball: points = rim(input.camera, body.at, body.radius); break;
  case BodyForm::rod:
  case BodyForm::disc:
    if (!(axis.norm() > 0)) return;
    for (const Vec3& end : {body.from, body.to}) {
      edges.push_back(circle(end, axis, body.radius));
      points.insert(points.end(), edges.back().begin(), edges.back().end());
    }
    break;
  case BodyForm::block:
  case BodyForm::plate:
    points = corners(body.at, body.size);
    for (std::size_t i = 0; i < 8; ++i)
      for (const std::size_t bit : {1u, 2u, 4u})
        if (!(i & bit)) edges.push_back({points[i], points[i | bit]});
    break;
  }
  const Color& accent = palette(ui.theme).accent;
  const std::vector<ImVec2> hull = convex_hull(on_screen(input, points));
  if (hull.size() < 3) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddConvexPolyFilled(hull.data(), static_cast<int>(hull.size()), packed(accent, 0.22f));
  for (const std::vector<Vec3>& edge : edges) {
    const std::vector<ImVec2> line = on_screen(input, edge);
    list.AddPolyline(line.data(), static_cast<int>(line.size()), packed(accent, 0.45f),
                     edge.size() > 2 ? ImDrawFlags_Closed : ImDrawFlags_None, ui.scale);
  }
  draw_lines(ui, hull, accent, 1.6f, true);
}

} // namespace flyball
