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

bool BoundLaw::resists_at_rest() const {
  constexpr double near = 1e-9; // before and after a kink
  const Dual before = (*this)({-near, 1}), at_rest = (*this)({0, 1}), beyond = (*this)({near, 1});
  // What is steep between these has its slope at rest, and beyond acts the same way.
  return before.rate >= 0 && !(at_rest.rate < 0) && beyond.rate >= 0 && before.value <= 0 &&
         beyond.value >= 0;
}

BoundLaw line_through(const BoundLaw& law, double x, double slope) {
  static const auto line = std::make_shared<const ForceLaw>("force + slope*(x - there)", "x");
  return {line, {law.value(x), slope, x}};
}

} // namespace flyball
