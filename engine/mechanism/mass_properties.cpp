#include "engine/mechanism/mass_properties.hpp"

#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <type_traits>
#include <vector>

namespace flyball {
namespace {

using std::numbers::pi;

template <class N>
using Vector = Eigen::Matrix<N, 3, 1>;
template <class N>
using Tensor = Eigen::Matrix<N, 3, 3>;

template <class N>
N cube(N x) {
  return x * x * x;
}

template <class N>
N positive(N x) {
  return x > N(0) ? x : N(0);
}

// A shape's numbers, read as N.
template <class N>
struct Solid {
  ShapeType type;
  N radius;
  Vector<N> size, line, centre; // `line` from one end of a rod to the other

  Solid(const Shape& shape, const Vec3& mass_centre, const NumberReader<N>& read)
      : type(shape.type), radius(read(shape.radius)), size(read(shape.size)) {
    if (is_rod(type)) {
      const Vector<N> from = read(shape.from), to = read(shape.to);
      line = to - from;
      centre = N(0.5) * (from + to);
    } else {
      line.setZero();
      centre = read(shape.at, read(mass_centre));
    }
  }

  N volume() const {
    const N r = positive(radius);
    switch (type) {
    case ShapeType::sphere: return 4 * pi / 3 * cube(r);
    case ShapeType::box: return positive(size.x()) * (positive(size.y()) * positive(size.z()));
    case ShapeType::cylinder: return pi * r * r * line.norm();
    case ShapeType::capsule: return pi * r * r * line.norm() + 4 * pi / 3 * cube(r);
    }
    return 0;
  }
};

// Of a body of revolution, from its moments along the axis and across it.
template <class N>
Tensor<N> tensor(const Vector<N>& axis, N along, N across) {
  return across * Tensor<N>::Identity() + (along - across) * axis * axis.transpose();
}

template <class N>
Vector<N> direction(const Vector<N>& line) {
  if constexpr (std::is_same_v<N, double>)
    return line.stableNormalized();
  else
    return line.normalized();
}

// About the shape's centre and by its mass (m^2), in body axes.
template <class N>
Tensor<N> inertia_by_mass(const Solid<N>& solid, const Eigen::Quaternion<N>& rotation) {
  const N r = solid.radius, r2 = r * r;
  if (solid.type == ShapeType::sphere) return N(0.4) * r2 * Tensor<N>::Identity();
  if (solid.type == ShapeType::box) {
    const Vector<N> squares = solid.size.cwiseAbs2();
    return ((squares.sum() - squares.array()) / N(12)).matrix().asDiagonal();
  }
  const N l = solid.line.norm();
  const Vector<N> axis = rotation.conjugate() * direction<N>(solid.line);
  const N cylinder_across = l * l / 12 + r2 / 4;
  if (solid.type == ShapeType::cylinder) return tensor<N>(axis, r2 / 2, cylinder_across);
  // The two halves of a ball at the ends of a capsule: their mass centres are 3/8 r outside the cylinder.
  const N balls = 4 * r / (3 * l + 4 * r);
  const N ball_across = 0.4 * r2 + l * l / 4 + 0.375 * l * r;
  return tensor<N>(axis, (1 - balls) * r2 / 2 + balls * 0.4 * r2,
                   (1 - balls) * cylinder_across + balls * ball_across);
}

template <class N>
struct Properties {
  N mass = 0;
  Vector<N> centre = Vector<N>::Zero();
  Tensor<N> inertia = Tensor<N>::Zero();
};

// Of the shapes together; `inertia` in body axes. Nothing without any volume.
template <class N>
std::optional<Properties<N>> in_body_axes(const Body& body, N density, const NumberReader<N>& read) {
  std::vector<Solid<N>> solids;
  std::vector<N> masses;
  solids.reserve(body.shapes.size());
  masses.reserve(body.shapes.size());
  const Vector<N> drawn = read(body.position);
  Properties<N> all;
  for (const Shape& shape : body.shapes) {
    solids.emplace_back(shape, body.position, read);
    masses.push_back(density * solids.back().volume());
    all.mass += masses.back();
    all.centre += masses.back() * (solids.back().centre - drawn);
  }
  if (!(all.mass > N(0))) return {};
  all.centre = drawn + all.centre / all.mass;
  const Eigen::Quaternion<N> rotation = read(body.rotation).normalized();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (!(masses[i] > N(0))) continue;
    const Vector<N> away = rotation.conjugate() * (solids[i].centre - all.centre);
    all.inertia += masses[i] * (inertia_by_mass(solids[i], rotation) +
                                away.squaredNorm() * Tensor<N>::Identity() - away * away.transpose());
  }
  const auto finite = [](const N& x) { return std::isfinite(static_cast<double>(x)); };
  if (!finite(all.mass) || !std::ranges::all_of(all.centre, finite) ||
      !std::ranges::all_of(all.inertia.reshaped(), finite))
    return {};
  return all;
}

std::optional<Properties<double>> in_body_axes(const Body& body, double density) {
  return in_body_axes<double>(body, density, {});
}

// Products of inertia that are round-off beside the moments are none.
double product(const Mat3& inertia, int i, int j) {
  constexpr double round_off = 1e-15;
  return std::abs(inertia(i, j)) > round_off * inertia.trace() ? inertia(i, j) : 0;
}

} // namespace

double volume(const Shape& shape) {
  return Solid<double>(shape, Vec3::Zero(), {}).volume();
}

std::optional<MassProperties> mass_properties(const Body& body, double density) {
  const std::optional<Properties<double>> all = in_body_axes(body, density);
  if (!all) return {};
  const Mat3 axes = body.rotation.normalized().toRotationMatrix();
  return MassProperties{all->mass, all->centre, axes * all->inertia * axes.transpose()};
}

namespace {

void take(Body& body, const Properties<double>& all, double mass) {
  // A shape that stands at the mass centre stays where it is when that moves.
  if (all.centre != body.position)
    for (Shape& shape : body.shapes)
      if (!shape.at && (shape.type == ShapeType::sphere || shape.type == ShapeType::box))
        shape.at = body.position;
  const Mat3 i = all.inertia * (mass / all.mass);
  body.mass = mass;
  body.position = all.centre;
  body.inertia = {i(0, 0), i(1, 1), i(2, 2), product(i, 0, 1), product(i, 0, 2), product(i, 1, 2)};
}

} // namespace

bool take_mass_properties(Body& body, double density) {
  const std::optional<Properties<double>> all = in_body_axes(body, density);
  // Without the last digit's dust: a block of 0.2 m by 7850 kg/m^3 has 62.8 kg.
  if (all) take(body, *all, std::strtod(rounded_text(all->mass, 15).c_str(), nullptr));
  return all.has_value();
}

bool take_uniform_mass(Body& body, double mass) {
  const std::optional<Properties<double>> all = in_body_axes(body, 1);
  if (all) take(body, *all, mass);
  return all.has_value();
}

void take_mass_rates(const Body& body, NumberRates& rates) {
  const NumberReader<Dual> read(rates);
  const auto all = in_body_axes<Dual>(body, read(*body.density), read);
  if (!all) return;
  rates.set(place_of(body.mass), all->mass.rate);
  for (int i = 0; i < 3; ++i)
    rates.set(place_of(body.position[i]), all->centre[i].rate);
  constexpr std::array<std::array<int, 2>, 6> entries{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  for (std::size_t k = 0; k < entries.size(); ++k)
    rates.set(place_of(body.inertia[k]), all->inertia(entries[k][0], entries[k][1]).rate);
}

std::optional<double> density_of(const Body& body) {
  double all = 0;
  for (const Shape& shape : body.shapes)
    all += volume(shape);
  if (!(all > 0) || !std::isfinite(all)) return {};
  return body.mass / all;
}

} // namespace flyball
