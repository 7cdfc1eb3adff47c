// Waiting for what a session finds in the background.
#pragma once

#include "app/session/session.hpp"

#include <chrono>
#include <thread>

namespace flyball::test {

// Updates it until something is so; false where it is not within a minute.
template <class Done>
bool wait_until(Session& session, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done() && std::chrono::steady_clock::now() < end) {
    update(session, 0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done();
}

} // namespace flyball::test
