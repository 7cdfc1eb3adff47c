// The inspector's contents, one function a kind of thing.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/inspector/inspector_state.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/ui.hpp"

namespace flyball {

class CommandRunner;

void scene_inspector(Session& session, Ui& ui, ToolState& tool);
void body_inspector(Session& session, Ui& ui, InspectorState& inspector, ToolState& tool, const Body& body);
void joint_inspector(Session& session, Ui& ui, const Joint& joint);
void force_inspector(Session& session, Ui& ui, const Force& force);
// The inspector of the last one picked, for all of its kind and type.
void several_inspector(Session& session, Ui& ui, InspectorState& inspector, ToolState& tool,
                       const CommandRunner& commands);
// "3 prismatic joints", of the type of this part.
std::string several_words(const Mechanism& mechanism, PartId part, std::size_t count);

// Parts of them.
void named_sections(Session& session, Ui& ui, ToolState& tool);
void measures_section(Session& session, Ui& ui);
void mass_section(Session& session, Ui& ui, InspectorState& inspector, const Body& body);
void rotation_section(Session& session, Ui& ui, InspectorState& inspector, const ToolState& tool,
                      const Body& body);
void shapes_section(Session& session, Ui& ui, InspectorState& inspector, const Body& body);
void coordinate_sections(Session& session, Ui& ui, const Joint& joint);
void distance_rows(Session& session, Ui& ui, const Joint& joint);
void gear_rows(Session& session, Ui& ui, const Joint& joint);
// A button that gives a body in elastic bearings a drive; nothing where it cannot have one.
void bearing_drive_row(Session& session, Ui& ui, const std::string& body);

// Whether mass, mass centre and inertia are those of the body's shapes as a solid of one density.
bool is_uniform_solid(const Body& body);
// Whether they are to stay so when the mass or a size changes.
bool follows_shapes(const InspectorState& inspector, const Body& body);
// Another mass, with the inertia of a solid where it follows its shapes.
void give_mass(const InspectorState& inspector, Body& body, double mass);
// A shape of another type of about the same place and size.
Shape shape_as(const Shape& shape, ShapeType type, const Body& body);

// Another type for a joint: coordinates of the same kind keep what acts on them, gears and sliders follow.
// For every type but gears.
void change_joint_type(Mechanism& mechanism, const std::string& joint, JointType type);
// "Angle", "Slide", "x", ...
const char* coordinate_title(JointType type, int i);

} // namespace flyball
