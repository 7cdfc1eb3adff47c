#include "engine/dynamics/local_motion.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/solve/newton.hpp"
#include "engine/stability/linear_motion.hpp"
#include "engine/system/rotation_vector.hpp"

#include <limits>

namespace flyball {
namespace {

// Closed in a chord iteration, whose steps shrink by the distance from the steady state: a scaled step that
// is rounding, one from which a state that far may be, and how many.
constexpr double rounding = 1e-16, closed = 1e-11;
constexpr int most_steps = 80;

// Tells when such an iteration is over.
class Closing {
 public:
  // After a scaled step of this length; false to go on.
  bool over(double length) {
    const bool done = length <= rounding || (length < closed && !(length < 0.5 * last_)) ||
                      ++steps_ >= most_steps || !(length < 1);
    last_ = length;
    return done;
  }
  bool good() const { return last_ < closed; }

 private:
  double last_ = std::numeric_limits<double>::infinity();
  int steps_ = 0;
};

} // namespace

LocalMotion::LocalMotion(const MotionModel& model, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                         double rate, bool with_angles)
    : model_(model), equations_(model, watch_), origin_(q), speed_(u), rate_(rate) {
  equations_.analyse(0, origin_, speed_);
  if (equations_.has_massless())
    throw SceneError("", "parts move without mass, so that their motion is no differential equation");
  const System& system = model.system;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(system.nv, system.nv);
  if (system.rows > 0) {
    const Problem dense{system, model.parameters, model.scaling};
    flyball::evaluate(dense, {origin_, Eigen::VectorXd::Zero(system.rows)}, 0, w_);
    factor_constraints(dense, w_);
    basis = w_.dense.constraints().basis();
  }
  const Eigen::MatrixXd found = cyclic_directions(system, basis, false),
                        kept = cyclic_directions(system, basis, true);
  Eigen::MatrixXd cyclic(basis.cols(), found.cols() + kept.cols());
  cyclic << found, kept;
  Eigen::MatrixXd standing = Eigen::MatrixXd::Identity(basis.cols(), basis.cols());
  if (cyclic.cols() > 0) {
    const auto completed = orthonormal_completion(cyclic);
    if (!completed) throw SceneError("", "the coordinates that turn cannot be told from the others");
    standing = completed->rightCols(basis.cols() - cyclic.cols());
  }
  turning_ = basis * found;
  kept_ = basis * kept;
  positions_ = basis * standing;
  rates_.resize(system.nv, positions_.cols() + turning_.cols());
  rates_ << positions_, turning_;
  standing_ = positions_.cols();
  way_ = turning_.rowwise().sum() + kept_.rowwise().sum();
  if (with_angles) {
    const Eigen::VectorXd way = turning_.transpose() * speed_.cwiseQuotient(model.scaling.column);
    const auto across = way.norm() > 0 ? orthonormal_completion(way.normalized()) : std::nullopt;
    if (!across) throw SceneError("", "what turns at speeds that are found cannot be told from what stands");
    positions_.conservativeResize(Eigen::NoChange, standing_ + way.size() - 1);
    positions_.rightCols(way.size() - 1) = turning_ * across->rightCols(way.size() - 1);
    way_ = turning_ * way.normalized();
  }

  all_q_.resize(model.released.nq);
  all_u_.resize(model.released.nv);
  theta_.setZero(system.nv);
  q_ = origin_;
  u_ = speed_;
  if (kept_.cols() == 0) return;
  place(0);
  evaluate_mass(model.released, model.parameters, kinematics_, mass_);
  const Eigen::MatrixXd along = model.scaling.column.asDiagonal() * kept_;
  kept_mass_ = along.transpose() * mass_.mass.topLeftCorner(system.nv, system.nv) * along;
  kept_momentum_ = along.transpose() * (mass_.mass.topRows(system.nv) * all_u_);
}

void LocalMotion::place(double t) {
  all_q_.head(model_.system.nq) = q_;
  all_u_.head(model_.system.nv) = u_;
  set_drives(model_.system, model_.parameters, t, all_q_, all_u_);
  move(model_.released, model_.parameters, {all_q_, all_u_}, kinematics_, carried_);
}

bool LocalMotion::close_position(const Eigen::VectorXd& y, double t, double turn) {
  const auto set = [&] {
    q_ = origin_;
    turned_ = theta_.cwiseProduct(model_.scaling.column);
    retract<double>(model_.system, turned_, q_);
  };
  theta_ = positions_ * y;
  if (turn != 0) theta_ += turn * way_;
  set();
  if (model_.system.rows == 0) return true;
  Closing closing;
  do {
    forward<double>(model_.system, model_.parameters, q_, t, kinematics_);
    evaluate_constraints<double>(model_.system, model_.parameters, q_, kinematics_, open_);
    w_.dense.constraints().solve(-open_.cwiseProduct(model_.scaling.row), step_);
    theta_ += step_;
    set();
  } while (!closing.over(step_.size() > 0 ? step_.lpNorm<Eigen::Infinity>() : 0));
  return closing.good();
}

bool LocalMotion::close_velocity(const Eigen::VectorXd& v, double t) {
  const System& system = model_.system;
  const Eigen::VectorXd& column = model_.scaling.column;
  u_ = speed_ + rate_ * column.cwiseProduct(rates_ * v);
  if (system.rows == 0 && kept_.cols() == 0) {
    place(t);
    return true;
  }
  Closing closing;
  double size = 0;
  do {
    place(t);
    step_.setZero(system.nv);
    if (system.rows > 0) {
      constraint_rates(model_.released, model_.parameters, all_u_, kinematics_, carried_, open_);
      w_.dense.constraints().solve(-open_.cwiseProduct(model_.scaling.row), step_);
    }
    if (kept_.cols() > 0) {
      evaluate_mass(model_.released, model_.parameters, kinematics_, mass_);
      const auto missing = solve_square(
          kept_mass_,
          kept_momentum_ - kept_.transpose() * column.cwiseProduct(mass_.mass.topRows(system.nv) * all_u_));
      if (!missing) return false;
      step_ += kept_ * *missing;
    }
    u_ += column.cwiseProduct(step_);
    size = std::max(rate_, u_.cwiseQuotient(column).lpNorm<Eigen::Infinity>());
  } while (!closing.over(step_.lpNorm<Eigen::Infinity>() / size));
  place(t);
  return closing.good();
}

bool LocalMotion::evaluate(const Eigen::VectorXd& x, double t, double turn, Eigen::VectorXd& out) {
  const Eigen::Index k = positions_.cols();
  if (!close_position(x.head(k), t, turn) || !close_velocity(x.tail(rates_.cols()), t) ||
      !equations_.evaluate(t, q_, u_))
    return false;
  const Eigen::VectorXd& column = model_.scaling.column;
  step_ = u_;
  for (const Link& link : model_.system.links)
    if (link.type == LinkType::spherical && link.v >= 0)
      step_.segment<3>(link.v) =
          inverse_left_jacobian<double>(turned_.segment<3>(link.v)) * step_.segment<3>(link.v);
  out.resize(size());
  out << positions_.transpose() * step_.cwiseQuotient(column),
      rates_.transpose() * equations_.acceleration().cwiseQuotient(column) / rate_;
  return out.allFinite();
}

Eigen::VectorXcd LocalMotion::amplitudes(const Eigen::VectorXcd& x) const {
  Eigen::VectorXcd scaled = positions_.leftCols(standing_).cast<std::complex<double>>() * x.head(standing_);
  scaled += turning_.cast<std::complex<double>>() * x.tail(turning_.cols()) / std::complex<double>(0, 1);
  return scaled.cwiseProduct(model_.scaling.column.cast<std::complex<double>>());
}

} // namespace flyball
