// A linear model as a file for others: JSON, arrays for NumPy, and scripts for MATLAB (Octave) and Python
// that make a system of the control toolbox where it is there, and plain matrices else.
#pragma once

#include "engine/study/linear_model.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

enum class LinearModelFormat { json, npz, matlab, python };

// By a file's ending: ".json", ".npz", ".m", ".py".
std::optional<LinearModelFormat> linear_model_format(std::string_view extension);

// All of it: names, units, values in the steady state, both forms (A, B, C, D null where there is none
// without E), poles, zeros by output and input, static gain, the state's residual and errors. Of a refusal
// its reason, and null for the rest.
nlohmann::ordered_json linear_model_json(const Mechanism& mechanism, const LinearModel& model);

// Of a model that is not refused.
std::string linear_model_file(const Mechanism& mechanism, const LinearModel& model, LinearModelFormat format);

// What the frequency response is told at: `count` frequencies from one to the other (Hz), evenly spaced in
// their logarithm.
std::vector<double> log_spaced(double from, double to, int count);

// One row a frequency (Hz): of each output by each input the magnitude in units of the output by those of the
// input, and the phase (degrees), without jumps of a turn. Empty cells at a pole.
std::string bode_csv(const LinearModel& model, const std::vector<double>& frequencies);

// Magnitude and phase (degrees, without jumps of a turn) of one output by one input; NaN at a pole.
struct BodePoint {
  double frequency = 0, magnitude = 0, phase = 0;
};
std::vector<std::vector<BodePoint>> bode(const LinearModel& model, const std::vector<double>& frequencies);

} // namespace flyball
