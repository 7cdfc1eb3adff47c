// One cell of the stability suite: a mechanism with extreme numbers, and what came of solving it.
#pragma once

#include "engine/report/analysis.hpp"

#include <functional>
#include <string>
#include <vector>

namespace flyball::stress {

enum class Outcome {
  solved,  // and judged by the reference
  refused, // with a reason, where a refusal is allowed
  unclear, // the reference itself did not settle well enough to judge
  failed,  // wrong, not finite, a broken promise, a refusal where there has to be an answer, too slow
};

struct Verdict {
  Outcome outcome = Outcome::failed;
  std::string remark; // why it failed or was refused, or what else is worth telling
  // Of the coordinate whose error is largest relative to its estimate; rad or m.
  double true_error = 0, estimate = 0;
  int judged = 0, bounded = 0; // coordinates; of these, estimates that bound the error and one unit in the
                               // last place
  double worst = 0;            // largest true error / estimate
  // By coordinate: estimate / max(true error, unit in the last place of the value and of 1 rad or the reach).
  std::vector<double> caution;
  int iterations = 0;
  std::string net;   // "" for plain Newton-Raphson
  double time_s = 0; // of the solve
};

struct Case {
  std::string family, name;
  std::function<Verdict(const std::atomic<bool>& cancel)> run;
  // What makes a refusal the poorer, though not wrong: other starts that find an answer. Takes several
  // solves.
  std::function<std::string(const std::atomic<bool>& cancel)> other_starts{};
};
using Cases = std::vector<Case>;

struct CaseChoice {
  bool thinned = false; // the short form: fewer values on the same axes
  int seeds = 8;        // random cases of each kind
};

void add_scene_cases(const CaseChoice& choice, Cases& cases);
void add_stiffness_cases(const CaseChoice& choice, Cases& cases);
void add_speed_cases(const CaseChoice& choice, Cases& cases);
void add_mass_cases(const CaseChoice& choice, Cases& cases);
void add_length_cases(const CaseChoice& choice, Cases& cases);
void add_damping_cases(const CaseChoice& choice, Cases& cases);
void add_singular_cases(const CaseChoice& choice, Cases& cases);
void add_redundant_cases(const CaseChoice& choice, Cases& cases);
void add_fold_cases(const CaseChoice& choice, Cases& cases);
void add_far_start_cases(const CaseChoice& choice, Cases& cases);
void add_random_cases(const CaseChoice& choice, Cases& cases);
void add_motion_cases(const CaseChoice& choice, Cases& cases);

// All of the above.
Cases all_cases(const CaseChoice& choice);

} // namespace flyball::stress
