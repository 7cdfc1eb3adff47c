#include "app/ui/tools/tool_glyphs.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace flyball {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Draws in a square from (-1, -1), at the upper left, to (1, 1).
class GlyphPen {
 public:
  GlyphPen(ImDrawList& list, ImVec2 center, float half, ImU32 ink)
      : list_(list), center_(center), half_(half), ink_(ink), width_(std::max(1.f, 0.15f * half)) {}

  void line(std::initializer_list<ImVec2> points, bool closed = false) const {
    for (const ImVec2& p : points)
      list_.PathLineTo(at(p));
    list_.PathStroke(ink_, closed ? ImDrawFlags_Closed : ImDrawFlags_None, width_);
  }
  void fill(std::initializer_list<ImVec2> points, float alpha = 1) const {
    for (const ImVec2& p : points)
      list_.PathLineTo(at(p));
    list_.PathFillConvex(faded(alpha));
  }
  void circle(ImVec2 p, float radius) const { list_.AddCircle(at(p), radius * half_, ink_, 0, width_); }
  void disc(ImVec2 p, float radius, float alpha = 1) const {
    list_.AddCircleFilled(at(p), radius * half_, faded(alpha));
  }
  void arc(ImVec2 p, float radius, float from, float to) const {
    list_.PathArcTo(at(p), radius * half_, from, to, 20);
    list_.PathStroke(ink_, ImDrawFlags_None, width_);
  }
  // A head whose tip is at `tip`, that points along the angle.
  void head(ImVec2 tip, float angle, float size = 0.62f) const {
    const auto corner = [&](float side) {
      const float a = angle + pi + 0.5f * side;
      return ImVec2(tip.x + size * std::cos(a), tip.y + size * std::sin(a));
    };
    fill({tip, corner(-1), corner(1)});
  }

 private:
  ImVec2 at(ImVec2 p) const { return {center_.x + half_ * p.x, center_.y + half_ * p.y}; }
  ImU32 faded(float alpha) const {
    const auto a = static_cast<ImU32>(alpha * static_cast<float>((ink_ >> IM_COL32_A_SHIFT) & 0xFF));
    return (ink_ & ~IM_COL32_A_MASK) | (a << IM_COL32_A_SHIFT);
  }

  ImDrawList& list_;
  ImVec2 center_;
  float half_;
  ImU32 ink_;
  float width_;
};

void draw_pointer(const GlyphPen& pen) {
  pen.fill({{-0.62f, -0.95f}, {-0.62f, 0.62f}, {-0.2f, 0.25f}, {0.62f, 0.3f}});
  pen.line({{-0.2f, 0.2f}, {0.2f, 0.95f}});
}

void draw_turning(const GlyphPen& pen) {
  pen.arc({0, 0}, 0.8f, -0.1f * pi, 1.4f * pi);
  pen.head({0.32f, -0.8f}, 0.06f * pi, 0.7f);
  pen.fill({{-0.25f, -0.25f}, {0.25f, -0.25f}, {0.25f, 0.25f}, {-0.25f, 0.25f}});
}

void draw_frame(const GlyphPen& pen) {
  for (const float side : {-0.85f, 0.85f})
    for (const float along : {-0.85f, -0.2f, 0.45f}) {
      const float end = along + 0.4f;
      pen.line({{along, side}, {end, side}});
      pen.line({{side, along}, {side, end}});
    }
}

void draw_ball(const GlyphPen& pen) {
  pen.disc({0, 0}, 0.85f, 0.22f);
  pen.circle({0, 0}, 0.85f);
  pen.arc({0, 0}, 0.5f, -0.95f * pi, -0.6f * pi);
}

void draw_block(const GlyphPen& pen) {
  pen.fill({{-0.8f, -0.45f}, {0, -0.05f}, {0, 0.95f}, {-0.8f, 0.5f}}, 0.28f);
  pen.fill({{0.8f, -0.45f}, {0, -0.05f}, {0, 0.95f}, {0.8f, 0.5f}}, 0.12f);
  pen.line({{0, -0.92f}, {0.8f, -0.45f}, {0.8f, 0.5f}, {0, 0.95f}, {-0.8f, 0.5f}, {-0.8f, -0.45f}}, true);
  pen.line({{-0.8f, -0.45f}, {0, -0.05f}, {0.8f, -0.45f}});
  pen.line({{0, -0.05f}, {0, 0.95f}});
}

// A disc with its shaft's hole.
void draw_wheel(const GlyphPen& pen) {
  pen.disc({0, 0}, 0.85f, 0.22f);
  pen.circle({0, 0}, 0.85f);
  pen.circle({0, 0}, 0.25f);
}

void draw_rod(const GlyphPen& pen) {
  pen.fill({{-0.92f, 0.6f}, {0.6f, -0.92f}, {0.92f, -0.6f}, {-0.6f, 0.92f}}, 0.25f);
  pen.line({{-0.92f, 0.6f}, {0.6f, -0.92f}, {0.92f, -0.6f}, {-0.6f, 0.92f}}, true);
}

// A hand that closes, seen from its back.
void draw_hand(const GlyphPen& pen) {
  pen.line({{-0.5f, 0.3f},
            {-0.9f, -0.15f},
            {-0.75f, -0.3f},
            {-0.45f, -0.05f},
            {-0.45f, -0.7f},
            {-0.15f, -0.7f},
            {-0.15f, -0.85f},
            {0.15f, -0.85f},
            {0.15f, -0.7f},
            {0.45f, -0.7f},
            {0.45f, -0.45f},
            {0.75f, -0.45f},
            {0.75f, 0.3f},
            {0.5f, 0.9f},
            {-0.25f, 0.9f}},
           true);
  for (const float x : {-0.15f, 0.15f, 0.45f})
    pen.line({{x, -0.7f}, {x, -0.1f}});
}

void draw_plate(const GlyphPen& pen) {
  pen.fill({{-0.95f, 0.1f}, {0, -0.45f}, {0.95f, 0.1f}, {0, 0.65f}}, 0.25f);
  pen.line({{-0.95f, 0.1f}, {0, -0.45f}, {0.95f, 0.1f}, {0, 0.65f}}, true);
  pen.line({{-0.95f, 0.1f}, {-0.95f, 0.35f}, {0, 0.9f}, {0.95f, 0.35f}, {0.95f, 0.1f}});
}

void draw_hinge(const GlyphPen& pen) {
  pen.circle({0, 0.1f}, 0.36f);
  pen.disc({0, 0.1f}, 0.1f);
  pen.line({{-0.26f, 0.36f}, {-0.8f, 0.9f}});
  pen.line({{0.26f, -0.16f}, {0.9f, -0.8f}});
}

void draw_link(const GlyphPen& pen) {
  pen.circle({-0.66f, 0.66f}, 0.27f);
  pen.circle({0.66f, -0.66f}, 0.27f);
  pen.line({{-0.47f, 0.47f}, {0.47f, -0.47f}});
}

void draw_spring(const GlyphPen& pen) {
  pen.line({{-1, 0},
            {-0.72f, 0},
            {-0.56f, -0.55f},
            {-0.26f, 0.55f},
            {0.02f, -0.55f},
            {0.3f, 0.55f},
            {0.56f, -0.55f},
            {0.72f, 0},
            {1, 0}});
}

void draw_damper(const GlyphPen& pen) {
  pen.line({{-1, 0}, {-0.5f, 0}});
  pen.line({{0.4f, -0.5f}, {-0.5f, -0.5f}, {-0.5f, 0.5f}, {0.4f, 0.5f}});
  pen.line({{0, -0.28f}, {0, 0.28f}});
  pen.line({{0, 0}, {1, 0}});
}

// A ring of balls between two rings.
void draw_bearing(const GlyphPen& pen) {
  pen.circle({0, 0}, 0.92f);
  pen.circle({0, 0}, 0.34f);
  for (int i = 0; i < 6; ++i) {
    const float angle = pi * static_cast<float>(i) / 3;
    pen.disc({0.63f * std::cos(angle), 0.63f * std::sin(angle)}, 0.17f);
  }
}

void draw_force(const GlyphPen& pen) {
  pen.disc({0, -0.78f}, 0.2f);
  pen.line({{0, -0.7f}, {0, 0.5f}});
  pen.head({0, 0.98f}, 0.5f * pi, 0.75f);
}

void draw_torque(const GlyphPen& pen) {
  pen.disc({0, 0}, 0.18f);
  pen.arc({0, 0}, 0.78f, -0.9f * pi, 0.45f * pi);
  pen.head({-0.2f, 0.8f}, pi, 0.66f);
}

// Wind: three lines, of which two curl.
void draw_stream(const GlyphPen& pen) {
  pen.line({{-0.95f, -0.3f}, {0.3f, -0.3f}});
  pen.arc({0.3f, -0.6f}, 0.3f, 0.5f * pi, -0.85f * pi);
  pen.line({{-0.95f, 0.05f}, {0.95f, 0.05f}});
  pen.line({{-0.6f, 0.4f}, {0.2f, 0.4f}});
  pen.arc({0.2f, 0.67f}, 0.27f, -0.5f * pi, 0.85f * pi);
}

// A slanted plate that turns a stream.
void draw_vane(const GlyphPen& pen) {
  pen.line({{-0.45f, 0.75f}, {0.45f, -0.75f}});
  pen.line({{-0.95f, 0.1f}, {-0.2f, 0.1f}, {0.1f, 0.8f}});
  pen.line({{-0.95f, -0.35f}, {0.05f, -0.35f}});
  pen.line({{0.4f, -0.35f}, {0.95f, -0.35f}});
}

} // namespace

void draw_tool_glyph(ImDrawList& list, Tool tool, ImVec2 center, float half, ImU32 ink) {
  const GlyphPen pen(list, center, half, ink);
  switch (tool) {
  case Tool::select: return draw_pointer(pen);
  case Tool::rotate: return draw_turning(pen);
  case Tool::pull: return draw_hand(pen);
  case Tool::box: return draw_frame(pen);
  case Tool::ball: return draw_ball(pen);
  case Tool::block: return draw_block(pen);
  case Tool::rod: return draw_rod(pen);
  case Tool::plate: return draw_plate(pen);
  case Tool::disc: return draw_wheel(pen);
  case Tool::joint: return draw_hinge(pen);
  case Tool::distance: return draw_link(pen);
  case Tool::spring: return draw_spring(pen);
  case Tool::damper: return draw_damper(pen);
  case Tool::bearing: return draw_bearing(pen);
  case Tool::force: return draw_force(pen);
  case Tool::torque: return draw_torque(pen);
  case Tool::drag: return draw_stream(pen);
  case Tool::vane: return draw_vane(pen);
  case Tool::point: return; // begun from a field, not from the strip
  }
}

void draw_magnet_glyph(ImDrawList& list, ImVec2 center, float half, ImU32 ink) {
  const GlyphPen pen(list, center, half, ink);
  pen.arc({0, -0.05f}, 0.75f, pi, 2 * pi);
  pen.arc({0, -0.05f}, 0.3f, pi, 2 * pi);
  for (const float side : {-1.f, 1.f}) {
    pen.line({{0.75f * side, -0.05f}, {0.75f * side, 0.85f}, {0.3f * side, 0.85f}, {0.3f * side, -0.05f}});
    pen.fill({{0.75f * side, 0.45f}, {0.75f * side, 0.85f}, {0.3f * side, 0.85f}, {0.3f * side, 0.45f}});
  }
}

} // namespace flyball
