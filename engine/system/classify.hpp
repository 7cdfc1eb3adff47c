// Which passes a scene needs: whether it has a potential, and in which form its KKT matrix is solved.
#pragma once

#include "engine/system/system.hpp"

namespace flyball {

// The innermost link of those driven that a link turns with, -1 for none: two links with the same one never
// move against each other in the steady state.
inline int moving_frame(const System& system, int link) {
  return link < 0 ? -1 : system.links[static_cast<std::size_t>(link)].frame;
}

// Sets whether the forces have a potential (System::conservative and its like), of a system with all its
// elements.
void find_potential(const Mechanism& mechanism, System& system);
// After it.
void choose_kkt_form(System& system);

} // namespace flyball
