// What large scenes cost, stage by stage, and with which power of their bodies that grows.
#include "tests/bench/large_scenes.hpp"

#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

namespace {

using namespace flyball;

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Milliseconds in all.
double measure(const std::string& family, const Mechanism& mechanism, double before) {
  const std::string text = write_scene(mechanism);
  Mechanism read;
  Solution solution;
  std::optional<Analysis> analysis;
  const double reading = seconds([&] { read = parse_scene(text); });
  const double checking = seconds([&] { validate(read); });
  const double compiling = seconds([&] { analysis.emplace(read); });
  const double solving = seconds([&] { solution = analysis->solve(); });
  const double all = 1e3 * (reading + checking + compiling + solving);
  double error = 0;
  for (const CoordinateSolution& c : solution.coordinates)
    error = std::max(error, c.error);
  const std::string power = before > 0 ? std::to_string(std::log10(all / before)).substr(0, 4) : "";
  std::printf("%-14s %6zu %9.2f %9.2f %9.2f %9.2f %9.2f %9.1f %5s %6d %-9s %-11s %8.1e %8.1e\n",
              family.c_str(), mechanism.bodies.size() - 1, 1e3 * reading, 1e3 * checking, 1e3 * compiling,
              1e3 * solution.run_time_s, 1e3 * solving, all, power.c_str(), solution.iterations,
              solution.net ? std::string(word(*solution.net)).c_str() : "-",
              solution.stability_reason ? std::string(word(*solution.stability_reason)).c_str()
                                        : std::string(word(solution.status)).c_str(),
              solution.residual, error);
  std::fflush(stdout);
  return all;
}

void family(const std::string& name, int largest, const std::function<Mechanism(int)>& make) {
  double before = 0;
  for (int n = 10; n <= largest; n *= 10)
    before = measure(name, make(n), before);
}

} // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 10000;
  std::printf(
      "Milliseconds. `solve` is until the answer is accepted, `whole` with what is reported of it.\n");
  std::printf("%-14s %6s %9s %9s %9s %9s %9s %9s %5s %6s %-9s %-11s %8s %8s\n", "scene", "bodies", "read",
              "validate", "compile", "solve", "whole", "all", "power", "iter", "net", "stable", "residual",
              "error");
  if (argc < 3)
    for (const double speed : {2., 5., 10., 15.})
      family("chain " + std::to_string(static_cast<int>(speed)) + " rad/s", largest,
             [&](int n) { return bench::chain(n, speed); });
  family("net", largest, [](int n) {
    return bench::spring_net(std::max(2, static_cast<int>(std::lround(std::sqrt(n)))), 3);
  });
  family("cable net", largest,
         [](int n) { return bench::cable_net(std::max(2, static_cast<int>(std::lround(std::sqrt(n)))), 3); });
  family("tree", largest, [](int n) { return bench::binary_tree(n, 3); });
}
