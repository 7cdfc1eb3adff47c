// A transfer function as plots: Bode's, and its poles and zeros.
#pragma once

#include "app/plot/plot.hpp"
#include "engine/study/frequency_response.hpp"

namespace flyball {

// Over Hz, or rad/s: the magnitude in decibels of one SI unit of the output by one of the input, and the
// phase in degrees.
Plot magnitude_plot(const std::vector<BodePoint>& response, bool hertz);
Plot phase_plot(const std::vector<BodePoint>& response, bool hertz);

// Crosses and circles in the complex plane (1/s).
Plot pole_zero_plot(const std::vector<std::complex<double>>& poles,
                    const std::vector<std::complex<double>>& zeros);

} // namespace flyball
