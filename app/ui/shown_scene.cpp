#include "app/ui/shown_scene.hpp"

#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"

#include <algorithm>

namespace flyball {

namespace {

bool same(const std::vector<Pose>& kept, std::span<const Pose> now) {
  return std::ranges::equal(kept, now, [](const Pose& a, const Pose& b) {
    return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
  });
}

const ShownScene& keep(const Session& session, const ToolState& tool, ShownScene& shown,
                       const ViewFrame& frame) {
  SceneSource& source = shown.source;
  // While exploring, the picture waits for the answer.
  const bool waits = session.mode == Mode::explore && session.answer.ticket != 0;
  const std::uint64_t revision = waits ? 0 : session.document.revision();
  if (shown.scene && source.revision == revision && source.ticket == session.answer.ticket &&
      source.theme == frame.theme && source.loads == (frame.loads || frame.loads_motion) &&
      source.loads_body == frame.loads_body && source.load_lengths == frame.load_lengths &&
      source.hidden == frame.hidden && same(source.poses, frame.poses) && same(source.ghost, frame.ghost) &&
      same(source.motion, frame.motion))
    return shown;
  source.revision = revision;
  source.ticket = session.answer.ticket;
  source.theme = frame.theme;
  source.loads = frame.loads || frame.loads_motion;
  source.loads_body = frame.loads_body;
  source.load_lengths = frame.load_lengths;
  source.hidden = frame.hidden;
  source.poses.assign(frame.poses.begin(), frame.poses.end());
  source.ghost.assign(frame.ghost.begin(), frame.ghost.end());
  source.motion.assign(frame.motion.begin(), frame.motion.end());
  shown.mechanism = shown_mechanism(session, tool);
  shown.scene = std::make_shared<const ViewScene>(view_scene(frame));
  ++shown.made;
  return shown;
}

} // namespace

const ShownScene& show_scene(const Session& session, const ToolState& tool, ViewState& view,
                             const ViewFrame& frame) {
  const bool loads = view.scene.source.loads;
  const int body = view.scene.source.loads_body;
  const ShownScene& shown = keep(session, tool, view.scene, frame);
  // The diagram of another body has arrows of its own.
  if (loads && shown.source.loads && shown.source.loads_body != body) view.fit_loads = true;
  return shown;
}

const ShownScene& show_motion_scene(const Session& session, const ToolState& tool, ViewState& view,
                                    const ViewFrame& frame) {
  return keep(session, tool, view.scene_beside, frame);
}

const std::shared_ptr<const ViewScene>& shown_scene(const ViewContext& context) {
  return show_scene(context.session, context.tool, context.view,
                    view_frame(context.session, context.ui, context.tool, context.view))
      .scene;
}

} // namespace flyball
