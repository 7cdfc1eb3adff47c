// How often a slider's move copies the mechanism: its description is so long that nothing else asks for as
// much memory at once, and is counted as it is allocated.
#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr std::size_t long_text = 40'000'000;
std::atomic<int> copies{0};

void* counted(std::size_t size) {
  if (size >= long_text) ++copies;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}

} // namespace

void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { // of std::stable_sort
  return std::malloc(size ? size : 1);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

TEST_CASE("Session: a slider's move copies the mechanism once at most") {
  Session session({.mode = BackgroundWorker::Mode::immediate});
  Mechanism governor = shipped("governor");
  governor.description.assign(long_text, ' ');
  open_document(session, Document(std::move(governor)));
  const std::string speed = "joints.spin.drive.speed", stiffness = "joints.slide.spring.stiffness";
  update(session, 0.02);
  REQUIRE(converged(session));
  const auto move = [&](const std::string& address, double factor) {
    const int before = copies;
    change_parameter(session, address, factor * get_parameter(session.mechanism(), address));
    for (int frame = 0; frame < 3; ++frame)
      update(session, 0.02);
    CHECK(converged(session));
    return copies - before;
  };
  ++session.gesture;
  CHECK(move(speed, 1.01) == 1); // the document's new one
  CHECK(move(speed, 1.01) == 1);
  ++session.gesture;
  CHECK(move(stiffness, 1.01) == 1);

  SECTION("and once more for each study that is followed") {
    open_study(session, StudyKind::response);
    update(session, 0.02);
    REQUIRE(session.study.response.curve.found);
    const int first = move(speed, 1.01);
    CHECK(first == 2); // the curve's mechanism, which turns out to be the same
  }
  SECTION("while building, too") {
    drop_explored(session); // which are kept beside what is stored
    set_mode(session, Mode::build);
    const int before = copies;
    change_parameter(session, stiffness, 1234);
    update(session, 0.02);
    CHECK(copies - before == 1);
  }
}
