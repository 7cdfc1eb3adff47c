// Pictures that OpenGL draws into, of sizes it has and sizes it does not have.
#include "app/render/framebuffer.hpp"
#include "app/render/offscreen.hpp"
#include "tests/catch.hpp"

using namespace flyball;

TEST_CASE("a picture that is too large for OpenGL is made smaller, in the same shape") {
  const OffscreenContext context;
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  const Framebuffer usual = largest_framebuffer(320, 200, 4);
  CHECK(usual.width() == 320);
  CHECK(usual.height() == 200);
  CHECK_FALSE(usual.short_of_samples());
  CHECK_THROWS_AS(Framebuffer(2 * most, 64, 1), GlError);
  const Framebuffer wide = largest_framebuffer(2 * most, 64, 1);
  CHECK(wide.width() == most);
  CHECK(wide.height() == 32);
  const Framebuffer none = largest_framebuffer(0, 0, 4);
  CHECK(none.width() == 1);
  CHECK(none.height() == 1);
}

TEST_CASE("a picture that has no memory for all samples has fewer") {
  const OffscreenContext context;
  // A row more than a display of 7680 x 4320, whose four samples are all that is taken.
  const Framebuffer large(7680, 4321, 4);
  CHECK(large.samples() < 4);
  CHECK(large.short_of_samples());
  CHECK(large.width() == 7680);
}
