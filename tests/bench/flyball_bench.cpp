// What a solve is made of, in microseconds, and how the parts compare: evaluating the balance, linearising
// it, a Newton step, a solve from a neighbouring state and one from the drawn pose; and what it saves to
// leave out what a scene does not need. Ratios of one run are printed at the end, since only those carry over
// to another machine.
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/messages.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/refine.hpp"
#include "tests/bench/large_scenes.hpp"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <functional>
#include <map>
#include <memory>

namespace {

using namespace flyball;

// A scene at its steady state, with the storage of its solves.
struct Case {
  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Workspace workspace;
  Found found;
  std::vector<double> history;
  Eigen::VectorXd drawn;
  ErrorEstimate error;
  Unknowns answer;

  explicit Case(Mechanism m) : mechanism(std::move(m)), system(compile(mechanism)) {
    take_numbers();
    drawn_configuration(system, parameters, drawn);
    solve(drawn, false);
    answer = found.z;
    answer.lambda.resize(system.rows);
  }
  Problem problem() const { return {system, parameters, scaling, nullptr, system.kkt_form}; }
  void take_numbers() {
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
  }
  void solve(const Eigen::VectorXd& start, bool warm) {
    find_equilibrium(problem(), start, false, warm, workspace, history, found);
    if (found.status == Status::converged) refine(problem(), found.z, found.newton, workspace, error);
  }
  void set_speed(double speed) {
    for (Joint& j : mechanism.joints)
      for (Coordinate& c : j.coordinates)
        if (c.drive) c.drive->speed = speed;
    take_numbers();
  }
  double speed() const { return get_parameter(mechanism, "joints.spin.drive.speed"); }
};

Mechanism scene(const std::string& name) {
  return load_scene(FLYBALL_ASSETS "/scenes/" + name + ".json");
}

Mechanism without_gravity(Mechanism m) {
  m.gravity.setZero();
  return m;
}

Mechanism standing(Mechanism m) {
  set_parameter(m, "joints.spin.drive.speed", 0);
  return m;
}

// Its drive gives a torque that holds the speed it is driven at, from a hundredth below.
Mechanism by_torque(Mechanism m) {
  for (Joint& j : m.joints)
    if (j.name == "spin") {
      Drive& drive = *j.coordinates[0].drive;
      drive.torque = 0;
      j.formulas.push_back({"drive.torque", "0.5 N m s*(" + number_text(drive.speed) + " - rate(spin))"});
      drive.speed *= 0.99;
    }
  validate(m);
  return m;
}

// The governor without its links: an open tree of the same bodies, its arms held by springs.
Mechanism without_loops(Mechanism m) {
  std::erase_if(m.joints, [](const Joint& j) { return j.type == JointType::distance; });
  for (Joint& j : m.joints)
    if (j.name.starts_with("arm")) j.coordinates[0].spring = CoordinateSpring{20, 0};
  return m;
}

void repeated(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMicrosecond)->MinTime(0.03)->Repetitions(9);
}

void add(const std::string& name, const std::shared_ptr<Case>& c, const std::string& part,
         std::function<void(Case&)> body) {
  benchmark::RegisterBenchmark((name + "/" + part).c_str(), [c, body](benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state)
      body(*c);
  })->Apply(repeated);
}

void add_parts(const std::string& name, Mechanism mechanism) {
  const auto c = std::make_shared<Case>(std::move(mechanism));
  if (c->found.status != Status::converged)
    std::fprintf(stderr, "%s does not converge: %s\n", name.c_str(), message(c->found, c->problem()).c_str());
  add(name, c, "residual", [](Case& x) {
    forward<double>(x.system, x.parameters, x.answer.q, 0, x.workspace.kinematics);
    evaluate_residual<double>(x.system, x.parameters, x.answer.q, x.answer.lambda, x.workspace.kinematics,
                              x.workspace.residual);
    benchmark::DoNotOptimize(x.workspace.residual.f.data());
  });
  add(name, c, "linearise", [](Case& x) {
    linearize(x.system, x.parameters, x.answer.q, x.answer.lambda, x.workspace.kinematics,
              x.workspace.residual, x.workspace.dense.linearization);
    benchmark::DoNotOptimize(x.workspace.dense.linearization.stiffness.data());
  });
  add(name, c, "iteration", [](Case& x) {
    const Problem p = x.problem();
    evaluate(p, x.answer, 0, x.workspace);
    factor(p, x.answer, x.workspace);
    newton_step(p, x.workspace.residual.f, x.workspace.residual.phi, x.workspace, x.workspace.scaled_step,
                x.workspace.scaled_lambda);
    benchmark::DoNotOptimize(x.workspace.scaled_step.data());
  });
  const double speed = c->speed();
  // A slider moves by half a percent to and fro, each answer the next start: with the new numbers taken.
  benchmark::RegisterBenchmark((name + "/warm").c_str(), [c, speed](benchmark::State& state) {
    Eigen::VectorXd q = c->answer.q;
    bool up = false;
    int iterations = 0, solves = 0;
    for ([[maybe_unused]] auto _ : state) {
      up = !up;
      c->set_speed(up ? 1.005 * speed : speed);
      c->solve(q, true);
      q = c->found.z.q;
      iterations += c->found.iterations;
      ++solves;
    }
    c->set_speed(speed);
    state.counters["iterations"] = static_cast<double>(iterations) / solves;
  })->Apply(repeated);
  benchmark::RegisterBenchmark((name + "/cold").c_str(), [c](benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state)
      c->solve(c->drawn, false);
    state.counters["iterations"] = c->found.iterations;
  })->Apply(repeated);
}

// The response curve over a drive's speed from `to` down to 0 in at least 400 points, each with its
// stability; with and without eigenvalues.
void add_curve(const std::string& name, const Mechanism& mechanism, double to) {
  for (const bool eigenvalues : {false, true})
    benchmark::RegisterBenchmark(
        (name + (eigenvalues ? "/curve with eigenvalues" : "/curve")).c_str(),
        [mechanism, to, eigenvalues](benchmark::State& state) {
          BranchOptions options;
          options.eigenvalues = eigenvalues;
          options.switch_branches = false;
          const auto points = [&](double step) {
            options.largest_step = step;
            const ResponseDiagram d = follow_branches(mechanism, "joints.spin.drive.speed", to, 0, options);
            return d.branches.empty() ? 0 : static_cast<int>(d.branches[0].points.size());
          };
          double step = 0.02;
          while (step > 1e-4 && points(step) < 400)
            step *= 0.9;
          int count = 0;
          for ([[maybe_unused]] auto _ : state)
            count = points(step);
          state.counters["points"] = count;
          const ResponseDiagram d = follow_branches(mechanism, "joints.spin.drive.speed", to, 0, options);
          if (d.branches.size() != 1 || d.branches[0].points.front().stable != true)
            state.SkipWithError("not the one stable curve");
        })
        ->Apply(repeated);
}

// A whole answer with the sign of its stability, from the drawn pose; from beside the answer, where no state
// is left for being unstable.
void add_answers(const std::string& name, const Mechanism& mechanism, double speed) {
  for (const bool beside : {false, true})
    benchmark::RegisterBenchmark(
        (name + (beside ? "/answer from beside" : "/answer")).c_str(),
        [mechanism, speed, beside](benchmark::State& state) {
          Analysis analysis(mechanism);
          SolveOptions options;
          options.details = false;
          const Solution first = analysis.solve(options);
          double found = speed;
          for (const CoordinateSolution& c : first.coordinates)
            if (c.speed) found = *c.speed;
          if (first.status != Status::converged || std::abs(found - speed) > 1e-9 * speed)
            state.SkipWithError(first.message.c_str());
          for (const CoordinateSolution& c : first.coordinates)
            if (beside && !c.driven && !c.dependent)
              options.start.emplace_back(coordinate_label(c),
                                         c.value + 0.01 / static_cast<double>(first.coordinates.size()));
          for ([[maybe_unused]] auto _ : state)
            benchmark::DoNotOptimize(analysis.solve(options));
          state.counters["iterations"] = analysis.solve(options).iterations;
        })
        ->Apply(repeated);
}

// A point of a sweep, from the number to the solution: by numbers that were found beforehand, and as one
// would solve a single mechanism.
void add_points(const std::string& name, const std::string& address, double from, double to) {
  constexpr int count = 200;
  const auto solve = [](Analysis& analysis) {
    SolveOptions options;
    options.details = false;
    benchmark::DoNotOptimize(analysis.solve(options));
  };
  const auto value = [from, to](int i) { return from + (to - from) * (i % count) / (count - 1); };
  benchmark::RegisterBenchmark((name + "/point of a sweep").c_str(), [=](benchmark::State& state) {
    Analysis analysis(scene(name));
    analysis.vary({&address, 1});
    int i = 0;
    for ([[maybe_unused]] auto _ : state) {
      const double x = value(i++);
      analysis.set({&x, 1});
      solve(analysis);
    }
  })->Apply(repeated);
  benchmark::RegisterBenchmark((name + "/point by itself").c_str(), [=](benchmark::State& state) {
    Mechanism varied = scene(name);
    Analysis analysis(varied);
    int i = 0;
    for ([[maybe_unused]] auto _ : state) {
      set_parameter(varied, address, value(i++));
      validate(varied);
      analysis.update(varied);
      solve(analysis);
    }
  })->Apply(repeated);
}

// Prints the fastest of the repetitions of a benchmark, the one least disturbed, and remembers its time.
class Fastest : public benchmark::ConsoleReporter {
 public:
  Fastest() : ConsoleReporter(OO_None) {}
  std::map<std::string, double> time; // us

 private:
  void ReportRuns(const std::vector<Run>& runs) override {
    const Run* best = nullptr;
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration &&
          (!best || run.GetAdjustedCPUTime() < best->GetAdjustedCPUTime()))
        best = &run;
    if (!best) return;
    time[best->run_name.function_name] = best->GetAdjustedCPUTime();
    Run line = *best;
    line.run_name.min_time.clear();
    line.run_name.repetitions.clear();
    ConsoleReporter::ReportRuns({line});
  }
};

void print_ratio(const Fastest& r, const std::string& of, const std::string& to) {
  const auto a = r.time.find(of), b = r.time.find(to);
  if (a != r.time.end() && b != r.time.end())
    std::printf("%-34s / %-34s %8.2f\n", of.c_str(), to.c_str(), a->second / b->second);
}

} // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const std::vector<std::string> scenes{"pendulum", "governor", "chain20"};
  for (const std::string& name : scenes)
    add_parts(name, scene(name));
  add_parts("governor without gravity", without_gravity(scene("governor")));
  add_parts("governor standing", standing(scene("governor")));
  add_parts("governor without loops", without_loops(scene("governor")));
  add_curve("governor", scene("governor"), 30);
  add_points("pendulum", "joints.spin.drive.speed", 2, 20);
  add_points("governor", "joints.spin.drive.speed", 9, 20);
  add_points("governor_parametric", "parameters.L", 0.1, 0.2);
  add_points("governor_engine", "joints.spin.drive.load", -10, 10);
  std::map<std::string, Mechanism> turned{{"governor", scene("governor")}, {"chain20", scene("chain20")}};
  for (const int links : {200, 1000})
    turned.emplace("chain" + std::to_string(links), bench::chain(links, 5));
  for (const auto& [name, mechanism] : turned) {
    const double speed = get_parameter(mechanism, "joints.spin.drive.speed");
    add_answers(name, mechanism, speed);
    add_answers(name + " by torque", by_torque(mechanism), speed);
  }
  Fastest reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();

  std::printf("\nRatios of this run\n");
  for (const std::string& name : scenes) {
    for (const char* part : {"linearise", "iteration", "warm", "cold"})
      print_ratio(reporter, name + "/" + part, name + "/residual");
    print_ratio(reporter, name + "/warm", name + "/iteration");
    print_ratio(reporter, name + "/cold", name + "/warm");
  }
  for (const std::string name : {"pendulum", "governor", "governor_parametric"})
    print_ratio(reporter, name + "/point by itself", name + "/point of a sweep");
  for (const auto& [name, mechanism] : turned)
    for (const std::string part : {"/answer", "/answer from beside"})
      print_ratio(reporter, name + " by torque" + part, name + part);
  print_ratio(reporter, "governor_engine/point of a sweep",
              "governor/point of a sweep"); // its speed is found
  for (const char* curve : {"governor/curve", "governor/curve with eigenvalues"})
    print_ratio(reporter, curve, "governor/cold");
  for (const char* part : {"residual", "iteration", "warm"})
    for (const char* variant : {"without gravity", "standing", "without loops"})
      print_ratio(reporter, "governor " + std::string(variant) + "/" + part, std::string("governor/") + part);
}
