#include "engine/study/input_effect.hpp"

#include "engine/linear/pencil.hpp"
#include "engine/stability/linear_motion.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double massless = 1e-13;    // beside the largest inertia
constexpr double coupling = 1e-13;    // of an inertia between two coordinates, beside the mean of their own
constexpr double consistent = 1e-9;   // what an equation may leave of what it is made of
constexpr double same_balance = 1e-8; // a balance at another angle of a drive, likewise

template <class... Numbers>
bool moves(const Numbers&... numbers) {
  const auto any = [](const auto& x) {
    if constexpr (std::is_same_v<std::decay_t<decltype(x)>, Dual>)
      return x.rate != 0;
    else
      return std::ranges::any_of(x, [](const Dual& each) { return each.rate != 0; });
  };
  return (any(numbers) || ...);
}

} // namespace

bool places_parts(const BasicParameters<Dual>& p) {
  const auto link = [](const BasicLinkParameters<Dual>& l) {
    return moves(l.offset, l.axis, l.drawn, l.com, l.start, l.drawn_rotation.coeffs());
  };
  const auto spring = [](const BasicPointSpringParameters<Dual>& s) { return s.damped() && moves(s.a, s.b); };
  const auto bearing = [](const BasicBearingParameters<Dual>& b) {
    return std::ranges::any_of(b.damping.reshaped(), [](const Dual& c) { return c.value != 0; }) &&
           moves(b.a, b.b, b.axes.reshaped());
  };
  const auto air = [](const BasicBodyForceParameters<Dual>& f) { return is_of_air(f.type) && moves(f.at); };
  const auto damper = [](const BasicCutDamperParameters<Dual>& d) { return moves(d.b, d.axis); };
  const auto cut = [](const BasicCutParameters<Dual>& c) {
    return moves(c.a, c.b, c.drawn, c.constant, c.ratio) ||
           std::ranges::any_of(c.frame, [](const Vec3T<Dual>& x) { return moves(x); });
  };
  return std::ranges::any_of(p.links, link) || std::ranges::any_of(p.springs, spring) ||
         std::ranges::any_of(p.bearings, bearing) || std::ranges::any_of(p.body_forces, air) ||
         std::ranges::any_of(p.turning_air, air) || std::ranges::any_of(p.cut_dampers, damper) ||
         std::ranges::any_of(p.cuts, cut);
}

MotionAt::MotionAt(const MotionModel& model, const MotionOfAll& state, std::span<const int> held)
    : at(state), model_(model), n_(model.system.nv), drives_(static_cast<int>(model.system.drives.size())) {
  const System& released = model.released;
  const Parameters& p = model.parameters;
  column_.resize(released.nv);
  column_.head(n_) = model.scaling.column;
  for (int d = 0; d < drives_; ++d) {
    const int link = model.system.drives[static_cast<std::size_t>(d)].link;
    column_[n_ + d] =
        released.links[static_cast<std::size_t>(link)].type == LinkType::prismatic ? p.length : 1;
  }
  std::vector<LinkRates> none;
  move(released, p, {at.q, at.u}, kinematics_, none);
  find_multipliers(held);
  evaluate_residual<double>(released, p, at.q, at.lambda, kinematics_, residual_);
  for (const Eigen::VectorXd& share : open_shares)
    refuse_dead_point(share);
  linearize(released, p, at.q, at.lambda, kinematics_, residual_, l_);
  linearize_motion(released, p, at.q, kinematics_, l_);
  add_coordinate_damping_stiffness(released, p, at.q, at.u, l_.stiffness);
  for (Eigen::MatrixXd* m : {&l_.mass, &l_.velocity, &l_.stiffness})
    *m = (column_.asDiagonal() * *m * column_.asDiagonal()).eval();
  mass = reduced(l_.mass);
  velocity = reduced(l_.velocity);
  stiffness = reduced(l_.stiffness);
  const Eigen::Index k = mass.rows();
  if (k == 0) return;
  inertia = basis_.cwiseAbs2().transpose() * own_inertia(model.system, l_.mass);
  units_ = units_of_inertia(mass, velocity, stiffness, inertia);
  const Eigen::MatrixXd symmetric = (mass + mass.transpose()) / 2;
  if (!shape_.compute(units_.asDiagonal() * symmetric * units_.asDiagonal()))
    throw Refusal{"The inertias overflow."};
  while (without_mass < k && !(shape_.values()[without_mass] > massless * shape_.values()[k - 1]))
    ++without_mass;
  if (without_mass == 0 && !factors_.compute(symmetric)) throw Refusal{"The inertias are too far apart."};
}

Eigen::VectorXd MotionAt::accelerate(const Eigen::VectorXd& rhs) const {
  if (rhs.size() == 0) return rhs;
  if (without_mass == 0) return factors_.solve(rhs);
  const auto vectors = shape_.vectors().rightCols(mass.rows() - without_mass);
  const auto values = shape_.values().tail(mass.rows() - without_mass);
  const Eigen::VectorXd along = vectors.transpose() * units_.cwiseProduct(rhs);
  return units_.cwiseProduct(vectors * along.cwiseQuotient(values));
}

InputEffect MotionAt::effect(const Eigen::VectorXd& force, const Eigen::VectorXd& rows,
                             const Eigen::VectorXd& drive_rates) const {
  InputEffect out;
  out.force = force.cwiseProduct(column_.head(n_));
  out.drive_rates = drive_rates.cwiseQuotient(column_.tail(drives_));
  out.closing.setZero(n_);
  if (rows.size() > 0 && !rows.isZero(0)) {
    Eigen::VectorXd scaled = Eigen::VectorXd::Zero(constraint_.rows());
    scaled.head(rows.size()) = rows.cwiseProduct(model_.scaling.row);
    space_.solve(-scaled, out.closing);
    if (!((constraint_.leftCols(n_) * out.closing + scaled).norm() <= consistent * scaled.norm()))
      throw Refusal{"the loops do not let it change alone"};
    const Eigen::VectorXd along = basis_.transpose() * l_.mass.topLeftCorner(n_, n_) * out.closing;
    out.closing -= basis_ * accelerate(along);
  }
  if (const double turned = out.drive_rates.norm(); turned > 0) {
    const Eigen::VectorXd phase = l_.stiffness.topRightCorner(n_, drives_) * out.drive_rates;
    if ((constraint_.rightCols(drives_) * out.drive_rates).norm() > consistent * turned ||
        (basis_.transpose() * phase).norm() >
            same_balance * phase.norm() + massless * l_.stiffness.norm() * turned)
      throw Refusal{"the balance depends on the angle that the speed adds up to"};
  }
  out.b0 = -(basis_.transpose() * (out.force + l_.stiffness.topLeftCorner(n_, n_) * out.closing));
  out.b1 =
      -(basis_.transpose() * (carried(out.drive_rates) + l_.velocity.topLeftCorner(n_, n_) * out.closing));
  const Eigen::VectorXd acts = out.b1.size() > 0 ? units_.cwiseProduct(out.b1) : out.b1;
  if (without_mass > 0 && // else of what is held whole there are no directions to look along
      !((shape_.vectors().leftCols(without_mass).transpose() * acts).norm() <= consistent * acts.norm()))
    throw Refusal{"its rate moves dampers of parts without mass"};
  out.shift = accelerate(out.b1);
  return out;
}

Eigen::VectorXd MotionAt::carried(const Eigen::VectorXd& drive_rates) const {
  Eigen::VectorXd out = l_.mass.topRightCorner(n_, drives_) * drive_rates;
  const Eigen::VectorXd own = l_.mass.diagonal().cwiseMax(0).cwiseSqrt();
  const double turned = own.tail(drives_).dot(drive_rates.cwiseAbs());
  for (Eigen::Index v = 0; v < n_; ++v)
    if (std::abs(out[v]) <= coupling * own[v] * turned) out[v] = 0;
  return out;
}

MotionDirection MotionAt::direction(const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                    const Eigen::VectorXd& a, const Eigen::VectorXd* force) const {
  MotionDirection out{column_.cwiseProduct(q), column_.cwiseProduct(u), column_.cwiseProduct(a),
                      Eigen::VectorXd::Zero(model_.system.rows)};
  if (model_.system.rows == 0) return out;
  Eigen::VectorXd left =
      l_.mass.topRows(n_) * a + l_.stiffness.topRows(n_) * q + l_.velocity.topLeftCorner(n_, n_) * u.head(n_);
  if (force) left += *force;
  out.lambda = multipliers(left);
  return out;
}

Eigen::MatrixXd MotionAt::reduced(const Eigen::MatrixXd& m) const {
  return basis_.transpose() * m.topLeftCorner(n_, n_) * basis_;
}

Eigen::VectorXd MotionAt::multipliers(const Eigen::VectorXd& force) const {
  return space_.least_norm_multipliers(-force).head(model_.system.rows).cwiseProduct(model_.scaling.row);
}

void MotionAt::refuse_dead_point(const Eigen::VectorXd& share) {
  const double bears = at.lambda.lpNorm<Eigen::Infinity>(), whole = share.lpNorm<Eigen::Infinity>();
  if (!(bears > 0 && whole > 0)) return;
  const auto stiffness_with = [&](const Eigen::VectorXd& lambda) {
    evaluate_residual<double>(model_.released, model_.parameters, at.q, lambda, kinematics_, residual_);
    linearize(model_.released, model_.parameters, at.q, lambda, kinematics_, residual_, l_);
    return reduced(column_.asDiagonal() * l_.stiffness * column_.asDiagonal());
  };
  const Eigen::MatrixXd other = stiffness_with(at.lambda + share * (bears / whole)),
                        drawn = stiffness_with(at.lambda);
  if ((other - drawn).norm() > consistent * (drawn.norm() + other.norm()))
    throw Refusal{
        "A joint that friction holds stands at a dead point of its loop: how much of the load it bears "
        "is open, and small motions depend on it."};
}

void MotionAt::find_multipliers(std::span<const int> held) {
  const System& released = model_.released;
  linearize_constraints(released, model_.parameters, kinematics_, l_);
  const auto holds = static_cast<Eigen::Index>(held.size());
  constraint_.setZero(released.rows + holds, released.nv);
  constraint_.topRows(released.rows) = model_.scaling.row.asDiagonal() * l_.constraint * column_.asDiagonal();
  for (Eigen::Index i = 0; i < holds; ++i)
    constraint_(released.rows + i, held[static_cast<std::size_t>(i)]) = 1;
  space_.factor(constraint_.leftCols(n_), consistent, row_rounding);
  basis_ = space_.basis();
  for (const int v : held)
    basis_.row(v).setZero();
  Eigen::VectorXd combination, left;
  for (int k = 0; holds > 0 && k < space_.rows() - space_.rank(); ++k) {
    space_.dependence(k, combination, left);
    if (combination.tail(holds).lpNorm<Eigen::Infinity>() > consistent)
      open_shares.push_back(combination.head(released.rows).cwiseProduct(model_.scaling.row));
  }
  at.lambda.setZero(released.rows);
  if (constraint_.rows() == 0) return;
  evaluate_residual<double>(released, model_.parameters, at.q, at.lambda, kinematics_, residual_);
  Eigen::VectorXd force = residual_.f;
  add_coordinate_damping(released, model_.parameters, at.q, at.u, force);
  at.lambda = multipliers(force.head(n_).cwiseProduct(column_.head(n_)));
}

} // namespace flyball
