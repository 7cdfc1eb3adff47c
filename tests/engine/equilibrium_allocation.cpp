// A repeated small solve allocates nothing. This program's allocation functions count, on demand.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/mechanism/varied_numbers.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/refine.hpp"

#include <cerrno>
#include <cstdlib>

// Sanitizers bring allocation functions of their own; elsewhere there is no way in below malloc.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FLYBALL_COUNT_ALLOCATIONS 1
#else
#define FLYBALL_COUNT_ALLOCATIONS 0
#endif

namespace {

thread_local bool counting = false;
thread_local long allocations = 0;

} // namespace

#if FLYBALL_COUNT_ALLOCATIONS

// operator new and everything else ends up in one of these.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept {
  allocations += counting;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  allocations += counting;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  allocations += counting;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  allocations += counting;
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  allocations += counting;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) noexcept {
  allocations += counting;
  *out = __libc_memalign(alignment, size);
  return *out ? 0 : ENOMEM;
}
}

#endif

using namespace flyball;
using namespace flyball::test;

namespace {

template <class F>
long allocations_of(F f) {
  allocations = 0;
  counting = true;
  f();
  counting = false;
  return allocations;
}

// One scene and the storage of its solves, as a slider keeps it.
struct Solver {
  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Workspace workspace;
  Found found;
  std::vector<double> history;
  Eigen::VectorXd drawn;
  ErrorEstimate error;

  explicit Solver(Mechanism m) : mechanism(std::move(m)), system(compile(mechanism)) {
    // The cuts that carry the bearing's loop along are the analysis' to find.
    if (mechanism.name == "Governor with a bearing")
      for (const CutChoice& choice : neighbouring_cuts(mechanism, system))
        if (choice.cut == std::vector<int>{joint_index(mechanism, "bearing")})
          system = compile(mechanism, choice);
    take_numbers();
    drawn_configuration(system, parameters, drawn);
  }

  void take_numbers() {
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
  }

  bool solve(const Eigen::VectorXd& start, bool warm) {
    const Problem problem{system, parameters, scaling};
    find_equilibrium(problem, start, false, warm, workspace, history, found);
    if (found.status != Status::converged) return false;
    refine(problem, found.z, found.newton, workspace, error);
    return true;
  }
};

} // namespace

TEST_CASE("a repeated small solve allocates nothing") {
  if (!FLYBALL_COUNT_ALLOCATIONS) {
    WARN("skipped: allocations cannot be counted here (sanitizer, or not glibc)");
    return;
  }
  // The counter counts: through a pointer, since compilers may leave out an allocation nobody uses.
  void* (*const volatile allocate)(std::size_t) = &::operator new;
  CHECK(allocations_of([&] { ::operator delete(allocate(100)); }) == 1);
  CHECK(allocations_of([] {
          Eigen::VectorXd x = Eigen::VectorXd::Zero(50);
          counting = counting && x.size() == 50;
        }) == 1);

  for (const char* scene :
       {"pendulum", "governor", "governor_bearing", "fourbar_turntable", "conical_pendulum"}) {
    Solver solver(shipped(scene));
    CAPTURE(scene);
    bool arrived = true;
    // Warm: a slider moves to and fro, each answer the next start.
    Eigen::VectorXd answer = solver.drawn;
    const double speed = get_parameter(solver.mechanism, "joints.spin.drive.speed");
    const auto warm_solve = [&](double factor) {
      set_parameter(solver.mechanism, "joints.spin.drive.speed", speed * factor);
      solver.take_numbers();
      bool ok = false;
      const long n = allocations_of([&] {
        ok = solver.solve(answer, true);
        answer = solver.found.z.q;
      });
      arrived = arrived && ok;
      return n;
    };
    for (const double factor : {1., 1.01, 1.})
      warm_solve(factor);
    for (const double factor : {1.005, 1.01, 0.99, 1.}) {
      CAPTURE(factor);
      CHECK(warm_solve(factor) == 0);
      CHECK(solver.found.remark == Remark::none);
    }
    // Cold: from the drawn pose, every time, where Newton-Raphson arrives without a fallback.
    arrived = solver.solve(solver.drawn, false) && arrived;
    const bool plain = !solver.found.fallback && solver.found.remark == Remark::none;
    CHECK(plain == (std::string(scene) != "conical_pendulum"));
    for (int i = 0; plain && i < 2; ++i)
      CHECK(allocations_of([&] { arrived = solver.solve(solver.drawn, false) && arrived; }) == 0);
    CHECK(arrived);
    // New numbers cost nothing either.
    CHECK(allocations_of([&] { solver.take_numbers(); }) == 0);
  }
}

TEST_CASE("a repeated solve of a torque by places of points allocates no more than by a coordinate") {
  if (!FLYBALL_COUNT_ALLOCATIONS) return;
  const auto allocated = [](const std::string& law) {
    Mechanism m = shipped("governor_engine");
    for (Joint& joint : m.joints)
      for (Formula& formula : joint.formulas)
        if (formula.key == "drive.torque") formula.text = law;
    Solver solver(std::move(m));
    Eigen::VectorXd answer = solver.drawn;
    long count = 0;
    for (const double gain : {7500., 7600., 7500., 7550.}) {
      set_parameter(solver.mechanism, "parameters.gain", gain);
      solver.take_numbers();
      bool arrived = false;
      count = allocations_of([&] {
        arrived = solver.solve(answer, true);
        answer = solver.found.z.q;
      });
      CHECK(arrived);
    }
    return count;
  };
  const long by_coordinate = allocated("gain*(coordinate(slide) - 0.15 m)");
  CHECK(by_coordinate <= 1); // of a state rounded for the law
  CHECK(allocated("gain*(distance(collar, spindle) - 0.15 m) - 2 N s*vy(collar)") == by_coordinate);
}

TEST_CASE("setting numbers again and again allocates nothing, nor do expressions of them") {
  if (!FLYBALL_COUNT_ALLOCATIONS) return;
  Mechanism m = shipped("governor_parametric");
  const std::vector<std::string> addresses{"parameters.L", "parameters.k", "joints.slide.damping"};
  VariedNumbers numbers(m, addresses);
  for (const double arm : {0.1, 0.15, 0.2}) {
    const std::array<double, 3> values{arm, 1000 * arm, 10};
    CHECK(allocations_of([&] { numbers.set(values); }) == 0);
    CHECK(m.bodies[1].position.x() == -arm);
  }
}
