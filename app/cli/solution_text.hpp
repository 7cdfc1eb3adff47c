// A solution as a person reads it in a terminal: no more digits than the error estimate supports, every
// number with its unit.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/report/analysis.hpp"

#include <span>
#include <string>

namespace flyball::cli {

std::string to_text(const Mechanism& mechanism, const Solution& solution);
// `more`: lines that follow each equilibrium.
std::string to_text(const Mechanism& mechanism, const AllSolutions& all, std::span<const std::string> more);

// Lines of position, velocity and, where it is known, acceleration, with the label in a column of `width`.
std::string motion_text(const std::string& label, std::size_t width, const PointMotion& motion,
                        bool accelerated = true);

} // namespace flyball::cli
