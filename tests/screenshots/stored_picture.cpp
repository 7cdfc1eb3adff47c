#include "stored_picture.hpp"

#include "app/render/fonts.hpp"

#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace flyball::test {

namespace fs = std::filesystem;

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

// What text is drawn with: the same words are a pixel wider or lower in other releases.
std::string text_is_drawn_with() {
  ImFontAtlas atlas;
  std::string all = std::string("Dear ImGui ") + IMGUI_VERSION + "\n";
  for (const std::string& file : load_fonts(atlas, 15, 1).files)
    all += fs::path(file).filename().string() + " " + std::to_string(fs::file_size(file)) + " bytes\n";
  return all;
}

fs::path drawn_with_file() {
  return fs::path(FLYBALL_EXPECTED) / "drawn_with.txt";
}

bool same_text() {
  static const bool same = [] {
    std::ifstream in(drawn_with_file());
    std::stringstream stored;
    stored << in.rdbuf();
    return stored.str() == text_is_drawn_with();
  }();
  return same;
}

// By squares of so many pixels, their means.
Image shrunk(const Image& image, int by) {
  Image out(image.width / by, image.height / by);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (std::size_t c = 0; c < 4; ++c) {
        int sum = 0;
        for (int j = 0; j < by; ++j)
          for (int i = 0; i < by; ++i)
            sum += image.at(x * by + i, y * by + j)[c];
        out.at(x, y)[c] = static_cast<std::uint8_t>(sum / (by * by));
      }
  return out;
}

} // namespace

ImageComparison compare_but_for_letters(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) return compare(a, b);
  return compare(shrunk(a, 8), shrunk(b, 8), {.channel = 16, .stray = 0.01, .block = 4, .dense = 0.5});
}

Image stored_picture(const std::string& name) {
  return read_png(fs::path(FLYBALL_EXPECTED) / (name + ".png"));
}

ImageComparison compare_with_stored(const std::string& name, const Image& image) {
  if (const char* update = std::getenv("FLYBALL_UPDATE_SCREENSHOTS"); update && *update == '1') {
    fs::create_directories(FLYBALL_EXPECTED);
    write_png(fs::path(FLYBALL_EXPECTED) / (name + ".png"), coarse(image));
    std::ofstream(drawn_with_file()) << text_is_drawn_with();
  }
  const bool has_text = !name.ends_with("-view");
  ImageComparison comparison = has_text && !same_text() ? compare_but_for_letters(stored_picture(name), image)
                                                        : compare(stored_picture(name), image);
  if (!comparison.same) {
    fs::create_directories(FLYBALL_DIFFERENT);
    write_png(fs::path(FLYBALL_DIFFERENT) / (name + ".png"), image);
    write_png(fs::path(FLYBALL_DIFFERENT) / (name + "-difference.png"), comparison.difference);
  }
  return comparison;
}

} // namespace flyball::test
