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

void gravity_buttons(App& app) {
  struct Choice {
    const char *text, *key, *help;
    Vec3 gravity;
  };
  const std::array choices{Choice{"−y", "-y", "The earth's, with y pointing up.", {0, -earth, 0}},
                           Choice{"−z", "-z", "The earth's, with z pointing up.", {0, 0, -earth}},
                           Choice{"none", "none", "No gravity.", Vec3::Zero()}};
  row_label(app, "");
  bool first = true;
  for (const Choice& choice : choices) {
    if (!first) ImGui::SameLine(0, 3 * app.scale);
    first = false;
    if (text_button(app, std::string("inspector/gravity/") + choice.key, choice.text,
                    app.mechanism().gravity == choice.gravity))
      edit_later(app, "Set gravity", [gravity = choice.gravity](Mechanism& mechanism, Selection&) {
        mechanism.gravity = gravity;
      });
    help_on_hover(choice.help);
  }
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// Where there is something for the air to act on.
void air_rows(App& app) {
  const Mechanism& mechanism = app.mechanism();
  const Air& air = mechanism.air;
  const auto of_air = [](const Force& force) { return is_of_air(force.type); };
  if (air == Air() && std::ranges::none_of(mechanism.forces, of_air)) return;
  if (!inspector_section(app, "inspector/air section", "Air", true)) return;
  const std::string nothing = "nothing";
  std::vector<std::string> choices{nothing};
  for (const Body& body : mechanism.bodies)
    choices.push_back(body.name);
  const auto chosen = name_choice_row(app, "inspector/turns_with", "Turns with", choices,
                                      air.turns_with.empty() ? nothing : air.turns_with,
                                      "A body that carries the air round as if it were fixed in it.");
  if (chosen)
    edit_later(app, "What the air turns with",
               [body = *chosen == nothing ? "" : *chosen](Mechanism& m, Selection&) {
                 m.air.turns_with = body;
                 if (!body.empty()) m.air.wind.setZero();
               });
  if (air.turns_with.empty())
    vector_rows(app, "Wind",
                {.name = "inspector/wind",
                 .value = air.wind,
                 .unit = "m/s",
                 .help = "The velocity of the air, the same everywhere, in the world's axes.",
                 .address = "air.wind"});
  quantity_row(app, "Density",
               {.name = "inspector/density of air",
                .value = air.density,
                .unit = "kg/m^3",
                .help = "Of the air, for vanes.",
                .least = Least::zero,
                .address = "air.density"});
}

void simulation_rows(App& app) {
  const Simulation& simulation = app.mechanism().simulation;
  if (!inspector_section(app, "inspector/simulation section", "Simulation", false)) return;
  quantity_row(app, "Duration",
               {.name = "inspector/duration",
                .value = simulation.duration,
                .unit = "s",
                .help = "How long the damped motion is simulated.",
                .least = Least::above_zero,
                .address = "simulation.duration"});
  if (check_row(app, "inspector/damped", "With dampers", simulation.damped,
                "Whether dampers act in the simulation."))
    edit_later(app, "Set damped", [](Mechanism& mechanism, Selection&) {
      mechanism.simulation.damped = !mechanism.simulation.damped;
    });
}

} // namespace

void scene_inspector(App& app) {
  const Mechanism& mechanism = app.mechanism();
  text_row(app, "inspector/name", "Name", mechanism.name, "What the scene is called.",
           [&app](const std::string& text) {
             edit(app, "Rename the scene", [&](Mechanism& m, Selection&) { m.name = text; });
           });
  text_row(app, "inspector/description", "Note", mechanism.description, "A note for whoever reads the scene.",
           [&app](const std::string& text) {
             edit(app, "Describe the scene", [&](Mechanism& m, Selection&) { m.description = text; });
           });
  vector_rows(app, "Gravity",
              {.name = "inspector/gravity",
               .value = mechanism.gravity,
               .unit = "m/s^2",
               .help = "The acceleration of free fall, in the world's axes.",
               .address = "gravity"});
  gravity_buttons(app);
  air_rows(app);
  named_sections(app);
  simulation_rows(app);
  ImGui::Dummy({0, 2 * app.scale});
  paragraph(counted(mechanism.bodies.size(), "body", "bodies") + ", " +
                counted(mechanism.joints.size(), "joint", "joints") + ", " +
                counted(mechanism.forces.size(), "force", "forces"),
            colors_of(app).dim);
}

} // namespace flyball
