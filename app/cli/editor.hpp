// The window.
#pragma once

#include "app/cli/command.hpp"
#include "app/session/settings.hpp"

#include <filesystem>
#include <optional>

namespace flyball::cli {

struct EditorOptions {
  std::optional<float> scale;         // pixels a point has; the display's own without
  std::optional<ThemeChoice> theme{}; // for this run; none: as the person has chosen
  int width = 1280, height = 800;     // points
  std::filesystem::path state_file{}; // what the window shows, as JSON after every change: for tests
};

// Opens the scene; an empty path opens the governor. Where there is no display it says so on standard error,
// draws the interface into a PNG in the current folder instead and prints its path.
Ending run_editor(const std::filesystem::path& scene, const EditorOptions& options);

} // namespace flyball::cli
