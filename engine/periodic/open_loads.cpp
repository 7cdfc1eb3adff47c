#include "engine/periodic/open_loads.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/kkt/workspace.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/report_forces.hpp"

#include <algorithm>
#include <iterator>

namespace flyball {
namespace {

OpenForces open_at(const Run& run, std::size_t sample, Workspace& w) {
  const auto segment = std::ranges::find_if(run.segments.rbegin(), run.segments.rend(),
                                            [&](const Run::Segment& s) { return s.first <= sample; });
  const MotionModel& model = *segment->model;
  const std::size_t length = run.states.size() / run.time.size();
  const Eigen::Map<const Eigen::VectorXd> q(run.states.data() + sample * length, model.system.nq);
  return find_open_forces(model.problem(), q, run.time[sample], w);
}

std::vector<int> both(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> out;
  std::ranges::set_intersection(a, b, std::back_inserter(out));
  return out;
}

} // namespace

void mark_open_loads(const Run& run, PeriodicState& out) {
  if (run.segments.empty() || run.time.empty()) return;
  const MotionModel& model = *run.segments.front().model;
  if (model.system.rows == 0) return;
  Workspace w;
  const OpenForces first = open_at(run, 0, w);
  if (first.joints.empty() && first.drives.empty()) return;
  const OpenForces later = open_at(run, run.time.size() * 3 / 8, w);
  const std::vector<int> joints = both(first.joints, later.joints), drives = both(first.drives, later.drives);
  const auto is_open = [&](const std::string& joint) {
    return std::ranges::binary_search(joints, joint_index(model.mechanism, joint));
  };
  for (PeriodicReaction& reaction : out.reactions)
    reaction.nonunique = is_open(reaction.name);
  for (PeriodicGear& gear : out.gears)
    gear.nonunique = is_open(gear.joint);
  for (PeriodicTorque& torque : out.drive_torques)
    torque.nonunique = std::ranges::any_of(drives, [&](int d) {
      const Link& link =
          model.system.links[static_cast<std::size_t>(model.system.drives[static_cast<std::size_t>(d)].link)];
      return link.coordinate == torque.index &&
             model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name == torque.joint;
    });
}

} // namespace flyball
