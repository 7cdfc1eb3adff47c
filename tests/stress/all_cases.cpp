#include "tests/stress/case.hpp"

namespace flyball::stress {

Cases all_cases(const CaseChoice& choice) {
  Cases cases;
  for (const auto add : {add_scene_cases, add_stiffness_cases, add_speed_cases, add_mass_cases,
                         add_length_cases, add_damping_cases, add_singular_cases, add_redundant_cases,
                         add_fold_cases, add_far_start_cases, add_random_cases, add_motion_cases})
    add(choice, cases);
  return cases;
}

} // namespace flyball::stress
