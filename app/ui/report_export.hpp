// A report of what is shown, written in the background.
#pragma once

#include "app/live/background.hpp"

#include <filesystem>
#include <memory>

namespace flyball {

struct App;
struct ExportRequest;
struct Session;

struct ReportExport {
  std::unique_ptr<Background<std::filesystem::path>> task; // made when it is first asked for; its file
};

// Draws the picture for it, which needs OpenGL, and has the rest done in the background.
void begin_report(App& app, const ExportRequest& request);
bool writing_report(const ReportExport& report);
// Once a frame: tells where it was written, or why not; a person may have cancelled it.
void update_report(Session& session, ReportExport& report);

} // namespace flyball
