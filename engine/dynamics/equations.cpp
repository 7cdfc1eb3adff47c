#include "engine/dynamics/equations.hpp"

#include "engine/kkt/constraint_space.hpp"
#include "engine/linear/interruption.hpp"

namespace flyball {

Equations::Equations(const MotionModel& model, const Watch& watch)
    : model_(model), watch_(watch), system_(model.released), parameters_(model.parameters),
      n_(model.system.nv), drives_(static_cast<int>(model.system.drives.size())),
      dense_(model, rows_, regular_) {
  if (model.along_tree) tree_.emplace(model);
  if (model.sparse) sparse_.emplace(model);
  q_.setZero(system_.nq);
  u_.setZero(system_.nv);
  s_.setZero(system_.nv);
  full_a_.setZero(system_.nv);
  a_.setZero(n_);
  lambda_.setZero(system_.rows);
  zero_lambda_.setZero(system_.rows);
  for (int i = 0; i < n_; ++i)
    regular_.push_back(i);
}

// With rotations that are past half a turn put back to it.
const Eigen::VectorXd& Equations::sided_configuration() {
  if (flips_.empty()) return q_;
  sided_q_ = q_;
  for (const FlipElement& flip : flips_) {
    const Link& link = system_.links[static_cast<std::size_t>(flip.link)];
    const LinkParameters& p = parameters_.links[static_cast<std::size_t>(flip.link)];
    Quat rotation = joint_rotation(link, p, q_);
    if ((rotation.w() >= 0) == flip.side) continue;
    rotation.w() = (flip.side ? 1e-15 : -1e-15) * rotation.norm();
    Quat d = rotation * p.drawn_rotation.conjugate();
    if (link.reversed) d = d.conjugate();
    sided_q_.segment<4>(link.q) << d.w(), d.vec();
  }
  return sided_q_;
}

void Equations::latch(const std::vector<StopElement>& stops, const std::vector<bool>& touching,
                      std::vector<FlipElement> flips) {
  flips_ = std::move(flips);
  parameters_.links = model_.parameters.links;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const StopElement& s = stops[i];
    CoordinateForce& f =
        parameters_.links[static_cast<std::size_t>(s.link)].force.hold(static_cast<std::size_t>(s.component));
    // Spring and stop together are one spring, unless they cancel.
    const double together = f.stiffness + s.stiffness;
    if (touching[i] && std::abs(together) < 1e-9 * s.stiffness) continue;
    (s.upper ? f.has_upper : f.has_lower) = false;
    if (!touching[i]) continue;
    f.free = (f.stiffness * f.free + s.stiffness * s.limit) / together;
    f.stiffness = together;
  }
}

void Equations::load(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  q_.head(model_.system.nq) = q;
  u_.head(n_) = u;
  set_drives(model_.system, parameters_, t, q_, u_);
}

void Equations::place(const Eigen::VectorXd* s, const Eigen::VectorXd* a) {
  move(system_, parameters_, {q_, u_, s, a}, kinematics_, carried_);
}

MotionPoint Equations::point() {
  return {parameters_, sided_configuration(), u_, kinematics_, carried_};
}

bool Equations::evaluate(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s) {
  if (watch_.over()) return false;
  // A large mass matrix takes long to factor. What that throws must not pass through an integrator's library.
  const Interruptible scope(watch_.flag());
  try {
    return evaluate_uncaught(t, q, s);
  } catch (const Interrupted&) {
    return false;
  }
}

bool Equations::evaluate_uncaught(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& s) {
  load(t, q, s);
  s_ = u_;
  place();
  const MotionPoint here = point();
  if (!solver_->factor(here)) return false;
  if (!idle_.empty()) {
    if (!find_null_directions() || !find_damped_velocity()) return false;
    if (standing_ > 0 && !find_standing_velocity()) return false;
    place(&s_);
  }
  if (!solver_->accelerate(here, a_, lambda_)) return false;
  if (standing_ > 0) {
    const auto kinds = kinds_.middleCols(damped_, standing_);
    standing_force_ = kinds.transpose() * null_force();
  }
  return true;
}

bool Equations::reduce(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, Eigen::VectorXd& s) {
  s = u;
  if (idle_.empty()) return true;
  load(t, q, u);
  place();
  if (!dense_.factor(point()) || !find_null_directions()) return false;
  Eigen::VectorXd idle(static_cast<Eigen::Index>(idle_.size()));
  for (std::size_t i = 0; i < idle_.size(); ++i)
    idle[static_cast<Eigen::Index>(i)] = u[idle_[i]] / model_.scaling.column[idle_[i]];
  s -= (null_ * idle).cwiseProduct(model_.scaling.column);
  for (int v : idle_)
    s[v] = 0;
  return true;
}

double Equations::drive_power() const {
  double power = 0;
  for (int d = 0; d < drives_; ++d)
    power += solver_->drive_force(d) * u_[n_ + d];
  return power;
}

ForcePowers Equations::powers() {
  return force_powers(system_, parameters_, sided_configuration(), u_, kinematics_);
}

double Equations::stored_energy() const {
  return kinetic_energy(system_, parameters_, kinematics_) +
         potential_energy(system_, model_.parameters, q_, kinematics_);
}

double Equations::energy_scale() {
  // A spring at rest at zero has a size for the sake of rounding alone; stiff ones would count for more than
  // all that moves.
  constexpr double at_rest = 1e-6; // rad, or of the reach
  Parameters moving = parameters_;
  for (std::size_t i = 0; i < system_.links.size(); ++i) {
    const Link& link = system_.links[i];
    if (link.v < 0 || link.type == LinkType::spherical || !moving.links[i].elastic) continue;
    const CoordinateForce& spring = moving.links[i].force[0];
    const double reach = link.type == LinkType::prismatic ? parameters_.length : 1;
    if (std::abs(q_[link.q]) + std::abs(spring.free) < at_rest * reach)
      moving.links[i].force.hold(0).stiffness = 0;
  }
  evaluate_magnitudes(system_, moving, q_, lambda_, kinematics_, magnitudes_);
  double most = 0;
  for (const Link& link : system_.links) {
    if (link.v < 0) continue;
    const double unit = link.type == LinkType::prismatic ? parameters_.length : 1;
    most = std::max(most, unit * magnitudes_.force[link.v]);
  }
  const double scale = kinetic_energy(system_, parameters_, kinematics_) + most;
  return scale > 0 ? scale : 1;
}

double Equations::position_drift() const {
  return system_.rows > 0 ? phi().lpNorm<Eigen::Infinity>() : 0;
}

double Equations::velocity_drift() {
  if (system_.rows == 0) return 0;
  static const std::vector<LinkRates> none;
  constraint_rates(system_, parameters_, u_, kinematics_, none, row_values_);
  return row_values_.lpNorm<Eigen::Infinity>();
}

const Kinematics<double>& Equations::accelerated_kinematics() {
  full_a_.head(n_) = a_;
  place(idle_.empty() ? nullptr : &s_, &full_a_);
  return kinematics_;
}

TransmittedForces Equations::reactions() {
  accelerated_kinematics();
  Eigen::VectorXd lambda = lambda_;
  if (static_cast<int>(rows_.size()) < system_.rows) {
    linearize_constraints(model_.system, parameters_, kinematics_, linearization_);
    const Eigen::MatrixXd scaled =
        model_.scaling.row.asDiagonal() * linearization_.constraint * model_.scaling.column.asDiagonal();
    ConstraintSpace space;
    space.factor(scaled, 1e-9, row_rounding);
    const Eigen::VectorXd total = linearization_.constraint.transpose() * lambda_;
    lambda = space.least_norm_multipliers(total.cwiseProduct(model_.scaling.column))
                 .cwiseProduct(model_.scaling.row);
  }
  evaluate_residual<double>(model_.system, parameters_, q_, lambda, kinematics_, moving_residual_);
  return transmitted_forces(model_.system, parameters_, lambda, kinematics_, moving_residual_);
}

Equations::Pencil Equations::pencil() {
  full_a_.head(n_) = a_;
  place(nullptr, &full_a_);
  evaluate_residual<double>(system_, parameters_, q_, lambda_, kinematics_, moving_residual_);
  linearize(system_, parameters_, q_, lambda_, kinematics_, moving_residual_, linearization_);
  linearize_motion(system_, parameters_, q_, kinematics_, linearization_);
  Eigen::MatrixXd scaled(dense_.gradient().rows(), n_);
  if (scaled.rows() > 0) // else of a tree, whose gradients are never evaluated
    for (int v = 0; v < n_; ++v)
      scaled.col(v) = dense_.gradient().col(v) * model_.scaling.column[v];
  ConstraintSpace space;
  space.factor(scaled, 1e-9, row_rounding);
  const Eigen::MatrixXd basis = model_.scaling.column.asDiagonal() * space.basis();
  const auto project = [&](const Eigen::MatrixXd& m) {
    return Eigen::MatrixXd(basis.transpose() * m.topLeftCorner(n_, n_) * basis);
  };
  return {project(linearization_.mass), project(linearization_.velocity), project(linearization_.stiffness)};
}

bool Equations::linearise() {
  full_a_.head(n_) = a_;
  place(nullptr, &full_a_);
  return solver_->linearise(point(), lambda_);
}

} // namespace flyball
