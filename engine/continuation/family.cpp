#include "engine/continuation/family.hpp"

#include "engine/mechanism/address.hpp"

namespace flyball {

Family::Family(const System& system, const Mechanism& mechanism, const std::string& address, double scale,
               KktForm form)
    : system_(system), mechanism_(mechanism), number_(mechanism_, {&address, 1}), scale_(scale),
      value_(get_parameter(mechanism, address)), form_(form) {
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
}

void Family::set(double value) {
  if (value == value_) return; // bound already
  number_.set({&value, 1});
  bind(system_, mechanism_, parameters_);
  value_ = value;
}

const NumberRates& Family::rates() {
  number_.rates(0, rates_);
  return rates_;
}

} // namespace flyball
