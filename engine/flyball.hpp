// The engine as a library: scenes, steady states, branches, motion. What is included here stays; the rest of
// engine/ may change from one version to the next.
//
//   flyball::Mechanism m = flyball::load_scene("governor.json");      // or built in code; then validate(m)
//   flyball::Analysis analysis(m);                                     // compiled once
//   flyball::Solution s = analysis.solve();                            // again and again: update(m), solve()
//   flyball::ResponseDiagram d = flyball::follow_branches(m, "joints.spin.drive.speed", 0, 20);
//   flyball::Run run = flyball::simulate(m, {.duration = 5});          // the damped motion
//
// Numbers are in SI units and radians; bad input throws SceneError, which names the place; what cannot be
// solved is a Solution whose status and message say why. Distinct objects may be used by distinct threads.
#pragma once

#include "engine/continuation/branches.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/periodic/periodic_state.hpp"
#include "engine/report/analysis.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/design.hpp"
#include "engine/study/fold_curve.hpp"
#include "engine/study/hopf_curve.hpp"
#include "engine/study/linear_model.hpp"
#include "engine/study/sweep.hpp"
