#include "engine/continuation/family.hpp"

#include "engine/mechanism/address.hpp"

namespace flyball {

Family::Family(const System& system, const Mechanism& mechanism, std::string address, double scale,
               KktForm form)
    : system_(system), mechanism_(mechanism), address_(std::move(address)), scale_(scale), form_(form) {
  value_ = get_parameter(mechanism_, address_);
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
}

void Family::set(double value) {
  if (value == value_) return; // bound already
  set_parameter(mechanism_, address_, value);
  bind(system_, mechanism_, parameters_);
  value_ = value;
}

} // namespace flyball
