#include "engine/dynamics/equations.hpp"

#include "engine/kkt/constraint_space.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/system/constraint_row.hpp"

namespace flyball {

std::vector<StopElement> list_stops(const System& system, const Parameters& p) {
  std::vector<StopElement> out;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    if (system.links[i].v < 0) continue;
    for (int k = 0; k < (system.links[i].type == LinkType::spherical ? 3 : 1); ++k) {
      const CoordinateForce& f = p.links[i].force[static_cast<std::size_t>(k)];
      if (f.stop_stiffness == 0) continue;
      if (f.has_lower) out.push_back({static_cast<int>(i), k, false, f.lower, f.stop_stiffness});
      if (f.has_upper) out.push_back({static_cast<int>(i), k, true, f.upper, f.stop_stiffness});
    }
  }
  return out;
}

Equations::Equations(const MotionModel& model, const Watch& watch)
    : model_(model), watch_(watch), system_(model.released), parameters_(model.parameters),
      n_(model.system.nv), drives_(static_cast<int>(model.system.drives.size())) {
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

std::vector<FlipElement> list_flips(const System& system, const Parameters& p) {
  std::vector<FlipElement> out;
  for (std::size_t i = 0; i < system.links.size(); ++i) {
    if (system.links[i].v < 0 || system.links[i].type != LinkType::spherical) continue;
    if (p.links[i].elastic || p.links[i].force[0].damping != 0 || p.links[i].force[1].damping != 0 ||
        p.links[i].force[2].damping != 0)
      out.push_back({static_cast<int>(i), true});
  }
  return out;
}

Quat joint_rotation(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q) {
  const Quat d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
  return (link.reversed ? d.conjugate() : d) * p.drawn_rotation;
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

void Equations::fill_gradient() {
  gradient_.setZero(static_cast<Eigen::Index>(rows_.size()), system_.nv);
  std::size_t next = 0;
  for (std::size_t c = 0; c < system_.cuts.size() && next < rows_.size(); ++c) {
    const CutJoint& cut = system_.cuts[c];
    const int end = cut.first_row + static_cast<int>(cut.rows.size());
    for (; next < rows_.size() && rows_[next] < end; ++next) {
      const auto at = static_cast<Eigen::Index>(next);
      row_gradient(cut, parameters_.cuts[c], cut.rows[static_cast<std::size_t>(rows_[next] - cut.first_row)],
                   kinematics_, [&](int v, double g) { gradient_(at, v) += g; });
      gradient_.row(at) *= model_.scaling.row[rows_[next]];
    }
  }
  const auto regular = static_cast<Eigen::Index>(regular_.size());
  scaled_gradient_.resize(gradient_.rows(), regular);
  for (Eigen::Index j = 0; j < regular; ++j) {
    const int v = regular_[static_cast<std::size_t>(j)];
    scaled_gradient_.col(j) = gradient_.col(v) * model_.scaling.column[v];
  }
}

bool Equations::factor() {
  evaluate_mass(system_, parameters_, kinematics_, mass_);
  fill_gradient();
  const auto regular = static_cast<Eigen::Index>(regular_.size());
  const Eigen::VectorXd& column = model_.scaling.column;
  scaled_mass_.resize(regular, regular);
  for (Eigen::Index j = 0; j < regular; ++j) {
    const int v = regular_[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < regular; ++i) {
      const int w = regular_[static_cast<std::size_t>(i)];
      scaled_mass_(i, j) = mass_.mass(w, v) * column[w] * column[v];
    }
  }
  return saddle_.factor_constraints(scaled_gradient_) && saddle_.factor_mass(scaled_mass_);
}

void Equations::forces() {
  const Eigen::VectorXd& q = sided_configuration();
  evaluate_residual<double>(system_, parameters_, q, zero_lambda_, kinematics_, residual_);
  force_ = residual_.f;
  add_coordinate_damping(system_, parameters_, q, u_, force_);
}

bool Equations::solve_motion(const Eigen::VectorXd& force, const Eigen::VectorXd& bias, Eigen::VectorXd& a) {
  const Eigen::VectorXd& column = model_.scaling.column;
  target_force_.resize(static_cast<Eigen::Index>(regular_.size()));
  target_rows_.resize(static_cast<Eigen::Index>(rows_.size()));
  for (std::size_t i = 0; i < regular_.size(); ++i)
    target_force_[static_cast<Eigen::Index>(i)] = -force[regular_[i]] * column[regular_[i]];
  for (std::size_t r = 0; r < rows_.size(); ++r)
    target_rows_[static_cast<Eigen::Index>(r)] = -bias[rows_[r]] * model_.scaling.row[rows_[r]];
  saddle_.solve(target_force_, target_rows_, scaled_a_, scaled_lambda_);
  a.setZero(n_);
  lambda_.setZero(system_.rows);
  for (std::size_t i = 0; i < regular_.size(); ++i)
    a[regular_[i]] = scaled_a_[static_cast<Eigen::Index>(i)] * column[regular_[i]];
  for (std::size_t r = 0; r < rows_.size(); ++r)
    lambda_[rows_[r]] = scaled_lambda_[static_cast<Eigen::Index>(r)] * model_.scaling.row[rows_[r]];
  return a.allFinite() && lambda_.allFinite();
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
  if (!factor()) return false;
  if (!idle_.empty()) {
    if (!find_null_directions() || !find_damped_velocity()) return false;
    if (standing_ > 0 && !find_standing_velocity()) return false;
    place(&s_);
  }
  forces();
  constraint_accelerations(system_, parameters_, nullptr, kinematics_, carried_, bias_);
  if (!solve_motion(force_, bias_, a_)) return false;
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
  if (!factor() || !find_null_directions()) return false;
  Eigen::VectorXd idle(static_cast<Eigen::Index>(idle_.size()));
  for (std::size_t i = 0; i < idle_.size(); ++i)
    idle[static_cast<Eigen::Index>(i)] = u[idle_[i]] / model_.scaling.column[idle_[i]];
  s -= (null_ * idle).cwiseProduct(model_.scaling.column);
  for (int v : idle_)
    s[v] = 0;
  return true;
}

std::string Equations::unsolved() const {
  if (!mass_.mass.allFinite()) return "the numbers overflow";
  if (!(saddle_.independence() > 1e-12))
    return "the equations of its loops are not independent to rounding at this position";
  int light = -1, heavy = -1;
  const auto inertia = [&](int v) {
    return mass_.mass(v, v) * model_.scaling.column[v] * model_.scaling.column[v];
  };
  for (const int v : regular_) {
    if (light < 0 || inertia(v) < inertia(light)) light = v;
    if (heavy < 0 || inertia(v) > inertia(heavy)) heavy = v;
  }
  if (light < 0 || !(inertia(light) < 1e-10 * inertia(heavy)))
    return "the mass matrix is singular to rounding";
  return "the inertias that move with " + name_of_coordinate(model_, heavy) + " and with " +
         name_of_coordinate(model_, light) + " are " + rounded_text(inertia(heavy), 2) + " and " +
         rounded_text(inertia(light), 2) +
         " kg m^2, too far apart for double precision; masses and lengths of like sizes mend that";
}

double Equations::drive_force(int d) const {
  double force = force_[n_ + d];
  for (int i = 0; i < n_; ++i)
    force += mass_.mass(n_ + d, i) * a_[i];
  for (Eigen::Index r = 0; r < gradient_.rows(); ++r)
    force += gradient_(r, n_ + d) * scaled_lambda_[r];
  return force;
}

double Equations::drive_power() const {
  double power = 0;
  for (int d = 0; d < drives_; ++d)
    power += drive_force(d) * u_[n_ + d];
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
  evaluate_magnitudes(system_, parameters_, q_, lambda_, kinematics_, magnitudes_);
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
  return residual_.phi.size() > 0 ? residual_.phi.lpNorm<Eigen::Infinity>() : 0;
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
    space.factor(scaled, 1e-9);
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
  Eigen::MatrixXd scaled(gradient_.rows(), n_);
  for (int v = 0; v < n_; ++v)
    scaled.col(v) = gradient_.col(v) * model_.scaling.column[v];
  ConstraintSpace space;
  space.factor(scaled, 1e-9);
  const Eigen::MatrixXd basis = model_.scaling.column.asDiagonal() * space.basis();
  const auto project = [&](const Eigen::MatrixXd& m) {
    return Eigen::MatrixXd(basis.transpose() * m.topLeftCorner(n_, n_) * basis);
  };
  return {project(linearization_.mass), project(linearization_.velocity), project(linearization_.stiffness)};
}

void Equations::acceleration_derivatives(Eigen::MatrixXd& with_q, Eigen::MatrixXd& with_s) {
  full_a_.head(n_) = a_;
  place(nullptr, &full_a_);
  const Eigen::VectorXd& q = sided_configuration();
  evaluate_residual<double>(system_, parameters_, q, lambda_, kinematics_, moving_residual_);
  linearize(system_, parameters_, q, lambda_, kinematics_, moving_residual_, linearization_);
  linearize_motion(system_, parameters_, q, kinematics_, linearization_);
  add_coordinate_damping_stiffness(system_, parameters_, q, u_, linearization_.stiffness);
  const auto column = model_.scaling.column.asDiagonal();
  const auto respond = [&](const Eigen::MatrixXd& change, Eigen::MatrixXd& out) {
    out = -(column * change.topLeftCorner(n_, n_));
    saddle_.respond(out);
    out = column * out;
  };
  respond(linearization_.stiffness, with_q);
  respond(linearization_.velocity, with_s);
}

} // namespace flyball
