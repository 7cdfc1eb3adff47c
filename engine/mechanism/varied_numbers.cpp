#include "engine/mechanism/varied_numbers.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>

namespace flyball {
namespace {

std::string changeable_instead(const Mechanism& mechanism, const std::string& formula) {
  std::vector<std::string> sources = sources_of(mechanism, formula);
  if (sources.empty()) return {};
  return "; change " + word_list(std::vector<std::string_view>(sources.begin(), sources.end()));
}

} // namespace

VariedNumbers::VariedNumbers(Mechanism& mechanism, std::span<const std::string> addresses)
    : plan_(mechanism) {
  for (const std::string& address : addresses) {
    places_.push_back({address, addressed_number(mechanism, address)});
    if (const std::optional<std::string> formula = formula_at(mechanism, address))
      throw SceneError(address, "its value is given by \"=" + *formula + "\"" +
                                    changeable_instead(mechanism, *formula));
  }
}

std::vector<double> VariedNumbers::values() const {
  std::vector<double> out;
  for (const Place& place : places_)
    out.push_back(place.number.value);
  return out;
}

void VariedNumbers::set(std::span<const double> values) {
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (!std::isfinite(values[i])) throw SceneError(places_[i].address, "expected a finite number");
  try {
    for (std::size_t i = 0; i < places_.size(); ++i)
      places_[i].number.set(values[i]);
    plan_.evaluate();
  } catch (const SceneError&) {
    for (std::size_t i = places_.size(); i-- > 0;)
      places_[i].number.set(places_[i].number.value);
    plan_.evaluate();
    throw;
  }
  for (std::size_t i = 0; i < places_.size(); ++i)
    places_[i].number.value = values[i];
}

void VariedNumbers::rates(std::size_t i, NumberRates& out) const {
  out.clear();
  out.set(places_[i].number.place, 1);
  plan_.differentiate(out);
}

} // namespace flyball
