#include "engine/mechanism/unit_hint.hpp"

#include "engine/mechanism/unit.hpp"

namespace flyball {

std::string unit_hint(std::string_view name) {
  return find_unit(name) ? "; units follow their number without a sign, as in 2 N m" : "";
}

} // namespace flyball
