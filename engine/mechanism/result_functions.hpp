// What measures may ask of results, by name: "x(ball@A)", "torque(spin)".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace flyball {

// World axes at the drawn phase of the drives throughout. "along" is positive as the coordinate.
enum class Result : std::uint8_t {
  coordinate,   // rad or m, as the joint labels it
  rate,         // rad/s or m/s: in a steady state of what is driven the speed, else zero
  x,            // m
  y,            //
  z,            //
  vx,           // m/s
  vy,           //
  vz,           //
  ax,           // m/s^2
  ay,           //
  az,           //
  speed,        // m/s, of a point
  acceleration, // m/s^2, its size
  distance,     // m, between two points
  angle,        // rad, from 0 to pi, at the second of three points between the other two
  length,       // m, of a spring between two points
  tension,      // N, of a spring between two points and its damper: positive where it pulls
  force_x,      // N, of a spring between two points or a bearing, on its second body
  force_y,      //
  force_z,      //
  force,        // N, its size
  couple_x,     // N m, of a bearing on its second body, about its point
  couple_y,     //
  couple_z,     //
  couple,       // N m, its size
  spring,       // N m or N, by a coordinate's spring, along the coordinate
  reaction_x,   // N, of the parent on the child of a joint, as Reaction::force
  reaction_y,   //
  reaction_z,   //
  reaction,     // N, its size
  moment_x,     // N m, as Reaction::torque
  moment_y,     //
  moment_z,     //
  moment,       // N m, its size
  torque,       // N m or N, by the drive of a coordinate, along it
  power,        // W, of that drive
  clearance,    // rad or m, of a coordinate to its nearer stop; m, between the shapes of two bodies
  mass,         // kg, of a body or of all
};

// What the arguments of a function name.
enum class ArgumentKind {
  coordinate, // of a joint: "slide", "ball.1"
  joint,
  force,
  body,
  point, // carried by a body: its mass centre "ball", or "ball@A" where the named point A is drawn
};

struct ResultFunction {
  std::string_view name;
  Result result;
  ArgumentKind kind;
  int fewest, most; // arguments
  std::string_view example;
};

// Where a name is that of a joint which the program made itself, "ball.free": that it is none of the scene's.
inline constexpr std::string_view implicit_joint = ".free";
inline constexpr std::string_view implicit_joint_hint =
    "the joint that holds a body on springs, strings and bearings is the program's own; a joint of the type "
    "free between the same two bodies, under a name of its own, makes its coordinates known";

std::span<const ResultFunction> result_functions();
const ResultFunction& result_function(Result result);
// Of so many arguments: clearance() takes a coordinate or two bodies.
ArgumentKind argument_kind(const ResultFunction& function, std::size_t arguments);
// "the coordinate of a joint".
std::string_view noun(ArgumentKind kind);

// A part's name as an argument: in quotes where it is no word.
std::string argument_text(std::string_view name);
// A coordinate's label as an argument: "slide", "ball.1", of which the joint's name is quoted.
std::string coordinate_argument(std::string_view label);

} // namespace flyball
