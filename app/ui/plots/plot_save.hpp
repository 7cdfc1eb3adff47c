// Saving a plot as it is looked at: PNG, SVG or CSV.
#pragma once

#include "app/plot/colors.hpp"
#include "app/ui/export_request.hpp"
#include "app/ui/plots/plot_view.hpp"
#include "app/ui/widgets/file_query.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace flyball {

struct DialogState;

// What is being saved. The dialog writes SVG and CSV itself; a PNG becomes an ExportRequest for whoever has
// OpenGL.
struct PlotSave {
  Plot plot;
  PlotLook look;
  PlotFile kind = PlotFile::png;
  double width = 0, height = 0; // points that it has on the screen
  std::array<int, 2> pixels{};  // wanted of PNG and SVG
  PlotGround ground = PlotGround::light;
};

// Asked for in a plot's menu.
struct PlotToSave {
  std::string name; // becomes part of the file's name
  PlotSave save;
};

// Asks where to.
class PlotDialog {
 public:
  // Opens where a plot is to be saved. Returns the picture that is asked for.
  std::optional<ExportRequest> draw(Session& session, Ui& ui, DialogState& dialog);
  // Again as it was, saying why the picture of this plot was not written.
  void refuse(DialogState& dialog, const PlotSave& save, std::string why);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  void open(const Session& session, DialogState& dialog, PlotToSave asked);
  bool save(Session& session, std::optional<ExportRequest>& picture);
  void close();

  FileQuery query_;
  std::shared_ptr<PlotSave> save_; // while one is being saved
};

} // namespace flyball
