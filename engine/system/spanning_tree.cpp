#include "engine/system/spanning_tree.hpp"

#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/joint_parts.hpp"
#include "engine/system/law_elements.hpp"

#include <algorithm>
#include <tuple>

namespace flyball {
namespace {

void find_ends(const Mechanism& m, const BodyNumbers& numbers, SpanningTree& tree) {
  constexpr int no_body = -2; // gears join coordinates, not bodies
  tree.ends.resize(m.joints.size(), {no_body, no_body});
  for (std::size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& x = m.joints[j];
    if (x.type == JointType::gear) continue;
    for (std::size_t end = 0; end < 2; ++end)
      tree.ends[j][end] = body_number(numbers, x.bodies[end], "joints." + x.name);
  }
}

// A gear to a driven coordinate makes the other driven.
void propagate_drives(const Mechanism& m, const CutChoice& choice, SpanningTree& tree) {
  const int joints = static_cast<int>(m.joints.size());
  tree.origins.resize(m.joints.size());
  for (int j = 0; j < joints; ++j) {
    const Joint& x = m.joints[static_cast<std::size_t>(j)];
    auto& o = tree.origins[static_cast<std::size_t>(j)];
    o.resize(x.coordinates.size());
    for (std::size_t k = 0; k < o.size(); ++k)
      if (const auto& drive = x.coordinates[k].drive)
        o[k] = {true, finds_speed(*drive), j, static_cast<int>(k), {}};
  }
  for (const CoordinateReference& c : choice.turning)
    if (!tree.origin(c).driven) tree.origin(c) = {true, true, c.joint, c.coordinate, {}};
  for (bool changed = true; changed;) {
    changed = false;
    for (int j = 0; j < joints; ++j) {
      const Joint& x = m.joints[static_cast<std::size_t>(j)];
      if (x.type != JointType::gear) continue;
      DriveOrigin &a = tree.origin(gear_end(m, j, 0)), &b = tree.origin(gear_end(m, j, 1));
      if (a.driven && b.driven && a.finds_speed != b.finds_speed)
        throw SceneError("joints." + x.name,
                         "ties a coordinate whose speed is found to one at a given speed");
      if (a.driven == b.driven) continue;
      DriveOrigin &from = a.driven ? a : b, &to = a.driven ? b : a;
      to = from;
      to.gears.push_back(j);
      changed = true;
    }
  }
}

void find_needed_coordinates(const Mechanism& m, SpanningTree& tree) {
  tree.needs_coordinate.assign(m.joints.size(), false);
  for (int j = 0; j < static_cast<int>(m.joints.size()); ++j) {
    const Joint& x = m.joints[static_cast<std::size_t>(j)];
    for (const Coordinate& c : x.coordinates)
      if (c.spring || c.stop || c.friction) tree.needs_coordinate[static_cast<std::size_t>(j)] = true;
    if (x.type == JointType::gear)
      for (int end : {0, 1})
        tree.needs_coordinate[static_cast<std::size_t>(gear_end(m, j, end).joint)] = true;
    for (int i = 0; i < static_cast<int>(x.coordinates.size()); ++i)
      for (const char* which : {"torque", "load"})
        read_drive_law_of(m, x, i, which, [&](const Expression& law) {
          for (const ResultCall& call : law.results())
            if (const ResultQuantity asked = find_law_quantity(m, call); asks_for_coordinate(call))
              tree.needs_coordinate[static_cast<std::size_t>(asked.of[0].part)] = true;
        });
  }
}

// What turns at a given speed, or has a drive of its own. What turns at a speed that is found because others
// do may close a loop.
bool is_driven(const Mechanism& m, const SpanningTree& tree, int j) {
  const auto& all = tree.origins[static_cast<std::size_t>(j)];
  const auto& coordinates = m.joints[static_cast<std::size_t>(j)].coordinates;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (coordinates[k].drive || (all[k].driven && !all[k].finds_speed)) return true;
  return false;
}

// Lower is kept in the tree first.
auto preference(const Mechanism& m, const SpanningTree& tree, int j) {
  const Joint& x = m.joints[static_cast<std::size_t>(j)];
  const bool labelled = std::ranges::any_of(
      x.coordinates, [](const Coordinate& c) { return c.drawn != 0 || c.damping != 0 || c.damping_force; });
  int rank = 4;
  if (labelled) rank = 3;
  if (tree.needs_coordinate[static_cast<std::size_t>(j)]) rank = 2;
  if (x.cut == false || x.type == JointType::free) rank = 1; // a free joint cannot close a loop
  if (is_driven(m, tree, j)) rank = 0;
  return std::tuple(rank, coordinate_count(x.type), j);
}

} // namespace

int body_number(const BodyNumbers& numbers, const std::string& name, const std::string& where) {
  if (!numbers.has(name)) throw SceneError(where, "there is no body \"" + name + "\"");
  return static_cast<int>(numbers[name]) - 1;
}

CoordinateReference gear_end(const Mechanism& m, int joint, int end) {
  const Joint& gear = m.joints[static_cast<std::size_t>(joint)];
  const std::string& name = gear.joints[static_cast<std::size_t>(end)];
  const CoordinateReference r = find_coordinate(m, name);
  if (r.joint < 0) throw SceneError("joints." + gear.name, "there is no joint coordinate \"" + name + "\"");
  return r;
}

SpanningTree choose_tree(const Mechanism& m, const CutChoice& choice, const BodyNumbers& numbers) {
  SpanningTree tree;
  find_ends(m, numbers, tree);
  propagate_drives(m, choice, tree);
  find_needed_coordinates(m, tree);
  std::vector<decltype(preference(m, tree, 0))> order;
  for (int j = 0; j < static_cast<int>(m.joints.size()); ++j)
    if (joins_trees(m.joints[static_cast<std::size_t>(j)].type)) order.push_back(preference(m, tree, j));
  std::ranges::sort(order);
  tree.in_tree.assign(m.joints.size(), false);
  BodyGroups parts(numbers);
  for (const auto& [rank, coordinates, j] : order) {
    const Joint& x = m.joints[static_cast<std::size_t>(j)];
    if (x.cut == true || std::ranges::find(choice.cut, j) != choice.cut.end()) continue;
    if (parts.join(x.bodies))
      tree.in_tree[static_cast<std::size_t>(j)] = true;
    else if (is_driven(m, tree, j))
      throw SceneError("joints." + x.name + ".drive",
                       "driven joints close a loop; a driven joint cannot be cut");
    else if (x.type == JointType::free)
      throw SceneError("joints." + x.name,
                       "a free joint joins bodies that are joined already; it constrains nothing");
  }
  return tree;
}

} // namespace flyball
