// Every analysis of mutated scenes under libFuzzer. Which one, and what it varies, follows from the bytes, so
// that an input says it all.
#include "tests/fuzz/check_analyses.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  unsigned hash = 2166136261u; // FNV-1a
  for (std::size_t i = 0; i < size; ++i)
    hash = (hash ^ data[i]) * 16777619u;
  const int which = static_cast<int>(hash % flyball::fuzz::analysis_count);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto complaint = flyball::fuzz::check_analysis(bytes, which, hash / flyball::fuzz::analysis_count,
                                                       std::chrono::milliseconds(400));
  if (complaint) {
    std::fprintf(stderr, "fuzz_analyses: %s\n", complaint->c_str());
    std::abort();
  }
  return 0;
}
