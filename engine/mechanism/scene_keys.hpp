// The keys of every object in a scene file, as the reader and the tests of assets/scene.schema.json use them.
// `description` belongs to every object and is not listed.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <span>
#include <string_view>

namespace flyball::scene_keys {

struct Key {
  std::string_view name;
  std::string_view expected; // what a right value looks like, for messages
  bool required = false;
};
using Keys = std::span<const Key>;

// Version of the format that this program reads and writes.
inline constexpr int version = 1;

Keys scene();
Keys body();
Keys shape(ShapeType type);
Keys joint(JointType type);
Keys spring();
Keys stop();
Keys drive();
Keys force(ForceType type);
Keys slider();
Keys simulation();
Keys view();
Keys camera();

// The words of an enumeration, in its order.
std::span<const std::string_view> joint_types();
std::span<const std::string_view> force_types();
std::span<const std::string_view> shape_types();
std::span<const std::string_view> force_frames();
std::span<const std::string_view> slider_scales();

} // namespace flyball::scene_keys
