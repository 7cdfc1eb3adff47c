// Asks another program.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flyball {

// What a program prints within the time, which is ended then or when `given_up` says so; nothing where it
// cannot be run, fails or is late.
std::optional<std::string> printed_by(const std::vector<std::string>& command,
                                      std::chrono::milliseconds limit,
                                      const std::function<bool()>& given_up = {});

} // namespace flyball
