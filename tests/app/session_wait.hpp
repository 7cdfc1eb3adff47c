// Waiting for what is found in the background.
#pragma once

#include "app/session/session.hpp"

#include <chrono>
#include <thread>

namespace flyball::test {

// Takes steps, as frames of a window, until something is so; false where it is not within two minutes.
template <class Step, class Done>
bool steps_until(const Step& step, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!done() && std::chrono::steady_clock::now() < end) {
    step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done();
}

// The same, updating the session.
template <class Done>
bool wait_until(Session& session, const Done& done) {
  return steps_until([&] { update(session, 0.01); }, done);
}

} // namespace flyball::test
