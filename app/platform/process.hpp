// Which program wrote something, and whether it still runs.
#pragma once

#include <string>

namespace flyball {

// Names this process for as long as the machine is up: no other one, not even of another machine or with the
// same number after this one has ended, has the same name.
std::string this_process();
// False for names of another machine or of before its last start, too.
bool is_running(const std::string& process);
// The number in it, which other processes have had before or have on other machines.
unsigned process_number();

} // namespace flyball
