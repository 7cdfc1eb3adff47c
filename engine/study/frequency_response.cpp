#include "engine/study/frequency_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr double turn = 2 * std::numbers::pi;

} // namespace

std::vector<std::vector<BodePoint>> frequency_response(const LinearModel& model,
                                                       const std::vector<double>& frequencies) {
  const std::size_t inputs = model.inputs.size(), outputs = model.outputs.size();
  std::vector<std::vector<BodePoint>> out(inputs * outputs);
  std::vector<double> before(out.size(), 0);
  const double none = std::numeric_limits<double>::quiet_NaN(), degrees = 360 / turn;
  for (const double f : frequencies) {
    const auto h = transfer(best_form(model), {0, turn * f});
    for (std::size_t i = 0; i < outputs; ++i)
      for (std::size_t j = 0; j < inputs; ++j) {
        const std::size_t pair = i * inputs + j;
        if (!h) {
          out[pair].push_back({f, none, none});
          continue;
        }
        const std::complex<double> value = (*h)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        double phase = std::arg(value) * degrees;
        if (!out[pair].empty()) phase = before[pair] + std::remainder(phase - before[pair], 360);
        before[pair] = phase;
        out[pair].push_back({f, std::abs(value), phase});
      }
  }
  return out;
}

std::vector<double> log_spaced(double from, double to, int count) {
  std::vector<double> out{from};
  for (int i = 1; i < count; ++i)
    out.push_back(i + 1 == count ? to : from * std::pow(to / from, i / static_cast<double>(count - 1)));
  return out;
}

std::vector<double> telling_frequencies(const LinearModel& model, int count) {
  std::vector<std::complex<double>> told = model.poles;
  if (const auto& x = model.explicit_form)
    for (Eigen::Index i = 0; i < x->c.rows(); ++i)
      for (Eigen::Index j = 0; j < x->b.cols(); ++j)
        if (const auto found = zeros(*x, j, i)) told.insert(told.end(), found->begin(), found->end());
  double fastest = 0;
  for (const std::complex<double> s : model.poles)
    fastest = std::max(fastest, std::abs(s));
  if (fastest == 0) return log_spaced(0.01, 100, count);
  double least = fastest, most = fastest;
  for (const std::complex<double> s : told) {
    const double size = std::abs(s);
    if (!(size > 1e-4 * fastest) || size > 1e4 * fastest) continue; // zero, and what is far away
    least = std::min(least, size);
    most = std::max(most, size);
  }
  std::vector<double> out = log_spaced(least / 10 / turn, most * 10 / turn, count);
  for (const std::complex<double> s : told) {
    const double at = std::abs(s.imag()), wide = std::max(std::abs(s.real()), 1e-6 * at);
    if (!(at > 0) || at < least || at > most || wide > 0.3 * at) continue;
    for (int i = -6; i <= 6; ++i)
      if (const double f = (at + 0.5 * i * wide) / turn; f > out.front() && f < out.back()) out.push_back(f);
  }
  std::ranges::sort(out);
  return out;
}

std::string transfer_unit(const LinearSignal& output, const LinearSignal& input) {
  const auto whole = [](const std::string& unit) {
    return unit.find_first_of(" /") == std::string::npos ? unit : "(" + unit + ")";
  };
  if (input.unit.empty()) return output.unit;
  return (output.unit.empty() ? "1" : whole(output.unit)) + "/" + whole(input.unit);
}

} // namespace flyball
