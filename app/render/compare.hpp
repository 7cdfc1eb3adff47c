// Whether two pictures show the same thing, as drawn by two machines.
//
// Another Mesa or CPU rounds colours differently by a few 1/255 and moves anti-aliased edges by a
// fraction of a pixel; a missing part changes many neighbouring pixels by a lot. So a pixel is compared
// with the range of colours in the 3x3 window around it in the other picture, both ways: an edge that
// moved by less than a pixel stays inside that range, whatever its contrast. What sticks out of the
// range by more than `channel` in any channel is a differing pixel, and the pictures differ if more than
// `stray` of all pixels do, or if any `block` x `block` tile has more than `dense` of its pixels differing.
#pragma once

#include "app/render/image.hpp"

#include <string>

namespace flyball {

struct CompareTolerance {
  int channel = 10;      // of 255
  double stray = 0.0005; // of all pixels
  int block = 8;         // pixels
  double dense = 0.2;    // of a tile's pixels
};

struct ImageComparison {
  bool same = false;
  double differing = 0;       // of all pixels
  double densest = 0;         // of its pixels, the worst tile
  int worst = 0;              // of 255, the largest excess over the window's range
  int tile_x = 0, tile_y = 0; // pixels, corner of the worst tile
  Image difference;           // the first picture faded, differing pixels in red
  std::string message;        // one line
};

ImageComparison compare(const Image& a, const Image& b, const CompareTolerance& tolerance = {});

} // namespace flyball
