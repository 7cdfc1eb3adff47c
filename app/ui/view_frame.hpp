// What the 3-D view shows.
#pragma once

#include "app/viewport/view_renderer.hpp"

#include <memory>

namespace flyball {

struct Session;
struct ToolState;
struct Ui;
struct ViewState;

// The mechanism that it shows.
const std::shared_ptr<const Mechanism>& shown_mechanism(const Session& session, const ToolState& tool);
// Refers to these: use before they change. The stage makes one a frame; what is drawn over the view reads
// view.scene, which was made of it.
ViewFrame view_frame(const Session& session, const Ui& ui, const ToolState& tool, const ViewState& view);
// What the view beside it shows, once that frame's scene was made: the motion alone.
ViewFrame motion_frame(const Session& session, const ViewState& view, ViewFrame frame);

} // namespace flyball
