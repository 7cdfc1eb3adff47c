// Plots as pictures in memory. Needs a current OpenGL context: the window's, between frames, or an
// OffscreenContext.
#pragma once

#include "app/plot/colors.hpp"
#include "app/ui/plots/plot_save.hpp"
#include "app/ui/stage.hpp"

namespace flyball {

struct PlotPictureOptions {
  PixelSize size{1600, 1040};
  float scale = 2; // pixels a point has
  PlotGround ground = PlotGround::light;
};

// Leaves ImGui's context and the bound framebuffer as they were. Throws GlError.
Image draw_plot_picture(const Plot& plot, const PlotPictureOptions& options, const PlotLook& look = {});

// As it was looked at: letters grow with the size.
Image plot_picture(const PlotSave& save, PixelSize size);

} // namespace flyball
