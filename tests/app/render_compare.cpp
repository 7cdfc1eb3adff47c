#include "app/render/compare.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <functional>

using namespace flyball;

namespace {

// A disc of `radius` at (x, y) on a gradient, its edge anti-aliased.
Image disc(double x, double y, double radius, int noise = 0) {
  Image image(160, 120);
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const double inside = std::clamp(radius + 0.5 - std::hypot(u + 0.5 - x, v + 0.5 - y), 0.0, 1.0);
      const int jitter = noise ? (u * 7 + v * 13) % (2 * noise + 1) - noise : 0;
      for (int c = 0; c < 3; ++c)
        image.at(u, v)[c] = static_cast<std::uint8_t>(
            std::clamp(std::lround(200 + 0.2 * v + inside * (40.0 * c - 190)) + jitter, 0L, 255L));
      image.at(u, v)[3] = 255;
    }
  return image;
}

} // namespace

TEST_CASE("a picture is the same as itself") {
  const Image a = disc(80, 60, 30);
  const ImageComparison c = compare(a, a);
  CHECK(c.same);
  CHECK(c.worst == 0);
}

TEST_CASE("rounding and edges moved by less than a pixel are accepted") {
  const Image a = disc(80, 60, 30);
  CHECK(compare(a, disc(80, 60, 30, 3)).same);
  CHECK(compare(a, disc(80.4, 59.7, 30, 2)).same);
  CHECK(compare(a, disc(80, 60, 30.5)).same);
}

TEST_CASE("missing, added, moved and recoloured parts are rejected") {
  const Image a = disc(80, 60, 30);
  CHECK_FALSE(compare(a, disc(80, 60, 0)).same);
  CHECK_FALSE(compare(disc(80, 60, 0), disc(80, 60, 4)).same);
  CHECK_FALSE(compare(a, disc(83, 60, 30)).same);
  CHECK_FALSE(compare(a, disc(80, 60, 34)).same);
  Image tinted = a;
  for (std::size_t i = 0; i < tinted.pixels.size(); i += 4)
    tinted.pixels[i] = static_cast<std::uint8_t>(std::min(255, tinted.pixels[i] + 25));
  CHECK_FALSE(compare(a, tinted).same);
}

TEST_CASE("a thin line that vanished is rejected") {
  const Image a = disc(80, 60, 30);
  Image lined = a;
  for (int u = 10; u < 150; ++u)
    for (int c = 0; c < 3; ++c)
      lined.at(u, 100)[c] = 60;
  CHECK_FALSE(compare(a, lined).same);
}

TEST_CASE("other sizes are rejected, with the reason") {
  const ImageComparison c = compare(Image(3, 4), Image(4, 3));
  CHECK_FALSE(c.same);
  CHECK_THAT(c.message, ContainsSubstring("3 x 4"));
}

TEST_CASE("PNG keeps every byte") {
  Image a = disc(40, 50, 20, 5);
  a.at(3, 3)[3] = 17;
  CHECK(decode_png(encode_png(a)) == a);
  CHECK_THROWS(decode_png("not a picture"));
}
