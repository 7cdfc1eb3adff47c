#include "engine/dynamics/start.hpp"

#include "engine/dynamics/articulated_bodies.hpp"
#include "engine/dynamics/sparse_motion.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/messages.hpp"
#include "engine/search/steady_state.hpp"
#include "engine/system/motion.hpp"

#include <algorithm>

namespace flyball {
namespace {

// All coordinates, the drives' included, with the rates u of the others.
struct ReleasedMotion {
  ReleasedMotion(const MotionModel& model, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u)
      : all_q(model.released.nq), all_u(model.released.nv) {
    all_q.head(model.system.nq) = q;
    set_rates(model, t, u);
  }
  void set_rates(const MotionModel& model, double t, const Eigen::VectorXd& u) {
    all_u.head(model.system.nv) = u;
    set_drives(model.system, model.parameters, t, all_q, all_u);
    move(model.released, model.parameters, {all_q, all_u}, k, rates);
  }
  Eigen::VectorXd all_q, all_u;
  Kinematics<double> k;
  std::vector<LinkRates> rates;
};

// The velocity of all coordinates nearest to `u` in kinetic energy (massless ones: in size) that keeps the
// loops closed, with the coordinates in `prescribed` as they are. Names what cannot be.
void close_velocity(const MotionModel& model, double t, const Eigen::VectorXd& q,
                    const std::vector<int>& prescribed, bool from_rest, Eigen::VectorXd& u) {
  const int n = model.system.nv;
  const ReleasedMotion moving(model, t, q, u);
  const Kinematics<double>& k = moving.k;
  MassMatrix m;
  evaluate_mass(model.released, model.parameters, k, m);
  Linearization l;
  linearize_constraints(model.released, model.parameters, k, l);

  const Eigen::VectorXd& column = model.scaling.column;
  const auto rows = static_cast<Eigen::Index>(model.system.rows),
             fixed = static_cast<Eigen::Index>(prescribed.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(rows + fixed, n);
  Eigen::VectorXd open(rows + fixed);
  c.topRows(rows) = model.scaling.row.asDiagonal() * l.constraint.leftCols(n) * column.asDiagonal();
  constraint_rates(model.released, model.parameters, moving.all_u, k, moving.rates, open);
  open = open.cwiseProduct(model.scaling.row).eval();
  open.conservativeResize(rows + fixed);
  for (Eigen::Index i = 0; i < fixed; ++i) {
    c(rows + i, prescribed[static_cast<std::size_t>(i)]) = 1;
    open[rows + i] = 0;
  }
  Eigen::VectorXd range = Eigen::VectorXd::Zero(n);
  const auto refuse = [] { throw SceneError("", "the forces are too large for the computer's numbers"); };
  if (c.size() > 0) {
    const auto shortest = least_squares(c, -open);
    if (!shortest) refuse();
    range = *shortest;
  }
  const double left = (c * range + open).lpNorm<Eigen::Infinity>();
  if (left > 1e-9 * (1 + open.lpNorm<Eigen::Infinity>())) {
    if (fixed > 0)
      throw SceneError("joints." + name_of_coordinate(model, prescribed.front()),
                       "the loops do not let it move at this rate");
    Eigen::Index worst = 0;
    (c * range + open).cwiseAbs().maxCoeff(&worst);
    for (const CutJoint& cut : model.system.cuts)
      if (worst >= cut.first_row && worst < cut.first_row + static_cast<int>(cut.rows.size()))
        throw SceneError("joints." + model.mechanism.joints[static_cast<std::size_t>(cut.joint)].name,
                         "cannot stay closed as the drives turn");
  }
  if (n == 0) return;
  Eigen::VectorXd step = range;
  const auto kernel = null_space(c);
  if (!kernel) refuse();
  if (const Eigen::MatrixXd& basis = *kernel; basis.cols() > 0) {
    const Eigen::MatrixXd mass = column.asDiagonal() * m.mass.topLeftCorner(n, n) * column.asDiagonal();
    // From rest: the momentum of everything, the drives' motion included, is to vanish.
    Eigen::VectorXd momentum = mass * range;
    if (from_rest) momentum += column.cwiseProduct(m.mass.topRows(n) * moving.all_u);
    const Eigen::MatrixXd reduced = large::projected(mass, basis);
    const auto along = least_squares(reduced, basis.transpose() * momentum);
    if (!along) refuse();
    step -= basis * *along;
  }
  u += step.cwiseProduct(column);
}

// The same with nothing prescribed, without matrices: along a tree, or by sparse equations. False where not
// all that moves has mass, or the loops cannot stay closed.
bool close_velocity_of_many(const MotionModel& model, double t, const Eigen::VectorXd& q, bool from_rest,
                            Eigen::VectorXd& u) {
  ReleasedMotion moving(model, t, q, u);
  const Kinematics<double>& k = moving.k;
  std::vector<Vec6> momenta(k.links.size());
  for (std::size_t l = 0; l < momenta.size(); ++l) {
    BodyInertia body;
    set_body_inertia(model.parameters, l, k, body);
    body.turning = 0;
    Vec6 velocity;
    velocity << k.links[l].w, k.links[l].v;
    momenta[l] = times_inertia(body, velocity);
  }
  Eigen::VectorXd change(model.system.nv);
  if (ArticulatedBodies bodies(model.released, model.system.nv);
      model.along_tree && from_rest && bodies.factor(model.parameters, k) && bodies.carry_all()) {
    bodies.solve(momenta, Eigen::VectorXd::Zero(model.released.nv), change);
    u += change;
    return true;
  }
  if (!model.sparse) return false;
  SparseMotion motion(model);
  const MotionPoint point{model.parameters, moving.all_q, moving.all_u, k, moving.rates};
  if (!motion.analyse(point)) return false;
  Eigen::VectorXd open;
  constraint_rates(model.released, model.parameters, moving.all_u, k, moving.rates, open);
  motion.correct_velocity(point, open, from_rest ? &momenta : nullptr, change);
  const double before = open.cwiseProduct(model.scaling.row).lpNorm<Eigen::Infinity>();
  moving.set_rates(model, t, u + change);
  constraint_rates(model.released, model.parameters, moving.all_u, k, moving.rates, open);
  if (!(open.cwiseProduct(model.scaling.row).lpNorm<Eigen::Infinity>() <= 1e-9 * (1 + before))) return false;
  u += change;
  return true;
}

// What torques drive turns at the speed where the search for the steady one begins.
void turn_on(const MotionModel& model, Eigen::VectorXd& u) {
  for (const DriveTorqueElement& drive : model.system.torques) {
    const auto l = static_cast<std::size_t>(drive.link);
    u[model.system.links[l].v] = model.parameters.links[l].speed;
  }
}

// The rates of what is left to itself, and what its momenta, as kept, are more than those at rates u.
std::vector<int> kept_entries(const MotionModel& model) {
  std::vector<int> entries;
  for (const DriveTorqueElement& drive : model.system.torques)
    if (drive.keeps_momentum) entries.push_back(model.system.links[static_cast<std::size_t>(drive.link)].v);
  return entries;
}
Eigen::VectorXd missing_momenta(const MotionModel& model, double t, const Eigen::VectorXd& q,
                                const Eigen::VectorXd& u) {
  const std::vector<int> entries = kept_entries(model);
  const ReleasedMotion moving(model, t, q, u);
  MassMatrix m;
  evaluate_mass(model.released, model.parameters, moving.k, m);
  Eigen::VectorXd missing = -(m.mass(entries, Eigen::all) * moving.all_u);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < model.system.torques.size(); ++i)
    if (model.system.torques[i].keeps_momentum) missing[row++] += model.parameters.torques[i].momentum;
  return missing;
}

// What is left to itself turns so that it has the momentum it keeps, wherever the motion begins; `moved` has
// the rates of all where it turns at these: nothing else changes, or what stands still in the world goes on
// doing so.
template <class Moved>
Eigen::VectorXd with_momenta(const MotionModel& model, double t, const Eigen::VectorXd& q,
                             const Moved& moved) {
  const auto count = static_cast<Eigen::Index>(kept_entries(model).size());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd u = moved(none);
  if (count == 0) return u;
  const Eigen::VectorXd missing = missing_momenta(model, t, q, u);
  Eigen::MatrixXd by_rate(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    by_rate.col(i) = missing - missing_momenta(model, t, q, moved(Eigen::VectorXd::Unit(count, i)));
  const auto rates = least_squares(by_rate, missing);
  if (!rates) throw SceneError("", "the forces are too large for the computer's numbers");
  return moved(*rates);
}

// The same where speeds are found.
void start_at_found_speeds(const SimulationOptions& options, MotionModel& model, Eigen::VectorXd& q,
                           Eigen::VectorXd& u) {
  SolveOptions solve;
  solve.details = false;
  solve.cancel = options.cancel;
  const Solution steady = Analysis(model.mechanism).solve(solve);
  if (steady.status != Status::converged)
    throw SceneError("", "there is no steady state to start from: " + steady.message);
  std::vector<std::pair<std::string, double>> start;
  for (const CoordinateSolution& c : steady.coordinates) {
    if (c.dependent) continue;
    if (!c.driven || (steady.turned && c.speed)) start.emplace_back(coordinate_label(c), c.value);
    if (!c.speed) continue;
    const int found = coordinate_called(model.system, coordinate_label(c));
    u[model.system
          .links[static_cast<std::size_t>(model.system.coordinates[static_cast<std::size_t>(found)].link)]
          .v] = *c.speed;
  }
  set_start(model.system, model.parameters, start, q);
}

// The steady state that `solve` answers with.
void start_at_equilibrium(const SimulationOptions& options, MotionModel& model, Eigen::VectorXd& q,
                          Eigen::VectorXd& u) {
  if (model.finds_speeds) return start_at_found_speeds(options, model, q, u);
  const Problem problem{model.system, model.parameters, model.scaling, options.cancel, model.system.kkt_form};
  SteadyState steady;
  steady.find(problem, q, q, {.seconds = SolveOptions{}.search});
  if (!steady.holds && has_friction(model.mechanism)) // which may hold it, or let it slip on and on
    return start_at_found_speeds(options, model, q, u);
  if (!steady.holds) {
    const Stability unknown;
    const ReportInput input{model.mechanism, problem, steady.found, steady.existence, unknown};
    throw SceneError("", "there is no steady state to start from: " +
                             failure_message(input, steady.elsewhere()).text);
  }
  q = steady.found.z.q;
}

std::vector<int> apply_kick(const SimulationOptions& options, const MotionModel& model,
                            const Eigen::VectorXd& q, Eigen::VectorXd& u) {
  std::vector<int> prescribed;
  for (const auto& [name, rate] : options.kick) {
    const int found = coordinate_called(model.system, name);
    if (found < 0)
      throw SceneError(name,
                       "is not a free coordinate; use the joint's name, or name.index where it has several");
    const CoordinateInfo& c = model.system.coordinates[static_cast<std::size_t>(found)];
    const Link& link = model.system.links[static_cast<std::size_t>(c.link)];
    if (link.v < 0) throw SceneError(name, "is driven; a kick is for free coordinates");
    if (link.type != LinkType::spherical) {
      u[link.v] += rate;
      prescribed.push_back(link.v);
      continue;
    }
    const Mat3 map = rotation_vector_rate(link, model.parameters.links[static_cast<std::size_t>(c.link)], q);
    u.segment<3>(link.v) += map.partialPivLu().solve(rate * Vec3::Unit(c.index - link.coordinate));
    for (int k = 0; k < 3; ++k)
      if (std::ranges::find(prescribed, link.v + k) == prescribed.end()) prescribed.push_back(link.v + k);
  }
  return prescribed;
}

// The entries of a tangent vector that belong to the coordinates a start is given for.
std::vector<int> placed_entries(const SimulationOptions& options, const MotionModel& model) {
  std::vector<int> placed;
  for (const auto& [name, value] : options.at) {
    const int found = coordinate_called(model.system, name); // set_start() has found it, too
    const CoordinateInfo& c = model.system.coordinates[static_cast<std::size_t>(found)];
    const Link& link = model.system.links[static_cast<std::size_t>(c.link)];
    for (int k = 0; k < (link.type == LinkType::spherical ? 3 : 1); ++k)
      placed.push_back(link.v + k);
  }
  return placed;
}

// Closes the loops by the coordinates that no start was given for (Gauss-Newton). Without this the others
// would be moved, too, and the motion begin elsewhere than asked for.
void close_around(const SimulationOptions& options, const MotionModel& model, Eigen::VectorXd& q) {
  const std::vector<int> placed = placed_entries(options, model);
  const System& system = model.system;
  const Eigen::VectorXd no_lambda = Eigen::VectorXd::Zero(system.rows);
  Kinematics<double> k;
  Residual<double> residual;
  Linearization l;
  const auto open_at = [&](const Eigen::VectorXd& at) {
    forward<double>(system, model.parameters, at, 0, k);
    evaluate_residual<double>(system, model.parameters, at, no_lambda, k, residual);
    return residual.phi.cwiseProduct(model.scaling.row).lpNorm<Eigen::Infinity>();
  };
  double open = open_at(q);
  for (int i = 0; i < 60 && open > 1e-14; ++i) {
    linearize_constraints(system, model.parameters, k, l);
    Eigen::MatrixXd c = model.scaling.row.asDiagonal() * l.constraint * model.scaling.column.asDiagonal();
    for (const int v : placed)
      c.col(v).setZero();
    const Eigen::VectorXd phi = residual.phi.cwiseProduct(model.scaling.row);
    const auto shortest = least_squares(c, -phi);
    if (!shortest) break;
    const Eigen::VectorXd& step = *shortest;
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!(size > 1e-16)) break;
    Eigen::VectorXd moved;
    double next = open;
    for (double part = std::min(1., 0.5 / size); part > 1e-8; part /= 2) {
      moved = q;
      retract<double>(system, (part * step).cwiseProduct(model.scaling.column), moved);
      next = open_at(moved);
      if (next < open) break;
    }
    if (!(next < open)) break;
    q = moved;
    open = next;
  }
  if (open > 1e-10)
    throw SceneError("joints." + options.at.front().first,
                     options.at.size() == 1 ? "the loops do not let it start there"
                                            : "the loops do not let it and the others start there");
}

} // namespace

void find_start(const SimulationOptions& options, MotionModel& model, Eigen::VectorXd& q,
                Eigen::VectorXd& u) {
  double t = 0;
  if (options.start == Start::state) {
    t = options.state.time;
    take_state(options.state, model, q, u);
  } else {
    drawn_configuration(model.system, model.parameters, q);
    set_start(model.system, model.parameters, options.at, q);
    if (!options.at.empty() && model.system.rows > 0) close_around(options, model, q);
    u.setZero(model.system.nv);
  }
  const std::vector<int> kept = kept_entries(model);
  if (options.start == Start::rest) {
    turn_on(model, u);
    u = with_momenta(model, t, q, [&](const Eigen::VectorXd& rates) {
      Eigen::VectorXd turned = u;
      turned(kept) = rates;
      return turned;
    });
  }
  if (options.start == Start::equilibrium) start_at_equilibrium(options, model, q, u);
  Workspace w;
  const Problem problem = model.problem();
  if (model.system.rows > 0) {
    if (!assemble(problem, q, t, w) || !same_assembly_mode(problem, w.kinematics)) {
      double worst = 0;
      std::string name;
      for (std::size_t c = 0; c < model.system.cuts.size(); ++c)
        for (std::size_t r = 0; r < model.system.cuts[c].rows.size(); ++r) {
          const int row = model.system.cuts[c].first_row + static_cast<int>(r);
          const double open = std::abs(w.residual.phi[row]) * model.scaling.row[row];
          if (!name.empty() && open <= worst) continue;
          worst = open;
          name = model.mechanism.joints[static_cast<std::size_t>(model.system.cuts[c].joint)].name;
        }
      throw SceneError("joints." + name, "cannot be closed from the start");
    }
  }
  const auto move_on = [&](const std::vector<int>& prescribed, bool from_rest, Eigen::VectorXd& velocity) {
    if ((model.along_tree || model.sparse) && prescribed.empty() &&
        close_velocity_of_many(model, t, q, from_rest, velocity))
      return;
    close_velocity(model, t, q, prescribed, from_rest, velocity);
  };
  const bool from_rest = options.start == Start::drawn;
  std::vector<int> prescribed = apply_kick(options, model, q, u);
  const std::vector<int> kicked = prescribed;
  if (options.start == Start::rest || options.start == Start::equilibrium)
    for (const DriveTorqueElement& drive : model.system.torques)
      if (const int v = model.system.links[static_cast<std::size_t>(drive.link)].v;
          std::ranges::find(prescribed, v) == prescribed.end())
        prescribed.push_back(v);
  const bool two_steps = from_rest && !(prescribed.empty() && kept.empty());
  if (two_steps) // at rest first, but for what is left to itself, which has its momentum; then the kick on
                 // top
    u += with_momenta(model, t, q, [&](const Eigen::VectorXd& rates) {
      Eigen::VectorXd still = Eigen::VectorXd::Zero(model.system.nv);
      still(kept) = rates;
      move_on(kept, true, still);
      return still;
    });
  if (model.system.rows > 0 || (from_rest && !two_steps)) {
    const Eigen::VectorXd asked = u;
    try {
      move_on(prescribed, from_rest && !two_steps, u);
    } catch (const SceneError&) {
      // Drives by torque that loops or gears tie together begin as near as they can to where they should.
      if (prescribed.size() == kicked.size()) throw;
      u = asked;
      move_on(kicked, false, u);
    }
  }
}

} // namespace flyball
