// A linear model as a file for others: JSON, arrays for NumPy, and scripts for MATLAB (Octave) and Python
// that make a system of the control toolbox where it is there, and plain matrices else.
#pragma once

#include "engine/study/frequency_response.hpp"

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

// What dry friction does in it, sentences; empty where nothing rests on friction.
std::string friction_text(const LinearModel& model);

// Of a model that is not refused.
std::string linear_model_file(const Mechanism& mechanism, const LinearModel& model, LinearModelFormat format);

// One row a frequency (Hz): of each output by each input the magnitude in units of the output by those of the
// input, and the phase (degrees), without jumps of a turn. Empty cells at a pole.
std::string bode_csv(const LinearModel& model, const std::vector<double>& frequencies);

} // namespace flyball
