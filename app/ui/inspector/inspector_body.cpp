#include "app/document/transform.hpp"
#include "app/document/turns.hpp"
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
Turns shown_turns(App& app, const Body& body) {
  if (std::optional<Turns> given = given_turns(app.mechanism(), body)) return std::move(*given);
  InspectorState& state = app.inspector;
  const Part part{PartKind::body, body.name};
  if (state.turned != part || state.turned_to.coeffs() != body.rotation.coeffs()) {
    state.turned = part;
    state.turned_to = body.rotation;
    state.turns = turns_of(body.rotation);
  }
  return {state.turns, {}};
}

void turn_body(App& app, const std::string& name, int axis, double angle) {
  const int index = body_index(app.mechanism(), name);
  if (index < 0) return;
  Turns turns = shown_turns(app, app.mechanism().bodies[static_cast<std::size_t>(index)]);
  turns.angles[axis] = angle;
  const bool given = !turns.texts[static_cast<std::size_t>(axis)].empty();
  edit(app, "Turn " + name, [&](Mechanism& mechanism, Selection&) {
    Body& body = mechanism.bodies[static_cast<std::size_t>(index)];
    const Quat to = rotation_by(turns.angles);
    if (!app.inspector.mass_alone)
      rotate_parts(mechanism, only(body), body.position, to * body.rotation.normalized().conjugate(),
                   joints_of_moved(app, false));
    if (given)
      body.rotation = to; // what the expression rests on changes
    else
      set_turns(body, turns);
  });
  if (!app.inspector.mass_alone)
    tell_joints(app, only(app.mechanism().bodies[static_cast<std::size_t>(index)]), false);
  app.inspector.turned_to = app.mechanism().bodies[static_cast<std::size_t>(index)].rotation;
  app.inspector.turns = turns.angles;
}

// What is on the body turns with it when an expression is typed, as when a number is.
void turn_along(const App& app, const std::string& name, const Mechanism& before, Mechanism& next) {
  const int index = body_index(next, name);
  if (index < 0 || app.inspector.mass_alone) return;
  const auto i = static_cast<std::size_t>(index);
  const Body given = next.bodies[i];
  const Quat from = before.bodies[i].rotation;
  next.bodies[i].rotation = from;
  rotate_parts(next, only(given), given.position, given.rotation.normalized() * from.normalized().conjugate(),
               joints_of_moved(app, false));
  next.bodies[i].rotation = given.rotation;
  next.bodies[i].formulas = given.formulas;
}

void move_body(App& app, const std::string& name, int axis, double to) {
  const int index = body_index(app.mechanism(), name);
  if (index < 0) return;
  edit(app, "Move " + name, [&](Mechanism& mechanism, Selection&) {
    Body& body = mechanism.bodies[static_cast<std::size_t>(index)];
    Vec3 position = body.position;
    position[axis] = to;
    if (app.inspector.mass_alone)
      body.position = position;
    else
      set_point(mechanism, {{PartKind::body, name}, 0}, position, joints_of_moved(app, false));
  });
  if (!app.inspector.mass_alone)
    tell_joints(app, only(app.mechanism().bodies[static_cast<std::size_t>(index)]), false);
}

void inertia_rows(App& app, const Body& body) {
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
    if (i == 3 && !inspector_section(app, "inspector/products", "Products of inertia", has_products)) return;
    quantity_row(app, (i < 3 ? "Inertia " : "Product ") + std::string(keys[i]),
                 {.name = std::string("inspector/inertia/") + keys[i],
                  .value = body.inertia[i],
                  .unit = "kg m^2",
                  .help = helps[i],
                  .least = i < 3 ? Least::zero : Least::any,
                  .address = "bodies." + body.name + ".inertia." + std::to_string(i)});
  }
}

// A density that was typed is shown as typed, not as the mass by the volume comes out.
double shown_density(const App& app, const Body& body, double density) {
  const auto given = app.inspector.given_masses.find(body.name);
  if (given == app.inspector.given_masses.end() || given->second.mass) return density;
  const double typed = given->second.density;
  return std::abs(typed - density) <= 1e-13 * typed ? typed : density;
}

// Of a body that weighs what its shapes do.
void density_rows(App& app, const Body& body) {
  quantity_row(app, "Density",
               {.name = "inspector/density",
                .value = *body.density,
                .unit = "kg/m^3",
                .help = "Mass, mass centre and inertia follow from it and the shapes.",
                .least = Least::above_zero,
                .address = "bodies." + body.name + ".density"});
  row(app, "Mass", short_text(body.mass, 9), "kg", "Follows from the density and the shapes.");
}

// Whether mass, mass centre and inertia are to follow.
void density_tick(App& app, const Body& body) {
  if (check_row(app, "inspector/by density", "By density", body.density.has_value(),
                "Mass, mass centre and inertia follow from a density and the shapes, whatever moves these."))
    edit_body(app, body.density ? "Take the density off" : "Mass by density", body.name, [](Body& same) {
      same.density = same.density ? std::nullopt : density_of(same);
      std::erase_if(same.formulas, [](const Formula& formula) {
        return formula.key == "density" || formula.key == "mass" || formula.key.starts_with("position") ||
               formula.key.starts_with("inertia");
      });
    });
}

void density_row(App& app, const Body& body) {
  const std::optional<double> density = density_of(body);
  if (!density) return;
  quantity_row(app, "Density",
               {.name = "inspector/density",
                .value = shown_density(app, body, *density),
                .unit = "kg/m^3",
                .help = "The mass by the volume of the shapes; typing it makes the body a uniform solid.",
                .least = Least::zero,
                .set = [&app, name = body.name](double value) {
                  app.inspector.given_masses[name] = {false, value};
                  edit(app, "Set density of " + name, [&](Mechanism& mechanism, Selection&) {
                    for (Body& same : mechanism.bodies)
                      if (same.name == name) take_mass_properties(same, value);
                  });
                }});
}

// Of a rotation whose quaternion is given otherwise than by turns.
void quaternion_rows(App& app, const Body& body) {
  const Quat& q = body.rotation;
  const std::array<double, 4> values{q.w(), q.x(), q.y(), q.z()};
  constexpr std::array letters{"w", "x", "y", "z"};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto text = formula_at(app.mechanism(), "bodies." + body.name + ".rotation." + std::to_string(i));
    const std::string value = short_text(values[i], 9);
    row(app, std::string("Quaternion ") + letters[i], text ? "=" + *text : value, "",
        text ? (value + "; a turn that is typed takes the place of all four.").c_str() : nullptr);
  }
}

} // namespace

bool is_uniform_solid(const Body& body) {
  const std::optional<double> density = density_of(body);
  if (!density || !(body.mass > 0)) return false;
  Body solid = body;
  if (!take_mass_properties(solid, *density)) return false;
  constexpr double tolerance = 1e-6;
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < body.inertia.size(); ++i) {
    largest = std::max(largest, std::abs(solid.inertia[i]));
    difference = std::max(difference, std::abs(solid.inertia[i] - body.inertia[i]));
  }
  const double size = std::sqrt(largest / body.mass); // about the radius of gyration
  return difference <= tolerance * largest && (solid.position - body.position).norm() <= tolerance * size;
}

bool follows_shapes(const App& app, const Body& body) {
  return app.inspector.independent != Part{PartKind::body, body.name} && is_uniform_solid(body);
}

void mass_section(App& app, const Body& body) {
  if (!inspector_section(app, "inspector/mass section", "Mass", true)) return;
  if (body.density) {
    density_rows(app, body);
    return density_tick(app, body);
  }
  const bool follows = follows_shapes(app, body);
  QuantityField mass{.name = "inspector/mass",
                     .value = body.mass,
                     .unit = "kg",
                     .help = follows ? "Inertia goes with it, as in a solid of one density."
                                     : "Mass; zero is allowed.",
                     .least = Least::zero,
                     .address = "bodies." + body.name + ".mass"};
  mass.set = [&app, name = body.name, follows](double value) {
    app.inspector.given_masses[name] = {true, 0};
    if (!follows) return set_number(app, "bodies." + name + ".mass", value);
    edit(app, "Set mass of " + name, [&](Mechanism& mechanism, Selection&) {
      for (Body& same : mechanism.bodies) {
        if (same.name != name || (value > 0 && take_uniform_mass(same, value))) continue;
        same.mass = value; // a drawing without mass: no density says so
        same.inertia = {};
      }
    });
  };
  quantity_row(app, "Mass", mass);
  density_row(app, body);
  inertia_rows(app, body);
  if (!density_of(body)) return;
  const Part part{PartKind::body, body.name};
  if (check_row(
          app, "inspector/uniform", "Uniform solid", follows,
          "Mass centre and inertia are those of the shapes at one density, and stay so when the mass or a "
          "size changes."))
    later(app, [&app, part, follows] {
      app.inspector.independent = follows ? part : Part{};
      if (follows) return;
      edit(app, "Make " + part.name + " uniform", [&](Mechanism& mechanism, Selection&) {
        for (Body& same : mechanism.bodies)
          if (same.name == part.name) take_uniform_mass(same, same.mass);
      });
    });
  density_tick(app, body);
}

void rotation_section(App& app, const Body& body) {
  const bool turned = body.rotation.coeffs() != Quat::Identity().coeffs();
  if (!inspector_section(app, "inspector/rotation section", "Rotation as drawn", turned)) return;
  vector_rows(app, "Turned",
              {.name = "inspector/rotation",
               .value = shown_turns(app, body).angles,
               .unit = "deg",
               .help =
                   "The body is turned about the world's x, then y, then z axis, and what is on it with it. "
                   "Where an expression gives a turn, a change of what this rests on turns the axes alone, "
                   "those of its inertia and boxes; in it angles are in radians unless they have a unit: "
                   "=30 deg.",
               .expression = "bodies." + body.name + ".turn",
               .set = [&app, name = body.name](int axis, double angle) { turn_body(app, name, axis, angle); },
               .follow = [&app, name = body.name](const Mechanism& before,
                                                  Mechanism& next) { turn_along(app, name, before, next); }});
  if (is_rotation_given(body) && !given_turns(app.mechanism(), body)) quaternion_rows(app, body);
}

void body_inspector(App& app, const Body& body) {
  name_row(app, {PartKind::body, body.name});
  text_row(app, "inspector/description", "Note", body.description, "A note for whoever reads the scene.",
           [&app, name = body.name](const std::string& text) {
             edit_body(app, "Describe " + name, name, [text](Body& same) { same.description = text; });
           });
  vector_rows(
      app, "Position",
      {.name = "inspector/position",
       .value = body.position,
       .unit = "m",
       .help = app.inspector.mass_alone
                   ? "The mass centre in the world, as drawn; it moves alone."
                   : "The mass centre in the world, as drawn; what is on the body moves along.",
       .address = "bodies." + body.name + ".position",
       .set = [&app, name = body.name](int axis, double value) { move_body(app, name, axis, value); }});
  if (check_row(
          app, "inspector/mass alone", "Move mass centre alone", app.inspector.mass_alone,
          "Typing a position or rotation moves the mass centre and the axes of inertia, and leaves shapes, "
          "joints and ends of springs where they are."))
    app.inspector.mass_alone = !app.inspector.mass_alone;
  if (check_row(
          app, "inspector/leave joints", "Leave joints behind", app.inspector.leave_joints,
          "A body that is moved or turned, here or in the view, leaves its joints where they are in the "
          "world; otherwise they go with it. In the view Shift does the opposite.",
          app.inspector.mass_alone ? "A mass centre that moves alone leaves everything." : nullptr))
    app.inspector.leave_joints = !app.inspector.leave_joints;
  mass_section(app, body);
  rotation_section(app, body);
  shapes_section(app, body);
}

} // namespace flyball
