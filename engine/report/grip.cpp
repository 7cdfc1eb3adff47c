#include "engine/report/grip.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/report/report.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/solve/factored_state.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/point_motion.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

constexpr double share = 3;      // of the hand's spring, beside the mechanism's own stiffness
constexpr double softest = 1e-3; // of the stiffness that weights, speeds and springs suggest
constexpr double rigid = 1e4; // likewise: what gives way by less does not, as where an engine's law holds it

// The body that turns with this link as one, where there is one.
int body_with(const System& system, int frame) {
  if (system.links[static_cast<std::size_t>(frame)].body >= 0)
    return system.links[static_cast<std::size_t>(frame)].body;
  for (std::size_t b = 0; b < system.body_link.size(); ++b) {
    int l = system.body_link[b];
    while (l >= 0 && l != frame && system.links[static_cast<std::size_t>(l)].type == LinkType::fixed)
      l = system.links[static_cast<std::size_t>(l)].parent;
    if (l == frame) return static_cast<int>(b);
  }
  return -1;
}

std::string holder_of(const System& system, const Mechanism& mechanism, int body) {
  const int frame =
      system.links[static_cast<std::size_t>(system.body_link[static_cast<std::size_t>(body)])].frame;
  if (frame < 0) return std::string(ground_name);
  const int holder = body_with(system, frame);
  if (holder < 0 || holder == body) return {};
  return mechanism.bodies[static_cast<std::size_t>(holder)].name;
}

// N/m, of what moves: its weight, and what holds it at its speed, by the mechanism's reach; springs.
double usual_stiffness(const Problem& problem, double mass) {
  const Parameters& p = problem.parameters;
  const double fastest = fastest_given_rate(problem.system, p);
  double sum = mass * (p.gravity.norm() / p.length + fastest * fastest);
  for (const PointSpringParameters& spring : p.springs)
    sum = std::max(sum, spring.pull_slope(spring.free_length));
  for (std::size_t l = 0; l < p.links.size(); ++l) {
    const double unit = problem.system.links[l].type == LinkType::prismatic ? 1 : p.length;
    for (const CoordinateForce& force : p.links[l].force)
      sum = std::max(sum, (force.stiffness + (force.laws ? force.laws->spring.slope(0) : 0)) / (unit * unit));
  }
  return sum > 0 ? sum : 1;
}

// By how much a point gives way to a force on it: m/N, world axes at the drawn phase. Along what nothing
// resists as though that stood still.
Mat3 compliance(const FactoredState& at, const TrackedPoint& point) {
  const System& system = at.problem.system;
  const Kinematics<double>& k = at.w.kinematics;
  const Vec3 p = k.point(point.link, point.at);
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(3, system.nv); // by scaled steps
  for (int l = point.link; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (link.v < 0 || link.drive >= 0 || finds_speed(link)) continue; // a step of a speed moves nothing
    for (int v = link.v; v < link.v + (link.type == LinkType::spherical ? 3 : 1); ++v)
      moves.col(v) = k.columns[static_cast<std::size_t>(v)].at(p) * at.problem.scaling.column[v];
  }
  Mat3 out;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.rows);
  Eigen::VectorXd force, step, multipliers;
  for (int i = 0; i < 3; ++i) {
    force = moves.row(i).transpose();
    at.kkt().solve(force, none, step, multipliers);
    out.col(i) = moves * step;
  }
  return out;
}

} // namespace

Grip find_grip(const Mechanism& mechanism, const Solution& solution, const BodyPoint& point) {
  const System system = compile_for_drives(mechanism);
  Parameters parameters;
  bind(system, mechanism, parameters);
  Scaling scaling;
  set_scaling(system, parameters, scaling);
  const TrackedPoint tracked = find_point(system, mechanism, parameters, point);
  const Problem problem{system, parameters, scaling, nullptr, system.kkt_form};
  Workspace w;
  Unknowns z;
  drawn_configuration(system, parameters, z.q);
  set_start(system, parameters, start_values(solution.coordinates), z.q);
  assemble(problem, z.q, 0, w);
  evaluate_with_multipliers(problem, z, w);
  const FactoredState at = factor_at(problem, z, w);
  Grip out;
  const int body = body_index(mechanism, point.body);
  out.holder = holder_of(system, mechanism, body);
  const double usual = usual_stiffness(problem, at.kkt().mass());
  double most = 0; // m/N
  if (system.nv > 0) {
    const Mat3 c = compliance(at, tracked);
    SymmetricEigen eigen;
    if (eigen.compute((c + c.transpose()) / 2, false)) most = eigen.values().cwiseAbs().maxCoeff();
  }
  const bool gives_way = std::isfinite(most) && share < rigid * usual * most;
  // Where nothing gives way a hand that is as strong as the heaviest body would tear at a light one.
  const double own = mechanism.bodies[static_cast<std::size_t>(body)].mass;
  out.stiffness = gives_way ? std::max(share / most, softest * usual)
                  : own > 0 ? usual_stiffness(problem, own)
                            : usual;
  return out;
}

} // namespace flyball
