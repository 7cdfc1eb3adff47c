// The 3-D view with the tools that work in it, what lies over it, and its context menu.
#pragma once

#include "app/ui/panels/context_menu.hpp"
#include "app/ui/panels/legend.hpp"

namespace flyball {

struct DialogState;
struct NoticeAge;
struct NoticeLog;

class ViewportPanel {
 public:
  void draw(const ViewContext& context, const DialogState& dialog, NoticeAge& age, NoticeLog& log,
            const CommandRunner& commands, const PanelRect& rect);
  // The view of the motion alone.
  void draw_beside(const ViewContext& context, const PanelRect& rect);
  // The view without anything round it, for pictures: with it only what is needed to read it.
  void draw_alone(const ViewContext& context, const PanelRect& rect);
  void open_menu(const Session& session) { menu_.open(session); }

 private:
  ContextMenu menu_;
  Legend legend_;
};

} // namespace flyball
