#include "app/platform/process.hpp"

#include <fstream>
#include <sstream>
#include <unistd.h>

namespace flyball {

namespace {

// Changes with every start of the machine.
std::string machine() {
  std::string id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
  return id.empty() ? "here" : id;
}

// When it was started, in the kernel's ticks; empty where it does not run.
std::string start_of(const std::string& number) {
  std::ifstream file("/proc/" + number + "/stat");
  std::string line;
  std::getline(file, line);
  // The program's name comes second, in brackets, and may hold anything.
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream rest(line.substr(name_end + 1));
  std::string word;
  rest >> word;
  if (word == "Z" || word == "X") return {}; // dead, only not yet buried
  for (int field = 4; field <= 22; ++field)
    rest >> word;
  return word;
}

} // namespace

unsigned process_number() {
  return static_cast<unsigned>(::getpid());
}

std::string this_process() {
  const std::string number = std::to_string(process_number());
  return machine() + ":" + number + ":" + start_of(number);
}

bool is_running(const std::string& process) {
  const std::size_t first = process.find(':'), last = process.rfind(':');
  if (first == std::string::npos || last == first || process.substr(0, first) != machine()) return false;
  const std::string number = process.substr(first + 1, last - first - 1);
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) return false;
  const std::string start = start_of(number);
  return !start.empty() && start == process.substr(last + 1);
}

} // namespace flyball
