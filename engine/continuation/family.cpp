#include "engine/continuation/family.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/validate.hpp"

#include <limits>

namespace flyball {

bool makes_others(const std::string& address) {
  return address.starts_with("parameters.") || address.starts_with("points.");
}

Family::Family(const System& system, const Mechanism& mechanism, const std::string& address, double scale,
               KktForm form)
    : system_(system), mechanism_(mechanism), number_(mechanism_, {&address, 1}),
      makes_others_(makes_others(address)), scale_(scale), value_(get_parameter(mechanism, address)),
      form_(form) {
  bind(system_, mechanism_, parameters_);
  set_scaling(system_, parameters_, scaling_);
}

void Family::set(double value) {
  if (value == value_) return;                       // bound already
  value_ = std::numeric_limits<double>::quiet_NaN(); // till it is bound
  number_.set({&value, 1});
  bind(system_, mechanism_, parameters_);
  value_ = value;
  turn(starts_);
}

void Family::expect_possible() const {
  if (makes_others_) validate_numbers(mechanism_);
}

void Family::tie(std::optional<AngleTies> ties) {
  ties_ = std::move(ties);
  starts_ = {};
  bind(system_, mechanism_, parameters_);
}

void Family::turn(const Eigen::VectorXd& starts) {
  if (!ties_ || starts.size() == 0) return;
  starts_ = starts;
  for (const int link : ties_->found)
    parameters_.links[static_cast<std::size_t>(link)].start = starts_[link];
}

const NumberRates& Family::rates() {
  number_.rates(0, rates_);
  return rates_;
}

} // namespace flyball
