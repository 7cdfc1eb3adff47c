#include "app/ui/camera_glide.hpp"

#include "app/ui/shown_scene.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

ViewCamera CameraGlide::now() const {
  const double t = std::clamp(elapsed / duration, 0., 1.), share = t * t * (3 - 2 * t);
  ViewCamera camera = to;
  camera.target = (1 - share) * from.target + share * to.target;
  camera.distance = from.distance * std::pow(to.distance / from.distance, share);
  const double turn = std::remainder(to.azimuth - from.azimuth, 2 * std::numbers::pi); // the shorter way
  camera.azimuth = to.azimuth - (1 - share) * turn;
  camera.elevation = (1 - share) * from.elevation + share * to.elevation;
  return camera;
}

ViewCamera& glide_goal(ViewState& view) {
  if (!view.animated) return view.camera;
  const ViewCamera goal = settled_camera(view);
  view.glide = CameraGlide{view.camera, goal, 0};
  return view.glide->to;
}

const ViewCamera& settled_camera(const ViewState& view) {
  return view.glide ? view.glide->to : view.camera;
}

void advance_glide(ViewState& view, double seconds) {
  if (!view.glide) return;
  constexpr double longest_first = 0.04; // s: a window that has been idle does not jump
  CameraGlide& glide = *view.glide;
  glide.elapsed += glide.elapsed == 0 ? std::min(seconds, longest_first) : seconds;
  view.camera = glide.elapsed >= CameraGlide::duration ? glide.to : glide.now();
  if (glide.elapsed >= CameraGlide::duration) view.glide.reset();
}

void stop_glide(ViewState& view) {
  view.glide.reset();
  view.fit = false;
}

bool in_motion(const Session& session, const ViewState& view) {
  return view.glide || in_motion(session);
}

void look_from(ViewState& view, double azimuth, double elevation) {
  ViewCamera& camera = glide_goal(view);
  camera.azimuth = azimuth;
  camera.elevation = elevation;
  view.fit = view.keep_direction = true;
}

void fit_all(ViewState& view) {
  glide_goal(view);
  view.fit = view.keep_direction = true;
}

void fit_selected(const ViewContext& context) {
  const std::vector<PartId> parts =
      find_parts(*shown_mechanism(context.session, context.tool), context.session.selection());
  Bounds bounds;
  for (const Instance& instance : shown_scene(context)->solid.instances)
    if (std::ranges::find(parts, instance.part) != parts.end()) bounds.add(instance_bounds(instance));
  if (bounds.empty) return fit_all(context.view);
  glide_goal(context.view).fit(bounds, context.view.size, 1.6);
  context.view.fit = false;
}

} // namespace flyball
