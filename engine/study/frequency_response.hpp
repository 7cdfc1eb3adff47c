// How the outputs of a linear model answer to sines of its inputs.
#pragma once

#include "engine/study/linear_model.hpp"

#include <vector>

namespace flyball {

// Magnitude (unit of the output by that of the input) and phase (degrees); not numbers at a pole.
struct BodePoint {
  double frequency = 0, magnitude = 0, phase = 0; // frequency in Hz
};

// Of each output by each input, inputs fastest; a phase goes on from the one before without jumps of a turn.
std::vector<std::vector<BodePoint>> frequency_response(const LinearModel& model,
                                                       const std::vector<double>& frequencies);

// `count` frequencies from one to the other, evenly spaced in their logarithm.
std::vector<double> log_spaced(double from, double to, int count);

// So many (Hz) from a decade below the slowest pole or zero to one above the fastest, and close about poles
// that are little damped, so that their peaks are met.
std::vector<double> telling_frequencies(const LinearModel& model, int count);

// Of what one unit of the input makes of the output: "m/(rad/s)".
std::string transfer_unit(const LinearSignal& output, const LinearSignal& input);

} // namespace flyball
