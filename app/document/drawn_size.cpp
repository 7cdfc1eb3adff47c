#include "app/document/drawn_size.hpp"

#include "engine/mechanism/mechanism.hpp"

#include <cmath>

namespace flyball {

double drawn_size(const Mechanism& mechanism) {
  Eigen::AlignedBox3d box;
  for (const Body& body : mechanism.bodies)
    box.extend(body.position);
  for (const Joint& joint : mechanism.joints)
    if (has_at(joint.type)) box.extend(joint.at);
  const double size = box.isEmpty() ? 0 : box.diagonal().norm();
  return std::isfinite(size) && size > 0 ? size : 1;
}

} // namespace flyball
