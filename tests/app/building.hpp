// The paper's two mechanisms built from an empty document as a person builds them: with the mouse in the
// view, the keys and the inspector's fields, nothing else. Tests read the answer; the tutorial takes pictures
// on the way.
#pragma once

#include "robot.hpp"

#include <functional>
#include <string>

namespace flyball::test {

// Told after each step a tutorial would show, with a name for it.
using OnStep = std::function<void(const std::string& step)>;

void build_pendulum(Robot& robot, const OnStep& on_step = {});
void build_governor(Robot& robot, const OnStep& on_step = {}); // its second arm by mirror

// A robot with a window large enough for a person to build in.
inline constexpr PixelSize building_size{1440, 900};

} // namespace flyball::test
