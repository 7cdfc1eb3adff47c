#include "engine/study/linear_model.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/inside_ranges.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/friction_state.hpp"
#include "engine/report/messages.hpp"
#include "engine/stability/stability.hpp"
#include "engine/study/input_effect.hpp"
#include "engine/study/linear_forms.hpp"
#include "engine/study/linear_friction.hpp"
#include "engine/study/linear_matrices.hpp"
#include "engine/study/linear_place.hpp"
#include "engine/study/model_coordinates.hpp"
#include "engine/study/motion_outputs.hpp"
#include "engine/system/balance_rate.hpp"
#include "engine/system/drive_rates.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

namespace flyball {
namespace {

constexpr double nothing = 1e-9;    // of what a signal feels, beside the most that it feels
constexpr double rounding = 1e-11;  // the same: what differences leave of nothing
constexpr double no_effect = 1e-14; // of an input, beside what holds the mechanism

// Nothing acts along what is left to itself: as it moves it is what a torque of nothing drives.
Mechanism with_momenta_free(Mechanism mechanism) {
  for (Joint& joint : mechanism.joints)
    for (Coordinate& coordinate : joint.coordinates)
      if (coordinate.drive && coordinate.drive->keeps == DriveKeeps::momentum) {
        coordinate.drive->keeps = DriveKeeps::speed;
        coordinate.drive->torque = 0;
      }
  return mechanism;
}

class Builder {
 public:
  Builder(const Mechanism& mechanism, std::span<const std::string> inputs,
          std::span<const std::string> outputs, const LinearModelOptions& options)
      : signals_(read_signals(mechanism, inputs, outputs)), options_(options),
        mechanism_(with_momenta_free(signals_.mechanism)) {
    for (const LinearInput& input : signals_.inputs)
      if (!input.address.empty()) {
        numbers_.push_back(static_cast<int>(addresses_.size()));
        addresses_.push_back(input.address);
      } else {
        numbers_.push_back(-1);
      }
    // Throws for numbers that are none.
    const VariedNumbers known(mechanism_, addresses_);
  }

  void run(LinearModel& out) {
    find_steady(out);
    const auto begin = std::chrono::steady_clock::now();
    const Interruptible scope(options_.cancel);
    check(out.steady);
    place_.emplace(mechanism_, with_dampers_beside(mechanism_, addresses_), out.steady);
    hold(out);
    const MotionAt drawn(place_->model, place_->at(0), place_->held);
    place_->choose(drawn, options_.phases);
    const LinearMatrices here = matrices(drawn, 0);
    for (std::size_t i = 0; i < signals_.outputs.size(); ++i)
      signals_.outputs[i].value = here.values[static_cast<Eigen::Index>(i)];
    const std::vector<DriveRate> rates = drive_rates(place_->steady, place_->parameters, place_->balance_q);
    const bool values_turn = place_->phases && !place_->steady.torques.empty();
    for (const double t : phase_times(rates))
      expect_same(here, matrices(MotionAt(place_->model, place_->at(t), place_->held), t), signals_,
                  values_turn, 4 * angle_rounding(rates, t));
    add_forms(*place_, here, drawn.without_mass > 0, signals_, options_.cancel, out);
    out.run_time_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

 private:
  // What slips is driven by its friction from here on.
  void find_steady(LinearModel& out) {
    SolveOptions solve;
    solve.start = options_.start;
    solve.nearest = options_.nearest;
    solve.cancel = options_.cancel;
    solve.friction = options_.slipping; // so that it is refused then
    out.steady = Analysis(signals_.mechanism).solve(solve);
    if (!solve.friction && !solve.nearest && out.steady.status != Status::converged &&
        has_friction(signals_.mechanism))
      if (std::optional<StateOnFriction> state = find_friction_state(signals_.mechanism, solve)) {
        mechanism_ = with_momenta_free(driven_by_slipping(signals_, *state));
        const VariedNumbers known(mechanism_, addresses_); // as above
        out.steady = std::move(state->solution);
      }
  }

  void hold(LinearModel& out) {
    for (const FrictionForce& force : out.steady.frictions)
      if (force.slips) out.slipping.push_back(coordinate_label(force));
    if (options_.slipping) return;
    for (HeldCoordinate& held : held_by_friction(mechanism_, place_->model, out.steady)) {
      out.held.push_back(std::move(held.name));
      place_->held.push_back(held.v);
    }
  }

  void check(const Solution& steady) const {
    if (steady.status != Status::converged) throw Refusal{steady.message};
    if (options_.slipping && !steady.frictions.empty())
      throw Refusal{rests_on_friction(steady, "Linear models once joints slip are made")};
    if (model_coordinates(steady) > largest_for_eigenvalues)
      throw Refusal{"Linear models are made of at most " + std::to_string(largest_for_eigenvalues) +
                    " coordinates."};
    if (steady.floquet || steady.stability_reason == StabilityReason::varying)
      throw Refusal{"The linearised motion turns with the drives: no constant matrices tell of it."};
  }

  static int model_coordinates(const Solution& steady) {
    return static_cast<int>(std::ranges::count_if(
        steady.coordinates, [](const CoordinateSolution& c) { return is_found(c) && !c.dependent; }));
  }

  // Whether a number that changes is the speed with which something left to itself begins.
  bool begins_with(const NumberRates& rates) const {
    for (std::size_t j = 0; j < mechanism_.joints.size(); ++j)
      for (std::size_t i = 0; i < mechanism_.joints[j].coordinates.size(); ++i) {
        const auto& drive = signals_.mechanism.joints[j].coordinates[i].drive;
        if (drive && drive->keeps == DriveKeeps::momentum &&
            rates.find(place_of(mechanism_.joints[j].coordinates[i].drive->speed)).value_or(0) != 0)
          return true;
      }
    return false;
  }

  InputEffect effect(const MotionAt& motion, std::size_t i, double t) {
    const LinearInput& input = signals_.inputs[i];
    Eigen::VectorXd none = Eigen::VectorXd::Zero(place_->model.system.rows),
                    still =
                        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(place_->model.system.drives.size()));
    try {
      if (input.address.empty()) return motion.effect(-torque_direction(input, motion), none, still);
      NumberRates rates;
      const VariedNumbers numbers(mechanism_, addresses_);
      numbers.rates(static_cast<std::size_t>(numbers_[i]), rates);
      if (std::ranges::any_of(place_->steady.torques, &DriveTorqueElement::implied)) {
        if (input.force) return motion.effect(of_force(rates, motion), none, still);
        throw Refusal{
            "where loops and gears make something turn at a rate of its own, inputs are torques and "
            "forces, as torque(joint) and force_x(body)"};
      }
      if (begins_with(rates))
        throw Refusal{"it is the speed with which something left to itself begins, and acts on nothing "
                      "later; a torque(joint) does"};
      BalanceRate balance;
      balance.evaluate(place_->steady, mechanism_, rates, place_->parameters, place_->balance_q,
                       motion.at.lambda, t);
      if (t == 0 && places_parts(balance.parameters()))
        throw Refusal{
            "it places parts, and as it changes its rates move mass, which a number alone does not tell. "
            "Inputs are torques, forces, speeds, stiffnesses, dampings, masses, free lengths, lengths of "
            "distance joints, offsets of gears, gravity, and parameters of these"};
      for (std::size_t d = 0; d < place_->model.system.drives.size(); ++d)
        still[static_cast<Eigen::Index>(d)] =
            balance.parameters()
                .links[static_cast<std::size_t>(place_->model.system.drives[d].link)]
                .speed.rate;
      return motion.effect(balance.force(), balance.phi(), still);
    } catch (const Refusal& refusal) {
      throw Refusal{"The input " + input.name + " has no place in a linear model: " + refusal.why + "."};
    }
  }

  // What a force on a body does to the balance, wherever the rates of what it moves come from.
  Eigen::VectorXd of_force(const NumberRates& rates, const MotionAt& motion) const {
    const MotionModel& model = place_->model;
    BalanceRate balance;
    balance.evaluate(model.released, mechanism_, rates, model.parameters, motion.at.q, motion.at.lambda);
    return balance.force().head(model.system.nv);
  }

  // The generalised force of a unit torque or force along the input's coordinate (N m or N).
  Eigen::VectorXd torque_direction(const LinearInput& input, const MotionAt& motion) const {
    const System& system = place_->model.system;
    for (const CoordinateInfo& c : system.coordinates) {
      if (system.tree_joints[static_cast<std::size_t>(c.tree_joint)].joint != input.joint ||
          c.index != input.coordinate)
        continue;
      const Link& link = system.links[static_cast<std::size_t>(c.link)];
      if (link.v < 0) throw Refusal{"the speed there is prescribed, whatever torque acts"};
      if (link.drive >= 0) return Eigen::VectorXd::Unit(system.nv, link.v);
      return coordinate_gradient(system, place_->model.parameters, motion.at.q.head(system.nq), c);
    }
    throw Refusal{
        "its joint closes a loop; \"cut\" at another joint of the loop makes it a coordinate of the tree"};
  }

  // By which a direction is measured, so that differences of it are about as large as the rest: radians,
  // parts of the reach, their rates by the speeds there are.
  static double size_of(const MotionAt& motion, const MotionDirection& d, double rate) {
    const auto scaled = [&](const Eigen::VectorXd& x) {
      return x.size() > 0 ? x.cwiseQuotient(motion.column()).lpNorm<Eigen::Infinity>() : 0;
    };
    return std::max({scaled(d.q), scaled(d.u) / rate, scaled(d.a) / (rate * rate)});
  }

  double speed_scale(const MotionAt& motion) const {
    const double m = motion.mass.norm(), k = motion.stiffness.norm();
    const double natural = m > 0 && k > 0 ? std::sqrt(k / m) : 0;
    const double turning =
        motion.at.u.size() > 0 ? motion.at.u.cwiseQuotient(motion.column()).lpNorm<Eigen::Infinity>() : 0;
    const double rate = std::max(natural, turning);
    return rate > 0 ? rate : 1;
  }

  LinearMatrices matrices(const MotionAt& motion, double t) {
    interruption_point();
    const Eigen::MatrixXd& basis = motion.basis();
    const auto k = static_cast<Eigen::Index>(place_->chosen.entries.size());
    const auto inputs = static_cast<Eigen::Index>(signals_.inputs.size());
    const Eigen::MatrixXd from = place_->from_chosen(motion), to = place_->to_chosen(motion);
    LinearMatrices out;
    out.mass = from.transpose() * motion.mass * from;
    out.velocity = from.transpose() * motion.velocity * from;
    out.stiffness = from.transpose() * motion.stiffness * from;
    out.made_of = from.cwiseAbs2().transpose() * motion.inertia;
    std::vector<InputEffect> effects;
    out.b0.resize(k, inputs);
    out.shift.resize(k, inputs);
    out.force.resize(k, inputs);
    out.momentum.resize(k, inputs);
    Eigen::MatrixXd fed(k, inputs); // on the basis
    for (Eigen::Index j = 0; j < inputs; ++j) {
      effects.push_back(effect(motion, static_cast<std::size_t>(j), t));
      fed.col(j) = effects.back().b0 - motion.velocity * effects.back().shift;
      out.b0.col(j) = from.transpose() * fed.col(j);
      out.shift.col(j) = to * effects.back().shift;
      out.force.col(j) = from.transpose() * effects.back().b0;
      out.momentum.col(j) = from.transpose() * effects.back().b1;
    }
    Eigen::VectorXd column(k);
    for (Eigen::Index i = 0; i < k; ++i)
      column[i] = motion.column()[place_->chosen.entries[static_cast<std::size_t>(i)]];
    out.force = column.asDiagonal() * out.force;
    out.momentum = column.asDiagonal() * out.momentum;
    out.stiffness_size = motion.stiffness.norm();
    out.held = (column.asDiagonal() * out.stiffness * column.asDiagonal()).rowwise().norm();
    out.inertia = (column.asDiagonal() * out.mass * column.asDiagonal()).rowwise().norm();
    out.speed_size = speed_scale(motion);
    out.momentum_size = out.speed_size * motion.mass.norm();
    for (Eigen::Index j = 0; j < inputs && k > 0; ++j) {
      if (!is_rounding(out, j, column.maxCoeff())) continue;
      InputEffect& e = effects[static_cast<std::size_t>(j)];
      for (Eigen::VectorXd* x : {&e.b0, &e.shift})
        x->setZero();
      for (Eigen::MatrixXd* x : {&fed, &out.b0, &out.shift, &out.force, &out.momentum})
        x->col(j).setZero();
    }
    const auto accelerated = [&](const Eigen::MatrixXd& rhs) {
      Eigen::MatrixXd x(rhs.rows(), rhs.cols());
      for (Eigen::Index i = 0; i < rhs.cols(); ++i)
        x.col(i) = motion.accelerate(rhs.col(i));
      return x;
    };
    const Eigen::MatrixXd by_position = accelerated(-motion.stiffness * from),
                          by_rate = accelerated(-motion.velocity * from), by_input = accelerated(fed);
    out.explicit_stiffness = to * by_position;
    out.explicit_velocity = to * by_rate;
    out.explicit_b = to * by_input;
    // What is left of slow motions where some parts are far lighter than others, so that terms of A cancel.
    const Eigen::ArrayXd damped = (column.asDiagonal() * out.velocity * column.asDiagonal()).rowwise().norm();
    const Eigen::ArrayXd felt =
        out.held.array() + out.speed_size * (damped + out.speed_size * out.inertia.array());
    const auto lost = [&](const Eigen::MatrixXd& accelerations) {
      const Eigen::MatrixXd terms =
          column.asDiagonal() * out.mass.cwiseAbs() * accelerations.cwiseAbs() * column.asDiagonal();
      return std::numeric_limits<double>::epsilon() * (terms.rowwise().norm().array() / felt).maxCoeff();
    };
    if (k > 0)
      out.lost = std::max(lost(out.explicit_stiffness), lost(out.explicit_velocity) * out.speed_size);

    add_outputs(motion, effects, {basis * from, basis * by_position, basis * by_rate, basis * by_input}, out);
    return out;
  }

  // What coordinates do and what goes with them, scaled, of all entries of q_R.
  struct Directions {
    Eigen::MatrixXd positions, by_position, by_rate, by_input; // by_: accelerations
  };

  // What outputs feel of positions, rates and inputs.
  void add_outputs(const MotionAt& motion, const std::vector<InputEffect>& effects,
                   const Directions& directions, LinearMatrices& out) {
    const Eigen::Index k = directions.positions.cols(), inputs = directions.by_input.cols(),
                       outputs = static_cast<Eigen::Index>(signals_.outputs.size());
    const int n = place_->model.system.nv;
    const auto all = static_cast<Eigen::Index>(place_->model.released.nv);
    MotionOutputs h(place_->model, addresses_, static_cast<std::size_t>(outputs), motion.without_mass == 0);
    out.values = h.values(motion.at);
    for (Eigen::Index i = 0; i < outputs; ++i)
      if (!std::isfinite(out.values[i]))
        throw Refusal{"The output " + output(i) +
                      (motion.without_mass > 0 ? " is not known: bodies without mass have no acceleration."
                                               : " has no value in the steady state.")};
    const double rate = out.speed_size;
    // Rates per unit, and in units of what a direction is measured by.
    Eigen::MatrixXd normalised(outputs, 2 * k + inputs), error = normalised, kink = normalised;
    Eigen::VectorXd sizes(2 * k + inputs);
    const auto take = [&](Eigen::Index i, MotionDirection d, double least) {
      double size = std::max(size_of(motion, d, rate), least);
      // What moves nothing may bear on something all the same, as a force on a part that is driven does.
      if (size == 0 && (d.change != 0 || !d.lambda.isZero(0))) size = 1;
      sizes[i] = size;
      if (!(size > 0)) { // nothing moves
        normalised.col(i).setZero();
        error.col(i).setZero();
        kink.col(i).setZero();
        return;
      }
      for (Eigen::VectorXd* x : {&d.q, &d.u, &d.a, &d.lambda})
        *x /= size;
      d.change /= size;
      const MotionOutputs::Rates rates = h.along(motion.at, d);
      normalised.col(i) = rates.value;
      error.col(i) = rates.error;
      kink.col(i) = rates.kink;
    };
    const auto zero = [&] { return Eigen::VectorXd(Eigen::VectorXd::Zero(all)); };
    const auto free = [&](const Eigen::VectorXd& x) {
      Eigen::VectorXd y = zero();
      y.head(n) = x;
      return y;
    };
    for (Eigen::Index i = 0; i < k; ++i) {
      take(i,
           motion.direction(free(directions.positions.col(i)), zero(), free(directions.by_position.col(i)),
                            nullptr),
           0);
      take(k + i,
           motion.direction(zero(), free(directions.positions.col(i)), free(directions.by_rate.col(i)),
                            nullptr),
           0);
    }
    for (Eigen::Index j = 0; j < inputs; ++j) {
      const InputEffect& e = effects[static_cast<std::size_t>(j)];
      Eigen::VectorXd u = free(motion.basis() * e.shift);
      u.tail(e.drive_rates.size()) = e.drive_rates;
      MotionDirection d = motion.direction(free(e.closing), u, free(directions.by_input.col(j)), &e.force);
      d.number = numbers_[static_cast<std::size_t>(j)];
      d.change = 1;
      const double value = d.number < 0 ? 0 : std::abs(signals_.inputs[static_cast<std::size_t>(j)].value);
      take(2 * k + j, std::move(d), value > 0 ? 1 / value : 0);
      if (!(sizes[2 * k + j] > 0)) sizes[2 * k + j] = 1;
    }
    out.most = normalised.cwiseAbs().rowwise().maxCoeff();
    if (normalised.cols() == 0) out.most.setZero(outputs);
    out.error.setZero(outputs);
    for (Eigen::Index i = 0; i < outputs; ++i)
      for (Eigen::Index s = 0; s < normalised.cols(); ++s)
        if (std::abs(normalised(i, s)) <= std::max(rounding * out.most[i], 8 * error(i, s)))
          normalised(i, s) = 0;
        else
          out.error[i] = std::max(out.error[i], error(i, s) / out.most[i]);
    for (Eigen::Index i = 0; i < outputs && kink.cols() > 0; ++i)
      if (kink.row(i).maxCoeff() > nothing * out.most[i])
        throw Refusal{"The output " + output(i) +
                      " has no slope in the steady state, where it stands on a kink, as the size of a vector "
                      "does that vanishes there. Its components may have one."};
    refuse_rates(motion, effects, directions.positions, h, rate, out.most);
    refuse_open_shares(motion, h);
    out.normalised = normalised;
    out.sizes = sizes;
    const Eigen::MatrixXd per_unit = normalised * sizes.asDiagonal();
    out.c_position = per_unit.leftCols(k);
    out.c_rate = per_unit.middleCols(k, k);
    out.d = per_unit.rightCols(inputs);
  }

  // Whether nothing is left of what an input does but rounding: for all of a number, or one newton at the
  // longest arm.
  bool is_rounding(const LinearMatrices& m, Eigen::Index j, double arm) const {
    const Eigen::ArrayXd force = m.force.col(j).cwiseAbs(), momentum = m.momentum.col(j).cwiseAbs();
    if (numbers_[static_cast<std::size_t>(j)] < 0)
      return momentum.isZero(0) && force.maxCoeff() <= no_effect * arm;
    const double all = std::abs(signals_.inputs[static_cast<std::size_t>(j)].value);
    return all > 0 && (all * force <= no_effect * m.held.array()).all() &&
           (all * momentum <= no_effect * m.speed_size * m.inertia.array()).all();
  }

  std::string output(Eigen::Index i) const { return signals_.outputs[static_cast<std::size_t>(i)].name; }

  // What an output may not feel: the rates of inputs, and angles that speeds add up to.
  void refuse_rates(const MotionAt& motion, const std::vector<InputEffect>& effects,
                    const Eigen::MatrixXd& positions, MotionOutputs& h, double rate,
                    const Eigen::VectorXd& most) {
    const int n = place_->model.system.nv;
    const auto zero = [&] { return Eigen::VectorXd(Eigen::VectorXd::Zero(place_->model.released.nv)); };
    const auto refuse = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& u, const Eigen::VectorXd& a,
                            const auto& why) {
      MotionDirection d = motion.direction(q, u, a, nullptr);
      const double size = size_of(motion, d, rate);
      if (!(size > 0)) return;
      for (Eigen::VectorXd* x : {&d.q, &d.u, &d.a, &d.lambda})
        *x /= size;
      const MotionOutputs::Rates rates = h.along(motion.at, d);
      for (Eigen::Index i = 0; i < rates.value.size(); ++i)
        if (std::abs(rates.value[i]) > std::max(nothing * most[i], 8 * rates.error[i]))
          throw Refusal{why(output(i))};
    };
    for (std::size_t j = 0; j < effects.size(); ++j) {
      const InputEffect& e = effects[j];
      const auto feels = [&](const std::string& name) {
        return "The output " + name + " feels the rate of the input " + signals_.inputs[j].name +
               " at once, so that no state form has both: take a position for a velocity, a torque for a "
               "speed, or the "
               "other way round.";
      };
      Eigen::VectorXd u = zero(), a = zero();
      u.head(n) = e.closing;
      a.head(n) = motion.basis() * e.shift;
      a.tail(e.drive_rates.size()) = e.drive_rates;
      refuse(zero(), u, a, feels);
      a.setZero();
      a.head(n) = e.closing;
      refuse(zero(), zero(), a, feels);
      Eigen::VectorXd q = zero();
      q.tail(e.drive_rates.size()) = e.drive_rates;
      refuse(q, zero(), zero(), [&](const std::string& name) {
        return "The output " + name + " depends on the angle that the speed " + signals_.inputs[j].name +
               " adds up to.";
      });
    }
    for (std::size_t i = 0; i < place_->chosen.entries.size(); ++i) {
      if (!place_->chosen.phase[i]) continue;
      Eigen::VectorXd q = zero();
      q.head(n) = positions.col(static_cast<Eigen::Index>(i)); // with what loops and gears move along
      refuse(q, zero(), zero(), [&](const std::string& name) {
        return "The output " + name + " depends on the angle of " +
               name_state(place_->model, place_->chosen.entries[i], false).name +
               ", which turns: it grows without end.";
      });
    }
  }

  // What an output feels of how joints that friction holds share what loops let each of them bear.
  void refuse_open_shares(const MotionAt& motion, MotionOutputs& h) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(place_->model.released.nv);
    for (const Eigen::VectorXd& share : motion.open_shares) {
      if (share.size() == 0) continue;
      MotionDirection d = motion.direction(none, none, none, nullptr);
      d.lambda = share;
      const MotionOutputs::Rates rates = h.along(motion.at, d);
      for (Eigen::Index i = 0; i < rates.value.size(); ++i)
        if (std::abs(rates.value[i]) >
            std::max(nothing * share.lpNorm<Eigen::Infinity>(), 8 * rates.error[i]))
          throw Refusal{"The output " + output(i) +
                        " is not determined: loops leave it open how the joints that friction holds share "
                        "what they bear."};
    }
  }

  LinearSignals signals_;
  const LinearModelOptions& options_;
  Mechanism mechanism_; // whose numbers have rates
  std::vector<std::string> addresses_;
  std::vector<int> numbers_; // by input, in addresses_; -1: none
  std::optional<LinearPlace> place_;
};

} // namespace

LinearModel linearize(const Mechanism& mechanism, std::span<const std::string> inputs,
                      std::span<const std::string> outputs, const LinearModelOptions& options) {
  LinearModel out;
  Builder builder(mechanism, inputs, outputs, options);
  try {
    builder.run(out);
  } catch (const Refusal& refusal) {
    out.refusal = refusal.why;
  } catch (const Interrupted&) {
    out.refusal = "The computation was cancelled.";
  }
  return out;
}

} // namespace flyball
