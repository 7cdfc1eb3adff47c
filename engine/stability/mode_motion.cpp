#include "engine/stability/mode_motion.hpp"

#include "engine/kkt/problem.hpp"
#include "engine/kkt/workspace.hpp"

namespace flyball {
namespace {

using Complex = std::complex<double>;
using Vec3c = Eigen::Vector3cd;

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

// A small motion of a link: its rotation, and the displacement of its point at the origin.
struct SmallMotion {
  Vec3c rotation = Vec3c::Zero(), shift = Vec3c::Zero();
  // (Eigen's product of complex vectors is conjugated.)
  Vec3c at(const Vec3& p) const {
    const Vec3 re = rotation.real().cross(p), im = rotation.imag().cross(p);
    return shift + re.cast<Complex>() + Complex(0, 1) * im.cast<Complex>();
  }
};

std::vector<SmallMotion> small_motions(const System& system, const Kinematics<double>& kinematics,
                                       const std::vector<Complex>& shape) {
  std::vector<SmallMotion> out(system.links.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Link& link = system.links[i];
    if (link.parent >= 0) out[i] = out[index(link.parent)];
    const int count = link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
    for (int k = 0; k < count; ++k) {
      const Column<double>& column = kinematics.columns[index(link.v + k)];
      const Complex part = shape[index(link.v + k)];
      out[i].rotation += part * column.turn().cast<Complex>();
      out[i].shift += part * column.at(Vec3::Zero()).cast<Complex>();
    }
  }
  return out;
}

Vec3 mass_centre(const Kinematics<double>& kinematics, const Parameters& parameters, int link) {
  return kinematics.point(link, parameters.links[index(link)].com);
}

// The signed and the whole size of a motion Re(u e^(i w t)) across `axis`.
struct Orbit {
  double signed_size = 0, size = 0;
  void add(double weight, const Vec3c& u, const Vec3& axis) {
    const Vec3c across = u - axis.cast<Complex>() * axis.cast<Complex>().dot(u);
    size += weight * across.squaredNorm();
    // At t = 0 it is at Re u, a quarter of a period later at -Im u.
    const Vec3 re = across.real(), im = across.imag();
    signed_size += weight * 2 * axis.dot(im.cross(re));
  }
};

} // namespace

std::vector<BodyAmplitude> body_amplitudes(const Problem& problem, const Eigen::VectorXd& q,
                                           const VibrationMode& mode, Workspace& w) {
  const System& system = problem.system;
  forward<double>(system, problem.parameters, q, 0, w.kinematics);
  const std::vector<SmallMotion> links = small_motions(system, w.kinematics, mode.shape);
  std::vector<BodyAmplitude> out;
  for (const int link : system.body_link) {
    const SmallMotion& motion = links[index(link)];
    out.push_back({motion.at(mass_centre(w.kinematics, problem.parameters, link)), motion.rotation});
  }
  return out;
}

std::string_view word(WhirlDirection direction) {
  switch (direction) {
  case WhirlDirection::forward: return "forward";
  case WhirlDirection::backward: return "backward";
  case WhirlDirection::straight: return "straight";
  }
  return "";
}

WhirlDirection Whirl::direction() const {
  constexpr double straight = 1e-3;
  return value > straight    ? WhirlDirection::forward
         : value < -straight ? WhirlDirection::backward
                             : WhirlDirection::straight;
}

std::array<double, 2> standing_frequencies(const Whirl& whirl, double frequency) {
  const double speed = std::abs(whirl.speed);
  return {std::abs(speed + frequency), std::abs(speed - frequency)};
}

std::optional<Whirl> find_whirl(const Problem& problem, const Eigen::VectorXd& q, const VibrationMode& mode,
                                int drive, Workspace& w) {
  const System& system = problem.system;
  if (!mode.oscillates() || mode.shape.size() != index(system.nv)) return {};
  double largest = 0;
  for (const Complex part : mode.shape)
    largest = std::max(largest, std::abs(part));
  std::vector<bool> rides(system.links.size());
  bool carried = false, standing = false;
  for (std::size_t i = 0; i < rides.size(); ++i) {
    const Link& link = system.links[i];
    rides[i] = link.parent >= 0 && (link.parent == drive || rides[index(link.parent)]);
    if (link.v < 0 || static_cast<int>(i) == drive) continue;
    for (int k = 0; k < (link.type == LinkType::spherical ? 3 : 1); ++k)
      if (std::abs(mode.shape[index(link.v + k)]) > 1e-9 * largest) (rides[i] ? carried : standing) = true;
  }
  if (carried == standing) return {};
  forward<double>(system, problem.parameters, q, 0, w.kinematics);
  const std::vector<SmallMotion> motions = small_motions(system, w.kinematics, mode.shape);
  const Link& driven = system.links[index(drive)];
  const LinkParameters& numbers = problem.parameters.links[index(drive)];
  Whirl out;
  out.turning = carried;
  out.speed = finds_speed(driven) ? q[driven.q] : numbers.speed;
  const Vec3 axis = w.kinematics.at(drive).axis * (out.speed < 0 ? -1 : 1);
  Orbit orbit;
  double all = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const LinkParameters& p = problem.parameters.links[i];
    if (p.mass == 0 && !p.has_inertia) continue;
    const Vec3c shift = motions[i].at(mass_centre(w.kinematics, problem.parameters, static_cast<int>(i)));
    const Mat3& turned = w.kinematics.links[i].R;
    const Mat3 inertia = turned * p.inertia * turned.transpose();
    const double across =
        (inertia.trace() - axis.dot(inertia * axis)) / 2; // kg m^2, the mean across the axis
    orbit.add(p.mass, shift, axis);
    orbit.add(across, motions[i].rotation, axis);
    all += p.mass * shift.squaredNorm() + across * motions[i].rotation.squaredNorm();
  }
  if (!(orbit.size > 1e-12 * all)) return {};
  out.value = orbit.signed_size / orbit.size;
  return out;
}

double modal_assurance(const VibrationMode& a, const VibrationMode& b) {
  if (a.amplitudes.size() != b.amplitudes.size()) return 0;
  Complex both = 0;
  double mine = 0, theirs = 0;
  for (std::size_t i = 0; i < a.amplitudes.size(); ++i) {
    const Complex x = a.measured(i), y = b.measured(i);
    both += std::conj(x) * y;
    mine += std::norm(x);
    theirs += std::norm(y);
  }
  const double both_ways = std::norm(both) / (mine * theirs);
  return std::isfinite(both_ways) ? both_ways : 0;
}

} // namespace flyball
