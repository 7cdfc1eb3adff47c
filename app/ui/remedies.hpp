// Buttons that mend what keeps a mechanism from having a steady state, or show what it does instead.
#pragma once

#include "app/ui/app.hpp"

#include <string>

namespace flyball {

// Below the verdict; nothing where there is a steady state.
void remedies(App& app);
// "Nothing holds prismatic1"; empty where nothing runs away.
std::string unheld_words(const Solution& solution);

} // namespace flyball
