#include "app/plot/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace flyball {

namespace {

// Collects points, thinning those within a column as they come.
class Thinner {
 public:
  void add(PixelPoint p) {
    if (count_ > 0 && std::floor(p[0]) == column_) {
      last_ = p;
      ++count_;
      if (p[1] < low_[1]) {
        low_ = p;
        low_at_ = count_;
      }
      if (p[1] > high_[1]) {
        high_ = p;
        high_at_ = count_;
      }
      return;
    }
    flush();
    column_ = std::floor(p[0]);
    first_ = last_ = low_ = high_ = p;
    count_ = low_at_ = high_at_ = 1;
  }
  void finish() {
    flush();
    if (line_.size() > 1) lines.push_back(std::move(line_));
    line_.clear();
  }
  std::vector<PixelLine> lines;

 private:
  void flush() {
    if (count_ == 0) return;
    keep(first_);
    keep(low_at_ < high_at_ ? low_ : high_);
    keep(low_at_ < high_at_ ? high_ : low_);
    keep(last_);
    count_ = 0;
  }
  void keep(const PixelPoint& p) {
    if (line_.empty() || line_.back() != p) line_.push_back(p);
  }

  PixelLine line_;
  double column_ = 0;
  PixelPoint first_{}, last_{}, low_{}, high_{};
  std::size_t count_ = 0, low_at_ = 0, high_at_ = 0;
};

// The part of a segment inside the box (Liang and Barsky); false where there is none.
bool clip_segment(PixelPoint& a, PixelPoint& b, const PlotBox& box) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  double from = 0, to = 1;
  const std::array<std::array<double, 2>, 4> sides = {
      {{-dx, a[0] - box.left}, {dx, box.right - a[0]}, {-dy, a[1] - box.top}, {dy, box.bottom - a[1]}}};
  for (const auto& [slope, room] : sides) {
    if (slope == 0) {
      if (room < 0) return false;
      continue;
    }
    const double t = room / slope;
    if (slope < 0)
      from = std::max(from, t);
    else
      to = std::min(to, t);
  }
  if (!(from <= to)) return false;
  const PixelPoint start = a;
  if (to < 1) b = {start[0] + to * dx, start[1] + to * dy};
  if (from > 0) a = {start[0] + from * dx, start[1] + from * dy};
  return true;
}

bool finite(const PixelPoint& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]);
}

// Both beyond the same side: most segments of a long curve that is zoomed into.
bool beyond(const PixelPoint& a, const PixelPoint& b, const PlotBox& box) {
  return (a[0] < box.left && b[0] < box.left) || (a[0] > box.right && b[0] > box.right) ||
         (a[1] < box.top && b[1] < box.top) || (a[1] > box.bottom && b[1] > box.bottom);
}

} // namespace

std::vector<PixelLine> visible_lines(std::span<const std::array<double, 2>> points, const PlotRuler& x,
                                     const PlotRuler& y, const PlotBox& clip) {
  Thinner thinner;
  PixelPoint before{};
  bool pen = false;     // `before` is a point
  bool drawing = false; // and it is the end of what was added
  for (const auto& point : points) {
    const PixelPoint here = {x.pixel(point[0]), y.pixel(point[1])};
    const bool usable = finite(here);
    if (usable && pen && !beyond(before, here, clip)) {
      const bool inside = clip.contains(before[0], before[1]) && clip.contains(here[0], here[1]);
      PixelPoint a = before, b = here;
      if (inside || clip_segment(a, b, clip)) {
        if (!drawing || a != before) {
          thinner.finish();
          thinner.add(a);
        }
        thinner.add(b);
        drawing = b == here;
      } else {
        drawing = false;
      }
    } else {
      drawing = false;
    }
    if (!drawing) thinner.finish();
    before = here;
    pen = usable;
  }
  thinner.finish();
  return std::move(thinner.lines);
}

PixelLine visible_points(std::span<const std::array<double, 2>> points, const PlotRuler& x,
                         const PlotRuler& y, const PlotBox& clip) {
  PixelLine out;
  std::unordered_set<std::int64_t> taken;
  for (const auto& point : points) {
    const PixelPoint here = {x.pixel(point[0]), y.pixel(point[1])};
    if (!finite(here) || !clip.contains(here[0], here[1])) continue;
    const std::int64_t cell = std::llround(here[0]) * 100'000 + std::llround(here[1]);
    if (taken.insert(cell).second) out.push_back(here);
  }
  return out;
}

std::vector<PixelLine> dashes(const PixelLine& line, double ink, double gap) {
  std::vector<PixelLine> out;
  if (line.size() < 2) return out;
  PixelLine stroke = {line.front()};
  bool inked = true;
  double left = ink; // of this stroke or gap
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const PixelPoint a = line[i], b = line[i + 1];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    double done = 0;
    while (length - done > left) {
      done += left;
      const PixelPoint p = {a[0] + (b[0] - a[0]) * done / length, a[1] + (b[1] - a[1]) * done / length};
      if (inked) {
        stroke.push_back(p);
        out.push_back(std::move(stroke));
      }
      inked = !inked;
      stroke = {p};
      left = inked ? ink : gap;
    }
    left -= length - done;
    if (inked) stroke.push_back(b);
  }
  if (inked && stroke.size() > 1) out.push_back(std::move(stroke));
  return out;
}

} // namespace flyball
