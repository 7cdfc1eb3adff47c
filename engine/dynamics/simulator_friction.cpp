#include "engine/dynamics/simulator_state.hpp"

#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace flyball {
namespace {

// A coordinate with friction stands still where its rate is this part of a usual one.
constexpr double still = 1e-9;

} // namespace

void Simulator::State::settle_frictions(double t, Eigen::VectorXd u, Turned turned_back) {
  best_independence = 0;
  const Eigen::VectorXd coming = u;
  const std::vector<int> before = std::exchange(slips, std::vector<int>(frictions.size(), 0));
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    const int v = v_of(frictions[i]);
    const double usual = model->scaling.column[v] * rate_scale;
    const bool turned = turned_back == Turned::stopped && !before.empty() && before[i] * u[v] < 0;
    if (std::abs(u[v]) > still * usual && !turned)
      slips[i] = u[v] > 0 ? 1 : -1;
    else
      u[v] = 0;
  }
  // Which of those at rest begin to slip is a linear complementarity problem: one is changed at a time, of
  // one that takes more than its limit or that would go against the way it slips. By the least number, after
  // others, it comes to an end (Murty's principal pivoting).
  std::vector<bool> begins(frictions.size(), false);
  const std::size_t most_tries = 12 * frictions.size();
  for (std::size_t tries = 0;; ++tries) {
    if (tries > most_tries) throw SceneError("", "which joints with friction begin to slip is not found");
    FrictionModes modes = with_modes(*free, frictions, slips, q, coming, rate_scale);
    undecided = std::move(modes.at_dead_points);
    equations.reset();
    model = std::move(modes.model);
    holds = std::move(modes.holds);
    equations = std::make_unique<Equations>(*model, watch);
    restructure(t, u);
    if (!equations->evaluate(t, q, s))
      throw SceneError("", "the equations of motion have no solution where friction sticks: " +
                               equations->unsolved());
    if (leave_dead_points(t)) continue;
    const bool in_order = tries > 3 * frictions.size();
    const FrictionHold* worst = nullptr;
    double most = slipping_by;
    for (const FrictionHold& hold : holds) {
      const double force = force_of(hold);
      const double part = force > 0 ? force / hold.most : force < 0 ? force / hold.least : 0;
      if (!(part > (in_order ? slipping_by : most)) && !std::isinf(part)) continue;
      if (in_order && worst && worst->element < hold.element) continue;
      most = part;
      worst = &hold;
    }
    const std::optional<std::size_t> against = goes_against_slip(begins);
    if (!worst && !against) break;
    if (against && (!worst || (in_order && *against < worst->element))) {
      slips[*against] = 0;
      begins[*against] = false;
      continue;
    }
    const auto release = [&](std::size_t element, int way) {
      slips[element] = way;
      begins[element] = true;
    };
    const int way = force_of(*worst) > 0 ? -1 : 1;
    release(worst->element, way);
    for (const FrictionHold::Tied& tied : worst->tied)
      release(tied.element, tied.rate > 0 ? way : -way);
  }
  for (std::size_t i = 0; i < frictions.size() && !before.empty(); ++i)
    if (slips[i] != before[i]) {
      run.frictions.push_back({t, "", 0, slips[i]});
      recorder->name(frictions[i], run.frictions.back());
    }
  if (recorder) recorder->follow(model, *equations);
}

std::optional<std::size_t> Simulator::State::goes_against_slip(const std::vector<bool>& begins) const {
  constexpr double seen = 1e-9; // of the largest acceleration
  const Eigen::VectorXd &rate = equations->velocity(), &acceleration = equations->acceleration();
  const Eigen::VectorXd& column = model->scaling.column;
  const double least = seen * acceleration.cwiseQuotient(column).lpNorm<Eigen::Infinity>();
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    if (!begins[i]) continue;
    const int v = v_of(frictions[i]);
    const bool moves = std::abs(rate[v]) > still * column[v] * rate_scale; // at once, as what has no mass
    if (moves ? slips[i] * rate[v] < 0 : slips[i] * acceleration[v] / column[v] < -least) return i;
  }
  return std::nullopt;
}

bool Simulator::State::leave_dead_points(double t) {
  if (undecided.empty()) return false;
  // Of the largest acceleration, which moves what is as good as at a dead point by less; of a usual rate.
  constexpr double seen = 2e-6, later = 0.05;
  const Eigen::VectorXd& column = model->scaling.column;
  const auto size = [&](const Eigen::VectorXd& x) {
    return x.cwiseQuotient(column).lpNorm<Eigen::Infinity>();
  };
  bool found = false;
  const auto look = [&] {
    const Eigen::VectorXd& bends = equations->acceleration();
    const double least = seen * size(bends);
    for (const std::size_t i : undecided)
      if (const int v = v_of(frictions[i]); slips[i] == 0 && std::abs(bends[v]) / column[v] > least) {
        slips[i] = bends[v] > 0 ? 1 : -1;
        found = true;
      }
  };
  look();
  const double most = size(equations->acceleration());
  if (found || !(most > 0)) return found;
  Eigen::VectorXd at = q, along = s + later * std::max(rate_scale, std::sqrt(most)) / most *
                                          equations->acceleration();
  if (equations->project(t, at, along) && equations->evaluate(t, at, along)) look();
  return found || !equations->evaluate(t, q, s);
}

bool Simulator::State::has_left_dead_point(const Eigen::VectorXd& state) const {
  return std::ranges::any_of(undecided, [&](std::size_t i) {
    const int v = v_of(frictions[i]);
    return std::abs(state[model->system.nq + v]) > still * model->scaling.column[v] * rate_scale;
  });
}

bool Simulator::State::some_slip_has_turned(const Eigen::VectorXd& u) const {
  for (std::size_t i = 0; i < frictions.size(); ++i)
    if (slips[i] * u[v_of(frictions[i])] < 0) return true;
  return false;
}

void Simulator::State::change_frictions(double t, const Eigen::VectorXd& u, Turned turned_back) {
  const Eigen::Vector3d energies = ode->energies(y);
  settle_frictions(t, u, turned_back);
  stepper->count(run.statistics);
  use_method(method);
  ode->pack(q, s, energies, y);
  start_stepper(t);
}

int Simulator::State::v_of(const FrictionElement& friction) const {
  return model->system.links[static_cast<std::size_t>(friction.link)].v;
}

double Simulator::State::force_of(const FrictionHold& hold) const {
  return -equations->multipliers()[hold.row];
}

} // namespace flyball
