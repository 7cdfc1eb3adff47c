// The camera's short way to where a command puts it, so that one sees how the new view lies to the old.
#pragma once

#include "app/viewport/camera.hpp"

namespace flyball {

struct Session;
struct ViewContext;
struct ViewState;

struct CameraGlide {
  static constexpr double duration = 0.18; // s
  ViewCamera from, to;
  double elapsed = 0; // s

  ViewCamera now() const;
  bool operator==(const CameraGlide&) const = default;
};

// The camera to be put somewhere else by a command: it gets there by and by where the program is animated
// (ViewState::animated), else at once.
ViewCamera& glide_goal(ViewState& view);
// The camera where it is going to be.
const ViewCamera& settled_camera(const ViewState& view);
// Moves the camera on by so many seconds.
void advance_glide(ViewState& view, double seconds);
// Whoever takes hold of the camera has it.
void stop_glide(ViewState& view);

// Whether the session or the camera moves by itself.
bool in_motion(const Session& session, const ViewState& view);

// The direction the view looks in, from azimuth and elevation (rad), with all in view.
void look_from(ViewState& view, double azimuth, double elevation);
// All in view from where the camera stands.
void fit_all(ViewState& view);
// What is selected in view; all of it where nothing is.
void fit_selected(const ViewContext& context);

} // namespace flyball
