#include "app/render/image.hpp"

#include "engine/mechanism/file.hpp"

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace flyball {

Image::Image(int w, int h)
    : width(w), height(h), pixels(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

std::string encode_png(const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.pixels.data(),
                              4 * image.width))
    throw std::runtime_error("the picture cannot be encoded as PNG");
  return bytes;
}

Image decode_png(std::string_view bytes) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> data(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                            &width, &height, &channels, 4),
      stbi_image_free);
  if (!data) throw std::runtime_error(std::string("not a picture: ") + stbi_failure_reason());
  Image image(width, height);
  std::copy_n(data.get(), image.pixels.size(), image.pixels.begin());
  return image;
}

void write_png(const std::filesystem::path& file, const Image& image) {
  write_bytes(file, encode_png(image));
}

Image read_png(const std::filesystem::path& file) {
  return decode_png(read_bytes(file));
}

} // namespace flyball
