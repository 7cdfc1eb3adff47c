#include "stored_picture.hpp"

#include <algorithm>
#include <cstdlib>

namespace flyball::test {

namespace fs = std::filesystem;

std::vector<fs::path> shipped_scenes() {
  std::vector<fs::path> scenes;
  for (const fs::directory_entry& entry : fs::directory_iterator(FLYBALL_ASSETS "/scenes"))
    if (entry.path().extension() == ".json") scenes.push_back(entry.path());
  std::ranges::sort(scenes);
  return scenes;
}

AppOptions steady_options(Theme theme) {
  return {.mode = LiveSolver::Mode::immediate,
          .on_news = {},
          .scenes = {},
          .theme = theme,
          .numbers = {.most_digits = 8, .noise = 1e-10, .run_times = false}};
}

namespace {

// To multiples of four: without the dither of smooth backgrounds a PNG takes a third of the room, and the
// comparison's tolerance is wider.
Image coarse(Image image) {
  for (std::uint8_t& value : image.pixels)
    value = static_cast<std::uint8_t>(std::min(255, (value + 2) / 4 * 4));
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    image.pixels[i] = 255;
  return image;
}

} // namespace

Image stored_picture(const std::string& name) {
  return read_png(fs::path(FLYBALL_EXPECTED) / (name + ".png"));
}

ImageComparison compare_with_stored(const std::string& name, const Image& image) {
  if (const char* update = std::getenv("FLYBALL_UPDATE_SCREENSHOTS"); update && *update == '1') {
    fs::create_directories(FLYBALL_EXPECTED);
    write_png(fs::path(FLYBALL_EXPECTED) / (name + ".png"), coarse(image));
  }
  ImageComparison comparison = compare(stored_picture(name), image);
  if (!comparison.same) {
    fs::create_directories(FLYBALL_DIFFERENT);
    write_png(fs::path(FLYBALL_DIFFERENT) / (name + ".png"), image);
    write_png(fs::path(FLYBALL_DIFFERENT) / (name + "-difference.png"), comparison.difference);
  }
  return comparison;
}

} // namespace flyball::test
