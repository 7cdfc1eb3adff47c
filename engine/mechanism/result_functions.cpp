#include "engine/mechanism/result_functions.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace flyball {
namespace {

using enum ArgumentKind;

// In the order of Result.
constexpr std::array result_list{
    ResultFunction{"coordinate", Result::coordinate, coordinate, 1, 1, "coordinate(slide)"},
    ResultFunction{"rate", Result::rate, coordinate, 1, 1, "rate(spin)"},
    ResultFunction{"x", Result::x, point, 1, 1, "x(ball)"},
    ResultFunction{"y", Result::y, point, 1, 1, "y(ball@A)"},
    ResultFunction{"z", Result::z, point, 1, 1, "z(ball)"},
    ResultFunction{"vx", Result::vx, point, 1, 1, "vx(ball)"},
    ResultFunction{"vy", Result::vy, point, 1, 1, "vy(ball)"},
    ResultFunction{"vz", Result::vz, point, 1, 1, "vz(ball)"},
    ResultFunction{"ax", Result::ax, point, 1, 1, "ax(ball)"},
    ResultFunction{"ay", Result::ay, point, 1, 1, "ay(ball)"},
    ResultFunction{"az", Result::az, point, 1, 1, "az(ball)"},
    ResultFunction{"speed", Result::speed, point, 1, 1, "speed(ball)"},
    ResultFunction{"acceleration", Result::acceleration, point, 1, 1, "acceleration(ball)"},
    ResultFunction{"distance", Result::distance, point, 2, 2, "distance(ball, ground@A)"},
    ResultFunction{"angle", Result::angle, point, 3, 3, "angle(ball, ground@A, collar)"},
    ResultFunction{"length", Result::length, force, 1, 1, "length(spring)"},
    ResultFunction{"tension", Result::tension, force, 1, 1, "tension(spring)"},
    ResultFunction{"force_x", Result::force_x, force, 1, 1, "force_x(bearing)"},
    ResultFunction{"force_y", Result::force_y, force, 1, 1, "force_y(bearing)"},
    ResultFunction{"force_z", Result::force_z, force, 1, 1, "force_z(bearing)"},
    ResultFunction{"force", Result::force, force, 1, 1, "force(bearing)"},
    ResultFunction{"couple_x", Result::couple_x, force, 1, 1, "couple_x(bearing)"},
    ResultFunction{"couple_y", Result::couple_y, force, 1, 1, "couple_y(bearing)"},
    ResultFunction{"couple_z", Result::couple_z, force, 1, 1, "couple_z(bearing)"},
    ResultFunction{"couple", Result::couple, force, 1, 1, "couple(bearing)"},
    ResultFunction{"spring", Result::spring, coordinate, 1, 1, "spring(slide)"},
    ResultFunction{"reaction_x", Result::reaction_x, joint, 1, 1, "reaction_x(slide)"},
    ResultFunction{"reaction_y", Result::reaction_y, joint, 1, 1, "reaction_y(slide)"},
    ResultFunction{"reaction_z", Result::reaction_z, joint, 1, 1, "reaction_z(slide)"},
    ResultFunction{"reaction", Result::reaction, joint, 1, 1, "reaction(slide)"},
    ResultFunction{"moment_x", Result::moment_x, joint, 1, 1, "moment_x(slide)"},
    ResultFunction{"moment_y", Result::moment_y, joint, 1, 1, "moment_y(slide)"},
    ResultFunction{"moment_z", Result::moment_z, joint, 1, 1, "moment_z(slide)"},
    ResultFunction{"moment", Result::moment, joint, 1, 1, "moment(slide)"},
    ResultFunction{"torque", Result::torque, coordinate, 1, 1, "torque(spin)"},
    ResultFunction{"power", Result::power, coordinate, 1, 1, "power(spin)"},
    ResultFunction{"clearance", Result::clearance, coordinate, 1, 2, "clearance(slide)"},
    ResultFunction{"mass", Result::mass, body, 0, 1, "mass(ball)"},
};
static_assert(result_list.back().result == Result::mass &&
              result_list.size() == static_cast<std::size_t>(Result::mass) + 1);

} // namespace

std::span<const ResultFunction> result_functions() {
  return result_list;
}

const ResultFunction& result_function(Result result) {
  return result_list[static_cast<std::size_t>(result)];
}

ArgumentKind argument_kind(const ResultFunction& function, std::size_t arguments) {
  return function.result == Result::clearance && arguments == 2 ? body : function.kind;
}

std::string_view noun(ArgumentKind kind) {
  switch (kind) {
  case coordinate: return "the coordinate of a joint, as in slide or ball.1";
  case joint: return "a joint";
  case force: return "a force";
  case body: return "a body";
  case point: return "a point of a body, as in ball or ball@A";
  }
  return "";
}

std::string argument_text(std::string_view name) {
  const auto letter = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalpha(byte) != 0 || c == '_' || byte >= 0x80;
  };
  const auto in_word = [&](char c) { return letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; };
  if (!name.empty() && letter(name.front()) && std::ranges::all_of(name, in_word)) return std::string(name);
  const char quote = name.find('"') == std::string_view::npos ? '"' : '\'';
  return quote + std::string(name) + quote;
}

std::string coordinate_argument(std::string_view label) {
  const std::size_t dot = label.rfind('.');
  if (dot == std::string_view::npos) return argument_text(label);
  return argument_text(label.substr(0, dot)) + std::string(label.substr(dot));
}

} // namespace flyball
