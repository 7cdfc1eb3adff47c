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
#include <limits>
#include <optional>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using namespace flyball;

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// What one scene costs.
struct Cost {
  double bodies = 0, solving = 0, memory = 0; // compiling and solving in ms; MB held
};

double held() {
#ifdef __GLIBC__
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks + now.hblkhd) / 1e6;
#else
  return 0;
#endif
}

std::string power(double now, double before, double ratio) {
  if (!(before > 0) || !(now > 0)) return "";
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", std::log(now / before) / std::log(ratio));
  return text;
}

Cost measure(const std::string& family, const Mechanism& mechanism, const Cost& before) {
  const std::string text = write_scene(mechanism);
  const double start = held();
  Mechanism read;
  Solution solution;
  std::optional<Analysis> analysis;
  const auto unlimited = std::numeric_limits<double>::infinity();
  double reading = unlimited, checking = unlimited, compiling = unlimited, whole = unlimited,
         accepted = unlimited;
  double total = 0;
  for (int run = 0; run < 9 && total < 8; ++run) {
    const auto least = [&](double& time, const std::function<void()>& work) {
      const double once = seconds(work);
      time = std::min(time, 1e3 * once);
      total += once;
    };
    least(reading, [&] { read = parse_scene(text); });
    least(checking, [&] { validate(read); });
    analysis.reset();
    least(compiling, [&] { analysis.emplace(read); });
    least(whole, [&] { solution = analysis->solve(); });
    accepted = std::min(accepted, 1e3 * solution.run_time_s);
  }
  const Cost cost{static_cast<double>(read.bodies.size() - 1), compiling + whole, held() - start};
  const double ratio = cost.bodies / before.bodies;
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f | %s | %.1f | %s | %d%s | %s | %.0e |\n",
              family.c_str(), cost.bodies, reading, checking, compiling, accepted, whole,
              power(cost.solving, before.solving, ratio).c_str(), cost.memory,
              power(cost.memory, before.memory, ratio).c_str(), solution.iterations,
              solution.net ? (" " + std::string(word(*solution.net))).c_str() : "",
              solution.stability_reason ? std::string(word(*solution.stability_reason)).c_str()
                                        : std::string(word(solution.status)).c_str(),
              solution.residual);
  std::fflush(stdout);
  return cost;
}

void family(const std::string& name, int largest, const std::function<Mechanism(int)>& make) {
  Cost before;
  for (int n = 10; n <= largest; n *= 10)
    before = measure(name, make(n), before);
}

int side_of(int bodies) {
  return std::max(2, static_cast<int>(std::lround(std::sqrt(bodies))));
}

} // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 10000;
  std::printf(
      "Milliseconds, the least of up to nine runs. `accepted` is the solve until its answer stands, `solve` "
      "with all that is\ntold of it; `power` of the bodies by which compiling and solving grow, and the "
      "memory "
      "held after it (MB).\n\n"
      "| scene | bodies | read | check | compile | accepted | solve | power | MB | power | iterations | "
      "stability | residual |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double speed : {2., 5., 10., 15.})
    family("chain at " + std::to_string(static_cast<int>(speed)) + " rad/s", largest,
           [&](int n) { return bench::chain(n, speed); });
  family("tree", largest, [](int n) { return bench::binary_tree(n, 3); });
  family("net of springs", largest, [](int n) { return bench::spring_net(side_of(n), 3); });
  family("net of cables", largest, [](int n) { return bench::cable_net(side_of(n), 3); });
  // Knots and about two rods each. Ten thousand bodies would take longer than all the rest.
  family("net of rods", std::min(largest, 1000), [](int n) { return bench::rod_net(side_of(n / 3), 3); });
}
