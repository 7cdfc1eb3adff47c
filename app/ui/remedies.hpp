// Buttons that mend what keeps a mechanism from having a steady state, or show what it does instead; and that
// turn what stands in elastic bearings.
#pragma once

#include <string>

namespace flyball {

struct Session;
struct Solution;
struct Ui;

// Below the verdict; nothing where there is a steady state in which bearings bear what turns.
void remedies(Session& session, Ui& ui);
// "Nothing holds prismatic1"; empty where nothing runs away.
std::string unheld_words(const Solution& solution);

} // namespace flyball
