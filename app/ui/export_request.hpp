// A picture or report that is asked for, of whoever can draw it.
#pragma once

#include <filesystem>
#include <memory>

namespace flyball {

struct PlotSave; // see plot_save.hpp

struct ExportRequest {
  std::filesystem::path file;
  int width = 1920, height = 1080; // pixels
  bool panels = false, loads = false;
  std::shared_ptr<const PlotSave> plot{}; // this instead of the window or the view
  bool report = false;                    // a page with the view in it
};

} // namespace flyball
