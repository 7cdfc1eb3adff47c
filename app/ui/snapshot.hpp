// Pictures for a file: the 3-D view alone, or the whole interface, at any size.
#pragma once

#include "app/ui/stage.hpp"

namespace flyball {

// The view from where the camera stands, in app.theme, anti-aliased as app.view says.
Image view_picture(App& app, PixelSize size);
// The same with the legend and the values that are written over it, where loads are shown: with letters for
// `scale` pixels a point.
Image view_picture(App& app, PixelSize size, float scale);
// The interface as a window of that size would show it, `scale` pixels a point.
Image interface_picture(App& app, PixelSize size, float scale);

// Carries out app.export_request and says in app.notice how it went. `window` is the window's size.
void export_picture(App& app, PixelSize window);

} // namespace flyball
