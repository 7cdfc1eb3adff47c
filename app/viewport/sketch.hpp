// Puts simple solids into a list: rods, tubes, arrows, coils.
#pragma once

#include "app/viewport/scene_list.hpp"

#include <vector>

namespace flyball {

struct Pen {
  Color color;
  Surface surface = Surface::plain;
  Role role = Role::body;
  PartId part;
};

// A rotation whose z axis is `z`, and whose x axis is as near to `x` as can be.
Quat frame_along(const Vec3& z);
Quat frame_along(const Vec3& z, const Vec3& x);

// Lengths in m; `edge` is the radius of rounded edges.
class Sketch {
 public:
  explicit Sketch(std::vector<Instance>& list) : list_(&list) {}
  Pen pen;

  void sphere(const Vec3& center, double radius);
  void rod(const Vec3& from, const Vec3& to, double radius); // with round ends
  void cylinder(const Vec3& from, const Vec3& to, double radius, double edge);
  void disc(const Vec3& center, const Vec3& axis, double half, double radius, double edge);
  void tube(const Vec3& center, const Vec3& axis, double half, double radius, double edge);
  void box(const Vec3& center, const Quat& frame, const Vec3& half, double edge);
  void cone(const Vec3& base, const Vec3& direction, double radius, double length);
  void arrow(const Vec3& from, const Vec3& to, double radius); // the head is 6 radii long
  void bowl(const Vec3& center, const Vec3& bottom, double radius);
  void ring(const Vec3& center, const Vec3& axis, double radius, double wire, bool broken);
  // Three quarters of a turn, right-handed about `axis`, with a head; `start` is where it begins.
  void turn(const Vec3& center, const Vec3& axis, const Vec3& start, double radius, double wire);
  void coil(const Vec3& from, const Vec3& to, const Vec3& start, double radius, double wire, bool open);
  void spiral(const Vec3& center, const Vec3& axis, const Vec3& end, double radius, double wire);
  void gear(const Vec3& center, const Vec3& axis, double half, double radius);

 private:
  void add(Primitive primitive, const Vec3& position, const Quat& rotation, const Vec3& extent, double round);
  std::vector<Instance>* list_;
};

} // namespace flyball
