// Changes that leave scenes JSON, for libFuzzer.
#include "tests/fuzz/mutate_scene.hpp"

#include <cstdint>
#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using flyball::fuzz::Json;

Json parsed(const std::uint8_t* data, std::size_t size) {
  return Json::parse(data, data + size, nullptr, false);
}

// Zero where it does not fit.
std::size_t written(const Json& scene, std::uint8_t* data, std::size_t most) {
  const std::string text = scene.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > most) return 0;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  std::mt19937 random(seed);
  if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, most);
  Json scene = parsed(data, size);
  if (scene.is_discarded()) return LLVMFuzzerMutate(data, size, most);
  for (unsigned i = 0; i <= seed / 16 % 4; ++i)
    flyball::fuzz::mutate(scene, random);
  const std::size_t length = written(scene, data, most);
  return length > 0 ? length : LLVMFuzzerMutate(data, size, most);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* a, std::size_t a_size,
                                                 const std::uint8_t* b, std::size_t b_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed) {
  std::mt19937 random(seed);
  Json scene = parsed(a, a_size), other = parsed(b, b_size);
  if (scene.is_discarded() || other.is_discarded()) return 0;
  flyball::fuzz::cross(scene, std::move(other), random);
  return written(scene, out, most);
}
