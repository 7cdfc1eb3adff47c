// What large scenes cost, stage by stage, and with which power of their bodies that grows.
#include "tests/bench/large_scenes.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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
  std::string text;
  Solution solution;
  double bodies = 0, reading = unlimited, checking = unlimited, compiling = unlimited, accepted = unlimited,
         solving = unlimited; // ms
  double memory = 0;          // MB held

  static constexpr double unlimited = std::numeric_limits<double>::infinity();
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
  if (!(before > 0) || !std::isfinite(before) || !(now > 0)) return "";
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", std::log(now / before) / std::log(ratio));
  return text;
}

// Once more, for the least. Returns the seconds it took.
double measure(Cost& cost) {
  const double start = held();
  Mechanism read;
  std::optional<Analysis> analysis;
  double total = 0;
  const auto least = [&](double& time, const std::function<void()>& work) {
    const double once = seconds(work);
    time = std::min(time, 1e3 * once);
    total += once;
  };
  least(cost.reading, [&] { read = parse_scene(cost.text); });
  least(cost.checking, [&] { validate(read); });
  least(cost.compiling, [&] { analysis.emplace(read); });
  least(cost.solving, [&] { cost.solution = analysis->solve(); });
  cost.accepted = std::min(cost.accepted, 1e3 * cost.solution.run_time_s);
  cost.bodies = static_cast<double>(read.bodies.size() - 1);
  cost.memory = std::max(cost.memory, held() - start);
  return total;
}

void print(const std::string& family, const Cost& cost, const Cost& before) {
  const double ratio = cost.bodies / before.bodies;
  const Solution& s = cost.solution;
  std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f | %s | %.1f | %s | %d%s | %s | %.0e |\n",
              family.c_str(), cost.bodies, cost.reading, cost.checking, cost.compiling, cost.accepted,
              cost.solving,
              power(cost.compiling + cost.solving, before.compiling + before.solving, ratio).c_str(),
              cost.memory, power(cost.memory, before.memory, ratio).c_str(), s.iterations,
              s.fallback ? (" " + std::string(word(*s.fallback))).c_str() : "",
              s.stability_reason ? std::string(word(*s.stability_reason)).c_str()
                                 : std::string(word(s.status)).c_str(),
              s.residual);
}

// All sizes in turn, so that a machine that is faster at times is so for all.
void family(const std::string& name, int largest, const std::function<Mechanism(int)>& make) {
  std::vector<Cost> costs;
  for (int n = 10; n <= largest; n *= 10) {
    costs.emplace_back();
    costs.back().text = write_scene(make(n));
  }
  double total = 0;
  for (int round = 0; round < 9 && total < 20; ++round)
    for (Cost& cost : costs)
      total += measure(cost);
  for (std::size_t i = 0; i < costs.size(); ++i)
    print(name, costs[i], i > 0 ? costs[i - 1] : Cost{});
  std::fflush(stdout);
}

// A row of another table: the ten modes of lowest frequency about a steady state that has been found.
void modes(const std::string& name, const Mechanism& mechanism) {
  Analysis analysis(mechanism);
  const double solving = 1e3 * seconds([&] { analysis.solve(); });
  std::vector<VibrationMode> found;
  double least = Cost::unlimited, total = 0;
  for (int round = 0; round < 9 && total < 20; ++round) {
    const double once = seconds([&] { found = analysis.modes(10); });
    total += once;
    least = std::min(least, once);
  }
  double residual = 0;
  for (const VibrationMode& mode : found)
    residual = std::max(residual, mode.residual);
  std::printf("| %s | %zu | %.2f | %.2f | %zu | %.3f | %.0e |\n", name.c_str(), mechanism.bodies.size() - 1,
              solving, 1e3 * least, found.size(), found.empty() ? 0. : hertz(found.front().frequency),
              residual);
  std::fflush(stdout);
}

// A row of a third table: motion from the drawn pose. Returns its seconds.
double motion(const std::string& name, const Mechanism& mechanism, Integrator method, double duration,
              double before, double ratio) {
  SimulationOptions options;
  options.duration = duration;
  options.method = method;
  Run run;
  double least = Cost::unlimited, total = 0;
  for (int round = 0; round < 9 && total < 10; ++round) {
    run = simulate(mechanism, options);
    least = std::min(least, run.statistics.run_time_s);
    total += run.statistics.run_time_s;
  }
  double balance = 0;
  for (const double b : run.energy.balance)
    balance = std::max(balance, std::abs(b));
  std::printf("| %s | %zu | %.3f | %s | %ld | %ld | %.1f | %.0e |\n", name.c_str(),
              mechanism.bodies.size() - 1, least, power(least, before, ratio).c_str(), run.statistics.steps,
              run.statistics.evaluations, 1e6 * least / static_cast<double>(run.statistics.steps), balance);
  std::fflush(stdout);
  return least;
}

// A row of another table: a curve of about a hundred points from rest on, with stability.
void curve(const std::string& name, const Mechanism& mechanism) {
  BranchOptions options;
  options.largest_step = 0.01;
  options.switch_branches = false;
  ResponseDiagram found;
  double least = Cost::unlimited, total = 0;
  for (int round = 0; round < 5 && total < 20; ++round) {
    const double once =
        seconds([&] { found = follow_branches(mechanism, "joints.spin.drive.speed", 0, 10, options); });
    total += once;
    least = std::min(least, once);
  }
  std::size_t points = 0, told = 0;
  for (const ResponseBranch& b : found.branches) {
    points += b.points.size();
    for (const ResponsePoint& p : b.points)
      told += p.stable.has_value();
  }
  std::printf("| %s | %zu | %.0f | %zu | %zu | %zu |\n", name.c_str(), mechanism.bodies.size() - 1,
              1e3 * least, points, told, found.special.size());
  std::fflush(stdout);
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

  std::printf("\nThe ten modes of lowest frequency: milliseconds, the least of up to nine runs beside the "
              "solve before "
              "them; the lowest\nfrequency, and the largest residual.\n\n"
              "| scene | bodies | solve | ten modes | found | lowest, Hz | residual "
              "|\n|---|---|---|---|---|---|---|\n");
  for (int n = 1000; n <= largest; n *= 10) {
    modes("springy chain at 5 rad/s", bench::springy_chain(n, 5, 0.1, 0));
    modes("springy and damped chain at 5 rad/s", bench::springy_chain(n, 5, 0.1, 1e-4));
    modes("tree", bench::binary_tree(n, 3));
    modes("net of springs", bench::spring_net(side_of(n), 3));
  }

  std::printf("\nOne second of damped motion with BDF at its usual tolerance of 1e-10: seconds, the least of "
              "up to nine runs, the\npower of the bodies by which they grow, microseconds a step, and the "
              "energy (J) not accounted for.\n\n"
              "| scene | bodies | s | power | steps | evaluations | us/step | energy error "
              "|\n|---|---|---|---|---|---|---|---|\n");
  double before = 0;
  int bodies = 0;
  for (const int n : {100, 300, 1000, 3000}) {
    if (n > largest) break;
    before = motion("springy and damped chain at 5 rad/s", bench::springy_chain(n, 5, 0.1, 1e-4),
                    Integrator::bdf, 1, before, bodies > 0 ? static_cast<double>(n) / bodies : 1);
    bodies = n;
  }
  std::printf(
      "\nA tenth of a second of nets, which nothing damps, by the method that the program chooses.\n\n"
      "| scene | bodies | s | power | steps | evaluations | us/step | energy error "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const bool cables : {false, true}) {
    before = bodies = 0;
    for (const int side : {10, 17, 32}) {
      const int n = side * side;
      if (n > largest) break;
      before = motion(cables ? "net of cables" : "net of springs",
                      cables ? bench::cable_net(side, 3) : bench::spring_net(side, 3), Integrator::automatic,
                      0.1, before, bodies > 0 ? static_cast<double>(n) / bodies : 1);
      bodies = n;
    }
  }

  std::printf(
      "\nA curve of about a hundred points with stability, from rest to 10 rad/s: milliseconds, the least "
      "of up to five runs,\nall that is solved on the way included; how many points it has, at how many "
      "the stability is told, and its special points.\n\n"
      "| scene | bodies | curve | points | told | special |\n|---|---|---|---|---|---|\n");
  for (const int n : {100, 300, 1000}) {
    if (n > largest) continue;
    curve("springy chain", bench::springy_chain(n, 2, 0.1, 0));
    curve("springy and damped chain", bench::springy_chain(n, 2, 0.1, 1e-4));
  }
}
