#include "app/ui/inspector/coordinate_drive.hpp"

#include "app/ui/inspector/inspector_rows.hpp"

namespace flyball {

const char* drive_refused(const Joint& joint, int coordinate) {
  const Coordinate& c = joint.coordinates[static_cast<std::size_t>(coordinate)];
  if (is_rotation_vector(joint.type, coordinate))
    return "A component of a rotation vector cannot be driven; use revolute joints, or, for what stands in "
           "bearings, Drive in its bearings (Edit).";
  if (joint.cut == true) return "A joint that is cut has no coordinate to drive.";
  if (c.spring || c.stop) return "Not beside a spring or stop, which would never settle; take it away first.";
  return nullptr;
}

void set_driven(Session& session, Ui& ui, const std::string& joint, int coordinate, bool driven) {
  constexpr double m_per_s = 0.1; // of a new drive
  const double turned = new_drive_speed(session.units);
  edit_joint(session, ui, (driven ? "Add drive to " : "Remove drive of ") + joint, joint, [=](Joint& same) {
    const auto i = static_cast<std::size_t>(coordinate);
    if (i >= same.coordinates.size()) return;
    Coordinate& c = same.coordinates[i];
    if (driven == c.drive.has_value()) return; // of several, one that is so already
    if (!driven) return c.drive.reset();
    c.drive.emplace().speed = is_angle(same.type, coordinate) ? turned : m_per_s;
    if (c.friction) c.friction->share = 0;
  });
}

} // namespace flyball
