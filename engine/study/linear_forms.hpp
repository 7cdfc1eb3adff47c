// A linear model's forms by its matrices: descriptor and explicit form, states, poles and static gain.
#pragma once

#include "engine/linear/interruption.hpp"
#include "engine/study/linear_matrices.hpp"
#include "engine/study/linear_model.hpp"
#include "engine/study/linear_place.hpp"

namespace flyball {

// `massless`: bodies without mass follow the others at once. Throws Refusal.
void add_forms(const LinearPlace& place, const LinearMatrices& matrices, bool massless,
               const LinearSignals& signals, CancelFlag cancel, LinearModel& out);

} // namespace flyball
