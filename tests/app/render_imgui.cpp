#include "app/render/fonts.hpp"
#include "app/render/framebuffer.hpp"
#include "app/render/icons.hpp"
#include "app/render/imgui_renderer.hpp"
#include "app/render/offscreen.hpp"
#include "tests/catch.hpp"

#include <memory>

using namespace flyball;

namespace {

struct ImGuiSession {
  std::unique_ptr<ImGuiContext, void (*)(ImGuiContext*)> context{ImGui::CreateContext(),
                                                                 ImGui::DestroyContext};
  ImGuiSession(float width, float height) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {width, height};
    io.DeltaTime = 1.f / 60;
  }
};

// The share of pixels that are not the background.
double inked(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      count += image.at(x, y)[0] > 90;
  return static_cast<double>(count) / (image.width * image.height);
}

Image draw_text(float scale, const char* text) {
  OffscreenContext gl;
  const auto width = static_cast<int>(160 * scale), height = static_cast<int>(60 * scale);
  ImGuiSession session(static_cast<float>(width), static_cast<float>(height));
  const UiFonts fonts = load_fonts(*ImGui::GetIO().Fonts, 15, scale);
  REQUIRE(fonts.text);
  ImGuiRenderer renderer;
  renderer.upload_fonts();
  Framebuffer target(width, height, 1);
  ImGui::NewFrame();
  ImGui::GetForegroundDrawList()->AddText(fonts.text, fonts.text->FontSize, {8 * scale, 8 * scale},
                                          0xFFFFFFFFu, text);
  ImGui::Render();
  target.bind();
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer.draw(*ImGui::GetDrawData());
  return target.read();
}

} // namespace

TEST_CASE("the interface's text is drawn off-screen, at both scales") {
  const double once = inked(draw_text(1, "Governor \u03B8 = 0.7856")),
               twice = inked(draw_text(2, "Governor \u03B8 = 0.7856"));
  CHECK(once > 0.03);
  CHECK(twice == Approx(once).epsilon(0.35));
  CHECK(inked(draw_text(1, "")) == 0);
}

TEST_CASE("fonts hold Greek, arrows and, where installed, icons") {
  ImFontAtlas atlas;
  const UiFonts fonts = load_fonts(atlas, 15, 1);
  atlas.Build();
  REQUIRE(fonts.text);
  REQUIRE(fonts.digits);
  if (!fonts.files.empty() && fonts.missing.empty()) {
    for (const ImWchar letter : std::initializer_list<ImWchar>{0x03B8, 0x03BB, 0x2192, 0x00B0, 0xF04B})
      CHECK(fonts.text->FindGlyphNoFallback(letter) != nullptr);
  }
  // Digits stand in columns.
  CHECK(fonts.digits->GetCharAdvance('1') == fonts.digits->GetCharAdvance('8'));
}
