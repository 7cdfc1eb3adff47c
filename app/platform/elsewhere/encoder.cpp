#include "app/platform/encoder.hpp"

#include <stdexcept>

namespace flyball {

struct Encoder::State {};

bool ffmpeg_available() {
  return false;
}

Encoder::Encoder(const std::vector<std::string>&) {
  throw std::runtime_error("cannot start ffmpeg on this system");
}
Encoder::~Encoder() = default;

void Encoder::send(std::vector<char>) {}

bool Encoder::flush(double) {
  return true;
}

bool Encoder::finish(double) {
  return true;
}

} // namespace flyball
