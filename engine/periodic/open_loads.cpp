#include "engine/periodic/open_loads.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/kkt/workspace.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/report_forces.hpp"

#include <algorithm>
#include <array>

namespace flyball {
namespace {

constexpr std::array<double, 3> moments{0, 0.382, 0.724}; // parts of the run, no multiples of few turns

OpenForces open_at(const Run& run, std::size_t sample, Workspace& w) {
  const auto segment = std::ranges::find_if(run.segments.rbegin(), run.segments.rend(),
                                            [&](const Run::Segment& s) { return s.first <= sample; });
  const MotionModel& model = *segment->model;
  const std::size_t length = run.states.size() / run.time.size();
  const Eigen::Map<const Eigen::VectorXd> q(run.states.data() + sample * length, model.system.nq);
  return find_open_forces(model.problem(), model.mechanism.joints.size(), q, run.time[sample], w);
}

} // namespace

void mark_open_loads(const Run& run, PeriodicState& out) {
  if (run.segments.empty() || run.time.empty()) return;
  const MotionModel& model = *run.segments.front().model;
  if (model.system.rows == 0) return;
  Workspace w;
  std::array<OpenForces, 3> at;
  for (std::size_t i = 0; i < at.size(); ++i)
    at[i] = open_at(run, static_cast<std::size_t>(moments[i] * static_cast<double>(run.time.size() - 1)), w);
  // Of what is open at most of them.
  const auto mostly = [&](auto&& is_open) { return std::ranges::count_if(at, is_open) >= 2; };
  for (PeriodicReaction& reaction : out.reactions) {
    const auto joint = static_cast<std::size_t>(joint_index(model.mechanism, reaction.name));
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      reaction.force.open[i] =
          mostly([&](const OpenForces& o) { return o.joints[joint].force.component(c); });
      reaction.torque.open[i] =
          mostly([&](const OpenForces& o) { return o.joints[joint].torque.component(c); });
    }
  }
  for (PeriodicGear& gear : out.gears) {
    const auto joint = static_cast<std::size_t>(joint_index(model.mechanism, gear.joint));
    gear.nonunique = mostly([&](const OpenForces& o) { return o.gears[joint]; });
  }
  for (std::size_t d = 0; d < model.system.drives.size(); ++d) {
    if (!mostly([&](const OpenForces& o) { return o.drives[d]; })) continue;
    const Link& link = model.system.links[static_cast<std::size_t>(model.system.drives[d].link)];
    const std::string& joint = model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name;
    for (PeriodicTorque& torque : out.drive_torques)
      torque.nonunique = torque.nonunique || (torque.joint == joint && torque.index == link.coordinate);
  }
}

} // namespace flyball
