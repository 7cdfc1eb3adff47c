// The studies below the view, one file each. They show what was asked for, and nothing is made before.
#pragma once

#include "app/plot/plot.hpp"
#include "app/session/session.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/studies/study_views.hpp"
#include "app/ui/ui.hpp"

#include <array>

namespace flyball {

class CommandRunner;

// The open study, with how a person looks at its plots.
class StudyPanel {
 public:
  void draw(Session& session, Ui& ui, const CommandRunner& commands, const PanelRect& rect);
  // What is closed is looked at afresh when it is opened again; once a frame.
  void forget_closed(const Session& session);
  void forget() { shown_ = {}; }
  // All of each plot in view again.
  void fit();
  const StudyViews& shown() const { return shown_; }

 private:
  StudyViews shown_;
};

// `with_transport`: above the plots.
void motion_panel(Session& session, Ui& ui, std::array<MotionPlot, 2>& plots, const CommandRunner& commands,
                  bool with_transport);
void motion_transport(Session& session, Ui& ui, float width); // play, scrub; in the present line, pixels
void compare_panel(Session& session, Ui& ui, CompareView& drawn);
void response_panel(Session& session, Ui& ui, ResponseView& drawn);
void states_panel(Session& session, Ui& ui);
void modes_panel(Session& session, Ui& ui, CampbellView& drawn, const CommandRunner& commands);
void map_panel(Session& session, Ui& ui, MapView& drawn);
void spread_panel(Session& session, Ui& ui, SpreadView& drawn);
void transfer_panel(Session& session, Ui& ui, TransferView& drawn, const CommandRunner& commands);

// Before two half fields, with the unit where one of them has no room for it: "Range (N/mm)".
std::string range_label(const Session& session, const Ui& ui, const std::string& label,
                        const std::string& si_unit, const std::array<double, 2>& ends);

// The name and the unit of what a plot over time can show.
struct MotionQuantity {
  std::string key;   // "value theta"
  std::string title; // "theta"
  std::string group; // "Coordinates"
};
std::vector<MotionQuantity> motion_quantities(const Run& run);
// The quantity over the runs there are, with the steady value.
Plot motion_plot(const Session& session, const std::string& quantity);

} // namespace flyball
