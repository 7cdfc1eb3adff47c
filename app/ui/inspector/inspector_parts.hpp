// The inspector's contents, one function a kind of thing.
#pragma once

#include "app/ui/app.hpp"

namespace flyball {

void scene_inspector(App& app);
void body_inspector(App& app, const Body& body);
void joint_inspector(App& app, const Joint& joint);
void force_inspector(App& app, const Force& force);
void several_inspector(App& app);

// Parts of them.
void named_sections(App& app);
void measures_section(App& app);
void mass_section(App& app, const Body& body);
void rotation_section(App& app, const Body& body);
void shapes_section(App& app, const Body& body);
void coordinate_sections(App& app, const Joint& joint);
void distance_rows(App& app, const Joint& joint);
void gear_rows(App& app, const Joint& joint);

// Whether mass, mass centre and inertia are those of the body's shapes as a solid of one density.
bool is_uniform_solid(const Body& body);
// Whether they are to stay so when the mass or a size changes.
bool follows_shapes(const App& app, const Body& body);
// A shape of another type of about the same place and size.
Shape shape_as(const Shape& shape, ShapeType type, const Body& body);

// Another type for a joint: coordinates of the same kind keep what acts on them, gears and sliders follow.
// For every type but gears.
void change_joint_type(Mechanism& mechanism, const std::string& joint, JointType type);
// "Angle", "Slide", "x", ...
const char* coordinate_title(JointType type, int i);

} // namespace flyball
