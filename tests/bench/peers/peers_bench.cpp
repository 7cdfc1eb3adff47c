// The direct solution against MuJoCo and Simbody at the same job, each tuned with hindsight, against the
// damped motion at equal error, and against known figures of Newton-Raphson elsewhere: a table in Markdown,
// ratios of one run.
#include "tests/bench/large_scenes.hpp"
#include "tests/bench/peers/flyball_side.hpp"

#include "engine/mechanism/scene.hpp"
#include "engine/study/compare.hpp"

#include <cstdio>
#include <cstring>
#include <exception>
#include <iterator>
#include <string>

namespace {

using namespace flyball;
using namespace flyball::peers;

// rad/s; a chain of 1 m bends above 3.8, and its peers are only given what hangs straight.
constexpr double below_critical = 2, above_critical = 5;

std::string duration(double s) {
  char out[32];
  if (s < 1e-3)
    std::snprintf(out, sizeof out, "%.3g µs", 1e6 * s);
  else if (s < 1)
    std::snprintf(out, sizeof out, "%.3g ms", 1e3 * s);
  else
    std::snprintf(out, sizeof out, "%.3g s", s);
  return out;
}

std::string with_median(const Times& t) {
  return duration(t.fastest_s) + " (" + duration(t.median_s) + ")";
}

std::string factor_text(double x) {
  char out[32];
  std::snprintf(out, sizeof out, x < 100 ? "%.2g" : "%.0f", x);
  return out;
}

// A row; `aim` is by what factor Flyball should be faster, 0 for none.
void row(const std::string& what, const Times& ours, const std::string& peer, double theirs_s, double aim) {
  const double ratio = theirs_s / ours.fastest_s;
  std::string judged;
  if (aim > 0) judged = ratio >= aim ? "met" : "missed " + factor_text(aim / ratio) + " ×";
  std::printf("| %s | %s | %s | %s × | %s | %s |\n", what.c_str(), with_median(ours).c_str(), peer.c_str(),
              factor_text(ratio).c_str(), aim > 0 ? (factor_text(aim) + " ×").c_str() : "", judged.c_str());
  std::fflush(stdout);
}

using Peer = PeerResult (*)(const Job&, Damping);

void measured_row(const Job& job, const Times& ours, const std::string& engine, Peer peer, Damping damping) {
  const char* kind = damping == Damping::free ? "each damper chosen by hindsight, beyond what is real"
                     : job.chain              ? "damped as tuned"
                                              : "the scene's dampers, scaled";
  std::fprintf(stderr, "%s: tuning %s, %s\n", job.name.c_str(), engine.c_str(), kind);
  const double begin = thread_seconds();
  const PeerResult r = peer(job, damping);
  const double spent = thread_seconds() - begin;
  const std::string what = job.name + ", " + engine + ", " + kind;
  if (!r.available) return;
  if (!r.reached) {
    std::printf("| %s | %s | not within %.0f s of tuning: stays %.1e off | | | |\n", what.c_str(),
                with_median(ours).c_str(), spent, r.bias);
    std::fflush(stdout);
    return;
  }
  char detail[160];
  std::snprintf(detail, sizeof detail, "%s (%s), %ld steps, %s, stands at %.0e",
                duration(r.fastest_s).c_str(), duration(r.median_s).c_str(), r.steps, r.settings.c_str(),
                r.bias);
  row(what, ours, detail, r.fastest_s, 0);
}

struct Known {
  const char* text;
  double seconds, aim;
};

void job_rows(const std::string& name, const Mechanism& mechanism, const Known& known) {
  std::fprintf(stderr, "%s: Flyball\n", name.c_str());
  const FlyballResult ours = measure_flyball(mechanism);
  const Job job = make_job(name, mechanism);
  row(name + ", MuJoCo as measured before", ours.cold, known.text, known.seconds, known.aim);
  for (const Damping damping : {Damping::critical, Damping::free}) {
    if (job.chain && damping == Damping::free) continue; // too many to choose
    measured_row(job, ours.cold, "MuJoCo", run_mujoco, damping);
    measured_row(job, ours.cold, "Simbody", run_simbody, damping);
  }
}

// From the straight, tilted start to the stable state.
void bent_row(int links) {
  std::fprintf(stderr, "chain of %d, bent: Flyball\n", links);
  const FlyballResult ours = measure_flyball(bench::chain(links, above_critical));
  std::printf("| chain of %d at 5 rad/s, bent | %s | %d iterations, error %.0e rad | | | |\n", links,
              with_median(ours.cold).c_str(), ours.iterations, ours.error);
  std::fflush(stdout);
}

void motion_row(const std::string& name, const Mechanism& mechanism) {
  std::fprintf(stderr, "%s: the damped motion\n", name.c_str());
  CompareOptions options;
  options.repeats = 2;
  const Comparison c = compare(mechanism, options);
  if (!c.best) return;
  char detail[96];
  std::snprintf(detail, sizeof detail, "%s, error %.1e, tolerance %.0e", duration(c.best->motion_s).c_str(),
                c.best->error, c.best->tolerance);
  row(name + ", the damped motion at its best", {c.best->direct_s, c.best->direct_s}, detail,
      c.best->motion_s, 1000);
}

// `aim` 0: compared with nothing but growth, `seconds` being ten times what a tenth of the links took.
FlyballResult newton_row(int links, const std::string& text, double seconds, double aim) {
  std::fprintf(stderr, "chain of %d: Newton-Raphson\n", links);
  const FlyballResult r = measure_flyball(bench::chain(links, above_critical), false);
  row("Newton, " + std::to_string(r.warm_iterations) + " iterations from a good guess, chain of " +
          std::to_string(links),
      r.warm, text, seconds, aim);
  row("one Newton iteration / one residual, chain of " + std::to_string(links), r.iteration,
      duration(r.residual.fastest_s), r.residual.fastest_s, 0);
  return r;
}

int help() {
  std::puts("usage: peers_bench [pendulum] [governor] [chain] [bent] [motion] [newton]\n"
            "Prints a Markdown table of Flyball against other ways to the same steady state; all parts\n"
            "unless some are named. The scans for the peers' best settings take about two minutes.");
  return 0;
}

} // namespace

int main(int argc, char** argv) try {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0) return help();
  const auto wanted = [&](const char* part) {
    for (int i = 1; i < argc; ++i)
      if (std::strcmp(argv[i], part) == 0) return true;
    return argc == 1;
  };
  const auto scene = [](const char* name) {
    return load_scene(std::string(FLYBALL_ASSETS "/scenes/") + name + ".json");
  };
#ifndef FLYBALL_HAVE_MUJOCO
  std::fprintf(stderr, "MuJoCo is not installed (libmujoco-dev): left out\n");
#endif
#ifndef FLYBALL_HAVE_SIMBODY
  std::fprintf(stderr, "Simbody is not installed (libsimbody-dev): left out\n");
#endif
  std::printf("From the drawn pose to |q - q*| < 1e-6, fastest (median) of one run\n\n"
              "| what | Flyball | the other | ratio | aim | |\n|---|---|---|---|---|---|\n");
  if (wanted("pendulum"))
    job_rows("pendulum", scene("pendulum"), {"9 µs, best conceivable damping", 9e-6, 5});
  if (wanted("governor"))
    job_rows("governor", scene("governor"), {"0.54 ms, best conceivable damping", 0.54e-3, 100});
  if (wanted("chain"))
    job_rows("chain of 100 at 2 rad/s", bench::chain(100, below_critical), {"50 ms", 50e-3, 100});
  if (wanted("bent"))
    for (const int links : {10, 100, 1000, 10000})
      bent_row(links);
  if (wanted("motion")) {
    motion_row("pendulum", scene("pendulum"));
    motion_row("governor", scene("governor"));
  }
  if (wanted("newton")) {
    newton_row(10, "23 µs, Pinocchio's derivatives", 23e-6, 1);
    newton_row(100, "0.45 ms, Pinocchio's derivatives", 0.45e-3, 1);
    const FlyballResult r = newton_row(1000, "170 ms, Pinocchio's derivatives", 0.17, 1);
    newton_row(10000, "ten times the chain of 1000", 10 * r.warm.fastest_s, 0);
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "peers_bench: %s\n", e.what());
  return 1;
}
