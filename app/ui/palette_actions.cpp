#include "app/ui/palette_actions.hpp"

#include "app/ui/app.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>

namespace flyball {

namespace {

// The part of the mechanism whose number it is; none for the scene's own.
Part part_of_address(const std::string& address) {
  const std::size_t from = address.find('.'), to = address.find('.', from + 1);
  if (from == std::string::npos || to == std::string::npos) return {};
  const std::string name = address.substr(from + 1, to - from - 1);
  if (address.starts_with("bodies.")) return {PartKind::body, name};
  if (address.starts_with("joints.")) return {PartKind::joint, name};
  if (address.starts_with("forces.")) return {PartKind::force, name};
  return {};
}

void fit_part(App& app, const Part& part) {
  const PartId id = find_part(*shown_mechanism(app.session, app.tool), part);
  const SceneList& scene = shown_scene(app.context())->solid;
  Bounds bounds;
  for (const Instance& instance : scene.instances)
    if (instance.part == id) bounds.add(instance_bounds(instance));
  if (id.kind == PartKind::none || bounds.empty) return;
  // With something of what is around it.
  const Vec3 around = Vec3::Constant(0.12 * (scene.bounds.upper - scene.bounds.lower).norm());
  const Vec3 middle = bounds.center();
  bounds.add(Vec3(middle - around));
  bounds.add(Vec3(middle + around));
  const WidgetRect& view = app.ui.keyboard.view;
  if (view.to.x <= view.from.x) return;
  app.view.camera.fit(
      bounds, {static_cast<double>(view.to.x - view.from.x), static_cast<double>(view.to.y - view.from.y)});
  app.view.fit = false;
}

void go_to_number(App& app, const std::string& address) {
  const auto control = std::ranges::find(app.session.parameters, address, &ParameterControl::address);
  if (control != app.session.parameters.end()) {
    set_mode(app.session, Mode::explore);
    app.panels->parameters.open_group(control->group);
  } else {
    const Part part = part_of_address(address);
    select(app.session, part.kind == PartKind::none ? Selection{} : Selection{{part}});
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    if (layout_of(app.session, app.ui, app.sizes, screen.x, screen.y).inspector.width <= 0)
      set_mode(app.session, Mode::build);
  }
  seek_number(app.ui, address);
}

} // namespace

void use_palette_entry(App& app, const PaletteEntry& entry) {
  if (entry.command) return entry.command->run(app);
  if (entry.part.kind != PartKind::none) {
    select(app.session, {{entry.part}});
    return fit_part(app, entry.part);
  }
  if (!entry.value) return go_to_number(app, entry.address);
  change_parameter(app.session, entry.address, *entry.value);
  app.session.notice =
      entry.title + ": " +
      number_words(app.session, parameter_unit(app.session.mechanism(), entry.address), *entry.value);
}

} // namespace flyball
