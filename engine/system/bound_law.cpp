#include "engine/system/bound_law.hpp"

#include "engine/linear/quadrature.hpp"

namespace flyball {

BoundLaw::BoundLaw(std::shared_ptr<const ForceLaw> law, std::vector<Dual> numbers)
    : law_(std::move(law)), numbers_(std::move(numbers)) {}

Dual BoundLaw::operator()(Dual x) const {
  if (law_) return (*law_)(numbers_, x);
  return numbers_.empty() ? Dual(0) : numbers_.front();
}

double BoundLaw::energy(double x) const {
  return integral([this](double at) { return (*this)(Dual(at)).value; }, 0, x);
}

BoundLaw line_through(const BoundLaw& law, double x, double slope) {
  static const auto line = std::make_shared<const ForceLaw>("force + slope*(x - there)", "x");
  return {line, {law.value(x), slope, x}};
}

} // namespace flyball
