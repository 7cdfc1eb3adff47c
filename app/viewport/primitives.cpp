#include "app/viewport/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <tuple>

namespace flyball {

namespace {

constexpr double tau = 2 * std::numbers::pi;

class Builder {
 public:
  std::uint32_t add(const Vec3& core, const Vec3& normal) {
    // Where a turn closes, sines and cosines come back to almost the same.
    const auto tidy = [](const Vec3& v) { return Vec3((v.array() * 1e7).round() / 1e7 + 0.0); };
    return add_vertex(tidy(core), tidy(normal.normalized()));
  }
  std::uint32_t add_vertex(const Vec3& core, const Vec3& n) {
    mesh.vertices.push_back(
        {{float(core.x()), float(core.y()), float(core.z())}, {float(n.x()), float(n.y()), float(n.z())}});
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }

  // Vertices lie in rows of `columns`; neighbours are joined.
  void grid(std::uint32_t first, int rows, int columns) {
    for (int r = 0; r + 1 < rows; ++r)
      for (int c = 0; c + 1 < columns; ++c) {
        const auto a = first + static_cast<std::uint32_t>(r * columns + c), b = a + 1;
        const auto d = a + static_cast<std::uint32_t>(columns), e = d + 1;
        mesh.indices.insert(mesh.indices.end(), {a, b, e, a, e, d});
      }
  }

  // Turns every triangle to the side its normals point to; drops those without area.
  PrimitiveMesh finish() {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      std::array<Vec3, 3> p;
      Vec3 outward = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const PrimitiveVertex& v = mesh.vertices[mesh.indices[i + k]];
        const Vec3 n(v.normal[0], v.normal[1], v.normal[2]);
        p[k] = Vec3(v.core[0], v.core[1], v.core[2]) + 0.11 * n;
        outward += n;
      }
      const Vec3 area = (p[1] - p[0]).cross(p[2] - p[0]);
      if (area.norm() < 1e-9) continue;
      const bool turned = area.dot(outward) < 0;
      kept.insert(kept.end(),
                  {mesh.indices[i], mesh.indices[i + (turned ? 2 : 1)], mesh.indices[i + (turned ? 1 : 2)]});
    }
    mesh.indices = std::move(kept);
    weld();
    return std::move(mesh);
  }

  // Vertices that are alike become one, as at the poles of a sphere; those that no triangle uses go.
  void weld() {
    std::map<std::array<float, 6>, std::uint32_t> places;
    std::vector<PrimitiveVertex> vertices;
    for (std::uint32_t& index : mesh.indices) {
      const PrimitiveVertex& v = mesh.vertices[index];
      const auto added = static_cast<std::uint32_t>(vertices.size());
      const auto [place, is_new] =
          places.try_emplace({v.core[0], v.core[1], v.core[2], v.normal[0], v.normal[1], v.normal[2]}, added);
      if (is_new) vertices.push_back(v);
      index = place->second;
    }
    mesh.vertices = std::move(vertices);
  }

  PrimitiveMesh mesh;
};

// A point of an outline turned about z: radius and height of the core, direction of the normal.
struct Profile {
  double radius, height, normal_radius, normal_height;
};

void arc_profile(std::vector<Profile>& profile, double radius, double height, double from, double to,
                 int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double a = from + (to - from) * i / steps;
    profile.push_back({radius, height, std::cos(a), std::sin(a)});
  }
}

PrimitiveMesh lathe(const std::vector<Profile>& profile, int sides) {
  Builder b;
  for (const Profile& p : profile)
    for (int i = 0; i <= sides; ++i) {
      const double a = tau * i / sides;
      const Vec3 out(std::cos(a), std::sin(a), 0);
      b.add(p.radius * out + p.height * Vec3::UnitZ(),
            p.normal_radius * out + p.normal_height * Vec3::UnitZ());
    }
  b.grid(0, static_cast<int>(profile.size()), sides + 1);
  return b.finish();
}

constexpr double quarter = std::numbers::pi / 2;

PrimitiveMesh turned_solid(Primitive primitive, int sides, int rounding) {
  std::vector<Profile> p;
  switch (primitive) {
  case Primitive::sphere: arc_profile(p, 0, 0, -quarter, quarter, 2 * rounding); break;
  case Primitive::capsule:
    arc_profile(p, 0, -1, -quarter, 0, rounding);
    arc_profile(p, 0, 1, 0, quarter, rounding);
    break;
  case Primitive::cylinder:
    p.push_back({0, -1, 0, -1});
    arc_profile(p, 1, -1, -quarter, 0, rounding / 2);
    arc_profile(p, 1, 1, 0, quarter, rounding / 2);
    p.push_back({0, 1, 0, 1});
    break;
  case Primitive::tube:
    arc_profile(p, 1, -1, -quarter, 0, rounding / 2);
    arc_profile(p, 1, 1, 0, quarter, rounding / 2);
    arc_profile(p, tube_hole, 1, quarter, 2 * quarter, rounding / 2);
    arc_profile(p, tube_hole, -1, 2 * quarter, 3 * quarter, rounding / 2);
    p.push_back(p.front());
    break;
  case Primitive::cone: p = {{0, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 1, 0.42}, {0, 1, 1, 0.42}}; break;
  default: { // bowl
    constexpr double inner = 0.84;
    for (int i = 0; i <= rounding; ++i) {
      const double a = -quarter + quarter * i / rounding;
      p.push_back({std::cos(a), std::sin(a), std::cos(a), std::sin(a)});
    }
    p.push_back({1, 0, 0, 1});
    p.push_back({inner, 0, 0, 1});
    for (int i = rounding; i >= 0; --i) {
      const double a = -quarter + quarter * i / rounding;
      p.push_back({inner * std::cos(a), inner * std::sin(a), -std::cos(a), -std::sin(a)});
    }
    break;
  }
  }
  return lathe(p, sides);
}

// A curve with the two directions its round cross-section lies in.
struct CurvePoint {
  Vec3 at, across, along;
};

void sweep(Builder& b, const std::function<CurvePoint(double)>& curve, double from, double to, int steps,
           int sides, bool capped) {
  const auto first = static_cast<std::uint32_t>(b.mesh.vertices.size());
  const auto row = [&](const CurvePoint& c, double bulge) {
    const Vec3 tangent = c.across.cross(c.along);
    for (int k = 0; k <= sides; ++k) {
      const double a = tau * k / sides;
      b.add(c.at,
            std::cos(bulge) * (std::cos(a) * c.across + std::sin(a) * c.along) + std::sin(bulge) * tangent);
    }
  };
  int rows = 0;
  const auto cap = [&](double t, double sign, bool opening) {
    for (int i = 0; i < 3; ++i, ++rows)
      row(curve(t), sign * quarter * (opening ? 3 - i : i + 1) / 3);
  };
  // `across` x `along` points forwards or backwards along the curve, whichever it is caps bulge outwards.
  const CurvePoint start = curve(from);
  const Vec3 ahead = curve(from + 1e-4 * (to - from)).at - start.at;
  const double forward = start.across.cross(start.along).dot(ahead) < 0 ? -1 : 1;
  if (capped) cap(from, -forward, true);
  for (int i = 0; i <= steps; ++i, ++rows)
    row(curve(from + (to - from) * i / steps), 0);
  if (capped) cap(to, forward, false);
  b.grid(first, rows, sides + 1);
}

CurvePoint circle(double t) {
  const double a = tau * t;
  const Vec3 out(std::cos(a), std::sin(a), 0);
  return {out, out, Vec3::UnitZ()};
}

// A straight lead on the axis at each end, then the turns.
CurvePoint hooked_coil(double t) {
  constexpr double lead = 0.08;
  const double turn = (t - lead) / (1 - 2 * lead);
  const double a = tau * coil_turns * std::clamp(turn, 0.0, 1.0);
  const double grown = std::clamp(std::min(turn, 1 - turn) * coil_turns * 2.5, 0.0, 1.0);
  const Vec3 out(std::cos(a), std::sin(a), 0);
  const Vec3 at = grown * grown * (3 - 2 * grown) * out + t * Vec3::UnitZ();
  const bool straight = turn < 0 || turn > 1;
  return {at, out, straight ? Vec3(Vec3::UnitZ().cross(out)) : Vec3(Vec3::UnitZ())};
}

// The first and the last turn lie flat, as in a ground compression spring.
CurvePoint flat_ended_coil(double t) {
  constexpr double flat = 0.9 / coil_turns;
  const double a = tau * coil_turns * t;
  const double u = std::clamp((t - 0.5 * flat) / (1 - flat), 0.0, 1.0);
  const Vec3 out(std::cos(a), std::sin(a), 0);
  return {out + (0.03 + 0.94 * u) * Vec3::UnitZ(), out, Vec3::UnitZ()};
}

CurvePoint flat_spiral(double t) {
  constexpr double turns = 3.25;
  const double a = tau * turns * (t - 1), r = 0.18 + 0.82 * t;
  const Vec3 out(std::cos(a), std::sin(a), 0);
  return {r * out, out, Vec3::UnitZ()};
}

// Of a regular polygon as large as the circle: its corners' distance from the middle.
double equal_area(int sides) {
  const double step = tau / sides;
  return std::sqrt(step / std::sin(step));
}

// The cylinder of a few sides between two heights, its ends flat, that stands for all that is about as thick
// all along: what is this small shows no more of itself.
PrimitiveMesh prism(int sides, double radius, double low, double high) {
  const double slant = std::sqrt(0.5);
  return lathe({{0, low, 0, -1}, {radius, low, slant, -slant}, {radius, high, slant, slant}, {0, high, 0, 1}},
               sides);
}

// Half of a ball or rod as it is seen, drawn tight over its outline; the normals lean to the eye, as if it
// bulged. `z` is the rod's axis and `up` points to the eye.
PrimitiveMesh flat(Primitive primitive, int detail) {
  const int sides = detail_sides[static_cast<std::size_t>(detail)];
  const double grown = equal_area(sides), lean = detail > 1 ? 0.3 : 0.7;
  PrimitiveMesh mesh;
  const auto corner = [&](double end, double x, double y, double z) {
    mesh.vertices.push_back({{0, 0, float(end)}, {float(x), float(y), float(z)}});
  };
  const auto count = [&] { return static_cast<std::uint32_t>(mesh.vertices.size()); };
  const bool ball = primitive == Primitive::sphere;
  if (ball) {
    if (detail > 1) corner(0, 0, 0, 1);
    for (int i = 0; i < sides; ++i)
      corner(0, grown * std::cos(tau * i / sides), grown * std::sin(tau * i / sides), lean);
  } else {
    // Round each end from one side to the other, the middle of it last.
    const int steps = std::array{1, 2, 4}[static_cast<std::size_t>(detail)];
    for (const double end : {-1.0, 1.0}) {
      for (int i = 0; i <= steps; ++i) {
        const double a = std::numbers::pi * i / steps;
        corner(end, -end * std::cos(a), lean, steps > 1 ? end * std::sin(a) : 0);
      }
      if (detail > 1) corner(end, 0, 1, 0);
    }
  }
  const auto fan = [&](std::uint32_t middle, std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = from + 1; i <= to; ++i)
      mesh.indices.insert(mesh.indices.end(), {middle, i - 1, i});
  };
  const std::uint32_t last = count() - 1, half = count() / 2;
  if (detail < 2) {
    fan(0, 1, last);
  } else if (ball) {
    fan(0, 1, last);
    mesh.indices.insert(mesh.indices.end(), {0, last, 1});
  } else {
    const std::uint32_t low = half - 1, high = last; // the ridge
    fan(low, 0, low - 1);
    fan(high, half, high - 1);
    mesh.indices.insert(mesh.indices.end(),
                        {low, low - 1, half, low, half, high, high, high - 1, 0, high, 0, low});
  }
  return mesh;
}

// A coil as it is seen from the side: `quads` straight pieces of wire for each half turn.
PrimitiveMesh flat_coil(bool open, int quads) {
  PrimitiveMesh mesh;
  // From one point to the next, as wide as the wire however steep it runs, within a sixth.
  const auto wire = [&](double x0, double z0, double x1, double z1) {
    const double lean = 0.5, side = 0.82, across = x1 == x0 ? 1 : side * (x1 > x0 ? -1 : 1);
    const double up = x1 == x0 ? 0 : side;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, z, sign] : {std::tuple(x0, z0, 1), {x0, z0, -1}, {x1, z1, -1}, {x1, z1, 1}})
      mesh.vertices.push_back(
          {{float(x), 0, float(z)}, {float(sign * across), float(lean), float(sign * up)}});
    // Counter-clockwise seen from y.
    const bool turned = (x1 - x0) * up - (z1 - z0) * across > 0;
    const std::uint32_t b = turned ? 3 : 1, d = turned ? 1 : 3;
    mesh.indices.insert(mesh.indices.end(), {first, first + b, first + 2, first, first + 2, first + d});
  };
  const double low = open ? 0.03 : 0.08;
  const int steps = static_cast<int>(2 * coil_turns) * quads;
  const auto at = [&](int i) {
    const bool tied = !open && (i == 0 || i == steps);
    return std::pair(tied ? 0 : std::cos(std::numbers::pi * i / quads), low + (1 - 2 * low) * i / steps);
  };
  for (int i = 0; i < steps; ++i)
    wire(at(i).first, at(i).second, at(i + 1).first, at(i + 1).second);
  if (!open) {
    wire(0, 0, 0, low);
    wire(0, 1 - low, 0, 1);
  }
  return mesh;
}

// What is left of a coil that is a line.
PrimitiveMesh strip() {
  PrimitiveMesh mesh;
  for (const float end : {0.f, 1.f})
    for (const float side : {1.f, -1.f})
      mesh.vertices.push_back({{0, 0, end}, {side, 0.7f, 0}});
  mesh.indices = {0, 1, 3, 0, 3, 2};
  return mesh;
}

PrimitiveMesh coarse_solid(Primitive primitive, int detail) {
  const int sides = detail_sides[static_cast<std::size_t>(detail)];
  const double grown = equal_area(sides);
  switch (primitive) {
  case Primitive::sphere:
  case Primitive::capsule: return flat(primitive, detail);
  case Primitive::cone: return turned_solid(primitive, sides, 1);
  case Primitive::bowl: return turned_solid(primitive, sides, 1 + detail);
  case Primitive::cylinder:
  case Primitive::tube:
  case Primitive::gear: return prism(sides, grown, -1, 1);
  default: return detail > 0 ? flat_coil(primitive == Primitive::open_coil, 2 * detail - 1) : strip();
  }
}

// `rounding` 0: sharp.
PrimitiveMesh rounded_box(int rounding) {
  Builder b;
  const int columns = 2 * rounding + 2;
  const auto coordinate = [&](int i) {
    if (rounding == 0) return i == 0 ? -1.0 : 1.0;
    if (i <= rounding) return std::tan(-0.5 * quarter * (rounding - i) / rounding);
    return std::tan(0.5 * quarter * (i - rounding - 1) / rounding);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(b.mesh.vertices.size());
      for (int i = 0; i < columns; ++i)
        for (int j = 0; j < columns; ++j) {
          Vec3 normal, core;
          normal[axis] = core[axis] = side;
          normal[(axis + 1) % 3] = coordinate(i);
          normal[(axis + 2) % 3] = coordinate(j);
          core[(axis + 1) % 3] = i <= rounding ? -1 : 1;
          core[(axis + 2) % 3] = j <= rounding ? -1 : 1;
          b.add(core, normal);
        }
      b.grid(first, columns, columns);
    }
  return b.finish();
}

PrimitiveMesh toothed_disc() {
  constexpr int teeth = 14;
  constexpr double root = 0.8, hole = 0.42;
  std::vector<Vec3> outline;
  for (int i = 0; i < teeth; ++i)
    for (const auto& [phase, radius] : {std::pair(0.0, root), {0.3, root}, {0.42, 1.0}, {0.88, 1.0}}) {
      const double a = tau * (i + phase) / teeth;
      outline.emplace_back(radius * std::cos(a), radius * std::sin(a), 0);
    }
  Builder b;
  const auto quad = [&](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s, const Vec3& normal) {
    const std::uint32_t first = b.add(p, normal);
    b.add(q, normal);
    b.add(s, normal);
    b.add(r, normal);
    b.grid(first, 2, 2);
  };
  const Vec3 z = Vec3::UnitZ();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 &p = outline[i], &q = outline[(i + 1) % outline.size()];
    const Vec3 inner_p = hole * p.normalized(), inner_q = hole * q.normalized();
    quad(p - z, q - z, q + z, p + z, (q - p).cross(z));
    quad(inner_p - z, inner_q - z, inner_q + z, inner_p + z, -(inner_p + inner_q));
    for (const double side : {-1.0, 1.0})
      quad(p + side * z, q + side * z, inner_q + side * z, inner_p + side * z, side * z);
  }
  return b.finish();
}

PrimitiveMesh swept(Primitive primitive, int detail) {
  Builder b;
  const auto level = static_cast<std::size_t>(detail);
  const int around = std::array{3, 4, 5, 6, 8, 10, 16}[level];
  const int circle_steps = std::array{8, 12, 20, 28, 44, 64, 128}[level];
  const int coil_steps = static_cast<int>(coil_turns) * std::array{0, 0, 0, 12, 20, 28, 48}[level];
  switch (primitive) {
  case Primitive::ring: sweep(b, circle, 0, 1, circle_steps, around, false); break;
  case Primitive::arc: sweep(b, circle, 0, 0.75, circle_steps, around, true); break;
  case Primitive::broken_ring:
    for (int i = 0; i < 4; ++i)
      sweep(b, circle, 0.25 * i + 0.04, 0.25 * i + 0.21, circle_steps / 4, around, true);
    break;
  case Primitive::coil: sweep(b, hooked_coil, 0, 1, coil_steps, around, true); break;
  case Primitive::open_coil: sweep(b, flat_ended_coil, 0, 1, coil_steps, around, true); break;
  default: sweep(b, flat_spiral, 0, 1, 2 * circle_steps, around, true); break;
  }
  return b.finish();
}

} // namespace

PrimitiveMesh primitive_mesh(Primitive primitive, int wanted) {
  const int detail = std::clamp(wanted, 0, finest_detail);
  const auto level = static_cast<std::size_t>(detail);
  const int rounding = std::array{0, 1, 1, 2, 2, 4, 6}[level];
  switch (primitive) {
  case Primitive::box: return rounded_box(rounding);
  case Primitive::ring:
  case Primitive::arc:
  case Primitive::broken_ring:
  case Primitive::spiral: return swept(primitive, detail);
  case Primitive::coil:
  case Primitive::open_coil:
    return detail > last_flat_detail ? swept(primitive, detail) : coarse_solid(primitive, detail);
  case Primitive::gear: return detail > 1 ? toothed_disc() : coarse_solid(primitive, detail);
  default: break;
  }
  if (detail < 2 || is_flat(primitive, detail)) return coarse_solid(primitive, detail);
  return turned_solid(primitive, detail_sides[level], std::array{1, 1, 2, 4, 6, 10, 24}[level]);
}

} // namespace flyball
