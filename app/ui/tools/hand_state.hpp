// What the hand pulls at: a body of the drawn pose, along its joints, or one of the steady state, by a
// spring.
#pragma once

#include "app/document/part.hpp"
#include "app/session/pull.hpp"
#include "app/viewport/camera.hpp"
#include "engine/report/grip.hpp"
#include "engine/solve/assembly_drag.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace flyball {

// On which the hand moves: through where it took hold.
struct HandPlane {
  Vec3 through = Vec3::Zero(); // m
  Vec3 normal = Vec3::UnitZ(); // unit
  bool of_view = true;         // parallel to the screen, rather than that in which the mechanism moves
};

// While building.
struct AssemblyGrab {
  AssemblyDrag drag;
  BodyPoint grabbed;
  HandPlane plane;
  std::shared_ptr<const Mechanism> before;
  std::vector<Pose> start; // of it
  Selection selection;
  std::uint64_t gesture = 0;
  std::string step;
  Vec2 cursor = Vec2::Constant(-1); // for which it was moved last
  Vec3 target = Vec3::Zero();       // m, there
  DragOutcome outcome{};
  bool moved = false;
};

// While exploring.
struct PullGrab {
  std::shared_ptr<const Mechanism> mechanism;        // without the hand
  std::uint64_t revision = 0;                        // of the document
  std::vector<std::pair<std::string, double>> start; // where it stood, and
  std::vector<Pose> stood;
  bool on_branch = false, playing = false; // as it was
  BodyPoint grabbed;
  HandPlane plane;
  Vec3 hand = Vec3::Zero();   // m, world, at the phase shown
  double strength = 1;        // times the stiffness that suits the mechanism
  std::optional<Grip> grip{}; // once it is known
  std::optional<Pull> pull{}; // that was asked for last
  bool released = false;      // what it settles in then is awaited
  std::uint64_t ticket = 0;   // of that
};

// While exploring: where a point of a body should be, which sliders bring it to.
struct ReachGrab {
  std::string body;
  Vec3 local = Vec3::Zero(); // m, of it, in its axes from its mass centre
  HandPlane plane;
  Vec3 hand = Vec3::Zero(); // m, world, at the phase shown
  std::optional<std::string>
      holder;               // the body that the hand turns along with, once it is known; empty: ground
  std::uint64_t opened = 0; // of the session, see Session::opened
  std::size_t position = 0; // of the history, as it was
  bool playing = false;     // as it was
  bool moved = false;
};

} // namespace flyball
