#include "app/document/bearing_drive.hpp"
#include "app/document/create.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/widgets.hpp"

#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/force_law.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr double usual_stiffness = 1000, usual_damping = 10; // N/m, N s/m; where there was a law

std::string address_of(const Force& force, const std::string& key) {
  return "forces." + force.name + "." + key;
}

// A law stands in its number's place.
std::string law_text(const Formula* law) {
  return law ? law->text : std::string();
}

void spring_rows(Session& session, Ui& ui, const Force& force) {
  const Part part{PartKind::force, force.name};
  for (std::size_t end = 0; end < 2; ++end) {
    body_end_row(session, ui, part, force.bodies, end, end == 0 ? "From" : "To");
    end_point_rows(session, ui, part, force.points, end);
  }
  if (force.force)
    number_row(session, ui, "Force",
               {.name = "inspector/force",
                .value = *force.force,
                .unit = "N",
                .help = "That pulls its ends together: a number, or an expression of the deflection such as "
                        "=2000 N/m*deflection + 1e6 N/m^3*deflection^3 or =table(deflection, [0 mm, 0 N], "
                        "[5 mm, 40 N]).",
                .address = address_of(force, "force"),
                .law = law_text(spring_law(force))},
               [&session, &ui, name = force.name] {
                 edit_force(session, ui, "Stiffness of " + name, name, [](Force& same) {
                   same.force.reset();
                   same.stiffness = usual_stiffness;
                 });
               });
  else
    number_row(session, ui, "Stiffness",
               {.name = "inspector/stiffness",
                .value = force.stiffness,
                .unit = "N/m",
                .help = "Force by how far it is stretched; zero for a damper alone. An expression of the "
                        "deflection is the whole force, as =table(deflection, [0 mm, 0 N], [5 mm, 40 N]).",
                .address = address_of(force, "stiffness")});
  std::function<void()> reset;
  if (force.free_length)
    reset = [&session, &ui, name = force.name] {
      edit_force(session, ui, "Length of " + name + " as drawn", name,
                 [](Force& same) { same.free_length.reset(); });
    };
  number_row(session, ui, "Free length",
             {.name = "inspector/free_length",
              .value = force.free_length.value_or(drawn_distance(force.points)),
              .unit = "m",
              .help = "The length at which the spring is slack.",
              .least = Least::zero,
              .address = address_of(force, "free_length"),
              .standard = !force.free_length},
             reset);
  if (force.damping_force)
    return number_row(session, ui, "Damping force",
                      {.name = "inspector/damping_force",
                       .value = *force.damping_force,
                       .unit = "N",
                       .help = "Against the rate of its length, an expression of it such as =40 "
                               "N*tanh(rate/(0.1 m/s)) or =table(rate, [-1 m/s, -30 N], [0 m/s, 0 N], [1 "
                               "m/s, 90 N]).",
                       .address = address_of(force, "damping_force"),
                       .law = law_text(damper_law(force))},
                      [&session, &ui, name = force.name] {
                        edit_force(session, ui, "Damping of " + name, name, [](Force& same) {
                          same.damping_force.reset();
                          same.damping = usual_damping;
                        });
                      });
  number_row(session, ui, "Damping",
             {.name = "inspector/damping",
              .value = force.damping,
              .unit = "N s/m",
              .help =
                  "Force by the speed at which its length changes. An expression of the rate is the whole "
                  "force, as =40 N*tanh(rate/(0.1 m/s)).",
              .least = Least::zero,
              .address = address_of(force, "damping")});
}

// One number each, by what moves and what feels it.
void matrix_rows(Session& session, Ui& ui, const Force& force, const std::string& key,
                 const BearingMatrix& matrix, std::string_view unit, double usual,
                 BearingMatrix Force::*member) {
  const std::string title = key == "stiffness" ? "Stiffness" : "Damping";
  if (check_row(ui, "inspector/" + key, title, !matrix.empty(), "A matrix by rows, in the bearing's axes."))
    edit_force(session, ui, title + " of " + force.name, force.name,
               [member, usual, had = !matrix.empty()](Force& same) {
                 const std::size_t size = bearing_size(same) == 6 ? 6 : 2;
                 BearingMatrix& entries = same.*member;
                 if (entries.empty() == had) return; // of several, one that is so already
                 entries.assign(had ? 0 : size * size, 0);
                 for (std::size_t i = 0; i < entries.size() && i / size < 2; i += size + 1)
                   entries[i] = usual;
               });
  const std::size_t size = matrix.size() > 4 ? 6 : 2;
  const auto field = [&](std::size_t row, std::size_t column) {
    return QuantityField{
        .name = "inspector/" + key + "/" + std::to_string(row) + "/" + std::to_string(column),
        .value = matrix[row * size + column],
        .unit = std::string(fields::bearing_unit(unit, size, row, column)),
        .help = "What resists along the first, by what happens along the second.",
        .address = address_of(force, key + "." + std::to_string(row) + "." + std::to_string(column))};
  };
  constexpr std::array<const char*, 6> names{"x", "y", "z", "turn x", "turn y", "turn z"};
  if (matrix.size() == 4)
    for (std::size_t i = 0; i < 4; ++i)
      number_row(session, ui, std::string(names[i / 2]) + " by " + names[i % 2], field(i / 2, i % 2));
  if (matrix.size() != 36) return;
  const auto matrix_entry = [&](std::size_t row, std::size_t column, float width) {
    QuantityField entry = field(row, column);
    if (edit_together(session, ui, entry)) quantity_field(session, ui, entry, width);
  };
  // Three columns at a time: six would have no room for their numbers.
  const float label = 52 * ui.scale, gap = 4 * ui.scale;
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const float start = ImGui::GetCursorPosX();
    const float width = std::floor((ImGui::GetContentRegionAvail().x - label - 3 * gap) / 3);
    for (std::size_t row = 0; row <= size; ++row) { // the first has the columns' names
      ImGui::AlignTextToFramePadding();
      ImGui::TextColored(colors_of(ui).dim, "%s", row == 0 ? "by" : names[row - 1]);
      for (std::size_t k = 0; k < 3; ++k) {
        ImGui::SameLine(0, 0);
        ImGui::SetCursorPosX(start + label + static_cast<float>(k) * (width + gap));
        if (row == 0)
          ImGui::TextColored(colors_of(ui).dim, "%s", names[first + k]);
        else
          matrix_entry(row - 1, first + k, width);
      }
    }
  }
}

void bearing_rows(Session& session, Ui& ui, const Force& force) {
  const Part part{PartKind::force, force.name};
  for (std::size_t end = 0; end < 2; ++end)
    body_end_row(session, ui, part, force.bodies, end, end == 0 ? "In" : "Holds",
                 end == 0 ? bearing_in_help : bearing_holds_help);
  if (!is_of_several(ui)) bearing_drive_row(session, ui, held_by(force));
  vector_rows(session, ui, "Point",
              {.name = "inspector/at",
               .value = force.at.value_or(Vec3::Zero()),
               .unit = "m",
               .help = "Where it is, in the world, as drawn.",
               .address = address_of(force, "at")});
  vector_rows(session, ui, "Axis",
              {.name = "inspector/axis",
               .value = force.axis,
               .help = "Of what turns in it; x and y are across.",
               .address = address_of(force, "axis")});
  std::function<void()> reset;
  if (force.x_axis)
    reset = [&session, &ui, name = force.name] {
      edit_force(session, ui, "x axis of " + name + " as usual", name,
                 [](Force& same) { same.x_axis.reset(); });
    };
  vector_rows(session, ui, "x axis",
              {.name = "inspector/x_axis",
               .value = bearing_x_towards(force),
               .help = force.x_axis ? "Where x is, in the plane across the axis; of any length."
                                    : "Where x is: towards the world axis most across, unless another "
                                      "direction is typed.",
               .address = address_of(force, "x_axis"),
               .standard = !force.x_axis},
              reset);
  constexpr std::array<std::string_view, 2> sizes{"2 rows", "6 rows"};
  const bool full = bearing_size(force) == 6;
  if (const auto chosen = choice_row(ui, "inspector/rows", "Matrices", sizes, full ? 1 : 0,
                                     "Of the shifts along x and y; or of three shifts and three turns.");
      chosen && (*chosen == 1) != full)
    edit_force(session, ui, "Rows of " + force.name, force.name, [full](Force& same) {
      if ((bearing_size(same) == 6) != full) return; // of several, one that is so already
      for (BearingMatrix* matrix : {&same.bearing_stiffness, &same.bearing_damping}) {
        if (matrix->empty()) continue;
        const std::size_t from = matrix->size() > 4 ? 6 : 2, to = 8 - from;
        BearingMatrix resized(to * to, 0);
        for (std::size_t i = 0; i < 4; ++i)
          resized[i / 2 * to + i % 2] = (*matrix)[i / 2 * from + i % 2];
        *matrix = std::move(resized);
      }
    });
  matrix_rows(session, ui, force, "stiffness", force.bearing_stiffness, "N/m", usual_bearing_stiffness,
              &Force::bearing_stiffness);
  matrix_rows(session, ui, force, "damping", force.bearing_damping, "N s/m", usual_bearing_damping,
              &Force::bearing_damping);
}

void point_rows(Session& session, Ui& ui, const Force& force) {
  const int body = body_index(session.mechanism(), force.body);
  const Vec3 centre =
      body < 0 ? Vec3(Vec3::Zero()) : session.mechanism().bodies[static_cast<std::size_t>(body)].position;
  std::function<void()> reset;
  if (force.at)
    reset = [&session, &ui, name = force.name] {
      edit_force(session, ui, "Point of " + name + " at the mass centre", name,
                 [](Force& same) { same.at.reset(); });
    };
  vector_rows(session, ui, "Point",
              {.name = "inspector/at",
               .value = force.at.value_or(centre),
               .unit = "m",
               .help = force.at ? "Where it acts on the body, in the world, as drawn."
                                : "Where it acts: the body's mass centre, unless another point is typed.",
               .address = address_of(force, "at"),
               .standard = !force.at},
              reset);
}

void vector_field(Session& session, Ui& ui, const Force& force) {
  const bool torque = force.type == ForceType::torque;
  vector_rows(session, ui, torque ? "Torque" : "Force",
              {.name = "inspector/vector",
               .value = force.vector,
               .unit = torque ? "N m" : "N",
               .help = force.frame == ForceFrame::world ? "Components along the world's axes."
                                                        : "Components along the body's axes.",
               .address = address_of(force, "vector")});
  constexpr std::array<std::string_view, 2> frames{"world", "body"};
  const auto chosen =
      choice_row(ui, "inspector/frame", "Axes", frames, static_cast<std::size_t>(force.frame),
                 "World: it keeps its direction; body: it turns with the body.",
                 std::ranges::any_of(others_edited(session, ui, force),
                                     [&](const Force* each) { return each->frame != force.frame; }));
  if (chosen)
    edit_force(session, ui, "Axes of " + force.name, force.name,
               [frame = static_cast<ForceFrame>(*chosen)](Force& same) { same.frame = frame; });
}

void drag_rows(Session& session, Ui& ui, const Force& force) {
  number_row(session, ui, "Linear",
             {.name = "inspector/linear",
              .value = force.linear,
              .unit = "N s/m",
              .help = "Force by the speed through the air.",
              .least = Least::zero,
              .address = address_of(force, "linear")});
  number_row(session, ui, "Quadratic",
             {.name = "inspector/quadratic",
              .value = force.quadratic,
              .unit = "N s^2/m^2",
              .help = "Force by the square of the speed through the air.",
              .least = Least::zero,
              .address = address_of(force, "quadratic")});
}

enum class VaneForm { plate, blade, airfoil };

VaneForm form_of(const Force& vane) {
  return has_polar(vane) ? VaneForm::airfoil : vane.chord ? VaneForm::blade : VaneForm::plate;
}

// An airfoil begins with the polar that it had as a blade.
void set_form(Force& vane, VaneForm form) {
  if (form == VaneForm::plate)
    vane.chord.reset();
  else if (!vane.chord)
    vane.chord = vane.normal.unitOrthogonal();
  const bool polar = form == VaneForm::airfoil;
  if (polar == has_polar(vane)) return;
  std::erase_if(vane.formulas, [](const Formula& f) {
    return f.key == "cn" || f.key == "cd" || f.key == "lift" || f.key == "drag";
  });
  vane.lift = vane.drag = polar ? std::optional(0.) : std::nullopt;
  if (!polar) return;
  const std::string cn = number_text(vane.cn);
  vane.formulas.push_back({"lift", cn + "*sin(incidence)*cos(incidence)"});
  vane.formulas.push_back({"drag", cn + "*sin(incidence)^2 + " + number_text(vane.cd)});
  std::ranges::sort(vane.formulas, {}, &Formula::key);
}

// Of lift and drag.
void coefficient_row(Session& session, Ui& ui, const Force& vane, const std::string& label,
                     const std::string& key, const std::optional<double>& coefficient, const Formula* law,
                     const char* help) {
  if (!coefficient) return; // zero, as the file leaves it out
  number_row(session, ui, label,
             {.name = "inspector/" + key,
              .value = *coefficient,
              .unit = "",
              .help = help,
              .address = address_of(vane, key),
              .law = law_text(law)});
}

void vane_rows(Session& session, Ui& ui, const Force& vane) {
  number_row(session, ui, "Area",
             {.name = "inspector/area",
              .value = vane.area,
              .unit = "m^2",
              .help = "Of one side.",
              .least = Least::zero,
              .address = address_of(vane, "area")});
  vector_rows(session, ui, "Normal",
              {.name = "inspector/normal",
               .value = vane.normal,
               .help = "Square to the plate, as drawn; of any length, either way.",
               .address = address_of(vane, "normal")});
  constexpr std::array<std::string_view, 3> forms{"plate", "blade", "airfoil"};
  const auto chosen =
      choice_row(ui, "inspector/form", "Form", forms, static_cast<std::size_t>(form_of(vane)),
                 "On a blade flow along its span does nothing; a plate is alike all round. An airfoil is a "
                 "blade with lift and drag by the direction of the flow.",
                 std::ranges::any_of(others_edited(session, ui, vane),
                                     [&](const Force* each) { return form_of(*each) != form_of(vane); }));
  if (chosen)
    edit_force(session, ui, "Form of " + vane.name, vane.name,
               [form = static_cast<VaneForm>(*chosen)](Force& same) { set_form(same, form); });
  if (vane.chord)
    vector_rows(session, ui, "Chord",
                {.name = "inspector/chord",
                 .value = *vane.chord,
                 .help = "Along the flow over the blade, from its leading edge on, as drawn; of any length.",
                 .address = address_of(vane, "chord")});
  if (has_polar(vane)) {
    coefficient_row(
        session, ui, vane, "Lift coefficient", "lift", vane.lift, lift_law(vane),
        "Of the force square to the flow: an expression of the incidence, the angle from the chord "
        "to the flow towards the normal, such as =table(incidence, [-180 deg, 0], [-90 deg, 0], "
        "[-12 deg, -1.1], [12 deg, 1.1], [90 deg, 0], [180 deg, 0]).");
    coefficient_row(session, ui, vane, "Drag coefficient", "drag", vane.drag, drag_law(vane),
                    "Of the force along the flow, such as =0.01 + 1.2*sin(incidence)^2; zero or more.");
    return;
  }
  number_row(session, ui, "cn (normal)",
             {.name = "inspector/cn",
              .value = vane.cn,
              .unit = "",
              .help = "Coefficient of the force square to the plate, times the sine of the angle of "
                      "attack; a plate in a "
                      "stream 1.2, a thin blade up to 2 pi.",
              .least = Least::zero,
              .address = address_of(vane, "cn")});
  number_row(session, ui, "cd (drag)",
             {.name = "inspector/cd",
              .value = vane.cd,
              .unit = "",
              .help = "Coefficient of the force along the flow that is there at any angle.",
              .least = Least::zero,
              .address = address_of(vane, "cd")});
}

} // namespace

void force_inspector(Session& session, Ui& ui, const Force& force) {
  const std::vector<const Force*> others = others_edited(session, ui, force);
  if (others.empty()) {
    name_row(session, ui, {PartKind::force, force.name});
    text_row(
        session, ui, "inspector/description", "Note", force.description,
        "A note for whoever reads the scene.", [&session, &ui, name = force.name](const std::string& text) {
          edit_force(session, ui, "Describe " + name, name, [text](Force& same) { same.description = text; });
        });
  }
  if (force.type == ForceType::spring) return spring_rows(session, ui, force);
  if (force.type == ForceType::bearing) return bearing_rows(session, ui, force);
  const std::vector<std::string> choices = body_choices(session.mechanism(), false);
  if (const auto chosen = name_choice_row(
          ui, "inspector/body", "Body", choices,
          std::ranges::all_of(others, [&](const Force* each) { return each->body == force.body; })
              ? force.body
              : "various",
          "The body it acts on."))
    edit_force(session, ui, "Body of " + force.name, force.name,
               [chosen = *chosen](Force& same) { same.body = chosen; });
  point_rows(session, ui, force);
  if (force.type == ForceType::drag)
    drag_rows(session, ui, force);
  else if (force.type == ForceType::vane)
    vane_rows(session, ui, force);
  else
    vector_field(session, ui, force);
}

} // namespace flyball
