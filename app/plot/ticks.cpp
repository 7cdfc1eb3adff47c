#include "app/plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// A tick as people write it: count * 10^power, exactly.
struct Round {
  double count = 0; // a whole number
  int power = 0;
  double value() const {
    // A power of ten with positive exponent is exact up to 1e22, so that 3e-1 is 0.3; below 1e-300 its
    // reciprocal would overflow.
    return power >= 0      ? count * std::pow(10., power)
           : power >= -300 ? count / std::pow(10., -power)
                           : count / 1e300 / std::pow(10., -power - 300);
  }
};

std::string superscript(int number) {
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (char c : std::to_string(std::abs(number)))
    text += digits[c - '0'];
  return text;
}

// With a minus sign rather than a hyphen.
std::string signed_text(const std::string& text) {
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

int leading_power(double value) {
  return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-12));
}

// All with the same decimal places or the same power of ten, whichever is shorter.
std::vector<std::string> labels_of(const std::vector<Round>& ticks, bool logarithmic) {
  std::vector<std::string> labels;
  double most = 0;
  for (const Round& tick : ticks)
    most = std::max(most, std::abs(tick.count));
  for (const Round& tick : ticks) {
    if (tick.count == 0) {
      labels.emplace_back("0");
      continue;
    }
    const int lead = leading_power(logarithmic ? tick.count : most) + tick.power; // of the first digit
    const int digits = lead - tick.power + 1;
    const int plain = tick.power >= 0 ? lead + 1 : std::max(lead, 0) + 2 - tick.power;
    const int scientific = digits + (digits > 1 ? 1 : 0) + (lead < 0 ? 5 : 4);
    labels.push_back(
        signed_text(plain > std::max(6, scientific)
                        ? fmt::format("{:.{}f}×10{}", Round{tick.count, tick.power - lead}.value(),
                                      digits - 1, superscript(lead))
                        : fmt::format("{:.{}f}", tick.value(), std::max(0, -tick.power))));
  }
  return labels;
}

struct Step {
  int factor = 1, power = 0; // factor 1, 2 or 5; of degrees also parts of a turn
};

Step step_of(double lower, double upper, int wanted) {
  const double raw = upper / wanted - lower / wanted;
  const int power = leading_power(raw);
  for (int factor : {1, 2, 5})
    if (raw <= Round{static_cast<double>(factor), power}.value() * (1 + 1e-9)) return {factor, power};
  return {1, power + 1};
}

std::vector<Round> multiples(double lower, double upper, Step step) {
  std::vector<Round> ticks;
  const double size = Round{static_cast<double>(step.factor), step.power}.value();
  if (!(size > 0) || (upper - lower) / size > 1000) return ticks;
  for (double i = std::ceil(lower / size - 1e-9); i <= upper / size + 1e-9; ++i)
    ticks.push_back({i * step.factor + 0., step.power});
  return ticks;
}

void fill(AxisTicks& out, const std::vector<Round>& major, const std::vector<Round>& minor,
          bool logarithmic) {
  for (const Round& tick : major)
    out.major.push_back(tick.value());
  out.labels = labels_of(major, logarithmic);
  for (const Round& tick : minor)
    if (std::ranges::find(out.major, tick.value()) == out.major.end()) out.minor.push_back(tick.value());
}

AxisTicks linear_ticks(double lower, double upper, int wanted, bool logarithmic) {
  const Step step = step_of(lower, upper, wanted);
  // Fifths of 1 and 5, halves of 2.
  const Step part = step.factor == 1 ? Step{2, step.power - 1} : Step{1, step.power};
  AxisTicks out;
  fill(out, multiples(lower, upper, step), multiples(lower, upper, part), logarithmic);
  return out;
}

// Multiples of the powers of ten.
std::vector<Round> decade_multiples(double lower, double upper, std::initializer_list<int> counts) {
  std::vector<Round> ticks;
  for (int power = leading_power(lower); power <= leading_power(upper); ++power)
    for (int count : counts) {
      const Round tick{static_cast<double>(count), power};
      if (tick.value() >= lower * (1 - 1e-9) && tick.value() <= upper * (1 + 1e-9)) ticks.push_back(tick);
    }
  return ticks;
}

AxisTicks logarithmic_ticks(double lower, double upper, int wanted) {
  const int from = static_cast<int>(std::ceil(std::log10(lower) - 1e-9));
  const int to = static_cast<int>(std::floor(std::log10(upper) + 1e-9));
  AxisTicks out;
  if (to - from + 1 > 2 || (to - from + 1 == 2 && wanted < 4)) {
    const int step = std::max(1, (to - from + wanted) / wanted);
    std::vector<Round> major;
    // Every third decade is a multiple of three.
    for (int power = from + (step - (from % step + step) % step) % step; power <= to; power += step)
      major.push_back({1, power});
    const bool plain = from >= -3 && to <= 4;
    std::vector<Round> minor;
    if (step == 1) {
      minor = decade_multiples(lower, upper, {2, 3, 4, 5, 6, 7, 8, 9});
    } else {
      for (int power = from; power <= to; ++power)
        minor.push_back({1, power});
    }
    fill(out, major, minor, true);
    if (!plain)
      for (std::size_t i = 0; i < major.size(); ++i)
        out.labels[i] = "10" + superscript(major[i].power);
    return out;
  }
  const std::vector<Round> fine = decade_multiples(lower, upper, {1, 2, 5});
  if (fine.size() < 3 && upper < 10 * lower) return linear_ticks(lower, upper, wanted, true);
  const std::vector<Round> coarse = decade_multiples(lower, upper, {1});
  fill(out, static_cast<int>(fine.size()) > 2 * wanted && coarse.size() > 1 ? coarse : fine,
       decade_multiples(lower, upper, {1, 2, 3, 4, 5, 6, 7, 8, 9}), true);
  return out;
}

} // namespace

AxisTicks axis_ticks(double lower, double upper, int wanted, bool logarithmic) {
  if (!(upper > lower) || !std::isfinite(lower) || !std::isfinite(upper) || wanted < 1) return {};
  if (!logarithmic) return linear_ticks(lower, upper, wanted, false);
  return lower > 0 ? logarithmic_ticks(lower, upper, wanted) : AxisTicks{};
}

AxisTicks degree_ticks(double lower, double upper, int wanted) {
  constexpr double turn = 360;
  if (!(upper > lower) || !std::isfinite(lower) || !std::isfinite(upper) || wanted < 1) return {};
  const double raw = upper / wanted - lower / wanted;
  if (raw <= 5 || raw > turn) return linear_ticks(lower, upper, wanted, false);
  struct Parts {
    int major, minor;
  };
  constexpr Parts parts[] = {{10, 5}, {15, 5}, {30, 10}, {45, 15}, {90, 30}, {180, 45}, {360, 90}};
  const Parts* step =
      std::ranges::find_if(parts, [&](const Parts& p) { return raw <= p.major * (1 + 1e-9); });
  AxisTicks out;
  fill(out, multiples(lower, upper, {step->major, 0}), multiples(lower, upper, {step->minor, 0}), false);
  return out;
}

std::string reading_text(double value, double resolution) {
  if (!std::isfinite(value)) return "–";
  // One digit beyond what a pixel tells.
  const int last = resolution > 0 && std::isfinite(resolution) ? leading_power(resolution) - 1 : -6;
  const int lead = value == 0 ? last : leading_power(value);
  const int digits = std::clamp(lead - last + 1, 1, 12);
  if (lead < -4 || lead >= 7)
    return signed_text(value == 0 ? "0" : fmt::format("{:.{}e}", value, digits - 1));
  return signed_text(fmt::format("{:.{}f}", value, std::clamp(digits - 1 - lead, 0, 12)));
}

} // namespace flyball
