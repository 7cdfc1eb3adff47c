// A cube in the corner of the view that stands as the mechanism does: its faces, edges and corners are the
// directions to look from, and dragging it turns the view. The world's axes are drawn at it.
#pragma once

#include "app/viewport/camera.hpp"

#include <array>
#include <optional>

namespace flyball {

struct PanelRect;
struct Session;
struct Ui;
struct ViewState;

// Where to look from: right, up and front of the mechanism, each -1, 0 or 1.
using CubeDirection = std::array<int, 3>;

struct ViewCubeState {
  std::optional<CubeDirection> hovered;
};

// Of the cube as the camera sees it, at a point given in half edges of the cube from its middle, to the right
// and up; nothing beside it.
std::optional<CubeDirection> cube_direction_at(const ViewCamera& camera, double right, double up);
// Azimuth and elevation (rad). From straight above and below the azimuth is the nearest quarter to the
// camera's.
std::array<double, 2> cube_angles(const CubeDirection& direction, double azimuth);

// Whether there is room for it.
bool has_view_cube(const Ui& ui, const ViewState& state, const PanelRect& view);
// Before the view's own button, of which it takes its part.
void use_view_cube(Ui& ui, ViewState& state, const PanelRect& view);
void draw_view_cube(const Session& session, const Ui& ui, const ViewState& state, const PanelRect& view);

} // namespace flyball
