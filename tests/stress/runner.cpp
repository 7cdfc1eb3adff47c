#include "tests/stress/runner.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <thread>

#include <unistd.h>

namespace flyball::stress {
namespace {

using Clock = std::chrono::steady_clock;

struct Slot {
  std::atomic<const char*> name{nullptr};
  std::atomic<double> since{0}; // s, of the clock
  std::atomic<bool> cancel{false};
};
std::array<Slot, 16> slots;

double now() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

void tell_running(const char* what) {
  const auto say = [](const char* text) { return write(STDERR_FILENO, text, std::strlen(text)); };
  say(what);
  for (const Slot& slot : slots)
    if (const char* name = slot.name.load()) {
      say(" ");
      say(name);
    }
  say("\n");
}

extern "C" void crashed(int) {
  tell_running("crashed in one of:");
  _exit(3);
}

Result run_one(const Case& c, Slot& slot, bool other_starts) {
  Result out{c.family, c.name, {}, 0};
  slot.cancel = false;
  slot.since = now();
  slot.name = c.name.c_str();
  try {
    out.verdict = c.run(slot.cancel);
    if (other_starts && out.verdict.outcome == Outcome::refused && c.other_starts)
      out.verdict.remark += c.other_starts(slot.cancel);
  } catch (const std::exception& e) {
    out.verdict = {};
    out.verdict.remark = std::string("an exception: ") + e.what();
  } catch (...) {
    out.verdict = {};
    out.verdict.remark = "an unknown exception";
  }
  slot.name = nullptr;
  out.wall_s = now() - slot.since;
  if (slot.cancel) {
    out.verdict.outcome = Outcome::failed;
    out.verdict.remark = "took too long: " + out.verdict.remark;
  }
  return out;
}

} // namespace

std::vector<Result> run_cases(const Cases& cases, int threads, bool other_starts) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL})
    std::signal(signal, crashed);
  std::vector<Result> results(cases.size());
  std::atomic<std::size_t> next{0}, done{0};
  std::vector<std::jthread> workers;
  for (int t = 0; t < std::min(threads, static_cast<int>(slots.size())); ++t)
    workers.emplace_back([&, t] {
      for (std::size_t i = next++; i < cases.size(); i = next++) {
        results[i] = run_one(cases[i], slots[static_cast<std::size_t>(t)], other_starts);
        ++done;
      }
    });
  while (done < cases.size()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (Slot& slot : slots) {
      if (!slot.name.load()) continue;
      const double spent = now() - slot.since;
      if (spent > patience) slot.cancel = true;
      if (spent > 6 * patience) { // it does not even listen
        tell_running("hangs in one of:");
        _exit(3);
      }
    }
  }
  return results;
}

} // namespace flyball::stress
