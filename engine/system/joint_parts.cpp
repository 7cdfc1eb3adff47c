#include "engine/system/joint_parts.hpp"

namespace flyball {

std::vector<ChainPart> chain_of(JointType type) {
  using enum LinkType;
  switch (type) {
  case JointType::revolute: return {{revolute, 0, 0}};
  case JointType::prismatic: return {{prismatic, 0, 0}};
  case JointType::cylindrical: return {{revolute, 0, 0}, {prismatic, 0, 1}};
  case JointType::universal: return {{revolute, 0, 0}, {revolute, 1, 1}};
  case JointType::spherical: return {{spherical, 0, 0}};
  case JointType::planar: return {{prismatic, 1, 0}, {prismatic, 2, 1}, {revolute, 0, 2}};
  case JointType::free: return {{prismatic, 3, 0}, {prismatic, 4, 1}, {prismatic, 5, 2}, {spherical, 0, 3}};
  case JointType::fixed: return {{fixed, 0, 0}};
  case JointType::distance:
  case JointType::gear: break;
  }
  return {};
}

std::vector<ConstraintRow> rows_of(JointType type) {
  const ConstraintRow px{RowType::point, 0, 0}, py{RowType::point, 1, 1}, pz{RowType::point, 2, 2};
  const ConstraintRow xz{RowType::direction, 0, 2}, yz{RowType::direction, 1, 2};
  const ConstraintRow xy{RowType::direction, 0, 1}, zx{RowType::direction, 2, 0};
  switch (type) {
  case JointType::revolute: return {px, py, pz, xz, yz};
  case JointType::prismatic: return {px, py, xy, yz, zx};
  case JointType::cylindrical: return {px, py, xz, yz};
  case JointType::universal: return {px, py, pz, {RowType::direction, 2, 3}};
  case JointType::spherical: return {px, py, pz};
  case JointType::planar: return {pz, xz, yz};
  case JointType::fixed: return {px, py, pz, xy, yz, zx};
  case JointType::distance: return {{RowType::distance, 0, 0}};
  case JointType::gear: return {{RowType::gear, 0, 0}};
  case JointType::free: break;
  }
  return {};
}

bool joins_trees(JointType type) {
  return type != JointType::distance && type != JointType::gear;
}

} // namespace flyball
