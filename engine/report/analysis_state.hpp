// What an Analysis keeps: the system compiled, its numbers, and the last answer.
#pragma once

#include "engine/mechanism/varied_numbers.hpp"
#include "engine/report/analysis.hpp"
#include "engine/report/measures.hpp"
#include "engine/search/phase_search.hpp"
#include "engine/search/steady_state.hpp"

namespace flyball {

struct Analysis::State {
  // Where numbers vary: the mechanism is of its own.
  struct Varied {
    std::shared_ptr<Mechanism> mechanism;
    VariedNumbers numbers;
    std::vector<bool> dampers, dampers_now; // that the system is compiled with, and of the numbers set
  };

  std::shared_ptr<const Mechanism> mechanism;
  std::optional<Varied> varied;
  System system;
  Parameters parameters;
  Parameters found; // see turning()
  Scaling scaling;
  MeasureSet measures;
  SteadyState steady; // of the last solve
  Eigen::VectorXd drawn, answer, start;
  bool answered = false;
  bool settled = false; // the last solve converged, and no number has changed since
  bool moved = false;   // numbers have changed since the system was compiled
  bool turned = false;  // what turns at found speeds stands otherwise than drawn in `parameters`
  AngleTies ties;       // of such
  // Of the last solve's answer where that rests on dry friction: it is not among the states of this system.
  std::optional<Analysis> on_friction;
  // Where the numbers as they are now make something else turn: as it was compiled for those before them.
  std::unique_ptr<State> before;

  // Whether a number makes a damper, which is none now, of a joint in which what turns moves against other
  // parts and which closes a loop: the system does not have it, and cannot tell what it does.
  bool makes_damper(const std::string& address) const;
  // How the steady state moves with the sliders' numbers.
  void add_rates(const Problem& problem, Solution& out);
  // The same where it stands turned.
  void add_turned_rates(const Problem& problem, Solution& out);
  // Looks for a steady state at other angles of what turns at found speeds, which then takes the place of
  // what does not hold.
  void find_turned(const Problem& problem);
  // The angles that find_turned() found, one sentence.
  std::string turned_message() const;
  // Where drives give torques: with the speeds that were found, for what turns with them.
  const Parameters& turning();
  // Whatever is solved begins so. Throws SceneError for points that name nothing.
  Problem prepare(const SolveOptions& options);
  // Why there is no steady state.
  void explain(const Problem& problem, const Stability& stability, Solution& out);
  // To what the verdict on the steady state rests on. Returns why there are none, where they are looked for.
  std::string add_eigenvalues(const Problem& problem, const SolveOptions& options, Stability& stability);
  // Fills in what is told of a state that holds.
  void conclude(const Problem& problem, SteadyState& at, Stability stability,
                const std::string& without_modes, const SolveOptions& options, Solution& out);
  // Compiled for the numbers as they are now, which go on to vary; where that throws this stays as it is.
  std::unique_ptr<State> compiled_anew();
  // To what was compiled before; numbers are to be bound.
  static void go_back(std::unique_ptr<State>& state);
  void bind_numbers();
};

} // namespace flyball
