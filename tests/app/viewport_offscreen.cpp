// Pictures without a display: whichever library makes the context, they agree.
#include "app/render/compare.hpp"
#include "app/render/offscreen.hpp"
#include "app/viewport/view_renderer.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <cstdlib>
#include <optional>

using namespace flyball;
using namespace flyball::test;

namespace {

struct Drawn {
  Image image;
  std::string by;
};

// Nothing where the library is not there.
std::optional<OffscreenContext> context_by(OffscreenLibrary library) {
  try {
    return OffscreenContext(library);
  } catch (const GlError& error) {
    WARN("skipped: " << error.what());
    return std::nullopt;
  }
}

// The governor.
std::optional<Drawn> draw(OffscreenLibrary library) {
  const std::optional<OffscreenContext> context = context_by(library);
  if (!context) return std::nullopt;
  const Mechanism mechanism = shipped("governor");
  ViewFrame frame;
  frame.mechanism = &mechanism;
  frame.camera.fit(scene_of(frame).bounds, {640, 400});
  ViewRenderer renderer;
  Framebuffer target(640, 400, 4);
  renderer.draw(frame, target);
  return Drawn{target.read(), context->description()};
}

} // namespace

TEST_CASE("OffscreenContext: pictures by OSMesa and by EGL agree") {
  const std::optional<Drawn> osmesa = draw(OffscreenLibrary::osmesa), egl = draw(OffscreenLibrary::egl);
  if (osmesa) CHECK(osmesa->by.starts_with("OSMesa, "));
  if (egl) CHECK(egl->by.starts_with("EGL, "));
  REQUIRE((osmesa || egl)); // the program cannot draw without a display
  if (!osmesa || !egl) return;
  const ImageComparison comparison = compare(osmesa->image, egl->image);
  INFO(osmesa->by << " and " << egl->by << ": " << comparison.message);
  CHECK(comparison.same);
  const Image empty(640, 400);
  CHECK_FALSE(compare(osmesa->image, empty).same);
}

TEST_CASE("OffscreenContext: contexts of both libraries follow each other") {
  for (int i = 0; i < 2; ++i)
    for (const OffscreenLibrary library : {OffscreenLibrary::osmesa, OffscreenLibrary::egl}) {
      const auto drawn = draw(library);
      if (drawn) CHECK(drawn->image.width == 640);
    }
}

TEST_CASE("OffscreenContext: the end of one leaves the next one current") {
  for (const OffscreenLibrary library : {OffscreenLibrary::osmesa, OffscreenLibrary::egl}) {
    std::optional<OffscreenContext> context = context_by(library);
    if (!context) continue;
    *context = OffscreenContext(library);
    CHECK(glGetString(GL_VERSION) != nullptr);
    const Framebuffer target(8, 8, 1);
    CHECK_NOTHROW(check_gl("making a framebuffer"));
  }
}

TEST_CASE("OffscreenContext: the environment chooses the library, a wrong word is named") {
  setenv("FLYBALL_OFFSCREEN", "glx", 1);
  try {
    const OffscreenContext context;
    FAIL("taken");
  } catch (const GlError& error) {
    CHECK(std::string(error.what()) == "FLYBALL_OFFSCREEN: expected osmesa or egl, found \"glx\"");
  }
  unsetenv("FLYBALL_OFFSCREEN");
}
