// What acts on each coordinate of a joint: drive, spring, damper, stop, friction; and where it settles.
#include "app/document/drawn_size.hpp"
#include "app/session/state_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/assembly_edits.hpp"
#include "app/ui/inspector/coordinate_drive.hpp"
#include "app/ui/inspector/coordinate_rows.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/snapping.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/frictions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

// What a new spring, damper, stop or friction begins with, to be changed at once.
struct Beginning {
  double stiffness, damping, stop_stiffness, friction;
};
constexpr Beginning of_angle{10, 1, 1000, 0.1}, of_length{1000, 10, 1e5, 1};
constexpr double usual_mu = 0.1, usual_radius = 0.01; // m

// The rows of a coordinate from the top down.
struct CoordinateSection : CoordinateRows {
  const Beginning& beginning() const { return angle() ? of_angle : of_length; }

  // Beside the one before, where there is room for it; else closer below than another row would be.
  void beside_last(const char* label) const {
    const float width = ImGui::GetFrameHeight() + ImGui::CalcTextSize(label).x + 10 * ui.scale;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float gap = 6 * ui.scale;
    if (ImGui::GetItemRectMax().x + gap + width <= right)
      ImGui::SameLine(0, gap);
    else
      ImGui::SetCursorPosY(ImGui::GetCursorPosY() - std::round(3 * ui.scale));
  }

  // A tick; `removed` and `added` edit the coordinate. Where some have it, all are given it.
  void tick(const std::string& word, const char* label, const char* what, bool (*has)(const Coordinate&),
            const char* help, const char* (*refused)(const CoordinateRows&),
            const std::function<void(Coordinate&)>& removed,
            const std::function<void(Coordinate&)>& added) const {
    const bool on = all_have(has);
    if (!check_row(ui, widget(key(word)), label, on, help, on ? nullptr : refused_of_any(refused),
                   !on && some_have(has)))
      return;
    const std::string step =
        (on ? "Remove " : "Add ") + std::string(what) + (on ? " of " : " to ") + joint.name;
    change(step, [on, has, removed, added](Coordinate& c) {
      if (on)
        removed(c);
      else if (!has(c))
        added(c);
    });
  }

  // Always in its place, so that nothing below it moves with what is ticked there or found meanwhile.
  void settled() const {
    const CoordinateSolution* found = solution();
    // Words and digits are of different heights.
    const float next = ImGui::GetCursorPosY() + ImGui::GetTextLineHeightWithSpacing() + std::round(ui.scale);
    if (found && found->speed) {
      const NumberStyle& numbers = session.options.numbers;
      const ShownUnit unit = rate_unit(angle(), session.units);
      row(ui, angle() ? "Turns at" : "Moves at",
          value_text(unit.shown(*found->speed), found->speed_error * unit.factor, numbers), unit.text.c_str(),
          !coordinate().drive ? "The rate at which loops and gears make it turn in the steady state."
          : coordinate().drive->torque
              ? "The steady speed: there the torque, less the load, is what turning takes."
              : "The steady speed, at which it has the momentum that it keeps.");
    } else if (coordinate().drive &&
               (coordinate().drive->torque || coordinate().drive->keeps == DriveKeeps::momentum)) {
      no_value("not known", "No steady speed was found.", angle() ? "Turns at" : "Moves at");
    } else if (coordinate().drive || (found && found->driven)) {
      no_value("driven", "It moves at a constant speed, so there is no place where it settles.");
    } else if (!found) {
      no_value("not known", "There is no steady state of which this could be told.");
    } else {
      const NumberStyle& numbers = session.options.numbers;
      const ShownUnit unit = coordinate_unit(angle(), session.units);
      std::string help = value_text(found->value, found->error, numbers) + " " + value_unit();
      if (found->error > 0)
        help += " ± " + magnitude_text(std::max(found->error, numbers.noise), numbers) + " " + value_unit();
      row(ui, "Settles at", value_text(unit.shown(found->value), found->error * unit.factor, numbers),
          unit.text.c_str(), ("In the steady state: " + help + ".").c_str());
    }
    note_widget(ui.widgets, widget(key("settles")));
    ImGui::SetCursorPosY(next);
  }

  // The row of a value that there is not.
  void no_value(const char* word, const char* help, const char* label = "Settles at") const {
    ImGui::BeginDisabled();
    row(ui, label, word, "", help);
    ImGui::EndDisabled();
  }

  // The drawn pose in which the coordinate has another value; the mechanism stays the same.
  void move_to() const {
    quantity_row(session, ui, "Move to",
                 {.name = widget(key("move")),
                  .value = coordinate().drawn,
                  .unit = value_unit(),
                  .help =
                      "Moves the mechanism along its joints until the coordinate has this value, as far as "
                      "loops and stops let it.",
                  .set = [&session = session, name = joint.name, i = i](double value) {
                    move_coordinate(session, name, i, value);
                  }});
  }

  void drive() const {
    const bool on = all_have(is_driven);
    if (check_row(ui, widget(key("drive")), "Drive", on,
                  "Moves the coordinate: at a speed that is prescribed, by a torque or force, or with its "
                  "momentum kept.",
                  on ? nullptr : refused_of_any(no_drive), !on && some_have(is_driven)))
      set_driven(session, ui, joint.name, i, !on);
  }

  // Why nothing that has to settle may act on it; null where it may.
  static bool is_driven(const Coordinate& c) { return c.drive.has_value(); }
  static bool has_spring(const Coordinate& c) { return c.spring.has_value(); }
  static bool has_stop(const Coordinate& c) { return c.stop.has_value(); }
  static bool has_friction(const Coordinate& c) { return c.friction.has_value(); }

  static const char* no_drive(const CoordinateRows& rows) { return drive_refused(rows.joint, rows.i); }
  static const char* driven(const CoordinateRows& rows) {
    if (is_driven(rows.coordinate()))
      return "Not on a driven coordinate: its torque or force would never settle.";
    const CoordinateSolution* found = rows.solution();
    if (!found || !found->driven) return nullptr;
    return found->speed
               ? "Not on a coordinate that goes on at a constant rate: its torque or force would never "
                 "settle."
               : "Not on a coordinate driven through a gear: its torque or force would never settle.";
  }

  void spring() const {
    tick(
        "spring", "Spring", "spring", has_spring, "Pulls the coordinate to a value.", driven,
        [](Coordinate& c) { c.spring.reset(); },
        [stiffness = beginning().stiffness](Coordinate& c) {
          c.spring.emplace();
          c.spring->stiffness = stiffness;
          c.spring->free = c.drawn;
        });
  }

  void spring_numbers() const {
    if (!all_have(has_spring)) return;
    const CoordinateSpring& spring = *coordinate().spring;
    if (spring.force)
      number_or_law(
          angle() ? "Spring torque" : "Spring force", key("spring") + ".force", spring_law(joint, i), {},
          *spring.force, force_unit(),
          "Against the deflection: a number, or an expression of it such as =2000 N/m*deflection + 1e6 "
          "N/m^3*deflection^3 or =table(deflection, [0 mm, 0 N], [5 mm, 40 N]).");
    else
      number("Stiffness", key("spring") + ".stiffness", coordinate().spring->stiffness, stiffness_unit(),
             angle()
                 ? "Torque by the angle from where the spring is slack. An expression of the deflection is "
                   "the whole torque."
                 : "Force by the distance from where the spring is slack. An expression of the deflection is "
                   "the whole force, as =table(deflection, [0 mm, 0 N], [5 mm, 40 N]).");
    number(spring.force ? "Counted from" : "Unstressed at", key("spring") + ".free", spring.free,
           value_unit(),
           spring.force ? "The coordinate's value at which the deflection is zero."
                        : "The coordinate's value at which the spring exerts nothing.");
  }

  static const char* no_damper(const CoordinateRows& rows) {
    const std::optional<Drive>& drive = rows.coordinate().drive;
    return drive && drive->keeps == DriveKeeps::momentum ? "Not on what keeps its momentum: it would take it."
                                                         : nullptr;
  }

  void damper() const {
    tick(
        "damper", "Damper", "damper", [](const Coordinate& c) { return is_damped(c); },
        "Resists the coordinate's motion; the steady state is the same.", no_damper,
        [](Coordinate& c) {
          c.damping = 0;
          c.damping_force.reset();
        },
        [damping = beginning().damping](Coordinate& c) { c.damping = damping; });
  }

  void damper_numbers() const {
    if (coordinate().damping_force)
      number_or_law(
          angle() ? "Damping torque" : "Damping force", key("damping_force"), damper_law(joint, i), {},
          *coordinate().damping_force, force_unit(),
          "Against the rate, an expression of it such as =40 N*tanh(rate/(0.1 m/s)) or =table(rate, "
          "[-1 m/s, -30 N], [0 m/s, 0 N], [1 m/s, 90 N]).");
    if (coordinate().damping != 0)
      number("Damping", key("damping"), coordinate().damping, damping_unit(),
             angle() ? "Torque by the speed of the angle. An expression of the rate is the whole torque."
                     : "Force by the speed of the slide. An expression of the rate is the whole force.",
             Least::zero);
  }

  // A limit that may be absent.
  void limit(const char* label, const char* word, const std::optional<double>& value,
             std::optional<double> Stop::*which, double usual) const {
    const std::string address = key("stop") + "." + word;
    if (value) {
      const bool last = !coordinate().stop->lower || !coordinate().stop->upper;
      std::function<void()> reset;
      if (!last)
        reset = [&session = session, &ui = ui, rows = joint.name, at = static_cast<std::size_t>(i), which,
                 word] {
          edit_joint(session, ui, std::string("Remove ") + word + " stop of " + rows, rows, [=](Joint& same) {
            if (at < same.coordinates.size() && same.coordinates[at].stop)
              ((*same.coordinates[at].stop).*which).reset();
          });
        };
      return number(label, address, *value, value_unit(), "Beyond this value the stop pushes back.",
                    Least::any, reset);
    }
    row_label(ui, label, "No limit on this side.");
    if (text_button(ui, widget(address) + "/add", "Add a limit"))
      change(std::string("Add ") + word + " stop to " + joint.name, [which, usual](Coordinate& c) {
        if (c.stop && !((*c.stop).*which)) (*c.stop).*which = c.drawn + usual;
      });
    help_on_hover("A limit on this side too.");
  }

  // How far from the drawn value a new limit is: a quarter of the mechanism, or about 30 degrees, and round
  // as it is shown.
  double stop_reach() const {
    if (angle()) return session.units.angle == AngleUnit::degree ? std::numbers::pi / 6 : 0.5;
    const ShownUnit unit = shown_unit("m", session.units);
    return unit.si(nearest_step(unit.shown(drawn_size(session.mechanism()) / 4)));
  }

  void stop() const {
    tick(
        "stop", "Stop", "stop", has_stop, "A stiff one-sided spring that acts beyond a limit.", driven,
        [](Coordinate& c) { c.stop.reset(); },
        [reach = stop_reach(), stiffness = beginning().stop_stiffness](Coordinate& c) {
          c.stop.emplace();
          c.stop->lower = c.drawn - reach;
          c.stop->upper = c.drawn + reach;
          c.stop->stiffness = stiffness;
        });
  }

  void stop_numbers() const {
    if (!all_have(has_stop)) return;
    limit("Stop from", "lower", coordinate().stop->lower, &Stop::lower, -stop_reach());
    limit("Stop to", "upper", coordinate().stop->upper, &Stop::upper, stop_reach());
    number("Stop stiffness", key("stop") + ".stiffness", coordinate().stop->stiffness, stiffness_unit(),
           "How hard the stop pushes back beyond its limits.", Least::above_zero);
  }

  // Why this coordinate can have none; null where it may.
  static const char* friction_refused(const CoordinateRows& rows) {
    const std::optional<Drive>& drive = rows.coordinate().drive;
    const JointType type = rows.joint.type;
    if (drive && drive->keeps == DriveKeeps::momentum)
      return "Not where momentum is kept: friction takes it away.";
    if (is_rotation_vector(type, rows.i) || type == JointType::free)
      return "Its coordinates do not slip one by one; use revolute and prismatic joints.";
    if (type == JointType::planar && !rows.angle())
      return "In a plane friction acts against the direction of slip, not along x and y each.";
    return nullptr;
  }

  void friction() const {
    tick(
        "friction", "Friction", "friction", has_friction,
        "Dry friction: holds the coordinate at rest up to a limit, so that the steady state is a band; at a "
        "given speed it loads the drive.",
        friction_refused, [](Coordinate& c) { c.friction.reset(); },
        [limit = beginning().friction](Coordinate& c) { c.friction.emplace().limit = limit; });
  }

  // Whether the limit is that of a preload.
  void by_preload(bool on) const {
    if (!check_row(ui, widget(key("friction") + ".by_preload"), "By preload", on,
                   "The limit is a coefficient of friction times what presses the parts together.", nullptr))
      return;
    change((on ? "Give the friction of " : "Find the friction by preload of ") + joint.name,
           [on, turns = angle()](Coordinate& c) {
             if (!c.friction || c.friction->limit.has_value() == on) return;
             Friction& f = *c.friction;
             const double limit = friction_limit(f);
             f.limit = f.mu = f.preload = f.radius = std::nullopt;
             if (on) {
               f.limit = limit;
               return;
             }
             f.mu = usual_mu;
             if (turns) f.radius = usual_radius;
             f.preload = limit / (usual_mu * f.radius.value_or(1));
           });
  }

  void friction_numbers() const {
    if (!all_have(has_friction)) return;
    const Friction& f = *coordinate().friction;
    by_preload(!f.limit);
    const std::string address = key("friction") + ".";
    if (f.limit) {
      number("Friction", address + "limit", *f.limit, angle() ? "N m" : "N",
             "The most that it holds, and what opposes the motion where it slips.", Least::zero);
    } else {
      number("Coefficient", address + "mu", f.mu.value_or(0), "", "Of friction, as it slips and at rest.",
             Least::zero);
      number("Preload", address + "preload", f.preload.value_or(0), "N", "What presses the parts together.",
             Least::zero);
      if (f.radius)
        number("Radius", address + "radius", *f.radius, "m", "At which it acts, for a moment.", Least::zero);
    }
    if (is_at_given_speed(session.mechanism(), {joint_index(session.mechanism(), joint.name), i}))
      return; // all of it loads the drive
    number(
        "Share", address + "share", f.share, "",
        "Of its limit, -1 to 1, positive along the coordinate: what friction gives in the steady state that "
        "is shown, one of the band.");
  }

  void all() const {
    if (others.empty()) settled();
    number("Drawn as", key("coordinate"), coordinate().drawn, value_unit(),
           "What the coordinate is called in the drawn pose; a label, it moves nothing.");
    if (others.empty()) move_to();
    // All that can act in one line, which stays where it is; below it the numbers of what does act.
    drive();
    beside_last("Spring");
    spring();
    beside_last("Damper");
    damper();
    beside_last("Stop");
    stop();
    beside_last("Friction");
    friction();
    if (all_have(is_driven)) drive_rows(*this);
    spring_numbers();
    damper_numbers();
    stop_numbers();
    friction_numbers();
  }

  bool acted_on() const {
    const Coordinate& c = coordinate();
    return c.drive || c.spring || c.stop || c.friction || is_damped(c);
  }
};

} // namespace

void coordinate_sections(Session& session, Ui& ui, const Joint& joint) {
  const auto count = static_cast<int>(joint.coordinates.size());
  if (count != coordinate_count(joint.type)) return; // a mistake, told elsewhere
  const std::vector<const Joint*> others = others_edited(session, ui, joint);
  if (std::ranges::any_of(
          others, [&](const Joint* each) { return each->coordinates.size() != joint.coordinates.size(); }))
    return;
  for (int i = 0; i < count; ++i) {
    const CoordinateSection rows{{session, ui, joint, i, others}};
    const std::string section = "inspector/coordinate " + std::to_string(i);
    if (inspector_section(session, ui, section, coordinate_title(joint.type, i),
                          count <= 2 || rows.acted_on()))
      rows.all();
  }
}

} // namespace flyball
