// Curves in pixels: broken at gaps, cut at the frame, and with no more points than can be seen.
#pragma once

#include "app/plot/axis.hpp"

#include <array>
#include <span>
#include <vector>

namespace flyball {

using PixelPoint = std::array<double, 2>;
using PixelLine = std::vector<PixelPoint>;

struct PlotBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool contains(double x, double y) const { return x >= left && x <= right && y >= top && y <= bottom; }
  bool overlaps(const PlotBox& other, double gap = 0) const {
    return left < other.right + gap && other.left < right + gap && top < other.bottom + gap &&
           other.top < bottom + gap;
  }
  PlotBox grown(double by) const { return {left - by, top - by, right + by, bottom + by}; }
};

// The lines through the points inside `clip`. Of the points that follow one another in one column of pixels
// the first, the lowest, the highest and the last are kept, so that no extreme is lost however many there
// are.
std::vector<PixelLine> visible_lines(std::span<const std::array<double, 2>> points, const PlotRuler& x,
                                     const PlotRuler& y, const PlotBox& clip);

// The points inside `clip`, one for each pixel.
PixelLine visible_points(std::span<const std::array<double, 2>> points, const PlotRuler& x,
                         const PlotRuler& y, const PlotBox& clip);

// The line cut into strokes: lengths of ink and gap in turn.
std::vector<PixelLine> dashes(const PixelLine& line, double ink, double gap);

} // namespace flyball
