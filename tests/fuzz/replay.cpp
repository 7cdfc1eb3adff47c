// The fuzzers' corpus, replayed: fuzz_corpus FOLDER [FILE ...]. Every scene under every analysis.
#include "tests/fuzz/check_analyses.hpp"
#include "tests/fuzz/check_scene.hpp"
#include "tests/support/campaign.hpp"

#include "engine/mechanism/file.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

int main(int argc, char** argv) try {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i])) {
      files.emplace_back(argv[i]);
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(argv[i]))
      if (entry.is_regular_file() && entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  using std::chrono::milliseconds, flyball::test::few_or_all;
  const milliseconds for_scene{few_or_all(1000, 2000)}, for_analysis{few_or_all(40, 100)};
  int wrong = files.empty() ? 1 : 0;
  for (const fs::path& file : files) {
    const auto begin = std::chrono::steady_clock::now();
    std::optional<std::string> complaint;
    try {
      const auto bytes = flyball::read_bytes(file);
      complaint = flyball::fuzz::check_scene(bytes, for_scene);
      for (int which = 0; which < flyball::fuzz::analysis_count && !complaint; ++which)
        complaint = flyball::fuzz::check_analysis(bytes, which, static_cast<unsigned>(which), for_analysis);
    } catch (const std::exception& error) {
      complaint = error.what();
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (!complaint && spent.count() > 30) complaint = "took " + std::to_string(spent.count()) + " s";
    if (!complaint) continue;
    ++wrong;
    std::printf("%s: %s\n", file.filename().c_str(), complaint->c_str());
  }
  std::printf("%zu scenes, %d wrong\n", files.size(), wrong);
  return wrong == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "fuzz_corpus: %s\n", error.what());
  return 1;
}
