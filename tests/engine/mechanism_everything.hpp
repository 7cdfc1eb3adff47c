// A scene in which every kind of object and key occurs, and the mistakes that can be made in it.
#pragma once

#include "tests/catch.hpp"

#include <string>
#include <string_view>

namespace flyball::test {

inline constexpr std::string_view everything = R"({
  "flyball": 2,
  "name": "Everything",
  "description": "all kinds of parts",
  "parameters": {
    "L": {"description": "reach", "value": 5, "unit": "m", "range": [0.5, 8]},
    "half": {"value": "=L/2", "unit": "m"}},
  "points": {"W": [0, 0, 8], "E": ["=L", "=W.y", 0.5]},
  "gravity": [0, -9.80665, 0],
  "air": {"description": "cold", "density": 1.5, "wind": [1, "=half / 1 s", 0]},
  "bodies": [
    {"name": "table", "description": "turns", "mass": 2, "position": [0, 0.5, 0], "inertia": [1, 1.5, 1],
     "rotation": [0.6, 0, 0.8, 0],
     "shapes": [
       {"type": "sphere", "description": "knob", "radius": 0.25, "at": [0, 1, 0], "color": [0.5, 0.25, 1]},
       {"type": "box", "size": [0.1, 0.2, 0.3]},
       {"type": "cylinder", "radius": 0.5, "from": [0, 0, 0], "to": [0, 0.1, 0]},
       {"type": "capsule", "radius": 0.6, "from": [0, 0, 1], "to": [0, 0, 2]}]},
    {"name": "arm", "mass": 1, "position": [1, 0, 0], "inertia": [0.5, 0.6, 0.7, 0.01, 0.02, 0.03]},
    {"name": "slider", "mass": 0, "position": [2, 0, 0]},
    {"name": "screw", "mass": 1, "position": [0, 0, 3]},
    {"name": "cross", "mass": 1, "position": [0, 0, 4]},
    {"name": "ball", "mass": 1, "position": [0, 0, 5]},
    {"name": "puck", "mass": 1, "position": [0, 0, 6]},
    {"name": "drone", "mass": 1, "position": [0, 0, 7]},
    {"name": "plate", "mass": "=2 kg * half / L", "position": "W"},
    {"name": "pinion", "density": 1000,
     "shapes": [{"type": "capsule", "radius": "=half / 10", "from": "E", "to": [0, 0, "=L + 4 m"]}]}
  ],
  "joints": [
    {"name": "spin", "type": "revolute", "bodies": ["ground", "table"], "at": [0, 0, 0], "axis": [0, 1, 0],
     "drive": {"description": "motor", "speed": 10}},
    {"name": "hinge", "description": "sprung", "type": "revolute", "bodies": ["table", "arm"], "at": [1, 1, 0],
     "axis": [0, 0, 2], "coordinate": 0.5, "spring": {"description": "coil", "stiffness": 300, "free": 0.1},
     "damping": 4, "stop": {"description": "rubber", "lower": -1, "upper": 1.25, "stiffness": 900},
     "friction": {"description": "dry", "mu": 0.125, "preload": 44, "radius": 0.0625, "share": -0.375}},
    {"name": "slide", "type": "prismatic", "bodies": ["arm", "slider"], "at": [2, 0, 0], "axis": [1, 0, 0],
     "cut": false},
    {"name": "thread", "type": "cylindrical", "bodies": ["table", "screw"], "at": [0, 0, 3], "axis": [0, 1, 1],
     "coordinate": [0.2, 0.3], "spring": [null, {"stiffness": 70}], "damping": [5, null],
     "stop": [null, {"upper": 3, "stiffness": 11}], "friction": [null, {"limit": "=L * 2 N/m"}],
     "drive": [{"speed": 6}, null]},
    {"name": "cardan", "type": "universal", "bodies": ["table", "cross"], "at": [0, 0, 4],
     "axes": [[1, 0, 0], [0, 1, 0]], "spring": [{"stiffness": 21}, {"stiffness": "=4 N * L"}]},
    {"name": "socket", "type": "spherical", "bodies": ["table", "ball"], "at": [0, 0, 5], "damping": [1, 2, 3]},
    {"name": "ice", "type": "planar", "bodies": ["table", "puck"], "at": [0, 0, 6], "axis": [0, 3, 0],
     "x_axis": [1, 0, 1], "drive": [null, null, {"speed": 7}]},
    {"name": "flight", "type": "free", "bodies": ["ground", "drone"], "at": [0, 0, 7],
     "drive": [{"speed": 8}, null, null, null, null, null]},
    {"name": "weld", "type": "fixed", "bodies": ["table", "plate"], "at": [0, 0, 8]},
    {"name": "axle", "type": "revolute", "bodies": ["table", "pinion"], "at": [0, 0, 9], "axis": [0, 1, 0]},
    {"name": "tie", "type": "distance", "bodies": ["arm", "ball"], "points": [[1, 0, 0], [0, 0, 5]], "length": 5.5},
    {"name": "teeth", "type": "gear", "joints": ["hinge", "axle"], "ratio": -2, "offset": 0.75},
    {"name": "worm", "type": "gear", "joints": ["hinge", "cardan.1"], "ratio": 3},
    {"name": "strap", "type": "gear", "kind": "belt", "joints": ["hinge", "cardan.0"], "radii": [0.75, 0.5],
     "crossed": true},
    {"name": "bar", "type": "gear", "kind": "rack", "joints": ["axle", "ice.0"], "radius": -0.125},
    {"name": "bolt", "type": "gear", "kind": "screw", "joints": ["cardan.0", "ice.1"], "lead": 0.0625}
  ],
  "forces": [
    {"name": "coil", "description": "holds", "type": "spring", "bodies": ["ground", "arm"],
     "points": [[0, 2, 0], [1, 1, 0]], "stiffness": 120, "free_length": 0.9, "damping": 1.5},
    {"name": "push", "type": "force", "body": "arm", "at": [1, 2, 3], "vector": [4, 5, 6], "frame": "body"},
    {"name": "turn", "type": "torque", "body": "arm", "vector": [7, 8, 9]},
    {"name": "air", "type": "drag", "body": "ball", "at": [0, 0, 5.5], "linear": 0.125, "quadratic": 0.375},
    {"name": "journal", "description": "oil", "type": "bearing", "bodies": ["ground", "drone"], "at": [0, 0, 7.5],
     "axis": [0, 0, 4], "x_axis": [1, 0, 0.5], "stiffness": [["=8 N / L", 17], [-17, 18]], "damping": [[3, 0], [0, 3]]},
    {"name": "sail", "type": "vane", "body": "puck", "at": [0, 0.5, 6], "area": "=L * 2 cm", "normal": [0, 1, 2],
     "chord": [1, 0, 0], "cn": 3, "cd": 0.0625},
    {"name": "wing", "type": "vane", "body": "puck", "area": 0.75, "normal": [0, 0, 3], "chord": [2, 0, 0],
     "lift": "=sin(2*incidence)*1.25", "drag": 0.125}
  ],
  "measures": {
    "gap": {"description": "between two", "value": "=distance(ball, drone) - half", "unit": "m"},
    "share": {"value": "=gap / L"}},
  "sliders": [
    {"parameter": "joints.spin.drive.speed", "description": "main", "range": [0, 30]},
    {"parameter": "joints.hinge.spring.stiffness", "range": [10, 1000], "scale": "log"}
  ],
  "simulation": {"description": "long", "duration": 20, "damped": false},
  "view": {"description": "side",
    "camera": {"description": "near", "target": [0, 1, 0], "distance": 4, "azimuth": 0.6, "elevation": 0.3}}
}
)";

// One edit of the text, and what the reader says to it.
struct Mistake {
  std::string_view find, replace; // `find` stands once in the text
  std::string_view where;
  std::string_view expected; // a part of what is said
};

inline std::string edited(std::string_view find, std::string_view replace) {
  std::string text(everything);
  const std::size_t place = text.find(find);
  INFO("edit of " << find);
  REQUIRE(place != std::string::npos);
  REQUIRE(text.find(find, place + 1) == std::string::npos);
  return text.replace(place, find.size(), replace);
}

// Mistakes in the form of the file, which the schema must find too.
inline constexpr Mistake mistakes_of_form[] = {
    // the version
    {R"("flyball": 2,)", "", "flyball", "missing"},
    {R"("flyball": 2)", R"("flyball": 3)", "flyball", "expected 1 or 2"},
    {R"("flyball": 2)", R"("flyball": "1")", "flyball", "found \"1\""},
    // parameters, points and expressions
    {R"("value": "=L/2", )", "", "parameters.half.value", "missing; a parameter needs it"},
    {R"("value": "=L/2")", R"("value": "L/2")", "parameters.half.value", "expected a number, found \"L/2\""},
    {R"("range": [0.5, 8])", R"("range": ["=L", 8])", "parameters.L.range[0]",
     "expected a number, found \"=L\""},
    {R"("half": {)", R"("a half": {)", "parameters.a half", "expected a name of letters"},
    {R"("W": [0, 0, 8])", R"("W": [0, 0])", "points.W", "three numbers"},
    {R"("value": "=gap / L")", "", "measures.share.value", "missing; a measure needs it"},
    {R"("value": "=gap / L")", R"("value": 3)", "measures.share.value", "an expression of results"},
    {R"("value": "=gap / L")", R"("value": "gap / L")", "measures.share.value", "an expression of results"},
    {R"("value": "=gap / L")", R"("value": "=gap / L", "range": [0, 1])", "measures.share.range",
     "unknown key of a measure"},
    {R"("share": {)", R"("a share": {)", "measures.a share", "expected a name of letters"},
    {R"("at": [0, 0, 9])", R"("at": "a hole")", "joints.axle.at", "expected the name of a point or three"},
    {R"("color": [0.5, 0.25, 1])", R"("color": [0.5, "=half", 1])", "bodies.table.shapes[0].color[1]",
     "expected a number, found \"=half\""},
    {R"("density": 1000)", R"("density": 1000, "mass": 1)", "bodies.pinion.mass", "follows from the density"},
    // what stands in the place of something else
    {R"("cn": 3,)", R"("lift": 1,)", "forces.sail.cd", "expected none beside `lift` and `drag`"},
    {R"("chord": [2, 0, 0],)", "", "forces.wing.chord", "missing; `lift` and `drag` need it"},
    {R"("damping": 1.5})", R"("damping": 1.5, "damping_force": "=3 N s/m*rate"})", "forces.coil.damping",
     "expected none beside `damping_force`"},
    {R"("damping": [[3, 0], [0, 3]])",
     R"("damping": [[1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0],
                    [1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0]])",
     "forces.journal.damping", "as many rows as `stiffness`"},
    // unknown keys, at every level
    {R"("gravity")", R"("gravitation")", "gravitation", "unknown key of a scene"},
    {R"("gravity")", R"("Gravity")", "Gravity", "did you mean \"gravity\"?"},
    {R"("mass": 2)", R"("mas": 2)", "bodies.table.mas", "did you mean \"mass\"?"},
    {R"("radius": 0.25)", R"("radius": 0.25, "raduis": 1)", "bodies.table.shapes[0].raduis", "\"radius\""},
    {R"("damping": 4)", R"("dampening": 4)", "joints.hinge.dampening", "did you mean \"damping\"?"},
    {R"("stiffness": 300)", R"("stiffness": 300, "rest": 1)", "joints.hinge.spring.rest",
     "its keys are force, stiffness, free and description"},
    {R"("upper": 3)", R"("uper": 3)", "joints.thread.stop[1].uper", "\"upper\""},
    {R"("speed": 10)", R"("speed": 10, "unit": "rpm")", "joints.spin.drive.unit", "unknown key of a drive"},
    {R"("vector": [7, 8, 9])", R"("vector": [7, 8, 9], "fram": "world")", "forces.turn.fram", "\"frame\""},
    {R"("scale": "log")", R"("log": true)", "sliders[1].log", "unknown key of a slider"},
    {R"("damped": false)", R"("dampd": false)", "simulation.dampd", "\"damped\""},
    {R"("distance": 4)", R"("distance": 4, "zoom": 2)", "view.camera.zoom", "unknown key of a camera"},
    {R"("view": {)", R"("view": {"light": 1, )", "view.light", "unknown key of a view"},
    // keys of another type
    {R"("damping": [1, 2, 3])", R"("axis": [1, 0, 0])", "joints.socket.axis",
     "does not belong to a spherical joint"},
    {R"("length": 5.5)", R"("drive": {"speed": 1})", "joints.tie.drive",
     "does not belong to a distance joint"},
    {R"("offset": 0.75)", R"("bodies": ["arm", "ball"])", "joints.teeth.bodies",
     "does not belong to a gear joint"},
    {R"("at": [0, 0, 8])", R"("at": [0, 0, 8], "damping": 1)", "joints.weld.damping",
     "does not belong to a fixed joint"},
    {R"("quadratic": 0.375)", R"("vector": [1, 0, 0])", "forces.air.vector", "does not belong to a drag"},
    {R"("size": [0.1, 0.2, 0.3])", R"("size": [0.1, 0.2, 0.3], "radius": 1)", "bodies.table.shapes[1].radius",
     "does not belong to a box"},
    {R"("lead": 0.0625)", R"("lead": 0.0625, "radius": 1)", "joints.bolt.radius",
     "does not belong to a screw"},
    {R"("wind": [1,)", R"("winds": [1,)", "air.winds", "did you mean \"wind\"?"},
    // missing keys
    {R"("radii": [0.75, 0.5],)", "", "joints.strap.radii", "missing; a belt needs it"},
    {R"("kind": "rack")", R"("kind": "rock")", "joints.bar.kind", "did you mean \"rack\"?"},
    {R"("name": "Everything",)", "", "name", "missing; a scene needs it"},
    {R"("mass": 2, )", "", "bodies.table.mass", "missing; a body needs it, or a density: a number"},
    {R"("name": "slider", )", "", "bodies[2].name", "missing"},
    {R"("axis": [0, 0, 2], )", "", "joints.hinge.axis", "missing; a revolute joint needs it: a direction"},
    {R"("type": "fixed", )", "", "joints.weld.type", "missing; a joint needs it: revolute, prismatic"},
    {R"("name": "weld", "type": "fixed", )", "", "joints[8].type", "missing"},
    {R"("x_axis": [1, 0, 1], )", "", "joints.ice.x_axis", "missing; a planar joint"},
    {R"("ratio": 3)", R"("offset": 3)", "joints.worm.ratio", "missing"},
    {R"("stiffness": 300, )", "", "joints.hinge.spring.stiffness", "missing"},
    {R"("upper": 3, )", "", "joints.thread.stop[1]", "expected lower, upper or both"},
    {R"("body": "ball", )", "", "forces.air.body", "missing; a drag needs it"},
    {R"(, "range": [10, 1000])", "", "sliders[1].range", "missing"},
    {R"("distance": 4, )", "", "view.camera.distance", "missing"},
    {R"("radius": 0.25, )", "", "bodies.table.shapes[0].radius", "missing; a sphere needs it"},
    // wrong types
    {R"("name": "Everything")", R"("name": 3)", "name", "expected a text, found 3"},
    {R"("description": "all kinds of parts")", R"("description": ["a"])", "description",
     "expected a text, found an array of 1 element"},
    {R"("mass": 2)", R"("mass": "2")", "bodies.table.mass", "expected a number, found \"2\""},
    {R"("mass": 2)", R"("mass": null)", "bodies.table.mass", "expected a number, found null"},
    {R"("mass": 2)", R"("mass": true)", "bodies.table.mass", "expected a number, found true"},
    {R"("position": [1, 0, 0])", R"("position": [1, "0", 0])", "bodies.arm.position[1]",
     "expected a number, found \"0\""},
    {R"("position": [1, 0, 0])", R"("position": {"x": 1})", "bodies.arm.position", "found an object"},
    {R"("drive": {"description": "motor", "speed": 10})", R"("drive": 10)", "joints.spin.drive",
     "expected an object, found 10"},
    {R"("drive": {"description": "motor", "speed": 10})", R"("drive": null)", "joints.spin.drive",
     "expected an object, found null"},
    {R"("cut": false)", R"("cut": "no")", "joints.slide.cut", "expected true or false"},
    {R"("damping": 4)", R"("damping": [4])", "joints.hinge.damping", "expected a number, found an array"},
    {R"("damping": [5, null])", R"("damping": 5)", "joints.thread.damping", "an array of 2 elements"},
    {R"("damping": [5, null])", R"("damping": [5, {}])", "joints.thread.damping[1]", "expected a number"},
    {R"("duration": 20)", R"("duration": [20])", "simulation.duration", "expected a number"},
    {R"("simulation": {"description": "long", "duration": 20, "damped": false})", R"("simulation": 20)",
     "simulation", "expected an object"},
    {R"({"name": "screw", "mass": 1, "position": [0, 0, 3]})", R"("screw")", "bodies[3]",
     "expected an object"},
    {R"({"type": "box", "size": [0.1, 0.2, 0.3]})", R"("box")", "bodies.table.shapes[1]",
     "expected an object"},
    // lengths of arrays
    {R"("gravity": [0, -9.80665, 0])", R"("gravity": [0, -9.80665])", "gravity",
     "expected three numbers [x, y, z], found an array of 2 elements"},
    {R"("inertia": [1, 1.5, 1])", R"("inertia": [1, 1.5, 1, 0])", "bodies.table.inertia", "or six"},
    {R"("rotation": [0.6, 0, 0.8, 0])", R"("rotation": [0.6, 0, 0.8])", "bodies.table.rotation",
     "four numbers"},
    {R"("bodies": ["table", "arm"])", R"("bodies": ["arm"])", "joints.hinge.bodies",
     "two names [parent, child]"},
    {R"("points": [[1, 0, 0], [0, 0, 5]])", R"("points": [[1, 0, 0]])", "joints.tie.points", "two points"},
    {R"("axes": [[1, 0, 0], [0, 1, 0]])", R"("axes": [[1, 0, 0], [0, 1]])", "joints.cardan.axes[1]",
     "three numbers"},
    {R"("coordinate": [0.2, 0.3])", R"("coordinate": [0.2])", "joints.thread.coordinate",
     "2 elements, one for each coordinate of a cylindrical joint"},
    {R"("range": [0, 30])", R"("range": [0, 30, 1])", "sliders[0].range", "two numbers [from, to]"},
    {R"("color": [0.5, 0.25, 1])", R"("color": [0.5, 0.25])", "bodies.table.shapes[0].color",
     "three numbers"},
    // words
    {R"("type": "planar")", R"("type": "plannar")", "joints.ice.type",
     "expected revolute, prismatic, cylindrical, universal, spherical, planar, free, fixed, distance or "
     "gear, found "
     "\"plannar\"; did you mean \"planar\"?"},
    {R"("type": "planar")", R"("type": 5)", "joints.ice.type", "found 5"},
    {R"("type": "drag")", R"("type": "wind")", "forces.air.type",
     "expected spring, force, torque, drag, vane or bearing"},
    {R"("type": "box")", R"("type": "cube")", "bodies.table.shapes[1].type",
     "expected sphere, box, cylinder or capsule"},
    {R"("frame": "body")", R"("frame": "Body")", "forces.push.frame", "did you mean \"body\"?"},
    {R"("scale": "log")", R"("scale": "ln")", "sliders[1].scale", "expected linear or log, found \"ln\""},
};

} // namespace flyball::test
