// What a joint type becomes in the system: links in the tree, constraint rows where it closes a loop.
#pragma once

#include "engine/system/system.hpp"

namespace flyball {

// An axis of a joint and the coordinate that moves along or about it.
struct ChainPart {
  LinkType type;
  int axis;
  int coordinate;
};

// The links of a joint in the tree, from its parent outwards.
std::vector<ChainPart> chain_of(JointType type);

// Constraint equations of a joint that closes a loop, in its frame with z along the axis.
std::vector<ConstraintRow> rows_of(JointType type);

// Whether a joint of this type can be part of the tree; the others are always cut.
bool joins_trees(JointType type);

} // namespace flyball
