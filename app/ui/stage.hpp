// Turns the app into a picture: one ImGui context with its fonts, and OpenGL for the 3-D view and the
// panels. The same in a window and off-screen. Needs a current OpenGL context for its whole life.
#pragma once

#include "app/render/draw_record.hpp"
#include "app/render/fonts.hpp"
#include "app/render/imgui_renderer.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/scene_pictures.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/studies/motion/movie_export.hpp"

#include <chrono>
#include <memory>

namespace flyball {

struct App;

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
  // Makes its own ImGui context current, with fonts and colours for app.theme at `scale`. The fonts are drawn
  // anew, or taken from `kept`, which no other stage may use at the same time.
  Stage(Ui& ui, float scale, KeptFonts* kept = nullptr);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void set_scale(Ui& ui, float scale);
  // One frame: update(), which views have changed, then the interface. ImGui's input must be in place;
  // `seconds` have passed since the last frame. `further`: it is one of several in the place of one, between
  // which no time passes, so that a key that is held is not held longer.
  void frame(App& app, PixelSize size, double seconds, bool further = false);
  // Whether the frame has come to another document or other panels than its views were made for, as by a
  // command: another frame puts that right.
  bool behind(const App& app, PixelSize size) const;
  // Whether the frame is another picture than the last that was asked about: asked once a frame.
  bool has_news();
  // Draws the frame into `target`: the views that have changed since they were drawn, then the interface.
  void render(const Ui& ui, const Framebuffer& target);
  // The same into the window's own picture.
  void render(const Ui& ui, PixelSize window);
  // In how many frames so far the 3-D view was to be drawn anew.
  int views_changed() const { return views_changed_; }
  // Where a view of thousands of bodies is drawn in software, it is drawn without anti-aliasing while it
  // moves, and in full once it rests: for windows. Frames have to go on while resting() is so.
  void draft_while_moving(bool on) { drafts_ = on; }
  bool resting() const { return view_.draft || beside_.draft; }

 private:
  // What is to be drawn of a view whose frame is gone by then.
  struct DueView {
    ViewFrame frame; // without poses, which are in the scene
    std::shared_ptr<const Mechanism> mechanism;
    std::shared_ptr<const ViewScene> scene;
  };
  // A view of the app, drawn again only where something in it changed.
  struct View {
    std::optional<Framebuffer> target, quick;  // quick: without anti-aliasing
    PixelSize target_made_for, quick_made_for; // they have fewer pixels where OpenGL has no more
    ViewKey key;
    std::optional<DueView> due; // not drawn since it changed
    bool draft = false;         // it is in `quick`
    int solids = 0;             // that were in what was drawn last
    std::chrono::steady_clock::time_point moved{};

    bool is_coarse() const {
      return target && (target->width() < target_made_for.width || target->short_of_samples());
    }
  };
  // The texture in which it will be once it is drawn.
  unsigned prepare(const ViewState& state, View& view, const ViewFrame& frame, const ShownScene& scene,
                   PixelSize size);
  void draw_due(View& view);
  void draw_interface(const Ui& ui, PixelSize size);

  ImGuiContext* former_; // that was current before
  KeptFonts* kept_;      // or none
  std::unique_ptr<ImGuiContext, void (*)(ImGuiContext*)> context_;
  ImGuiRenderer renderer_;
  DrawRecord drawn_;
  ViewRenderer view_renderer_;
  ScenePictures scene_pictures_;
  MovieExport movie_;
  View view_, beside_;
  int views_changed_ = 0;
  bool told_coarse_ = false; // that a view has fewer pixels or samples than it should
  bool drafts_ = false;
  std::uint64_t opened_ = 0;          // the document that the views were made for
  PanelRect view_rect_, beside_rect_; // and their places
};

} // namespace flyball
