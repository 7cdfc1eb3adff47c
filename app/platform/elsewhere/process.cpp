#include "app/platform/process.hpp"

#include <random>

namespace flyball {

unsigned process_number() {
  static const unsigned number = std::random_device()();
  return number;
}

std::string this_process() {
  return "here:" + std::to_string(process_number());
}

bool is_running(const std::string& process) {
  return process == this_process();
}

} // namespace flyball
