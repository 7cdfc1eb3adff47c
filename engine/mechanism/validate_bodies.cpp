#include "engine/mechanism/mistakes.hpp"
#include "engine/mechanism/text.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace flyball {
namespace {

struct PrincipalMoments {
  Vec3 values; // kg m^2, ascending
  double edge; // kg m^2: what rounding leaves open
  std::string text() const {
    return "; the principal moments are " + number_text(values[0]) + ", " + number_text(values[1]) + " and " +
           number_text(values[2]);
  }
};

// Nothing where there is no inertia. Thin rods and discs sit on the edge of what a body can have, and moments
// below those of the body's mass within a nanometre are what arithmetic left of zero.
std::optional<PrincipalMoments> principal_moments(const Body& body) {
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  Mat3 inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const double scale = inertia.cwiseAbs().maxCoeff(); // so that no sum overflows
  if (scale == 0) return std::nullopt;
  constexpr double relative = 1e-9, nanometre = 1e-9;
  Vec3 values(xx, yy, zz);
  if (xy == 0 && xz == 0 && yz == 0)
    std::sort(values.begin(), values.end());
  else if (const auto axes = principal_axes(inertia / scale))
    values = axes->values * scale;
  else
    return std::nullopt; // numbers that are not finite are reported where all numbers are checked
  return PrincipalMoments{values, relative * values.cwiseAbs().maxCoeff() +
                                      std::max(body.mass, 0.) * nanometre * nanometre};
}

// Calls add(key, expected) for each.
template <class Add>
void find_shape_mistakes(const Shape& shape, const Add& add) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (shape.type == ShapeType::box) {
    if (!positive(shape.size.x()) || !positive(shape.size.y()) || !positive(shape.size.z()))
      add(".size", "expected three numbers above zero");
  } else if (!positive(shape.radius)) {
    add(".radius", "expected a number above zero");
  }
  if (!shape.from.allFinite() || !shape.to.allFinite() ||
      (shape.type == ShapeType::cylinder && shape.from == shape.to))
    add(".to", "expected a point apart from `from`");
  if (shape.at && !shape.at->allFinite()) add(".at", "expected three finite numbers");
  if (shape.color)
    for (const double part : *shape.color)
      if (!(part >= 0 && part <= 1)) return add(".color", "expected three numbers from 0 to 1");
}

} // namespace

void find_mistakes_of(const Body& body, const std::string& path, Mistakes& mistakes) {
  if (body.mass < 0) mistakes.add(path + ".mass", "expected zero or more, found " + number_text(body.mass));
  if (const auto moments = principal_moments(body); moments && moments->values[0] < -moments->edge)
    mistakes.add(path + ".inertia", "expected a tensor without negative principal moments" + moments->text());
  constexpr double unit_tolerance = 1e-6;
  const double norm = body.rotation.coeffs().stableNorm();
  if (!(std::abs(norm - 1) <= unit_tolerance))
    mistakes.add(path + ".rotation",
                 "expected a unit quaternion [w, x, y, z], found one of length " + number_text(norm));
  for (std::size_t k = 0; k < body.shapes.size(); ++k)
    find_shape_mistakes(body.shapes[k], [&](const char* key, const char* expected) {
      mistakes.add(path + ".shapes[" + std::to_string(k) + "]" + key, expected);
    });
}

void find_body_mistakes(const Mechanism& mechanism, Mistakes& mistakes) {
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
    find_mistakes_of(mechanism.bodies[i], part_path("bodies", i, mechanism.bodies[i].name), mistakes);
}

void find_body_warnings(const Mechanism& mechanism, Mistakes& warnings) {
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i) {
    const Body& body = mechanism.bodies[i];
    const auto moments = principal_moments(body);
    if (!moments) continue;
    const Vec3& m = moments->values;
    if (m[2] / 2 > m[0] / 2 + m[1] / 2 + moments->edge / 2)
      warnings.add(part_path("bodies", i, body.name) + ".inertia",
                   "one principal moment is above the sum of the other two, as in no real body" +
                       moments->text() + "; used as it stands");
  }
}

} // namespace flyball
