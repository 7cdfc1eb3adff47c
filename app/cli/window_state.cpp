#include "app/cli/window_state.hpp"

#include "engine/mechanism/address.hpp"

#include <nlohmann/json.hpp>

namespace flyball::cli {

std::string window_state(const App& app) {
  nlohmann::ordered_json state = {{"frame", ImGui::GetFrameCount()},
                                  {"file", app.document.file().string()},
                                  {"name", app.mechanism().name},
                                  {"unsaved", app.document.unsaved()},
                                  {"autosave", app.files.autosave.path().string()},
                                  {"leftovers", app.files.leftovers.size()},
                                  {"problem", app.problem},
                                  {"notice", app.notice},
                                  {"dialog", app.dialog.showing},
                                  {"playing", app.playback.playing},
                                  {"answer", app.answer.ticket},
                                  {"status", std::string(word(app.answer.solution.status))}};
  for (const ParameterControl& control : app.parameters)
    state["parameters"][control.address] = get_parameter(app.mechanism(), control.address);
  for (const CoordinateSolution& c : app.answer.solution.coordinates)
    state["coordinates"][c.count > 1 ? c.joint + "." + std::to_string(c.index) : c.joint] = c.value;
  for (const auto& [name, rect] : app.widgets)
    state["widgets"][name] = {rect.from.x, rect.from.y, rect.to.x, rect.to.y};
  return state.dump(1) + "\n";
}

} // namespace flyball::cli
