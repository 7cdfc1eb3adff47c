#include "app/cli/window_state.hpp"

#include "app/session/motion.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <nlohmann/json.hpp>

namespace flyball::cli {

std::string window_state(const App& app) {
  nlohmann::ordered_json state = {
      {"frame", ImGui::GetFrameCount()},
      {"file", app.session.document.file().string()},
      {"name", app.session.mechanism().name},
      {"unsaved", app.session.document.unsaved()},
      {"explored", app.session.document.explored().size()},
      {"autosave", app.session.files.autosave.path().string()},
      {"leftovers", app.session.files.leftovers.size()},
      {"problem", app.session.problem},
      {"notice", app.session.notice},
      {"dialog", app.dialog.showing},
      {"tool", static_cast<int>(app.tool.tool)},
      {"typing", app.ui.fields.typing.name},
      {"selected", app.session.selection().parts.empty() ? "" : app.session.selection().parts.back().name},
      {"mode", app.session.mode == Mode::build ? "build" : "explore"},
      {"playing", app.session.playback.playing},
      {"answer", app.session.answer.ticket},
      {"status", std::string(word(app.session.answer.solution.status))}};
  if (const MotionRun* motion = app.session.motion.on ? shown_motion(app.session) : nullptr)
    state["motion"] = {{"computed", motion->run->time.back()},
                       {"finished", motion->finished},
                       {"time", app.session.playback.time},
                       {"settled", app.session.motion.settled ? app.session.motion.settled->message : ""}};
  for (const ParameterControl& control : app.session.parameters)
    state["parameters"][control.address] = get_parameter(app.session.mechanism(), control.address);
  for (const CoordinateSolution& c : app.session.answer.solution.coordinates)
    state["coordinates"][coordinate_label(c)] = c.value;
  // Where points of the plane z = 0 are, while looked at from the front.
  if (const auto view = app.ui.widgets.find("view"); view != app.ui.widgets.end()) {
    const WidgetRect& rect = view->second;
    const ViewSize size{static_cast<double>(rect.to.x - rect.from.x),
                        static_cast<double>(rect.to.y - rect.from.y)};
    const auto place = [&](const Vec3& world) -> nlohmann::ordered_json {
      const auto at = app.view.camera.project(world, size);
      if (!at) return nullptr;
      return {static_cast<double>(rect.from.x) + at->x(), static_cast<double>(rect.from.y) + at->y()};
    };
    state["screen"] = {
        {"origin", place(Vec3::Zero())}, {"x", place(Vec3::UnitX())}, {"y", place(Vec3::UnitY())}};
  }
  for (const auto& [name, rect] : app.ui.widgets)
    state["widgets"][name] = {rect.from.x, rect.from.y, rect.to.x, rect.to.y};
  return state.dump(1) + "\n";
}

} // namespace flyball::cli
