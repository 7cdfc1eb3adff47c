// The law of a copied drive: what it asks of parts that are copied it asks of their copies.
#pragma once

#include "app/document/isometry.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <functional>
#include <string>
#include <string_view>

namespace flyball {

// What copies are called, by the names of what they are copies of; a part that is not copied keeps its name.
struct CopiedNames {
  std::function<std::string(const std::string&)> body, joint, force;
};

// A law of `before`, its measures in their places, as the copies' own: of a place or velocity in the world's
// axes the component that the original's direction has become. Named points that copied bodies or the ground
// carry get images, which are added to `mechanism`. The text as it is where it cannot be read.
std::string law_image(const Mechanism& before, std::string_view law, const Isometry& isometry,
                      const CopiedNames& copies, Mechanism& mechanism);

} // namespace flyball
