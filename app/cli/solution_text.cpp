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

// The sections of a steady state, each with a heading where it has lines.
class SolutionText {
 public:
  explicit SolutionText(const Solution& s) : s_(s) {
    for (const auto& c : s.coordinates)
      widen(shown_label(c));
    for (const auto& m : s.measures)
      widen(m.name);
    for (const auto& r : s.reactions)
      widen(printable(r.joint));
    for (const auto& b : s.bearings)
      widen(printable(b.bearing));
    const auto take = [&](const auto& wrenches) {
      for (const auto& w : wrenches) {
        force_ = std::max(force_, w.force.norm());
        torque_ = std::max(torque_, w.torque.norm());
      }
    };
    take(s.reactions);
    take(s.bearings);
  }

  std::string write() {
    verdict();
    coordinates();
    measures();
    points();
    drives();
    frictions();
    reactions();
    bearings();
    gears();
    motion();
    effort();
    return std::move(out_);
  }

 private:
  void widen(const std::string& name) { width_ = std::max(width_, name.size()); }
  void heading(const char* text) { out_ += fmt::format("\n{}\n", text); }
  // What is rounding beside the largest load is shown as zero.
  static double clean(double x, double size) { return std::abs(x) < 1e-12 * size ? 0. : x; }

  void verdict() {
    const std::string with_engine = s_.at_constant_speed ? "with its speeds free: " : "";
    if (const std::string words = stability(s_); !words.empty()) out_ += "  " + with_engine + words + "\n";
    if (s_.at_constant_speed)
      out_ += "  at constant speed: " +
              stability(s_.at_constant_speed->stable, s_.at_constant_speed->stability_reason) + "\n";
  }

  void coordinates() {
    if (!s_.coordinates.empty()) heading("coordinates");
    for (const CoordinateSolution& c : s_.coordinates) {
      const std::string name = shown_label(c);
      if (c.speed) {
        const double shown = c.angle ? 30 / std::numbers::pi : 1000;
        out_ += fmt::format("  {:{}}  {:>22} {:5}  {:>18} {:4}  ± {:.1g} {}  {}\n", name, width_,
                            rounded(*c.speed, c.speed_error, 17), c.angle ? "rad/s" : "m/s",
                            rounded(*c.speed * shown, c.speed_error * shown, 12), c.angle ? "rpm" : "mm/s",
                            c.speed_error, c.angle ? "rad/s" : "m/s",
                            c.dependent ? "speed, closes a loop" : "speed found");
        continue;
      }
      if (c.driven) {
        out_ += fmt::format("  {:{}}  driven\n", name, width_);
        continue;
      }
      const double shown = c.angle ? 180 / std::numbers::pi : 1000;
      out_ += fmt::format("  {:{}}  {:>22} {:3}  {:>20} {:2}  ± {:.1g} {}{}\n", name, width_,
                          rounded(c.value, c.error, 17), c.angle ? "rad" : "m",
                          rounded(c.value * shown, c.error * shown, 12), c.angle ? "°" : "mm", c.error,
                          c.angle ? "rad" : "m", c.dependent ? "  closes a loop" : "");
    }
  }

  void measures() {
    if (!s_.measures.empty()) heading("measures, at the drawn phase");
    for (const MeasureSolution& m : s_.measures) {
      if (!m.value) {
        out_ += fmt::format("  {:{}}  {:>22}  {}\n", m.name, width_, "-", m.reason);
        continue;
      }
      out_ += fmt::format("  {:{}}  {:>22} {:6}", m.name, width_,
                          m.error ? rounded(*m.value, *m.error, 17) : number_text(*m.value), m.unit);
      if (m.error) out_ += fmt::format("  ± {:.1g} {}", *m.error, m.unit);
      out_ += m.nonunique ? "  (not unique)\n" : "\n";
    }
  }

  void points() {
    if (!s_.points.empty()) heading("points, world axes at the drawn phase");
    for (const PointSolution& p : s_.points)
      out_ += motion_text(point_label(p.point), width_, p.motion);
  }

  void drives() {
    double load = std::max(force_, torque_);
    for (const GearReaction& g : s_.gears)
      load = std::max({load, std::abs(g.a), std::abs(g.b)});
    if (!s_.drive_torques.empty()) heading("drives");
    for (const DriveTorque& d : s_.drive_torques)
      out_ += fmt::format("  {:{}}  {:>22.9g} {}{}{}\n", shown_label(d), width_, clean(d.value, load),
                          unit_of(d.angle), range_text(d), d.nonunique ? "  (not unique)" : "");
    for (const DriveTorque& d : s_.drive_torques)
      if (d.given)
        out_ += fmt::format("  {:{}}  {:>22} {:.9g} {} less a load of {:.9g} {}\n", shown_label(d), width_,
                            "gives", d.given->torque, unit_of(d.angle), d.given->load, unit_of(d.angle));
  }

  void frictions() {
    if (!s_.frictions.empty()) heading("friction that it rests on");
    for (const FrictionForce& f : s_.frictions)
      out_ += fmt::format("  {:{}}  {:>22} of {:.9g} {}{}\n", shown_label(f), width_,
                          f.value ? fmt::format("{:.9g}", *f.value) : std::string("not determined"), f.limit,
                          unit_of(f.angle), f.slips ? "  slips" : "  holds");
  }

  void reactions() {
    if (!s_.reactions.empty()) heading("reactions of the parent on the child, world axes at the drawn phase");
    for (const Reaction& r : s_.reactions) {
      wrench(r.joint, r.force, r.torque, r.open, flags(r.varying, r.nonunique()));
      if (!r.open.force.along_axes() || !r.open.torque.along_axes())
        wrench("  unique part", r.open.force.unique_part(r.force), r.open.torque.unique_part(r.torque), {},
               "");
    }
    if (s_.reactions_nonunique)
      out_ += "  (not unique): the loops are redundant; of many possible ones these have the least "
              "multipliers.\n"
              "  ≈ is what is open of a reaction; its components without are unique.\n";
  }

  void bearings() {
    if (!s_.bearings.empty()) heading("bearings, on their second body, world axes at the drawn phase");
    for (const BearingForce& b : s_.bearings)
      wrench(b.bearing, b.force, b.torque, {}, flags(b.varying, false));
  }

  void wrench(const std::string& name, const Vec3& force, const Vec3& torque, const OpenWrench& open,
              const std::string& told) {
    const auto components = [&](const Vec3& v, double size, const OpenDirections& directions) {
      std::string text;
      for (int i = 0; i < 3; ++i)
        text +=
            fmt::format("{}{}{:.6g}", i ? ", " : "", directions.component(i) ? "≈" : "", clean(v[i], size));
      return text;
    };
    out_ += fmt::format("  {:{}}  force [{}] N  torque [{}] N m{}\n", printable(name), width_,
                        components(force, force_, open.force),
                        components(torque, std::max(torque_, force_), open.torque), told);
  }

  void gears() {
    if (!s_.gears.empty())
      heading("gears, along the coordinates of their two joints, whose reactions include it");
    for (const GearReaction& g : s_.gears)
      out_ += fmt::format("  {:{}}  {:.9g} {}  {:.9g} {}{}\n", g.joint, width_, g.a, unit_of(g.angle_a), g.b,
                          unit_of(g.angle_b), flags(g.varying, g.nonunique));
  }

  void motion() {
    if (s_.floquet) {
      heading("Floquet multipliers");
      out_ += fmt::format("  {:{}}  {:.10g} s, multipliers to {:.1g}\n", "period", width_, s_.floquet->period,
                          s_.floquet->error);
      for (std::size_t i = 0; i < s_.floquet->growth.size(); ++i)
        out_ += fmt::format("  {:>+13.9f} {:>+13.9f} i  size {:.9g}, growth {:.6g} 1/s\n",
                            s_.floquet->multipliers[i].real(), s_.floquet->multipliers[i].imag(),
                            std::abs(s_.floquet->multipliers[i]), s_.floquet->growth[i]);
    } else if (s_.eigenvalues && !s_.eigenvalues->empty()) {
      heading(s_.at_constant_speed ? "eigenvalues of the linearised motion, its speeds free"
                                   : "eigenvalues of the linearised motion");
      out_ += lines_of(*s_.eigenvalues);
    }
    const auto& at = s_.at_constant_speed;
    if (!at || !at->eigenvalues || at->eigenvalues->empty()) return;
    heading("eigenvalues at constant speed");
    out_ += lines_of(*at->eigenvalues);
  }

  void effort() {
    out_ += fmt::format("\nresidual {:.1e}, {} iterations{}, {:.1f} µs", s_.residual, s_.iterations,
                        s_.fallback ? fmt::format(" (fallback: {})", word(*s_.fallback)) : std::string(),
                        s_.run_time_s * 1e6);
    if (s_.condition) out_ += fmt::format(", condition {:.2g}", *s_.condition);
    out_ += "\n";
  }

  const Solution& s_;
  std::size_t width_ = 10;        // of the names
  double force_ = 0, torque_ = 0; // the largest, N and N m
  std::string out_;
};

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
  const std::string head = fmt::format("{}: {}\n", printable(mechanism.name), printable(s.message));
  if (s.status == Status::converged) return head + SolutionText(s).write();
  const std::string residual =
      std::isfinite(s.residual) ? fmt::format("residual {:.2g}, ", s.residual) : std::string();
  return head + fmt::format("  {}{} iterations, {:.1f} µs\n", residual, s.iterations, s.run_time_s * 1e6);
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
