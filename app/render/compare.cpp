#include "app/render/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace flyball {

namespace {

// By how much pixel (x, y) of `a` lies outside the colours around it in `b`.
int excess(const Image& a, const Image& b, int x, int y) {
  std::array<int, 3> low{255, 255, 255}, high{0, 0, 0};
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, b.height - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, b.width - 1); ++u)
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min<int>(low[c], b.at(u, v)[c]);
        high[c] = std::max<int>(high[c], b.at(u, v)[c]);
      }
  int most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const int value = a.at(x, y)[c];
    most = std::max({most, low[c] - value, value - high[c]});
  }
  return most;
}

std::string percent(double fraction) {
  std::ostringstream text;
  text << std::setprecision(3) << 100 * fraction << " %";
  return text.str();
}

} // namespace

ImageComparison compare(const Image& a, const Image& b, const CompareTolerance& tolerance) {
  ImageComparison result;
  if (a.width != b.width || a.height != b.height) {
    result.differing = result.densest = 1;
    result.message = "sizes differ: " + std::to_string(a.width) + " x " + std::to_string(a.height) + " and " +
                     std::to_string(b.width) + " x " + std::to_string(b.height);
    return result;
  }
  result.difference = a;
  const int block = std::max(tolerance.block, 1);
  const int columns = (a.width + block - 1) / block, rows = (a.height + block - 1) / block;
  std::vector<int> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::size_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const int most = std::max(excess(a, b, x, y), excess(b, a, x, y));
      result.worst = std::max(result.worst, most);
      std::uint8_t* mark = result.difference.at(x, y);
      for (int c = 0; c < 3; ++c)
        mark[c] = static_cast<std::uint8_t>(191 + mark[c] / 4);
      if (most <= tolerance.channel) continue;
      ++count;
      ++tiles[static_cast<std::size_t>(y / block) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(x / block)];
      mark[0] = 220;
      mark[1] = mark[2] = 0;
    }
  const auto total = static_cast<double>(a.width) * a.height;
  result.differing = total > 0 ? static_cast<double>(count) / total : 0;
  if (const auto most = std::max_element(tiles.begin(), tiles.end()); most != tiles.end()) {
    const auto index = static_cast<int>(most - tiles.begin());
    result.densest = static_cast<double>(*most) / (static_cast<double>(block) * block);
    result.tile_x = index % columns * block;
    result.tile_y = index / columns * block;
  }
  result.same = result.differing <= tolerance.stray && result.densest <= tolerance.dense;
  result.message = percent(result.differing) + " of the pixels differ, " + percent(result.densest) +
                   " in the tile at (" + std::to_string(result.tile_x) + ", " +
                   std::to_string(result.tile_y) + "), by up to " + std::to_string(result.worst) + "/255";
  return result;
}

} // namespace flyball
