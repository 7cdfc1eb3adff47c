#include "engine/study/hopf_point.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/pair_crossing.hpp"
#include "engine/dynamics/local_motion.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/stability/phase_stiffness.hpp"
#include "engine/study/lyapunov.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/kept_momentum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

// Coordinates up to which there is a coefficient: each takes some twenty evaluations of the motion.
constexpr int most_coordinates = 200;

struct NoCoefficient {
  std::string why;
};

// The motion must be the same at every phase, away from the steady state, too.
void expect_one_motion(LocalMotion& motion, const Eigen::VectorXcd& swing,
                       const std::vector<DriveRate>& rates) {
  const Eigen::VectorXd x = 0.03 * (swing.real() + 0.7 * swing.imag());
  Eigen::VectorXd here, there;
  if (!motion.evaluate(x, here)) throw NoCoefficient{"the motion beside it cannot be evaluated"};
  constexpr std::array turned{0.83, 2.31, 4.17}; // of what turns at found speeds
  std::vector<double> times = phase_times(rates);
  times.resize(std::max(times.size(), turned.size()), 0);
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!motion.evaluate(x, times[i], turned[i % turned.size()], there) ||
        !((there - here).norm() <= (1e-9 + 4 * angle_rounding(rates, times[i])) * here.norm()))
      throw NoCoefficient{"the motion beside it turns with the drives"};
}

// Whether the angle of something that turns at a speed that is found matters.
bool angles_matter(const Mechanism& mechanism, const ResponsePoint& at) {
  const System system = compile_for_drives(mechanism);
  if (system.torques.empty()) return false;
  Parameters parameters;
  Scaling scaling;
  bind(system, mechanism, parameters);
  set_scaling(system, parameters, scaling);
  const Problem problem{system, parameters, scaling};
  const Eigen::VectorXd starts = starts_of(problem, at.coordinates);
  Unknowns z{configuration_of(problem, at.coordinates), {}};
  for (std::size_t l = 0; l < system.links.size(); ++l)
    if (finds_speed(system.links[l])) parameters.links[l].start = starts[static_cast<Eigen::Index>(l)];
  Workspace w;
  evaluate_with_multipliers(problem, z, w);
  return loops_tie_angles(problem, w.kinematics) || !phase_stiffness(problem, z, w).entries.empty();
}

// Each of the angles between what turns at found speeds must matter: one that does not is a phase of its own.
void expect_angles_tied(LocalMotion& motion) {
  constexpr double step = 1e-3, least = 1e-6; // rad; of the largest of their singular values
  Eigen::MatrixXd slopes(motion.size(), motion.angles());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(motion.size()), forth, back;
  for (Eigen::Index i = 0; i < slopes.cols(); ++i) {
    double& angle = x[motion.first_angle() + i];
    angle = step;
    const bool known = motion.evaluate(x, forth);
    angle = -step;
    if (!known || !motion.evaluate(x, back)) throw NoCoefficient{"the motion beside it cannot be evaluated"};
    angle = 0;
    slopes.col(i) = (forth - back) / (2 * step);
  }
  const auto singular = singular_values(slopes);
  if (slopes.cols() == 0 || !singular || !(singular->minCoeff() > least * singular->maxCoeff()))
    throw NoCoefficient{"it is looked for where all of what turns at speeds that are found is tied together"};
}

struct Amplitude {
  HopfPoint::Coordinate coordinate;
  double size = 0;    // rad or m
  double measure = 1; // m, what slides are measured by; 1 rad
};

// Of every coordinate that stands still in the steady state; where there is none, of those that turn.
std::vector<Amplitude> amplitudes(const MotionModel& model, const LocalMotion& motion,
                                  const Eigen::VectorXd& q, const Eigen::VectorXcd& swing) {
  const Eigen::VectorXcd all = motion.amplitudes(swing);
  std::vector<Amplitude> out;
  for (const bool standing : {true, false}) {
    for (const CoordinateInfo& c : model.system.coordinates) {
      const Link& link = model.system.links[static_cast<std::size_t>(c.link)];
      if (link.v < 0 || motion.stands(link.v) != standing) continue;
      const TreeJoint& joint = model.system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
      std::complex<double> value;
      if (link.type == LinkType::spherical) {
        const Mat3 rates =
            rotation_vector_rate(link, model.parameters.links[static_cast<std::size_t>(c.link)], q);
        value =
            (rates.row(c.index - link.coordinate).cast<std::complex<double>>() * all.segment<3>(link.v))(0);
      } else {
        value = all[link.v];
      }
      out.push_back({{joint.name, c.index, coordinate_count(joint.type), c.angle},
                     std::abs(value),
                     c.angle ? 1 : model.parameters.length});
    }
    if (!out.empty()) break;
  }
  return out;
}

// The first of those that move most.
const Amplitude* leading(const std::vector<Amplitude>& all) {
  double most = 0;
  for (const Amplitude& a : all)
    most = std::max(most, a.size / a.measure);
  const auto found =
      std::ranges::find_if(all, [&](const Amplitude& a) { return a.size / a.measure > 0.99 * most; });
  return most > 0 ? &*found : nullptr;
}

void find_coefficient(const Mechanism& mechanism, const ResponsePoint& at, double frequency,
                      const std::optional<HopfPoint::Coordinate>& wanted, HopfPoint& out) {
  if (at.floquet || at.stability_reason == StabilityReason::varying)
    throw NoCoefficient{"the motion beside it turns with the drives"};
  if (has_friction(mechanism)) throw NoCoefficient{"dry friction holds small motions"};
  if (!(frequency > 0)) throw NoCoefficient{"no pair of eigenvalues swings"};
  const bool with_angles = angles_matter(mechanism, at);
  MotionModel model = make_motion_model(mechanism, true);
  if (with_angles && keeps_momentum(model.system))
    throw NoCoefficient{"it is looked for without the angles of what keeps its momentum, which matter"};
  if (model.system.nv > most_coordinates)
    throw NoCoefficient{"it is looked for up to " + std::to_string(most_coordinates) + " coordinates"};
  SimulationOptions start;
  start.start = Start::state;
  for (const CoordinateSolution& c : at.coordinates)
    if (!c.dependent) start.state.coordinates.push_back({c.joint, c.index, c.value, c.speed.value_or(0)});
  Eigen::VectorXd q, u;
  find_start(start, model, q, u);
  LocalMotion motion(model, q, u, frequency, with_angles);
  if (with_angles) expect_angles_tied(motion);
  const auto found = first_lyapunov_coefficient(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd& rate) { return motion.evaluate(x, rate); },
      motion.size(), frequency);
  if (!found) throw NoCoefficient{"the motion beside it is not smooth enough"};
  if (!(std::abs(found->eigenvalue - std::complex<double>(0, frequency)) < 1e-5 * frequency))
    throw NoCoefficient{"differences of the motion do not confirm the pair of eigenvalues"};
  expect_one_motion(motion, found->q, drive_rates(model.system, model.parameters));
  const std::vector<Amplitude> all = amplitudes(model, motion, q, found->q);
  const Amplitude* unit = leading(all);
  if (wanted)
    for (const Amplitude& a : all)
      if (a.coordinate == *wanted && a.size > 0) unit = &a;
  if (!unit) throw NoCoefficient{"no coordinate swings"};
  // q is to make the coordinate swing by z: it moves as 2 Re(z q).
  const double scale = 1 / (2 * unit->size);
  out.coordinate = unit->coordinate;
  out.lyapunov = found->value * scale * scale;
  out.error = found->error * scale * scale;
}

} // namespace

std::string_view word(HopfLoss loss) {
  switch (loss) {
  case HopfLoss::soft: return "soft";
  case HopfLoss::hard: return "hard";
  case HopfLoss::undecided: return "undecided";
  }
  return "";
}

HopfLoss HopfPoint::loss() const {
  if (!lyapunov || !(std::abs(*lyapunov) > error)) return HopfLoss::undecided;
  return *lyapunov < 0 ? HopfLoss::soft : HopfLoss::hard;
}

double hopf_frequency(const std::vector<std::complex<double>>& eigenvalues) {
  double best = std::numeric_limits<double>::infinity(), frequency = 0;
  for (const std::complex<double> s : eigenvalues)
    if (s.imag() > 0 && std::abs(s.real()) / std::abs(s) < best) {
      best = std::abs(s.real()) / std::abs(s);
      frequency = s.imag();
    }
  return frequency;
}

HopfPoint describe_hopf(const Mechanism& mechanism, const ResponsePoint& at, double frequency,
                        const std::optional<HopfPoint::Coordinate>& coordinate) {
  HopfPoint out;
  out.frequency = frequency;
  std::vector<std::complex<double>> others = at.eigenvalues;
  for (const double sign : {1., -1.})
    if (!others.empty())
      others.erase(std::ranges::min_element(others, {}, [&](std::complex<double> s) {
        return std::abs(s - std::complex<double>(0, sign * frequency));
      }));
  out.growing = right_of_axis(others, false);
  try {
    find_coefficient(mechanism, at, frequency, coordinate, out);
  } catch (const NoCoefficient& none) {
    out.reason = none.why;
  } catch (const SceneError& error) {
    out.reason = error.what();
  }
  return out;
}

HopfPoints describe_hopf_points(const Mechanism& mechanism, const std::string& address,
                                const ResponseDiagram& diagram) {
  HopfPoints out;
  for (const SpecialPoint& s : diagram.special) {
    std::optional<HopfPoint>& point = out.emplace_back();
    if (s.type == SpecialPointType::hopf && !s.at.floquet)
      point = describe_hopf(with_parameter(mechanism, address, s.at.parameter), s.at,
                            hopf_frequency(s.at.eigenvalues));
  }
  return out;
}

} // namespace flyball
