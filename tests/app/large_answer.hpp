// A window with a mechanism whose solution does not matter: the drawn pose stands for the steady state.
#pragma once

#include "app/ui/app.hpp"
#include "tests/support/parts.hpp"

namespace flyball::test {

// The same mechanism with one mistake in it, for which it is not solved, and a slider for its first drive.
inline Mechanism unsolved(Mechanism mechanism) {
  const Body& first = mechanism.bodies.front();
  mechanism.forces.push_back(
      point_spring("mistake", std::string(ground_name), first.name, first.position, first.position, 1, 1.));
  Slider slider;
  slider.parameter = "joints." + mechanism.joints.front().name + ".drive.speed";
  slider.to = 20;
  mechanism.sliders = {slider};
  return mechanism;
}

// An answer with all that one of a large mechanism has: as many coordinates as hinges, with rates, reactions
// and torques.
inline void answer_as_drawn(App& app) {
  static std::uint64_t tickets = 0;
  LiveAnswer answer;
  answer.ticket = ++tickets;
  answer.mechanism = app.session.document.shared();
  answer.poses = drawn_poses(app.session.mechanism());
  Solution& solution = answer.solution;
  solution.status = Status::converged;
  solution.message = "Converged.";
  solution.stable = true;
  solution.poses = answer.poses;
  solution.sensitivities.resize(1);
  solution.sensitivities[0].address =
      "joints." + app.session.mechanism().joints.front().name + ".drive.speed";
  for (const Joint& joint : app.session.mechanism().joints) {
    Reaction reaction;
    reaction.joint = joint.name;
    reaction.force = Vec3(1, 2, 3);
    solution.reactions.push_back(reaction);
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) {
      CoordinateSolution c;
      c.joint = joint.name;
      c.index = static_cast<int>(i);
      c.count = static_cast<int>(joint.coordinates.size());
      c.angle = is_angle(joint.type, c.index);
      c.driven = joint.coordinates[i].drive.has_value();
      solution.coordinates.push_back(c);
      if (!c.driven) solution.sensitivities[0].rates.push_back({c.joint, c.index, c.count, 0.01});
    }
  }
  app.session.mistakes.clear();
  app.session.poses = answer.poses;
  app.session.answer = std::move(answer);
}

} // namespace flyball::test
