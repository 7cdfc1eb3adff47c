#include "app/ui/inspector/coordinate_drive.hpp"

#include "app/session/state_words.hpp"
#include "app/ui/inspector/coordinate_rows.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/drive_law.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

// What a drive prescribes; all else is found.
enum class Prescribed { speed, torque, momentum };

Prescribed prescribed(const Drive& drive) {
  if (drive.torque) return Prescribed::torque;
  return drive.keeps == DriveKeeps::momentum ? Prescribed::momentum : Prescribed::speed;
}

bool is_prescribed(const Coordinate& c, Prescribed what) {
  return c.drive && prescribed(*c.drive) == what;
}

void prescribe(Coordinate& c, Prescribed what) {
  if (!c.drive || is_prescribed(c, what)) return;
  c.drive->torque = what == Prescribed::torque ? std::optional(0.) : std::nullopt;
  c.drive->load = c.drive->torque;
  c.drive->keeps = what == Prescribed::momentum ? DriveKeeps::momentum : DriveKeeps::speed;
  // What slips at a given speed is at its limit: no share of it is to be found there.
  if (c.friction && what != Prescribed::torque) c.friction->share = 0;
}

// What the drive gives in the steady state that is shown.
std::optional<DriveTorque::Given> given_in_state(const CoordinateRows& rows) {
  if (!converged(rows.session)) return std::nullopt;
  const Solution& solution = rows.session.answer.solution;
  for (const DriveTorque& each : solution.drive_torques)
    if (each.joint == rows.joint.name && each.index == rows.i) return told_torque(solution, each);
  return std::nullopt;
}

void prescribed_row(const CoordinateRows& rows) {
  const bool angle = rows.angle();
  const char* no_momentum = rows.some_have([](const Coordinate& c) { return is_damped(c); })
                                ? "Not beside a damper, which would take the momentum."
                            : rows.some_have([](const Coordinate& c) { return c.friction.has_value(); })
                                ? "Not beside friction, which would take the momentum."
                                : nullptr;
  const std::array options{
      SideOption{"speed", "Speed",
                 "The speed is given, and constant; the torque or force that it takes is found."},
      SideOption{"torque", angle ? "Torque" : "Force",
                 angle ? "The torque is given, a number or an expression; the speed is found."
                       : "The force is given, a number or an expression; the speed is found."},
      SideOption{
          "momentum", "Momentum",
          "Nothing drives it any more: it keeps the momentum that the speed makes in the drawn pose, and "
          "the steady speed is found.",
          no_momentum}};
  const std::array<bool (*)(const Coordinate&), 3> have{
      [](const Coordinate& c) { return is_prescribed(c, Prescribed::speed); },
      [](const Coordinate& c) { return is_prescribed(c, Prescribed::torque); },
      [](const Coordinate& c) { return is_prescribed(c, Prescribed::momentum); }};
  std::optional<std::size_t> chosen;
  for (std::size_t k = 0; k < have.size(); ++k)
    if (rows.all_have(have[k])) chosen = k;
  const auto other =
      side_by_side_row(rows.ui, CoordinateRows::widget(rows.key("drive") + ".prescribes"), "Prescribed",
                       options, chosen, "What is given of the drive; the others are found.");
  if (!other) return;
  constexpr std::array steps{"Prescribe the speed of ", "Find the speed of ", "Keep the momentum of "};
  rows.change(steps[*other] + rows.joint.name,
              [what = static_cast<Prescribed>(*other)](Coordinate& c) { prescribe(c, what); });
}

} // namespace

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

void drive_rows(const CoordinateRows& rows) {
  prescribed_row(rows);
  const Drive& drive = *rows.coordinate().drive;
  const std::string address = rows.key("drive");
  const Mechanism& mechanism = rows.session.mechanism();
  if (drive.torque) {
    const std::optional<DriveTorque::Given> now = given_in_state(rows);
    rows.number_or_law(
        rows.angle() ? "Torque" : "Force", address + ".torque",
        drive_law(mechanism, rows.joint, rows.i, "torque"), now ? std::optional(now->torque) : std::nullopt,
        *drive.torque, rows.force_unit(),
        "What the drive gives along the coordinate: a number, or an expression of the state such as "
        "=7500 N*(coordinate(slide) - 0.15 m) or =20 N m - 2 N m s*rate(spin), of which the value in "
        "the steady state is shown.");
    rows.number_or_law("Load", address + ".load", drive_law(mechanism, rows.joint, rows.i, "load"),
                       now ? std::optional(now->load) : std::nullopt, drive.load.value_or(0),
                       rows.force_unit(), "What acts against it; likewise.");
  }
  rows.number(drive.torque         ? "Search from"
              : finds_speed(drive) ? "Drawn speed"
                                   : "Speed",
              address + ".speed", drive.speed, rows.value_unit() + "/s",
              drive.torque ? "Where the search for the steady speed begins."
              : finds_speed(drive)
                  ? "Makes, in the drawn pose, the momentum that is kept; the steady speed is found."
                  : "The constant speed of the coordinate; right-handed about or along the axis.");
}

} // namespace flyball
