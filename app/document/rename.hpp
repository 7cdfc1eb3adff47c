// A part's name is what others refer to it by.
#pragma once

#include "app/document/part.hpp"

#include <string>

namespace flyball {

// Every reference follows: joints' and forces' bodies, gears' ends, sliders' addresses,
// measures. Throws SceneError,
// and leaves all as it was, where the name is unusable or taken, or there is no such part.
void rename_part(Mechanism& mechanism, const Part& part, const std::string& name);

} // namespace flyball
