// Where to cut loops that the drives turn.
#pragma once

#include "engine/system/system.hpp"

namespace flyball {

// The cuts by preference, or the nearest others with which the drives carry the loops along: a joint that
// must turn or slide at a constant rate in the steady state has to be cut. Such cuts say so
// (CutJoint::turns). Where drives would carry weights round by one joint of a loop and not by another, the
// one is cut.
System compile_for_drives(const Mechanism& mechanism);
// The same tree and cuts as in the steady state (of compile_for_drives), so that the coordinates are the
// same, with what turns at speeds that are found there being coordinates like others.
System compile_for_motion(const Mechanism& mechanism, const System& steady);
// Whether both cut the same loops and let the same turn at speeds of its own: of one mechanism at two sets of
// numbers.
bool same_choice(const System& a, const System& b);

} // namespace flyball
