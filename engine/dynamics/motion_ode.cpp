#include "engine/dynamics/motion_ode.hpp"

namespace flyball {

// By how much more than its limits what sticks is torn off: enough for slipping_by to see it.
constexpr double off_by = 1 + 2 * (slipping_by - 1);

MotionOde::MotionOde(Equations& equations, const Watch& watch, double tolerance, double rate_scale,
                     double energy_scale)
    : equations_(equations), watch_(watch), model_(equations.model()), nq_(model_.system.nq),
      nv_(model_.system.nv), tolerance_(tolerance), energy_scale_(energy_scale), rate_scale_(rate_scale) {
  q_.resize(nq_);
  s_.resize(nv_);
  scale_.setOnes(nq_ + nv_);
  for (const Link& link : model_.system.links) {
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) {
      rotations_ = true;
      scale_.segment<3>(nq_ + link.v).setConstant(rate_scale);
    } else {
      scale_[link.q] = model_.scaling.column[link.v];
      scale_[nq_ + link.v] = model_.scaling.column[link.v] * rate_scale;
    }
  }
}

void MotionOde::set_events(std::vector<StopElement> stops, std::vector<FlipElement> flips) {
  stops_ = std::move(stops);
  touching_.assign(stops_.size(), false);
  flips_ = std::move(flips);
}

void MotionOde::set_frictions(const std::vector<FrictionElement>& frictions, const std::vector<int>& slips,
                              const std::vector<FrictionHold>& holds) {
  slips_.clear();
  for (std::size_t i = 0; i < frictions.size(); ++i)
    if (slips[i] != 0)
      slips_.push_back({model_.system.links[static_cast<std::size_t>(frictions[i].link)].v, slips[i]});
  holds_ = holds;
}

void MotionOde::pack(const Eigen::VectorXd& q, const Eigen::VectorXd& s, const Eigen::Vector3d& energies,
                     Eigen::VectorXd& y) const {
  y.resize(size());
  y << q, s, energies;
}

void MotionOde::unpack(const double* y, Eigen::VectorXd& q, Eigen::VectorXd& s) const {
  q = Eigen::Map<const Eigen::VectorXd>(y, nq_);
  s = Eigen::Map<const Eigen::VectorXd>(y + nq_, nv_);
}

bool MotionOde::rate(double t, const double* y, double* out) {
  unpack(y, q_, s_);
  if (inner_projection_ && !equations_.project(t, q_, s_)) return false;
  if (!equations_.evaluate(t, q_, s_)) return false;
  const Eigen::VectorXd& u = equations_.velocity();
  for (const Link& link : model_.system.links) {
    if (link.v < 0) continue;
    if (link.type != LinkType::spherical) {
      out[link.q] = u[link.v];
      continue;
    }
    // D' = w D / 2, which keeps the length that D has.
    const Quat turned = Quat(0, u[link.v], u[link.v + 1], u[link.v + 2]) *
                        Quat(y[link.q], y[link.q + 1], y[link.q + 2], y[link.q + 3]);
    out[link.q] = turned.w() / 2;
    for (int k = 0; k < 3; ++k)
      out[link.q + 1 + k] = turned.vec()[k] / 2;
  }
  for (int v = 0; v < nv_; ++v)
    out[nq_ + v] = equations_.acceleration()[v];
  const ForcePowers powers = equations_.powers();
  out[nq_ + nv_] = powers.dissipated;
  out[nq_ + nv_ + 1] = equations_.drive_power();
  out[nq_ + nv_ + 2] = powers.applied;
  for (int i = 0; i < size(); ++i)
    if (!std::isfinite(out[i])) return false;
  return true;
}

void MotionOde::weights(const double* y, double* out) {
  // Where an angle stands has no size of its own; lengths and speeds have.
  for (int i = 0; i < nq_; ++i)
    out[i] = tolerance_ * scale_[i];
  for (const Link& link : model_.system.links)
    if (link.v >= 0 && link.type == LinkType::prismatic)
      out[link.q] = tolerance_ * std::max(scale_[link.q], std::abs(y[link.q]));
  for (int i = nq_; i < nq_ + nv_; ++i)
    out[i] = tolerance_ * (scale_[i] + std::abs(y[i]));
  for (int i = nq_ + nv_; i < size(); ++i)
    out[i] = tolerance_ * (energy_scale_ + std::abs(y[i]));
}

bool MotionOde::linearise(double t, const double* y, const double* rate_at_y) {
  if (equations_.has_massless())
    return matrix_.take_quotients([&](const double* x, double* out) { return rate(t, x, out); }, y, rate_at_y,
                                  scale_, size());
  unpack(y, q_, s_);
  return equations_.evaluate(t, q_, s_) && matrix_.take_derivatives(equations_, y);
}

bool MotionOde::project(double t, double* y) {
  unpack(y, q_, s_);
  if (!equations_.project(t, q_, s_)) return false;
  Eigen::Map<Eigen::VectorXd>(y, nq_) = q_;
  Eigen::Map<Eigen::VectorXd>(y + nq_, nv_) = s_;
  return true;
}

void MotionOde::event_values(double t, const double* y, double* out) {
  q_ = Eigen::Map<const Eigen::VectorXd>(y, nq_);
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const Link& link = model_.system.links[static_cast<std::size_t>(stops_[i].link)];
    const double hair = 1e-12 * model_.scaling.column[link.v];
    out[i] = value_at_stop(model_, stops_[i], q_) + (touching_[i] == stops_[i].upper ? hair : -hair);
  }
  for (std::size_t i = 0; i < flips_.size(); ++i) {
    const auto l = static_cast<std::size_t>(flips_[i].link);
    out[stops_.size() + i] = joint_rotation(model_.system.links[l], model_.parameters.links[l], q_).w();
  }
  if (slips_.empty() && holds_.empty()) return;
  double* next = out + stops_.size() + flips_.size();
  unpack(y, q_, s_);
  const bool known = equations_.evaluate(t, q_, s_); // else the step fails, too
  for (const Slip& slip : slips_) {
    const double hair = 1e-11 * model_.scaling.column[slip.v] * rate_scale_;
    *next++ = known ? slip.way * equations_.velocity()[slip.v] + hair : hair;
  }
  for (const FrictionHold& hold : holds_) {
    const double force = known ? -equations_.multipliers()[hold.row] : 0;
    *next++ = hold.most * off_by - force;
    *next++ = force - hold.least * off_by;
  }
}

} // namespace flyball
