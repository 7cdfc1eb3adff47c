#include "app/ui/palette_actions.hpp"

#include "app/document/references.hpp"
#include "app/ui/app.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <span>
#include <unordered_set>

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

bool names(std::span<const std::string> all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

// The part with what it is joined to: of a body those that a joint, spring or bearing holds to it, of a joint
// or force its bodies, of a gear those of its joints.
std::unordered_set<std::string> bodies_about(const Mechanism& mechanism, const Part& part) {
  std::unordered_set<std::string> bodies;
  const auto take = [&](const auto& of, PartKind kind) {
    const auto held = bodies_of(of);
    if ((part.kind == kind && of.name == part.name) ||
        (part.kind == PartKind::body && names(held, part.name)))
      bodies.insert(held.begin(), held.end());
  };
  for (const Force& force : mechanism.forces)
    take(force, PartKind::force);
  for (const Joint& joint : mechanism.joints) {
    take(joint, PartKind::joint);
    if (part.kind != PartKind::joint || joint.name != part.name || joint.type != JointType::gear) continue;
    for (const std::string& end : joint.joints)
      if (const int i = joint_index(mechanism, joint_of_end(end)); i >= 0)
        for (const std::string& body : bodies_of(mechanism.joints[static_cast<std::size_t>(i)]))
          bodies.insert(body);
  }
  return bodies;
}

// The part in the middle of the view, and about it what it is joined to, as far as the whole would be seen.
void fit_part(App& app, const Part& part) {
  const Mechanism& mechanism = *shown_mechanism(app.session, app.tool);
  const PartId id = find_part(mechanism, part);
  const SceneList& scene = shown_scene(app.context())->solid;
  const std::unordered_set<std::string> about = bodies_about(mechanism, part);
  Bounds own, all;
  for (const Instance& instance : scene.instances) {
    const bool is_own = instance.part == id;
    const bool joined = instance.part.kind == PartKind::body && instance.part.index >= 0 &&
                        about.contains(mechanism.bodies[static_cast<std::size_t>(instance.part.index)].name);
    if (is_own) own.add(instance_bounds(instance));
    if (is_own || joined) all.add(instance_bounds(instance));
  }
  const ViewSize view = app.view.size;
  if (id.kind == PartKind::none || own.empty || !(view.width > 1)) return;
  const Vec3 middle = own.center();
  // Of what is joined to nothing, something of what else there is.
  const Vec3 least = Vec3::Constant(0.12 * (scene.bounds.upper - scene.bounds.lower).norm());
  const Vec3 reach = (all.upper - middle).cwiseMax(middle - all.lower).cwiseMax(least);
  Bounds shown;
  shown.add(Vec3(middle - reach));
  shown.add(Vec3(middle + reach));
  ViewCamera& camera = glide_goal(app.view);
  camera.fit(scene.bounds, view);
  const double whole = camera.distance;
  camera.fit(shown, view);
  camera.target = middle;
  camera.distance = std::min(camera.distance, whole);
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
