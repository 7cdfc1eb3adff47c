#include "app/cli/solution_text.hpp"

#include "app/cli/output.hpp"
#include "app/session/state_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball::cli {
namespace {

// As many decimals as the error leaves, at most `most`.
std::string rounded(double value, double error, int most) {
  const int decimals =
      std::clamp(error > 0 ? static_cast<int>(std::floor(-std::log10(error))) : most, 0, most);
  if (std::abs(value) < 0.5 * std::pow(10, -decimals)) value = 0; // no sign
  return fmt::format("{:.{}f}", value, decimals);
}

const char* unit_of(bool angle) {
  return angle ? "N m" : "N";
}

std::string range_text(const DriveTorque& d) {
  if (!d.varying) return "";
  if (!d.range) return "  (changes with the phase)";
  const double size = std::max(std::abs(d.range->least), std::abs(d.range->most));
  const double mean = std::abs(d.range->mean) < 1e-12 * size ? 0 : d.range->mean; // beyond its nine digits
  return fmt::format("  at the drawn phase; over all phases {:.9g} to {:.9g}, mean {:.9g} {}", d.range->least,
                     d.range->most, mean, unit_of(d.angle));
}

std::string flags(bool varying, bool nonunique) {
  return std::string(varying ? "  (changes with the phase)" : "") + (nonunique ? "  (not unique)" : "");
}

std::string stability(std::optional<bool> stable, std::optional<StabilityReason> reason) {
  if (!reason) return "";
  switch (*reason) {
  case StabilityReason::minimum: return "stable: a strict minimum of the amended potential";
  case StabilityReason::asymptotic: return "stable: every small motion about it dies out";
  case StabilityReason::gyroscopic_only: return "held by gyroscopic forces alone: any damping destroys it";
  case StabilityReason::neutral: return "neutral: nothing resists some direction";
  case StabilityReason::marginal: return "marginal: too close to the border of stability to tell";
  case StabilityReason::unstable: return "unstable";
  case StabilityReason::floquet:
    return stable == true    ? "stable by its Floquet multipliers"
           : stable == false ? "unstable: a Floquet multiplier is larger than 1"
                             : "a Floquet multiplier is too close to 1 to tell";
  case StabilityReason::varying: return "stability not known: the linearised motion turns with the drives";
  }
  return "";
}

std::string stability(const Solution& s) {
  const std::string undamped = undamped_words(s);
  return undamped.empty() ? stability(s.stable, s.stability_reason) : "undecided: " + undamped;
}

std::string lines_of(const std::vector<std::complex<double>>& eigenvalues) {
  std::string out;
  for (const auto& e : eigenvalues)
    if (e.imag() >= 0)
      out += e.imag() > 0 ? fmt::format("  {:>13.6g} ± {:.6g} i 1/s  ({:.4g} Hz)\n", e.real(), e.imag(),
                                        e.imag() / (2 * std::numbers::pi))
                          : fmt::format("  {:>13.6g} 1/s\n", e.real());
  return out;
}

} // namespace

std::string motion_text(const std::string& label, std::size_t width, const PointMotion& m, bool accelerated) {
  const auto line = [&](const std::string& name, const char* what, const Vec3& v, const char* unit,
                        bool size) {
    std::string text = fmt::format("  {:{}}  {:12}  [{:.9g}, {:.9g}, {:.9g}] {}", name, width, what, v.x(),
                                   v.y(), v.z(), unit);
    return text + (size ? fmt::format("  size {:.9g} {}\n", v.norm(), unit) : "\n");
  };
  return line(label, "position", m.position, "m", false) + line("", "velocity", m.velocity, "m/s", true) +
         (accelerated ? line("", "acceleration", m.acceleration, "m/s^2", true) : "");
}

std::string to_text(const Mechanism& mechanism, const Solution& s) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(s.message));
  if (s.status != Status::converged) {
    if (std::isfinite(s.residual)) out += fmt::format("  residual {:.2g}, ", s.residual);
    out += fmt::format("{}{} iterations, {:.1f} µs\n", std::isfinite(s.residual) ? "" : "  ", s.iterations,
                       s.run_time_s * 1e6);
    return out;
  }
  const std::string with_engine = s.at_constant_speed ? "with its speeds free: " : "";
  if (const std::string words = stability(s); !words.empty()) out += "  " + with_engine + words + "\n";
  if (s.at_constant_speed)
    out += "  at constant speed: " +
           stability(s.at_constant_speed->stable, s.at_constant_speed->stability_reason) + "\n";
  std::size_t width = 10;
  for (const auto& c : s.coordinates)
    width = std::max(width, shown_label(c).size());
  for (const auto& m : s.measures)
    width = std::max(width, m.name.size());
  for (const auto& r : s.reactions)
    width = std::max(width, printable(r.joint).size());
  for (const auto& b : s.bearings)
    width = std::max(width, printable(b.bearing).size());
  const auto heading = [&](const char* text) { out += fmt::format("\n{}\n", text); };
  if (!s.coordinates.empty()) heading("coordinates");
  for (const CoordinateSolution& c : s.coordinates) {
    const std::string name = shown_label(c);
    if (c.speed) {
      const double shown = c.angle ? 30 / std::numbers::pi : 1000;
      out += fmt::format("  {:{}}  {:>22} {:5}  {:>18} {:4}  ± {:.1g} {}  {}\n", name, width,
                         rounded(*c.speed, c.speed_error, 17), c.angle ? "rad/s" : "m/s",
                         rounded(*c.speed * shown, c.speed_error * shown, 12), c.angle ? "rpm" : "mm/s",
                         c.speed_error, c.angle ? "rad/s" : "m/s",
                         c.dependent ? "speed, closes a loop" : "speed found");
      continue;
    }
    if (c.driven) {
      out += fmt::format("  {:{}}  driven\n", name, width);
      continue;
    }
    const double shown = c.angle ? 180 / std::numbers::pi : 1000;
    out += fmt::format("  {:{}}  {:>22} {:3}  {:>20} {:2}  ± {:.1g} {}{}\n", name, width,
                       rounded(c.value, c.error, 17), c.angle ? "rad" : "m",
                       rounded(c.value * shown, c.error * shown, 12), c.angle ? "°" : "mm", c.error,
                       c.angle ? "rad" : "m", c.dependent ? "  closes a loop" : "");
  }
  if (!s.measures.empty()) heading("measures, at the drawn phase");
  for (const MeasureSolution& m : s.measures) {
    if (!m.value) {
      out += fmt::format("  {:{}}  {:>22}  {}\n", m.name, width, "-", m.reason);
      continue;
    }
    out += fmt::format("  {:{}}  {:>22} {:6}", m.name, width,
                       m.error ? rounded(*m.value, *m.error, 17) : number_text(*m.value), m.unit);
    if (m.error) out += fmt::format("  ± {:.1g} {}", *m.error, m.unit);
    out += m.nonunique ? "  (not unique)\n" : "\n";
  }
  if (!s.points.empty()) heading("points, world axes at the drawn phase");
  for (const PointSolution& p : s.points)
    out += motion_text(point_label(p.point), width, p.motion);
  // What is rounding beside the largest load is shown as zero.
  double force = 0, torque = 0;
  for (const Reaction& r : s.reactions) {
    force = std::max(force, r.force.norm());
    torque = std::max(torque, r.torque.norm());
  }
  for (const BearingForce& b : s.bearings) {
    force = std::max(force, b.force.norm());
    torque = std::max(torque, b.torque.norm());
  }
  double load = std::max(force, torque);
  for (const GearReaction& g : s.gears)
    load = std::max({load, std::abs(g.a), std::abs(g.b)});
  const auto clean = [](double x, double size) { return std::abs(x) < 1e-12 * size ? 0. : x; };
  if (!s.drive_torques.empty()) heading("drives");
  for (const DriveTorque& d : s.drive_torques)
    out += fmt::format("  {:{}}  {:>22.9g} {}{}{}\n", shown_label(d), width, clean(d.value, load),
                       unit_of(d.angle), range_text(d), d.nonunique ? "  (not unique)" : "");
  for (const DriveTorque& d : s.drive_torques)
    if (d.given)
      out += fmt::format("  {:{}}  {:>22} {:.9g} {} less a load of {:.9g} {}\n", shown_label(d), width,
                         "gives", d.given->torque, unit_of(d.angle), d.given->load, unit_of(d.angle));
  if (!s.frictions.empty()) heading("friction that it rests on");
  for (const FrictionForce& f : s.frictions)
    out += fmt::format("  {:{}}  {:>22} of {:.9g} {}{}\n", shown_label(f), width,
                       f.value ? fmt::format("{:.9g}", *f.value) : std::string("not determined"), f.limit,
                       unit_of(f.angle), f.slips ? "  slips" : "  holds");
  if (!s.reactions.empty()) heading("reactions of the parent on the child, world axes at the drawn phase");
  const auto wrench = [&](const std::string& name, const Vec3& raw_force, const Vec3& raw_torque,
                          const OpenWrench& open, const std::string& told) {
    const auto components = [&](const Vec3& v, double size, const OpenDirections& directions) {
      std::string text;
      for (int i = 0; i < 3; ++i)
        text +=
            fmt::format("{}{}{:.6g}", i ? ", " : "", directions.component(i) ? "≈" : "", clean(v[i], size));
      return text;
    };
    out += fmt::format("  {:{}}  force [{}] N  torque [{}] N m{}\n", printable(name), width,
                       components(raw_force, force, open.force),
                       components(raw_torque, std::max(torque, force), open.torque), told);
  };
  for (const Reaction& r : s.reactions) {
    wrench(r.joint, r.force, r.torque, r.open, flags(r.varying, r.nonunique()));
    if (!r.open.force.along_axes() || !r.open.torque.along_axes())
      wrench("  unique part", r.open.force.unique_part(r.force), r.open.torque.unique_part(r.torque), {}, "");
  }
  if (s.reactions_nonunique)
    out +=
        "  (not unique): the loops are redundant; of many possible ones these have the least multipliers.\n"
        "  ≈ is what is open of a reaction; its components without are unique.\n";
  if (!s.bearings.empty()) heading("bearings, on their second body, world axes at the drawn phase");
  for (const BearingForce& b : s.bearings)
    wrench(b.bearing, b.force, b.torque, {}, flags(b.varying, false));
  if (!s.gears.empty())
    heading("gears, along the coordinates of their two joints, whose reactions include it");
  for (const GearReaction& g : s.gears)
    out += fmt::format("  {:{}}  {:.9g} {}  {:.9g} {}{}\n", g.joint, width, g.a, unit_of(g.angle_a), g.b,
                       unit_of(g.angle_b), flags(g.varying, g.nonunique));
  if (s.floquet) {
    heading("Floquet multipliers");
    out += fmt::format("  {:{}}  {:.10g} s, multipliers to {:.1g}\n", "period", width, s.floquet->period,
                       s.floquet->error);
    for (std::size_t i = 0; i < s.floquet->growth.size(); ++i)
      out += fmt::format("  {:>+13.9f} {:>+13.9f} i  size {:.9g}, growth {:.6g} 1/s\n",
                         s.floquet->multipliers[i].real(), s.floquet->multipliers[i].imag(),
                         std::abs(s.floquet->multipliers[i]), s.floquet->growth[i]);
  } else if (s.eigenvalues && !s.eigenvalues->empty()) {
    heading(s.at_constant_speed ? "eigenvalues of the linearised motion, its speeds free"
                                : "eigenvalues of the linearised motion");
    out += lines_of(*s.eigenvalues);
  }
  if (s.at_constant_speed && s.at_constant_speed->eigenvalues && !s.at_constant_speed->eigenvalues->empty()) {
    heading("eigenvalues at constant speed");
    out += lines_of(*s.at_constant_speed->eigenvalues);
  }
  out += fmt::format("\nresidual {:.1e}, {} iterations{}, {:.1f} µs", s.residual, s.iterations,
                     s.fallback ? fmt::format(" (fallback: {})", word(*s.fallback)) : std::string(),
                     s.run_time_s * 1e6);
  if (s.condition) out += fmt::format(", condition {:.2g}", *s.condition);
  return out + "\n";
}

std::string to_text(const Mechanism& mechanism, const AllSolutions& all, std::span<const std::string> more) {
  std::string out = fmt::format("{}: {} equilibria from {} starts. {}\n", printable(mechanism.name),
                                all.equilibria.size(), all.starts, printable(all.message));
  out += "searched";
  for (const AllSolutions::Bound& b : all.bounds)
    out += fmt::format("  {} {:.4g} to {:.4g} {}", shown_label(b), b.lower, b.upper,
                       b.angle ? (b.speed ? "rad/s" : "rad") : (b.speed ? "m/s" : "m"));
  for (std::size_t i = 0; i < all.equilibria.size(); ++i) {
    const Solution& s = all.equilibria[i];
    out += fmt::format("\n\n{}  {}", i + 1, stability(s));
    if (s.potential) out += fmt::format(", potential {:.9g} J", *s.potential);
    for (const CoordinateSolution& c : s.coordinates)
      if (c.speed)
        out += fmt::format("\n   speed of {} = {} {}  ± {:.1g}", shown_label(c),
                           rounded(*c.speed, c.speed_error, 17), c.angle ? "rad/s" : "m/s", c.speed_error);
      else if (!c.driven)
        out += fmt::format("\n   {} = {} {}  ± {:.1g}", shown_label(c), rounded(c.value, c.error, 17),
                           c.angle ? "rad" : "m", c.error);
    if (!s.frictions.empty()) out += "\n   " + printable(s.message);
    if (i < more.size()) out += more[i];
  }
  return out;
}

} // namespace flyball::cli
