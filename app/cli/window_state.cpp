#include "app/cli/window_state.hpp"

#include "app/session/motion.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <nlohmann/json.hpp>

namespace flyball::cli {

std::string window_state(const App& app) {
  nlohmann::ordered_json state = {
      {"frame", ImGui::GetFrameCount()},
      {"file", app.document.file().string()},
      {"name", app.mechanism().name},
      {"unsaved", app.document.unsaved()},
      {"explored", app.document.explored().size()},
      {"autosave", app.files.autosave.path().string()},
      {"leftovers", app.files.leftovers.size()},
      {"problem", app.problem},
      {"notice", app.notice},
      {"dialog", app.dialog.showing},
      {"tool", static_cast<int>(app.tool.tool)},
      {"typing", app.fields.typing.name},
      {"selected", app.selection().parts.empty() ? "" : app.selection().parts.back().name},
      {"mode", app.mode == Mode::build ? "build" : "explore"},
      {"playing", app.playback.playing},
      {"answer", app.answer.ticket},
      {"status", std::string(word(app.answer.solution.status))}};
  if (const MotionRun* motion = app.motion.on ? shown_motion(app) : nullptr)
    state["motion"] = {{"computed", motion->run->time.back()},
                       {"finished", motion->finished},
                       {"time", app.playback.time},
                       {"settled", app.motion.settled ? app.motion.settled->message : ""}};
  for (const ParameterControl& control : app.parameters)
    state["parameters"][control.address] = get_parameter(app.mechanism(), control.address);
  for (const CoordinateSolution& c : app.answer.solution.coordinates)
    state["coordinates"][coordinate_label(c)] = c.value;
  // Where points of the plane z = 0 are, while looked at from the front.
  if (const auto view = app.widgets.find("view"); view != app.widgets.end()) {
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
  for (const auto& [name, rect] : app.widgets)
    state["widgets"][name] = {rect.from.x, rect.from.y, rect.to.x, rect.to.y};
  return state.dump(1) + "\n";
}

} // namespace flyball::cli
