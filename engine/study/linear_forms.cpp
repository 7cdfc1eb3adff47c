#include "engine/study/linear_forms.hpp"

#include "engine/linear/pencil.hpp"
#include "engine/study/input_effect.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

constexpr double sign_of_pole = 1e-9; // beside the largest, else rounding
constexpr double most_lost = 1e-8;    // by the inverse of M, else E stands alone

// Nothing where the sign of a pole is rounding, or what has no mass may run away at once.
std::optional<bool> stable_by(const LinearModel& model) {
  double size = 0, most = -std::numeric_limits<double>::infinity();
  for (const std::complex<double> pole : model.poles) {
    size = std::max(size, std::abs(pole));
    most = std::max(most, pole.real());
  }
  if (most > sign_of_pole * size) return false;
  if (most < -sign_of_pole * size && model.explicit_form) return true;
  return {};
}

// Of an output that is a state no difference leaves rounding in C.
void set_states_as_outputs(const std::vector<std::string>& as_states, LinearModel& out) {
  for (std::size_t i = 0; i < as_states.size(); ++i) {
    const auto state = std::ranges::find(out.states, as_states[i], &LinearModel::State::name);
    if (as_states[i].empty() || state == out.states.end()) continue;
    auto row = out.descriptor.c.row(static_cast<Eigen::Index>(i));
    row.setZero();
    row[state - out.states.begin()] = 1;
  }
}

} // namespace

void add_forms(const LinearPlace& place, const LinearMatrices& m, bool massless, const LinearSignals& signals,
               CancelFlag cancel, LinearModel& out) {
  const auto k = static_cast<Eigen::Index>(place.chosen.entries.size());
  std::vector<Eigen::Index> positions;
  for (Eigen::Index i = 0; i < k; ++i)
    if (!place.chosen.phase[static_cast<std::size_t>(i)]) positions.push_back(i);
  const auto np = static_cast<Eigen::Index>(positions.size());
  const Eigen::Index inputs = m.d.cols(), outputs = m.d.rows(), n = np + k;
  StateSpace& x = out.descriptor;
  x.e.setIdentity(n, n);
  x.e.bottomRightCorner(k, k) = m.mass;
  x.a.setZero(n, n);
  x.a.bottomRightCorner(k, k) = -m.velocity;
  x.b.setZero(n, inputs);
  x.b.bottomRows(k) = m.b0;
  x.c.setZero(outputs, n);
  x.c.rightCols(k) = m.c_rate;
  x.d = m.d;
  StateSpace direct{{}, x.a, x.b, x.c, x.d};
  direct.a.bottomRightCorner(k, k) = m.explicit_velocity;
  direct.b.bottomRows(k) = m.explicit_b;
  const std::vector<bool> turned = turning_entries(place.steady);
  for (Eigen::Index i = 0; i < np; ++i) {
    const Eigen::Index p = positions[static_cast<std::size_t>(i)];
    const auto v = static_cast<std::size_t>(place.chosen.entries[static_cast<std::size_t>(p)]);
    x.a(i, np + p) = direct.a(i, np + p) = 1;
    if (!turned[v] || place.angles) { // else nothing depends on the angle of a shaft, but rounding
      x.a.col(i).tail(k) = -m.stiffness.col(p);
      direct.a.col(i).tail(k) = m.explicit_stiffness.col(p);
    }
    x.b.row(i) = m.shift.row(p);
    direct.b.row(i) = m.shift.row(p);
    x.c.col(i) = m.c_position.col(p);
  }
  for (const bool rate : {false, true})
    for (Eigen::Index i = 0; i < k; ++i) {
      const int v = place.chosen.entries[static_cast<std::size_t>(i)];
      if (!rate && place.chosen.phase[static_cast<std::size_t>(i)]) continue;
      LinearModel::State state = name_state(place.model, v, rate);
      // Of a ball small turns count, from where it is.
      const Link* ball = nullptr;
      for (const Link& link : place.model.system.links)
        if (link.type == LinkType::spherical && link.v >= 0 && v >= link.v && v < link.v + 3) ball = &link;
      if (rate)
        state.value = place.u[v];
      else if (!ball)
        for (const Link& link : place.model.system.links)
          if (link.v == v) state.value = place.q[link.q];
      state.less_input = rate && inputs > 0 && !m.shift.row(i).isZero(0);
      out.states.push_back(std::move(state));
    }
  set_states_as_outputs(signals.as_states, out);
  direct.c = x.c;
  if (!massless && !(m.lost > most_lost)) out.explicit_form = std::move(direct);
  out.inputs.assign(signals.inputs.begin(), signals.inputs.end());
  out.outputs = signals.outputs;
  out.output_error = m.error;
  for (const StateSpace& form : {out.descriptor, best_form(out)})
    for (const Eigen::MatrixXd* matrix : {&form.e, &form.a, &form.b, &form.c, &form.d})
      if (!matrix->allFinite()) throw Refusal{"The numbers are too far apart for a linear model."};
  auto found = !massless ? poles(best_form(out))
                         : pencil_eigenvalues(m.mass, m.velocity, m.stiffness, cancel, m.made_of);
  if (massless) // angles that are no states: as many of those nearest to zero
    for (Eigen::Index phase = np; found && phase < k; ++phase)
      if (!found->empty())
        found->erase(std::ranges::min_element(*found, {}, [](auto pole) { return std::abs(pole); }));
  if (!found) throw Refusal{"The poles are not found: the numbers are too far apart."};
  out.poles = *found;
  out.stable = out.held.empty() ? out.steady.stable : stable_by(out);
  out.gain = static_gain(best_form(out));
}

const StateSpace& best_form(const LinearModel& model) {
  return model.explicit_form ? *model.explicit_form : model.descriptor;
}

} // namespace flyball
