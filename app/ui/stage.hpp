// Turns the app into a picture: one ImGui context with its fonts, and OpenGL for the 3-D view and the
// panels. The same in a window and off-screen. Needs a current OpenGL context for its whole life.
#pragma once

#include "app/render/imgui_renderer.hpp"
#include "app/ui/app.hpp"
#include "app/ui/scene_pictures.hpp"
#include "app/ui/studies/motion/movie_export.hpp"

#include <chrono>
#include <memory>

namespace flyball {

struct PixelSize {
  int width = 0, height = 0;
  bool operator==(const PixelSize&) const = default;
};

// Everything the 3-D view depends on; while it stays the same the view is not drawn again.
struct ViewKey {
  PixelSize size;
  int samples = 0;
  bool grid = false, shadow = false;
  std::shared_ptr<const ViewScene> scene;
  std::vector<PartId> selected;
  Theme theme = Theme::light;
  float scale = 1;
  PartId hovered;
  ViewCamera camera;
  bool operator==(const ViewKey&) const = default;
};

class Stage {
 public:
  // Makes its own ImGui context current, with fonts and colours for app.theme at `scale`.
  Stage(App& app, float scale);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void set_scale(App& app, float scale);
  // One frame: update(), the 3-D view where it changed, then the interface. ImGui's input must be in place;
  // `seconds` have passed since the last frame.
  void frame(App& app, PixelSize size, double seconds);
  // Draws the frame into the framebuffer that is bound.
  void render(const App& app, PixelSize size);
  // How often the 3-D view was drawn so far.
  int views_drawn() const { return views_drawn_; }
  // Where a view of thousands of bodies is drawn in software, it is drawn without anti-aliasing while it
  // moves, and in full once it rests: for windows. Frames have to go on while resting() is so.
  void draft_while_moving(bool on) { drafts_ = on; }
  bool resting() const { return view_.draft || beside_.draft; }

 private:
  // A view of the app, drawn again only where something in it changed; its texture.
  struct View {
    std::optional<Framebuffer> target, quick;  // quick: without anti-aliasing
    PixelSize target_made_for, quick_made_for; // they have fewer pixels where OpenGL has no more
    ViewKey drawn;
    bool draft = false; // what was drawn last is in `quick`
    int solids = 0;     // that were in it
    std::chrono::steady_clock::time_point moved{};

    bool is_coarse() const {
      return target && (target->width() < target_made_for.width || target->short_of_samples());
    }
  };
  unsigned draw_view(const App& app, View& view, const ViewFrame& frame,
                     const std::shared_ptr<const ViewScene>& scene, PixelSize size);

  ImGuiContext* former_; // that was current before
  std::unique_ptr<ImGuiContext, void (*)(ImGuiContext*)> context_;
  ImGuiRenderer renderer_;
  ViewRenderer view_renderer_;
  ScenePictures scene_pictures_;
  MovieExport movie_;
  View view_, beside_;
  int views_drawn_ = 0;
  bool told_coarse_ = false; // that a view has fewer pixels or samples than it should
  bool drafts_ = false;
};

} // namespace flyball
