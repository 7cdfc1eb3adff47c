// How the steady state moves with a pinned number, from the implicit function theorem: a line below its
// slider.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/shown_rate.hpp"

namespace flyball {

// By how much they move, the most first. Empty without a steady state, at a singular one, and for what is no
// slider.
std::vector<ShownRate> shown_rates(const Session& session, const std::string& address);

// Pixels; the same whether or not there is anything to tell, so that nothing jumps.
float sensitivity_height(const Ui& ui);
void sensitivity_line(const Session& session, Ui& ui, ShownRates& all, const ParameterControl& control);

} // namespace flyball
