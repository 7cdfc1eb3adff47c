#include "app/ui/scene_pictures.hpp"

#include "app/session/session.hpp"

#include "engine/report/analysis.hpp"

#include <cmath>

namespace flyball {

namespace {

// Where it settles; where it does not, nothing: the drawn pose.
std::vector<Pose> equilibrium_of(const Mechanism& mechanism) {
  try {
    Analysis analysis(mechanism);
    SolveOptions options;
    options.details = false;
    const Solution solution = analysis.solve(options);
    if (solution.status == Status::converged) return solution.poses;
  } catch (const SceneError&) { // not fit to be solved
  }
  return {};
}

Framebuffer draw(const Ui& ui, const ViewState& view, const Mechanism& mechanism, ViewRenderer& renderer) {
  Framebuffer target(static_cast<int>(std::lround(scene_picture_width * ui.scale)),
                     static_cast<int>(std::lround(scene_picture_height * ui.scale)), view.samples);
  const ViewSize size{static_cast<double>(target.width()), static_cast<double>(target.height())};
  const std::vector<Pose> poses = equilibrium_of(mechanism);
  ViewFrame frame;
  frame.mechanism = &mechanism;
  frame.poses = poses;
  frame.theme = ui.theme;
  frame.options.triad = false;
  frame.options.scale = ui.scale;
  frame.camera = initial_camera(mechanism, scene_of(frame).bounds, size);
  renderer.draw(frame, target);
  return target;
}

} // namespace

const ScenePictures::Picture* ScenePictures::find(const Ui& ui, const SceneCard& card) const {
  for (const Picture& picture : pictures_)
    if (picture.theme == ui.theme && picture.scale == ui.scale && picture.mechanism == card.mechanism)
      return &picture;
  return nullptr;
}

void ScenePictures::update(const Session& session, const Ui& ui, const ViewState& view,
                           GalleryDialog& gallery, bool wanted, ViewRenderer& renderer) {
  gallery.drawing = false;
  if (!gallery.showing() && !wanted) return;
  // Those of other colours and sizes are not wanted any more.
  std::erase_if(pictures_,
                [&](const Picture& one) { return one.theme != ui.theme || one.scale != ui.scale; });
  bool may_draw = true;
  for (SceneCard& card : gallery.cards()) {
    const Picture* picture = find(ui, card);
    if (!picture && may_draw) {
      pictures_.push_back({card.mechanism, ui.theme, ui.scale, draw(ui, view, card.mechanism, renderer)});
      picture = &pictures_.back();
      may_draw = session.options.mode == LiveSolver::Mode::immediate;
    }
    card.picture = picture ? picture->drawn.texture() : 0;
    gallery.drawing = gallery.drawing || !picture;
  }
}

} // namespace flyball
