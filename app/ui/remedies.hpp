// Buttons that mend what keeps a mechanism from having a steady state, or show what it does instead; and that
// turn what stands in elastic bearings.
#pragma once

#include "app/document/bearing_drive.hpp"

#include <memory>
#include <string>
#include <vector>

namespace flyball {

struct Session;
struct Solution;
struct Ui;

// The bodies of a mechanism that can be given a drive in their bearings, kept until it is another.
struct InBearings {
  std::shared_ptr<const Mechanism> of;
  std::vector<BodyInBearings> bodies;
};

// Below the verdict; nothing where there is a steady state in which bearings bear what turns.
void remedies(Session& session, Ui& ui, InBearings& in_bearings);
// "Nothing holds prismatic1"; empty where nothing runs away.
std::string unheld_words(const Solution& solution);

} // namespace flyball
