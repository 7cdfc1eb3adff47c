// A picture in memory, and PNG in and out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// Rows from the top, four bytes a pixel: red, green, blue, alpha (sRGB, alpha not premultiplied).
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int w, int h);
  const std::uint8_t* at(int x, int y) const { return &pixels[offset(x, y)]; }
  std::uint8_t* at(int x, int y) { return &pixels[offset(x, y)]; }
  bool operator==(const Image&) const = default;

 private:
  std::size_t offset(int x, int y) const {
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

// The bytes of a PNG file. Throws std::runtime_error.
std::string encode_png(const Image& image);
// Throws std::runtime_error where the bytes are no picture.
Image decode_png(std::string_view bytes);

// To and from a file; writing goes beside the file and renames. Throws std::runtime_error.
void write_png(const std::filesystem::path& file, const Image& image);
Image read_png(const std::filesystem::path& file);

} // namespace flyball
