// They end the program as usual.
#include "app/platform/end_signals.hpp"

namespace flyball {

EndSignals::EndSignals(std::function<void()>, std::function<void()>, double) {}
EndSignals::~EndSignals() = default;
void EndSignals::listen() {}

EndSignalsPutOff::EndSignalsPutOff() = default;
EndSignalsPutOff::~EndSignalsPutOff() = default;

bool EndSignalsPutOff::came_one() {
  return false;
}

} // namespace flyball
