#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"

#include "engine/linear/spectral.hpp"

#include <cmath>

namespace flyball {
namespace {

void find_inertia_mistakes(const Body& body, const std::string& path, Mistakes& mistakes) {
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  Mat3 inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  // Scaled, so that no sum overflows; thin rods and discs sit on the edge and need the tolerance.
  const double scale = inertia.cwiseAbs().maxCoeff();
  if (scale == 0) return;
  constexpr double tolerance = 1e-9;
  const auto axes = principal_axes(inertia / scale);
  if (!axes) return; // numbers that are not finite are told of where all numbers are looked at
  const Vec3& principal = axes->values;
  const std::string moments = "; the principal moments are " + number_text(principal[0] * scale) + ", " +
                              number_text(principal[1] * scale) + " and " + number_text(principal[2] * scale);
  const double edge = tolerance * principal.cwiseAbs().maxCoeff();
  if (principal[0] < -edge)
    mistakes.add(path + ".inertia", "expected a tensor without negative principal moments" + moments);
  else if (principal[2] > principal[0] + principal[1] + edge)
    mistakes.add(path + ".inertia",
                 "expected no principal moment above the sum of the other two, as in every real body" +
                     moments);
}

void find_shape_mistakes(const Shape& shape, const std::string& path, Mistakes& mistakes) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (shape.type == ShapeType::box) {
    mistakes.expect(positive(shape.size.x()) && positive(shape.size.y()) && positive(shape.size.z()),
                    path + ".size", "expected three numbers above zero");
  } else {
    mistakes.expect(positive(shape.radius), path + ".radius", "expected a number above zero");
  }
  const bool ends_right = shape.from.allFinite() && shape.to.allFinite() &&
                          (shape.type != ShapeType::cylinder || shape.from != shape.to);
  mistakes.expect(ends_right, path + ".to", "expected a point apart from `from`");
  if (shape.at) mistakes.expect(shape.at->allFinite(), path + ".at", "expected three finite numbers");
  if (shape.color)
    for (const double part : *shape.color)
      if (!(part >= 0 && part <= 1))
        return mistakes.add(path + ".color", "expected three numbers from 0 to 1");
}

} // namespace

void find_body_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const Body& body = mechanism.bodies[i];
    const std::string path = part_path("bodies", i, body.name);
    if (body.mass < 0) mistakes.add(path + ".mass", "expected zero or more, found " + number_text(body.mass));
    find_inertia_mistakes(body, path, mistakes);
    constexpr double unit_tolerance = 1e-6;
    const double norm = body.rotation.coeffs().stableNorm();
    if (!(std::abs(norm - 1) <= unit_tolerance))
      mistakes.add(path + ".rotation",
                   "expected a unit quaternion [w, x, y, z], found one of length " + number_text(norm));
    for (std::size_t k = 0; k < body.shapes.size(); ++k)
      find_shape_mistakes(body.shapes[k], path + ".shapes[" + std::to_string(k) + "]", mistakes);
  }
}

} // namespace flyball
