// All that is drawn round the view and over it and keeps something from frame to frame.
#pragma once

#include "app/ui/dialogs/copies_dialogs.hpp"
#include "app/ui/dialogs/export_dialog.hpp"
#include "app/ui/dialogs/gallery_dialog.hpp"
#include "app/ui/dialogs/model_dialog.hpp"
#include "app/ui/dialogs/open_dialog.hpp"
#include "app/ui/dialogs/recovery_dialog.hpp"
#include "app/ui/dialogs/report_dialog.hpp"
#include "app/ui/dialogs/save_dialog.hpp"
#include "app/ui/dialogs/unsaved_dialog.hpp"
#include "app/ui/inspector/inspector_panel.hpp"
#include "app/ui/panels/command_palette.hpp"
#include "app/ui/panels/history_panel.hpp"
#include "app/ui/panels/outline_panel.hpp"
#include "app/ui/panels/parameters_panel.hpp"
#include "app/ui/panels/results_panel.hpp"
#include "app/ui/panels/shortcut_sheet.hpp"
#include "app/ui/panels/tutorial_panel.hpp"
#include "app/ui/panels/viewport_panel.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/studies/motion/movie_dialog.hpp"
#include "app/ui/studies/study_panels.hpp"

namespace flyball {

struct Panels {
  ViewportPanel viewport;
  OutlinePanel outline;
  ParametersPanel parameters;
  InspectorPanel inspector;
  ResultsPanel results;
  StudyPanel studies;
  HistoryPanel history;
  ShortcutSheet shortcuts;
  TutorialPanel tutorial;
  CommandPalette palette;

  OpenDialog open;
  SaveDialog save;
  GalleryDialog gallery;
  ExportDialog picture;
  ReportDialog report;
  ModelDialog model;
  MovieDialog movie;
  PlotDialog plot;
  CopiesDialogs copies;
  RecoveryDialog recovery;
  UnsavedDialog unsaved;
};

} // namespace flyball
