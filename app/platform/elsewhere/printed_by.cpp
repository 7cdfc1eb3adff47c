#include "app/platform/printed_by.hpp"

namespace flyball {

std::optional<std::string> printed_by(const std::vector<std::string>&, std::chrono::milliseconds,
                                      const std::function<bool()>&) {
  return std::nullopt;
}

} // namespace flyball
