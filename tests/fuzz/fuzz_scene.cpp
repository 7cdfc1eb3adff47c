// The scene reader and the solver behind it under libFuzzer.
#include "tests/fuzz/check_scene.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (const auto complaint = flyball::fuzz::check_scene(bytes, std::chrono::milliseconds(300))) {
    std::fprintf(stderr, "fuzz_scene: %s\n", complaint->c_str());
    std::abort();
  }
  return 0;
}
