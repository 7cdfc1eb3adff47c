// Which parts dry friction may play: all ways of few joints, and of more joints a search by single ones.
#pragma once

#include "engine/report/friction_parts.hpp"

#include <functional>

namespace flyball {

// Whether friction_parts() are all that there are, as of up to three joints that may slip.
bool tries_all_parts(const Mechanism& mechanism);

// Those that are tried first: what holds all that it can, as drawn; then all ways of few joints, with
// something that slips or rests in balance, most held first, then those with most in balance, or of more
// joints that in which they begin.
std::vector<FrictionParts> first_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel);

// The same, and of more joints those with which a search by single ones finds a state.
std::vector<FrictionParts> friction_parts(const Mechanism& mechanism, const std::atomic<bool>* cancel);

// That search: of parts that go, until `accept` takes them.
void search_by_single_joints(const Mechanism& mechanism, const SolveOptions& options,
                             const std::function<bool(const FrictionParts&)>& accept);

// Names, as of coordinate_label(), of coordinates that stand, but may go on at constant rates where friction
// slips: those that have it, and those that loops turn with them.
std::vector<std::string> slipping_coordinates(const Mechanism& mechanism);

} // namespace flyball
