#include "app/document/bearing_drive.hpp"
#include "app/document/transform.hpp"
#include "app/document/turns.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/edit_commands.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/tools/joints_along.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/mass_properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

Selection only(const Body& body) {
  return {{{PartKind::body, body.name}}};
}

// The turns as they are shown: those that expressions give, or else angles that were typed as typed, though
// others would turn the body as far.
Turns shown_turns(const Session& session, InspectorState& inspector, const Body& body) {
  if (std::optional<Turns> given = given_turns(session.mechanism(), body)) return std::move(*given);
  InspectorState& state = inspector;
  const Part part{PartKind::body, body.name};
  if (state.turned != part || state.turned_to.coeffs() != body.rotation.coeffs()) {
    state.turned = part;
    state.turned_to = body.rotation;
    state.turns = turns_of(body.rotation);
  }
  return {state.turns, {}};
}

void turn_body(Session& session, InspectorState& inspector, const ToolState& tool, const std::string& name,
               int axis, double angle) {
  const int index = body_index(session.mechanism(), name);
  if (index < 0) return;
  Turns turns = shown_turns(session, inspector, session.mechanism().bodies[static_cast<std::size_t>(index)]);
  turns.angles[axis] = angle;
  const bool given = !turns.texts[static_cast<std::size_t>(axis)].empty();
  edit(session, "Turn " + name, [&](Mechanism& mechanism, Selection&) {
    Body& body = mechanism.bodies[static_cast<std::size_t>(index)];
    const Quat to = rotation_by(turns.angles);
    if (!inspector.mass_alone)
      rotate_parts(mechanism, only(body), body.position, to * body.rotation.normalized().conjugate(),
                   joints_of_moved(tool, false));
    if (given)
      body.rotation = to; // what the expression rests on changes
    else
      set_turns(body, turns);
  });
  if (!inspector.mass_alone)
    tell_joints(session, tool, only(session.mechanism().bodies[static_cast<std::size_t>(index)]), false);
  inspector.turned_to = session.mechanism().bodies[static_cast<std::size_t>(index)].rotation;
  inspector.turns = turns.angles;
}

// What is on the body turns with it when an expression is typed, as when a number is.
void turn_along(const InspectorState& inspector, const ToolState& tool, const std::string& name,
                const Mechanism& before, Mechanism& next) {
  const int index = body_index(next, name);
  if (index < 0 || inspector.mass_alone) return;
  const auto i = static_cast<std::size_t>(index);
  const Body given = next.bodies[i];
  const Quat from = before.bodies[i].rotation;
  next.bodies[i].rotation = from;
  rotate_parts(next, only(given), given.position, given.rotation.normalized() * from.normalized().conjugate(),
               joints_of_moved(tool, false));
  next.bodies[i].rotation = given.rotation;
  next.bodies[i].formulas = given.formulas;
}

void move_body(Session& session, const InspectorState& inspector, const ToolState& tool,
               const std::string& name, int axis, double to) {
  const int index = body_index(session.mechanism(), name);
  if (index < 0) return;
  edit(session, "Move " + name, [&](Mechanism& mechanism, Selection&) {
    Body& body = mechanism.bodies[static_cast<std::size_t>(index)];
    Vec3 position = body.position;
    position[axis] = to;
    if (inspector.mass_alone)
      body.position = position;
    else
      set_point(mechanism, {{PartKind::body, name}, 0}, position, joints_of_moved(tool, false));
  });
  if (!inspector.mass_alone)
    tell_joints(session, tool, only(session.mechanism().bodies[static_cast<std::size_t>(index)]), false);
}

void inertia_rows(Session& session, Ui& ui, const Body& body) {
  constexpr std::array keys{"xx", "yy", "zz", "xy", "xz", "yz"};
  constexpr std::array helps{
      "Moment of inertia about the body's x axis through the mass centre.",
      "Moment of inertia about the body's y axis through the mass centre.",
      "Moment of inertia about the body's z axis through the mass centre.",
      "Product of inertia: the tensor's own entry, minus the integral of x y dm.",
      "Product of inertia: the tensor's own entry, minus the integral of x z dm.",
      "Product of inertia: the tensor's own entry, minus the integral of y z dm.",
  };
  const bool has_products =
      std::any_of(body.inertia.begin() + 3, body.inertia.end(), [](double product) { return product != 0; });
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 3 && !inspector_section(session, ui, "inspector/products", "Products of inertia", has_products))
      return;
    number_row(session, ui, (i < 3 ? "Inertia " : "Product ") + std::string(keys[i]),
               {.name = std::string("inspector/inertia/") + keys[i],
                .value = body.inertia[i],
                .unit = "kg m^2",
                .help = helps[i],
                .least = i < 3 ? Least::zero : Least::any,
                .address = "bodies." + body.name + ".inertia." + std::to_string(i)});
  }
}

// A density that was typed is shown as typed, not as the mass by the volume comes out.
double shown_density(const InspectorState& inspector, const Body& body, double density) {
  const auto given = inspector.given_masses.find(body.name);
  if (given == inspector.given_masses.end() || given->second.mass) return density;
  const double typed = given->second.density;
  return std::abs(typed - density) <= 1e-13 * typed ? typed : density;
}

// Of a body that weighs what its shapes do.
void density_rows(Session& session, Ui& ui, const Body& body) {
  number_row(session, ui, "Density",
             {.name = "inspector/density",
              .value = *body.density,
              .unit = "kg/m^3",
              .help = "Mass, mass centre and inertia follow from it and the shapes.",
              .least = Least::above_zero,
              .address = "bodies." + body.name + ".density"});
  if (is_of_several(ui)) return;
  row(ui, "Mass", short_text(body.mass, 9), "kg", "Follows from the density and the shapes.");
}

// Whether mass, mass centre and inertia are to follow.
void density_tick(Session& session, Ui& ui, const Body& body) {
  const std::vector<const Body*> others = others_edited(session, ui, body);
  const auto by_density = [](const Body* each) { return each->density.has_value(); };
  const bool on = body.density && std::ranges::all_of(others, by_density),
             mixed = !on && (body.density || std::ranges::any_of(others, by_density));
  if (check_row(ui, "inspector/by density", "By density", on,
                "Mass, mass centre and inertia follow from a density and the shapes, whatever moves these.",
                nullptr, mixed))
    edit_body(session, ui, on ? "Take the density off" : "Mass by density", body.name, [on](Body& same) {
      if (same.density.has_value() != on) return; // of several, one that is so already
      if (!on && !density_of(same)) return;       // or one without shapes
      same.density = on ? std::nullopt : density_of(same);
      std::erase_if(same.formulas, [](const Formula& formula) {
        return formula.key == "density" || formula.key == "mass" || formula.key.starts_with("position") ||
               formula.key.starts_with("inertia");
      });
    });
}

void density_row(Session& session, Ui& ui, InspectorState& inspector, const Body& body) {
  const std::optional<double> density = density_of(body);
  if (!density) return;
  quantity_row(session, ui, "Density",
               {.name = "inspector/density",
                .value = shown_density(inspector, body, *density),
                .unit = "kg/m^3",
                .help = "The mass by the volume of the shapes; typing it makes the body a uniform solid.",
                .least = Least::zero,
                .set = [&session, &inspector, name = body.name](double value) {
                  inspector.given_masses[name] = {false, value};
                  edit(session, "Set density of " + name, [&](Mechanism& mechanism, Selection&) {
                    for (Body& same : mechanism.bodies)
                      if (same.name == name && !take_mass_properties(same, value)) take_uniform_mass(same, 0);
                  });
                }});
}

// Of a rotation whose quaternion is given otherwise than by turns.
void quaternion_rows(const Session& session, const Ui& ui, const Body& body) {
  const Quat& q = body.rotation;
  const std::array<double, 4> values{q.w(), q.x(), q.y(), q.z()};
  constexpr std::array letters{"w", "x", "y", "z"};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto text =
        formula_at(session.mechanism(), "bodies." + body.name + ".rotation." + std::to_string(i));
    const std::string value = short_text(values[i], 9);
    row(ui, std::string("Quaternion ") + letters[i], text ? "=" + *text : value, "",
        text ? (value + "; a turn that is typed takes the place of all four.").c_str() : nullptr);
  }
}

} // namespace

bool is_uniform_solid(const Body& body) {
  const std::optional<double> density = density_of(body);
  if (!density) return false;
  // Of any mass, where the body has none: then it has no inertia either.
  const bool massless = !(body.mass > 0);
  Body solid = body;
  if (!take_mass_properties(solid, massless ? 1 : *density)) return false;
  constexpr double tolerance = 1e-6;
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < body.inertia.size(); ++i) {
    largest = std::max(largest, std::abs(solid.inertia[i]));
    difference = std::max(difference, std::abs((massless ? 0 : solid.inertia[i]) - body.inertia[i]));
  }
  const double size = std::sqrt(largest / solid.mass); // about the radius of gyration
  return difference <= tolerance * largest && (solid.position - body.position).norm() <= tolerance * size;
}

bool follows_shapes(const InspectorState& inspector, const Body& body) {
  return inspector.independent != Part{PartKind::body, body.name} && is_uniform_solid(body);
}

void give_mass(const InspectorState& inspector, Body& body, double mass) {
  if (!follows_shapes(inspector, body) || !take_uniform_mass(body, mass)) body.mass = mass;
}

void mass_section(Session& session, Ui& ui, InspectorState& inspector, const Body& body) {
  if (!inspector_section(session, ui, "inspector/mass section", "Mass", true)) return;
  if (body.density) {
    density_rows(session, ui, body);
    return density_tick(session, ui, body);
  }
  if (std::ranges::any_of(others_edited(session, ui, body),
                          [](const Body* each) { return each->density.has_value(); }))
    return density_tick(session, ui, body); // masses of some follow from their densities
  const bool follows = follows_shapes(inspector, body);
  QuantityField mass{.name = "inspector/mass",
                     .value = body.mass,
                     .unit = "kg",
                     .help = follows ? "Inertia goes with it, as in a solid of one density."
                                     : "Mass; zero is allowed.",
                     .least = Least::zero,
                     .address = "bodies." + body.name + ".mass"};
  const std::vector<std::string> names = edited_with(ui, {PartKind::body, body.name});
  mass.set = [&session, &inspector, name = body.name, names, follows](double value) {
    for (const std::string& each : names)
      inspector.given_masses[each] = {true, 0};
    if (names.size() > 1)
      return edit(session, "Set mass of " + name + and_more(names.size() - 1),
                  [&](Mechanism& mechanism, Selection&) {
                    for (Body& each : mechanism.bodies)
                      if (std::ranges::count(names, each.name) > 0) give_mass(inspector, each, value);
                  });
    // Without mass a point is like a solid; it stays a point.
    if (!follows && value == 0) inspector.independent = {PartKind::body, name};
    if (!follows) return set_number(session, "bodies." + name + ".mass", value);
    edit(session, "Set mass of " + name, [&](Mechanism& mechanism, Selection&) {
      for (Body& same : mechanism.bodies)
        if (same.name == name) give_mass(inspector, same, value);
    });
  };
  number_row(session, ui, "Mass", mass);
  if (!is_of_several(ui)) density_row(session, ui, inspector, body);
  inertia_rows(session, ui, body);
  if (is_of_several(ui)) return density_tick(session, ui, body);
  if (!density_of(body)) return;
  const Part part{PartKind::body, body.name};
  if (check_row(
          ui, "inspector/uniform", "Uniform solid", follows,
          "Mass centre and inertia are those of the shapes at one density, and stay so when the mass or a "
          "size changes."))
    later(ui, [&session, &inspector, part, follows] {
      inspector.independent = follows ? part : Part{};
      if (follows) return;
      edit(session, "Make " + part.name + " uniform", [&](Mechanism& mechanism, Selection&) {
        for (Body& same : mechanism.bodies)
          if (same.name == part.name) take_uniform_mass(same, same.mass);
      });
    });
  density_tick(session, ui, body);
}

void rotation_section(Session& session, Ui& ui, InspectorState& inspector, const ToolState& tool,
                      const Body& body) {
  const bool turned = body.rotation.coeffs() != Quat::Identity().coeffs();
  if (!inspector_section(session, ui, "inspector/rotation section", "Rotation as drawn", turned)) return;
  vector_rows(
      session, ui, "Turned",
      {.name = "inspector/rotation",
       .value = shown_turns(session, inspector, body).angles,
       .unit = "deg",
       .help = "The body is turned about the world's x, then y, then z axis, and what is on it with it. "
               "Where an expression gives a turn, a change of what this rests on turns the axes alone, "
               "those of its inertia and boxes; in it angles are in radians unless they have a unit: "
               "=30 deg.",
       .expression = "bodies." + body.name + ".turn",
       .set = [&session, &inspector, &tool, name = body.name](
                  int axis, double angle) { turn_body(session, inspector, tool, name, axis, angle); },
       .follow = [&inspector, &tool,
                  name = body.name](const Mechanism& before,
                                    Mechanism& next) { turn_along(inspector, tool, name, before, next); }});
  if (is_rotation_given(body) && !given_turns(session.mechanism(), body)) quaternion_rows(session, ui, body);
}

void bearing_drive_row(Session& session, Ui& ui, const std::string& body) {
  if (!bearing_drive_refused(session.mechanism(), body).empty()) return;
  const Command& drive = command("edit.bearing_drive");
  if (text_button(ui, "inspector/edit.bearing_drive", drive.title))
    later(ui, [&session, body] { drive_in_bearings(session, body); });
  help_on_hover(drive.help);
}

void body_inspector(Session& session, Ui& ui, InspectorState& inspector, ToolState& tool, const Body& body) {
  if (is_of_several(ui)) {
    mass_section(session, ui, inspector, body);
    return shapes_section(session, ui, inspector, body);
  }
  name_row(session, ui, {PartKind::body, body.name});
  text_row(session, ui, "inspector/description", "Note", body.description,
           "A note for whoever reads the scene.", [&session, &ui, name = body.name](const std::string& text) {
             edit_body(session, ui, "Describe " + name, name,
                       [text](Body& same) { same.description = text; });
           });
  vector_rows(session, ui, "Position",
              {.name = "inspector/position",
               .value = body.position,
               .unit = "m",
               .help = inspector.mass_alone
                           ? "The mass centre in the world, as drawn; it moves alone."
                           : "The mass centre in the world, as drawn; what is on the body moves along.",
               .address = "bodies." + body.name + ".position",
               .set = [&session, &inspector, &tool, name = body.name](int axis, double value) {
                 move_body(session, inspector, tool, name, axis, value);
               }});
  if (check_row(
          ui, "inspector/mass alone", "Move mass centre alone", inspector.mass_alone,
          "Typing a position or rotation moves the mass centre and the axes of inertia, and leaves shapes, "
          "joints and ends of springs where they are."))
    inspector.mass_alone = !inspector.mass_alone;
  if (check_row(
          ui, "inspector/leave joints", "Leave joints behind", tool.leave_joints,
          "A body that is moved or turned, here or in the view, leaves its joints where they are in the "
          "world; otherwise they go with it. In the view Shift does the opposite.",
          inspector.mass_alone ? "A mass centre that moves alone leaves everything." : nullptr))
    tool.leave_joints = !tool.leave_joints;
  bearing_drive_row(session, ui, body.name);
  mass_section(session, ui, inspector, body);
  rotation_section(session, ui, inspector, tool, body);
  shapes_section(session, ui, inspector, body);
}

} // namespace flyball
