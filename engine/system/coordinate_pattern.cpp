#include "engine/system/coordinate_pattern.hpp"

namespace flyball {
namespace {

int column_count(const Link& link) {
  return link.v < 0 ? 0 : link.type == LinkType::spherical ? 3 : 1;
}

template <class Visit>
void for_supports(const System& system, Visit visit) {
  for (const PointSpringElement& e : system.springs)
    visit(e.ends.support);
  for (const CutDamperElement& e : system.cut_dampers)
    visit(e.ends.support);
  for (const CutJoint& c : system.cuts)
    visit(c.ends.support);
}

} // namespace

void for_coordinate_pairs(const System& system, const std::function<void(int, int)>& visit) {
  for (const Link& link : system.links)
    for (int c = 0; c < column_count(link); ++c) {
      for (int d = 0; d < column_count(link); ++d)
        visit(link.v + c, link.v + d);
      for (int l = link.parent; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
        const Link& other = system.links[static_cast<std::size_t>(l)];
        for (int d = 0; d < column_count(other); ++d) {
          visit(link.v + c, other.v + d);
          visit(other.v + d, link.v + c);
        }
      }
    }
  for_supports(system, [&](const Support& support) {
    for (const SupportColumn& i : support)
      for (const SupportColumn& j : support)
        visit(i.v, j.v);
  });
}

long count_coordinate_pairs(const System& system, long enough) {
  long count = 0;
  std::vector<long> above(system.links.size()); // coordinates from the root to each link
  for (std::size_t l = 0; l < system.links.size() && count < enough; ++l) {
    const Link& link = system.links[l];
    const long before = link.parent >= 0 ? above[static_cast<std::size_t>(link.parent)] : 0;
    const long own = column_count(link);
    above[l] = before + own;
    count += own * (own + 2 * before);
  }
  for_supports(system, [&](const Support& support) {
    const auto n = static_cast<long>(support.size());
    if (count < enough) count += n * n;
  });
  return count;
}

std::size_t pattern_hash(const System& system) {
  std::size_t hash = 14695981039346656037u; // FNV-1a
  const auto mix = [&](int x) { hash = (hash ^ static_cast<std::size_t>(x + 2)) * 1099511628211u; };
  for (const Link& link : system.links) {
    mix(link.parent);
    mix(link.v);
    mix(column_count(link));
  }
  for_supports(system, [&](const Support& support) {
    mix(-2);
    for (const SupportColumn& s : support)
      mix(s.v);
  });
  return hash;
}

} // namespace flyball
