// What the views show as lists of solids, made anew only where what they show has changed: for drawing, for
// pointing and for fitting the camera alike.
#pragma once

#include "app/viewport/view_scene.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace flyball {

struct ViewContext;
struct Session;
struct ToolState;
struct ViewState;

// All that the lists depend on.
struct SceneSource {
  std::uint64_t revision = 0; // of the document where its mechanism is shown, else 0
  std::uint64_t ticket = 0;   // of the answer
  Theme theme = Theme::light;
  bool loads = false;
  int loads_body = -1;
  std::optional<LoadLengths> load_lengths{};
  std::vector<PartId> hidden;
  std::vector<Pose> poses, ghost, motion;
};

struct ShownScene {
  SceneSource source;
  std::shared_ptr<const Mechanism> mechanism; // whose parts are in the scene
  std::shared_ptr<const ViewScene> scene;     // null: none yet
  int made = 0;                               // how often
};

// Of what the view shows in this frame, and of the view beside it.
const ShownScene& show_scene(const Session& session, const ToolState& tool, ViewState& view,
                             const ViewFrame& frame);
const ShownScene& show_motion_scene(const Session& session, const ToolState& tool, ViewState& view,
                                    const ViewFrame& frame);
// As all of it is now, which commands may have changed since the frame began.
const std::shared_ptr<const ViewScene>& shown_scene(const ViewContext& context);

} // namespace flyball
