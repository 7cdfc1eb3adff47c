// A joint's coordinates where an isometry puts the joint elsewhere.
#pragma once

#include "app/document/isometry.hpp"

#include <vector>

namespace flyball {

// What stands for a coordinate in the joint's image: new value = sign * old value.
struct CoordinateImage {
  std::size_t index = 0;
  double sign = 1;
  // Of a spherical or free joint, along a world axis that comes to lie between world axes: no one coordinate
  // stands for it.
  bool mixed = false;
};

// One for each coordinate. In a reflection a cylindrical joint's angle changes its sign, since only one of
// its coordinates can keep it; all others of joints with axes keep theirs. Those of spherical and free
// joints, which have the world's axes, trade places as these do.
std::vector<CoordinateImage> images_of_coordinates(JointType type, const Isometry& isometry);

// Labels, springs, stops and drives follow the coordinates. What is mixed is exact for labels, and where the
// same springs and dampers act along the mixed axes, drives along all or none, and no stops. Other springs,
// stops and drives stay with their world axes, springs and stops as far from the label as they were.
std::vector<Coordinate> image_of(const std::vector<Coordinate>& coordinates, JointType type,
                                 const Isometry& isometry);

// Puts an end of a gear, which is at this coordinate of the joint, at what stands for it: the joint's name
// may be another by now, a sign goes into ratio and offset.
void move_end(Joint& gear, std::size_t end, const Joint& joint, int coordinate, const CoordinateImage& image);

// Gears and sliders of a joint whose coordinates have traded places.
void follow_coordinates(Mechanism& mechanism, const Joint& joint, const std::vector<CoordinateImage>& images);

} // namespace flyball
