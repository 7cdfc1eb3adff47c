#include "app/viewport/view_renderer.hpp"

#include "app/render/shader.hpp"
#include "app/viewport/shadow_map.hpp"
#include "app/viewport/sketch.hpp"
#include "app/viewport/solid_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

void set_matrix(const ShaderProgram& program, const char* name, const Mat4& matrix) {
  const Eigen::Matrix4f m = matrix.cast<float>();
  program.set_matrix(name, std::span<const float, 16>(m.data(), 16));
}

void set_vector(const ShaderProgram& program, const char* name, const Vec3& v) {
  program.set(name, float(v.x()), float(v.y()), float(v.z()));
}

void set_color(const ShaderProgram& program, const char* name, const Color& c) {
  program.set(name, c.r, c.g, c.b, c.a);
}

// The camera in view units: it looks at the origin from a distance of one.
ViewCamera in_view_units(const ViewCamera& camera) {
  ViewCamera unit = camera;
  unit.target = Vec3::Zero();
  unit.distance = 1;
  return unit;
}

// What one picture's passes share, in view units.
struct Stage {
  ViewUnits units;
  ViewCamera camera;
  ViewSize size;
  Sight sight; // m, in the world
  Mat4 view_projection;
  Vec3 up, key;
  Vec3 center;          // of the solids
  bool nothing = false; // there are none
  double radius = 0, floor_reach = 0, floor_height = 0;
  const Palette* colors = nullptr;

  Stage(const ViewFrame& frame, const SceneList& scene, const Framebuffer& target)
      : units{frame.camera.target, frame.camera.distance},
        camera(in_view_units(frame.camera)), size{double(target.width()), double(target.height())},
        sight(sight_of(frame.camera, size)), up(frame.camera.up), colors(&palette(frame.theme)) {
    if (frame.options.draft) sight.flat_coil = 9;
    const Bounds& bounds = scene.bounds;
    nothing = bounds.empty;
    center = bounds.empty ? Vec3(Vec3::Zero()) : Vec3((bounds.center() - units.origin) / units.length);
    radius = std::clamp(bounds.empty ? 0.3 : bounds.radius() / units.length, 1e-6, 1e6);
    // Seen from above it covers the picture beside whatever is small, as it does where there is nothing; from
    // the side it would come to the eye.
    floor_reach = std::clamp(5 * radius, 1.5 * std::abs(std::sin(camera.elevation)), 60.0);
    floor_height = bounds.empty ? up.dot(-units.origin) / units.length
                                : (scene.floor - up.dot(units.origin)) / units.length;
    view_projection = camera.projection_matrix(size, center, floor_reach + 2 * radius) * camera.view_matrix();
    // From behind the viewer's left shoulder as one looks from the front, whatever way up is.
    ViewCamera front = camera;
    front.azimuth = 0;
    key = (0.62 * front.right() * -1 + 1.35 * up + 0.55 * up.cross(-front.right()).normalized()).normalized();
  }
  Vec3 floor_center() const { return center + (floor_height - up.dot(center)) * up; }
  // Where nothing is drawn the floor would have a height that the first body changes: seen from the side, as
  // if everything had moved.
  bool floor_in_view(const Vec3& eye) const {
    constexpr double from_the_side = 0.05; // rad
    if (nothing && std::abs(camera.elevation) < from_the_side) return false;
    return (eye - floor_center()).norm() < 50 * floor_reach &&
           std::abs(up.dot(eye - floor_center())) > 1e-6 * radius;
  }
};

bool before(const PartId& a, const PartId& b) {
  return std::pair(a.kind, a.index) < std::pair(b.kind, b.index);
}

std::vector<Instance> of_parts(const SceneList& scene, std::vector<PartId> parts) {
  std::vector<Instance> found;
  std::ranges::sort(parts, before);
  for (const Instance& instance : scene.instances)
    if (instance.part.kind != PartKind::none && std::ranges::binary_search(parts, instance.part, before))
      found.push_back(instance);
  return found;
}

std::vector<Instance> triad(const Palette& colors, const Mechanism* mechanism) {
  std::vector<Instance> list;
  Sketch sketch(list);
  const std::array<Color, 3> hues{colors.axis_x, colors.axis_y, colors.axis_z};
  for (int i = 0; i < 3; ++i) {
    sketch.pen.color = hues[static_cast<std::size_t>(i)];
    sketch.arrow(Vec3::Zero(), Vec3::Unit(i), 0.045);
  }
  sketch.pen.color = colors.metal;
  sketch.sphere(Vec3::Zero(), 0.1);
  if (mechanism && mechanism->gravity.stableNorm() > 0) {
    sketch.pen.color = colors.slack;
    sketch.arrow(Vec3::Zero(), 0.75 * mechanism->gravity.stableNormalized(), 0.03);
  }
  return list;
}

} // namespace

struct ViewRenderer::State {
  ShaderProgram background{"background.vert", "background.frag"}, depth{"depth.vert", "depth.frag"},
      lit{"lit.vert", "lit.frag"}, outline{"outline.vert", "outline.frag"}, floor{"floor.vert", "floor.frag"};
  SolidMeshes meshes;
  InstanceBatches solids, casting, translucent, marked, axes;
  GlVertexArray none = make_vertex_array(); // for vertices the shader makes up
  std::optional<ShadowMap> shadow;          // made when first needed
  std::shared_ptr<const ViewScene> shaded;  // that the shadow is of
  Vec3 shaded_from = Vec3::Zero();          // the key light then
  ViewReport report;

  void draw_background(const Stage& stage);
  void draw_shadow(const Stage& stage, const std::shared_ptr<const ViewScene>& scene);
  void set_shadow(const ShaderProgram& program, const Stage& stage, bool on) const;
  void use_lit(const Stage& stage, const ViewFrame& frame, const SceneList& scene, bool shadowed, bool glass);
  int draw_lit(const InstanceBatches& batches, bool draft);
  void use_outline(const Stage& stage, const ViewFrame& frame, Color ink, float width, float dash);
  void draw_outline(const Stage& stage, const ViewFrame& frame, std::span<const Instance> part, Color ink,
                    float width);
  void draw_drawn(const Stage& stage, const ViewFrame& frame, const SceneList& scene, const ViewScene& shown);
  void draw_floor(const Stage& stage, const ViewFrame& frame, bool shadowed);
  void draw_translucent(const Stage& stage, const ViewFrame& frame, const SceneList& scene,
                        std::span<const Instance> list, float push);
  void draw_loads(const Stage& stage, const ViewFrame& frame, const ViewScene& shown);
  void draw_triad(const Stage& stage, const ViewFrame& frame, const SceneList& scene);
};

void ViewRenderer::State::draw_background(const Stage& stage) {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  background.use();
  const Color &top = stage.colors->background_top, &bottom = stage.colors->background_bottom;
  background.set("top", top.r, top.g, top.b);
  background.set("bottom", bottom.r, bottom.g, bottom.b);
  glBindVertexArray(none.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  ++report.draw_calls;
  report.passes.push_back("background");
}

void ViewRenderer::State::draw_shadow(const Stage& stage, const std::shared_ptr<const ViewScene>& scene) {
  if (shaded == scene && shaded_from == stage.key) return;
  if (!shadow) shadow.emplace();
  shadow->begin(scene->solid.bounds, stage.key);
  const bool diagram = !scene->free_body.empty();
  casting.set(diagram ? scene->free_body : scene->solid.instances, shadow->units(), shadow->sight());
  depth.use();
  set_matrix(depth, "view_projection", shadow->matrix());
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  report.draw_calls += meshes.draw(casting);
  glDisable(GL_CULL_FACE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  report.passes.push_back("shadow");
  shaded = scene;
  shaded_from = stage.key;
}

void ViewRenderer::State::set_shadow(const ShaderProgram& program, const Stage& stage, bool on) const {
  program.set("shadow_map", 0);
  program.set("shadow_on", on ? 1.f : 0.f);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, on ? shadow->texture() : 0);
  if (!on) return;
  program.set("shadow_texel", 1.f / ShadowMap::size);
  set_matrix(program, "shadow_matrix", shadow->lookup_matrix(stage.units));
}

void ViewRenderer::State::use_lit(const Stage& stage, const ViewFrame& frame, const SceneList& scene,
                                  bool shadowed, bool glass) {
  lit.use();
  set_matrix(lit, "view_projection", stage.view_projection);
  set_vector(lit, "eye", stage.camera.eye());
  set_vector(lit, "backward", stage.camera.backward());
  lit.set("perspective", stage.camera.orthographic ? 0.f : 1.f);
  set_vector(lit, "up", stage.up);
  set_vector(lit, "key", stage.key);
  lit.set("stripe", float(0.72 * scene.scale.unit / stage.units.length));
  lit.set("normal_bias", shadowed ? float(1.6 * shadow->texel() / stage.units.length) : 0.f);
  lit.set("lightness", frame.theme == Theme::light ? 1.f : 0.f);
  lit.set("glass", glass ? 1.f : 0.f);
  set_shadow(lit, stage, shadowed);
}

// Specks are not worth many looks at the shadow.
int ViewRenderer::State::draw_lit(const InstanceBatches& batches, bool draft) {
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  lit.set("shadow_taps", draft ? 2 : 4);
  int calls = meshes.draw(batches, last_flat_detail + 1);
  lit.set("shadow_taps", 1);
  calls += meshes.draw(batches, 0, last_flat_detail);
  glDisable(GL_CULL_FACE);
  return calls;
}

// `dash`: points from one dash to the next; 0 for a line without gaps.
void ViewRenderer::State::use_outline(const Stage& stage, const ViewFrame& frame, Color ink, float width,
                                      float dash) {
  outline.use();
  set_matrix(outline, "view_projection", stage.view_projection);
  set_vector(outline, "eye", stage.camera.eye());
  outline.set("perspective", stage.camera.orthographic ? 0.f : 1.f);
  outline.set("pixel", float(stage.camera.pixel_size(stage.size)));
  outline.set("width", width * frame.options.scale);
  outline.set("viewport", float(stage.size.width), float(stage.size.height));
  outline.set("dash", dash * frame.options.scale);
  set_color(outline, "ink", ink);
}

void ViewRenderer::State::draw_outline(const Stage& stage, const ViewFrame& frame,
                                       std::span<const Instance> part, Color ink, float width) {
  if (part.empty()) return;
  constexpr std::size_t many = 2000;
  marked.set(part, stage.units, stage.sight, part.size() > many);
  use_outline(stage, frame, ink, width, 0);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  report.draw_calls += meshes.draw(marked, last_flat_detail + 1);
  glDisable(GL_CULL_FACE);
  report.draw_calls += meshes.draw(marked, 0, last_flat_detail); // specks are covered with the colour
  if (report.passes.back() != "outline") report.passes.push_back("outline");
}

// The drawn pose as a dashed outline. Where nothing else is drawn of it, its depth alone tells what of the
// outline is hidden.
void ViewRenderer::State::draw_drawn(const Stage& stage, const ViewFrame& frame, const SceneList& scene,
                                     const ViewScene& shown) {
  constexpr float width = 1.4f, dash = 9; // points
  constexpr float speck = 0.35f;          // alpha of what is too small for an outline
  translucent.set(shown.drawn, stage.units, stage.sight);
  if (!shown.drawn_is_solid) {
    use_lit(stage, frame, scene, false, true);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 4);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    report.draw_calls += draw_lit(translucent, frame.options.draft);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_POLYGON_OFFSET_FILL);
  }
  use_outline(stage, frame, stage.colors->drawn, width, dash);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  report.draw_calls += meshes.draw(translucent, last_flat_detail + 1);
  glDisable(GL_CULL_FACE);
  Color faint = stage.colors->drawn;
  faint.a = speck;
  use_outline(stage, frame, faint, 0, 0);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  if (!shown.drawn_is_solid) {
    glDepthFunc(GL_LEQUAL);
    report.draw_calls += meshes.draw(translucent, 0, last_flat_detail);
    glDepthFunc(GL_LESS);
  }
  glDisable(GL_BLEND);
  report.passes.push_back("drawn");
}

void ViewRenderer::State::draw_floor(const Stage& stage, const ViewFrame& frame, bool shadowed) {
  const Vec3 center = stage.floor_center();
  ViewCamera front = stage.camera;
  front.azimuth = 0;
  const Vec3 a = front.right(), b = stage.up.cross(a);
  const double metres = stage.units.length;
  // A cell of the fine grid is about a twentieth of what is in view.
  const double level = std::log10(0.045 * metres);
  const double cell = std::pow(10.0, std::floor(level));
  const Vec3 world = center * metres + stage.units.origin;
  const auto phase = [&](const Vec3& side) { return float(std::fmod(world.dot(side), 100 * cell) / metres); };

  floor.use();
  set_matrix(floor, "view_projection", stage.view_projection);
  set_vector(floor, "center", center);
  set_vector(floor, "side_a", a);
  set_vector(floor, "side_b", b);
  floor.set("reach", float(stage.floor_reach));
  floor.set("origin", phase(a), phase(b));
  floor.set("cell", float(cell / metres));
  floor.set("fading", float(level - std::floor(level)));
  floor.set("weight", frame.options.scale);
  floor.set("shade", frame.theme == Theme::light ? 0.30f : 0.45f);
  floor.set("lines", frame.options.grid ? 1.f : 0.f);
  floor.set("above", stage.camera.elevation >= 0 ? 1.f : 0.f);
  set_color(floor, "ink", stage.colors->grid);
  set_shadow(floor, stage, shadowed);
  floor.set("shadow_taps", frame.options.draft ? 2 : 4);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glBindVertexArray(none.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  ++report.draw_calls;
  report.passes.push_back("grid");
}

void ViewRenderer::State::draw_translucent(const Stage& stage, const ViewFrame& frame, const SceneList& scene,
                                           std::span<const Instance> list, float push) {
  translucent.set(list, stage.units, stage.sight);
  use_lit(stage, frame, scene, false, true);
  // Only the nearest surface is blended: depth first, then colour where the depth is the same. Pushed back a
  // little, so that it does not flicker through solids it coincides with.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(push, 4 * push);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  report.draw_calls += draw_lit(translucent, frame.options.draft);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  report.draw_calls += draw_lit(translucent, frame.options.draft);
  glDisable(GL_BLEND);
  glDepthFunc(GL_LESS);
  glDisable(GL_POLYGON_OFFSET_FILL);
  report.instances += static_cast<int>(list.size());
  report.drawn += translucent.count();
}

// Arrows are seen through the solids before them, faintly; glass is drawn over them later.
void ViewRenderer::State::draw_loads(const Stage& stage, const ViewFrame& frame, const ViewScene& shown) {
  constexpr float hidden = 0.3f; // alpha
  std::vector<Instance> faint = shown.arrows.solids;
  for (Instance& instance : faint)
    instance.color.a = hidden;
  translucent.set(faint, stage.units, stage.sight, false);
  use_lit(stage, frame, shown.solid, false, true);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  report.draw_calls += draw_lit(translucent, frame.options.draft);
  glDisable(GL_BLEND);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  marked.set(shown.arrows.solids, stage.units, stage.sight, false);
  use_lit(stage, frame, shown.solid, false, false);
  report.draw_calls += draw_lit(marked, frame.options.draft);
  report.passes.push_back("loads");
}

void ViewRenderer::State::draw_triad(const Stage& stage, const ViewFrame& frame, const SceneList& scene) {
  const auto side = static_cast<int>(76 * frame.options.scale);
  const auto gap = static_cast<int>(10 * frame.options.scale);
  if (stage.size.width < 4 * side || stage.size.height < 4 * side) return;
  glViewport(gap, gap, side, side);
  glScissor(gap, gap, side, side);
  glEnable(GL_SCISSOR_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  Stage corner = stage;
  corner.camera.orthographic = true;
  corner.camera.field_of_view = 2 * std::atan(1.2);
  corner.view_projection =
      corner.camera.projection_matrix({1, 1}, Vec3::Zero(), 2) * corner.camera.view_matrix();
  Sight sight = sight_of(corner.camera, {double(side), double(side)});
  sight.pixel /= 16; // a handful of solids that are always there: as smooth as can be
  axes.set(triad(*stage.colors, frame.mechanism), ViewUnits{}, sight);
  use_lit(corner, frame, scene, false, false);
  report.draw_calls += draw_lit(axes, frame.options.draft);
  report.passes.push_back("triad");
}

ViewRenderer::ViewRenderer() : state_(std::make_unique<State>()) {}
ViewRenderer::~ViewRenderer() = default;
ViewRenderer::ViewRenderer(ViewRenderer&&) noexcept = default;
ViewRenderer& ViewRenderer::operator=(ViewRenderer&&) noexcept = default;

ViewReport ViewRenderer::draw(const ViewFrame& frame, Framebuffer& target) {
  return draw(frame, std::make_shared<const ViewScene>(view_scene(frame)), target);
}

ViewReport ViewRenderer::draw(const ViewFrame& frame, const std::shared_ptr<const ViewScene>& shown,
                              Framebuffer& target) {
  State& s = *state_;
  s.report = {};
  const SceneList& scene = shown->solid;
  const Stage stage(frame, scene, target);
  const bool diagram = !shown->free_body.empty() || !shown->others.empty();
  s.solids.set(diagram ? shown->free_body : scene.instances, stage.units, stage.sight);
  s.report.instances = static_cast<int>(scene.instances.size());
  s.report.drawn = s.solids.count();
  const bool floor = (frame.options.grid || frame.options.shadow) && stage.floor_in_view(stage.camera.eye());
  const bool shadowed = frame.options.shadow && floor && !scene.instances.empty();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glDepthFunc(GL_LESS);
  if (shadowed) s.draw_shadow(stage, shown);

  target.bind();
  glDepthMask(GL_TRUE);
  glClear(GL_DEPTH_BUFFER_BIT);
  s.draw_background(stage);
  glEnable(GL_DEPTH_TEST);
  if (s.solids.count() > 0) {
    s.use_lit(stage, frame, scene, shadowed, false);
    s.report.draw_calls += s.draw_lit(s.solids, frame.options.draft);
    s.report.passes.push_back("solid");
    if (std::ranges::find(frame.selected, frame.hovered) == frame.selected.end())
      s.draw_outline(stage, frame, of_parts(scene, {frame.hovered}),
                     mix(stage.colors->accent, stage.colors->slack, 0.5f), 1.5f);
    s.draw_outline(stage, frame, of_parts(scene, frame.selected), stage.colors->accent, 2.5f);
  }
  if (floor) s.draw_floor(stage, frame, shadowed);
  if (!shown->arrows.solids.empty()) s.draw_loads(stage, frame, *shown);
  if (!shown->others.empty()) {
    s.draw_translucent(stage, frame, scene, shown->others, 1);
    s.report.passes.push_back("others");
  }
  if (!shown->motion.empty()) {
    s.draw_translucent(stage, frame, scene, shown->motion, 1);
    s.report.passes.push_back("motion");
  }
  if (!shown->ghost.empty()) {
    s.draw_translucent(stage, frame, scene, shown->ghost, 2);
    s.report.passes.push_back("ghost");
  }
  if (!shown->drawn.empty()) s.draw_drawn(stage, frame, scene, *shown);
  if (frame.options.triad) s.draw_triad(stage, frame, scene);
  glDisable(GL_DEPTH_TEST);
  check_gl("drawing the view");
  target.resolve();
  return s.report;
}

} // namespace flyball
