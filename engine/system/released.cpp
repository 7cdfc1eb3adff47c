#include "engine/system/released.hpp"

#include <algorithm>

namespace flyball {
namespace {

// Coordinates on the way from `l` to the root, the root's first.
Support path_to_root(const System& system, int l, bool second) {
  Support path;
  for (; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
    const Link& x = system.links[static_cast<std::size_t>(l)];
    if (x.v < 0) continue;
    for (int k = x.type == LinkType::spherical ? 2 : 0; k >= 0; --k)
      path.push_back({x.v + k, l, second});
  }
  std::ranges::reverse(path);
  return path;
}

void join_again(const System& system, PairEnds& ends) {
  const Support a = path_to_root(system, ends.a, false), b = path_to_root(system, ends.b, true);
  std::size_t common = 0;
  while (common < a.size() && common < b.size() && a[common].v == b[common].v)
    ++common;
  ends.support.assign(a.begin() + static_cast<std::ptrdiff_t>(common), a.end());
  ends.support.insert(ends.support.end(), b.begin() + static_cast<std::ptrdiff_t>(common), b.end());
}

} // namespace

System released(const System& system) {
  System out = system;
  for (const DrivenCoordinate& d : system.drives) {
    Link& link = out.links[static_cast<std::size_t>(d.link)];
    link.drive = -1;
    link.q = out.nq++;
    link.v = out.nv++;
  }
  for (Link& link : out.links)
    link.mobile =
        link.v >= 0 || (link.parent >= 0 && out.links[static_cast<std::size_t>(link.parent)].mobile);
  out.drives.clear();
  for (PointSpringElement& e : out.springs)
    join_again(out, e.ends);
  for (CutDamperElement& e : out.cut_dampers)
    join_again(out, e.ends);
  for (BearingElement& e : out.bearings)
    join_again(out, e.ends);
  for (TurningAirElement& e : out.turning_air)
    join_again(out, e.ends);
  for (CutJoint& c : out.cuts)
    if (c.type != JointType::gear) join_again(out, c.ends);
  return out;
}

void set_drives(const System& system, const Parameters& p, double t, Eigen::VectorXd& q, Eigen::VectorXd& u) {
  for (std::size_t d = 0; d < system.drives.size(); ++d) {
    const LinkParameters& l = p.links[static_cast<std::size_t>(system.drives[d].link)];
    q[system.nq + static_cast<int>(d)] = l.drawn + (l.start + l.speed * t);
    u[system.nv + static_cast<int>(d)] = l.speed;
  }
}

} // namespace flyball
