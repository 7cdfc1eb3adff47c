// The numbers of the whole scene, shown while nothing is selected.
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace flyball {

namespace {

constexpr double earth = 9.80665; // m/s^2

void gravity_buttons(Session& session, Ui& ui) {
  struct Choice {
    const char *text, *key, *help;
    Vec3 gravity;
  };
  const std::array choices{Choice{"−y", "-y", "The earth's, with y pointing up.", {0, -earth, 0}},
                           Choice{"−z", "-z", "The earth's, with z pointing up.", {0, 0, -earth}},
                           Choice{"none", "none", "No gravity.", Vec3::Zero()}};
  row_label(ui, "");
  bool first = true;
  for (const Choice& choice : choices) {
    if (!first) ImGui::SameLine(0, 3 * ui.scale);
    first = false;
    if (text_button(ui, std::string("inspector/gravity/") + choice.key, choice.text,
                    session.mechanism().gravity == choice.gravity))
      edit_later(session, ui, "Set gravity", [gravity = choice.gravity](Mechanism& mechanism, Selection&) {
        mechanism.gravity = gravity;
      });
    help_on_hover(choice.help);
  }
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// Where there is something for the air to act on.
void air_rows(Session& session, Ui& ui) {
  const Mechanism& mechanism = session.mechanism();
  const Air& air = mechanism.air;
  const auto of_air = [](const Force& force) { return is_of_air(force.type); };
  if (air == Air() && std::ranges::none_of(mechanism.forces, of_air)) return;
  if (!inspector_section(session, ui, "inspector/air section", "Air", true)) return;
  const std::string nothing = "nothing";
  std::vector<std::string> choices{nothing};
  for (const Body& body : mechanism.bodies)
    choices.push_back(body.name);
  const auto chosen = name_choice_row(ui, "inspector/turns_with", "Turns with", choices,
                                      air.turns_with.empty() ? nothing : air.turns_with,
                                      "A body that carries the air round as if it were fixed in it.");
  if (chosen)
    edit_later(session, ui, "What the air turns with",
               [body = *chosen == nothing ? "" : *chosen](Mechanism& m, Selection&) {
                 m.air.turns_with = body;
                 if (!body.empty()) m.air.wind.setZero();
               });
  if (air.turns_with.empty())
    vector_rows(session, ui, "Wind",
                {.name = "inspector/wind",
                 .value = air.wind,
                 .unit = "m/s",
                 .help = "The velocity of the air, the same everywhere, in the world's axes.",
                 .address = "air.wind"});
  quantity_row(session, ui, "Density",
               {.name = "inspector/density of air",
                .value = air.density,
                .unit = "kg/m^3",
                .help = "Of the air, for vanes.",
                .least = Least::zero,
                .address = "air.density"});
}

void simulation_rows(Session& session, Ui& ui) {
  const Simulation& simulation = session.mechanism().simulation;
  if (!inspector_section(session, ui, "inspector/simulation section", "Simulation", false)) return;
  quantity_row(session, ui, "Duration",
               {.name = "inspector/duration",
                .value = simulation.duration,
                .unit = "s",
                .help = "How long the damped motion is simulated.",
                .least = Least::above_zero,
                .address = "simulation.duration"});
  if (check_row(ui, "inspector/damped", "With dampers", simulation.damped,
                "Whether dampers act in the simulation."))
    edit_later(session, ui, "Set damped", [](Mechanism& mechanism, Selection&) {
      mechanism.simulation.damped = !mechanism.simulation.damped;
    });
}

} // namespace

void scene_inspector(Session& session, Ui& ui, ToolState& tool) {
  const Mechanism& mechanism = session.mechanism();
  text_row(session, ui, "inspector/name", "Name", mechanism.name, "What the scene is called.",
           [&session](const std::string& text) {
             edit(session, "Rename the scene", [&](Mechanism& m, Selection&) { m.name = text; });
           });
  text_row(session, ui, "inspector/description", "Note", mechanism.description,
           "A note for whoever reads the scene.", [&session](const std::string& text) {
             edit(session, "Describe the scene", [&](Mechanism& m, Selection&) { m.description = text; });
           });
  vector_rows(session, ui, "Gravity",
              {.name = "inspector/gravity",
               .value = mechanism.gravity,
               .unit = "m/s^2",
               .help = "The acceleration of free fall, in the world's axes.",
               .address = "gravity"});
  gravity_buttons(session, ui);
  air_rows(session, ui);
  named_sections(session, ui, tool);
  simulation_rows(session, ui);
  ImGui::Dummy({0, 2 * ui.scale});
  paragraph(counted(mechanism.bodies.size(), "body", "bodies") + ", " +
                counted(mechanism.joints.size(), "joint", "joints") + ", " +
                counted(mechanism.forces.size(), "force", "forces"),
            colors_of(ui).dim);
}

} // namespace flyball
