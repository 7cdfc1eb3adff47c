// The keys of every object in a scene file, and the words of its enumerations. `description` belongs to every
// object and is not listed.
#pragma once

#include "engine/mechanism/fields.hpp"

#include <span>

namespace flyball::scene_keys {

using Keys = std::span<const Field>;

// Versions of the format that this program reads are those up to this one; it writes the lowest that has all
// that a mechanism uses.
inline constexpr int newest_version = 2;

// Of objects such as this one, whose type matters only.
Keys of(const Mechanism& mechanism);
Keys of(const NamedParameter& parameter);
Keys of(const NamedMeasure&);
Keys of(const Body& body);
Keys of(const Shape& shape);
Keys of(const Joint& joint);
Keys of(const Coordinate& coordinate);
Keys of(const CoordinateSpring& spring);
Keys of(const Stop& stop);
Keys of(const Friction& friction);
Keys of(const Drive& drive);
Keys of(const Force& force);
Keys of(const Air& air);
Keys of(const Slider& slider);
Keys of(const Simulation& simulation);
Keys of(const View& view);
Keys of(const Camera& camera);

// Of the objects of all types that this one may be mistaken for; none where there is one type.
std::span<const Keys> of_all_types(const Joint& joint);
std::span<const Keys> of_all_types(const Force& force);
std::span<const Keys> of_all_types(const Shape& shape);

// The words of an enumeration, in its order.
std::span<const std::string_view> words_of(JointType any);
std::span<const std::string_view> words_of(GearKind);
std::span<const std::string_view> words_of(ForceType any);
std::span<const std::string_view> words_of(ShapeType any);
std::span<const std::string_view> words_of(ForceFrame any);
std::span<const std::string_view> words_of(DriveKeeps any);
std::span<const std::string_view> words_of(SliderScale any);

} // namespace flyball::scene_keys
