// Solved equilibria say nothing of how the mechanism was written down: the order and direction of its parts,
// the tree, the world's axes and origin, the unit of length.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"

#include "engine/report/analysis.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <map>
#include <optional>

using namespace flyball;
using namespace flyball::testing;
using reference::RandomOptions;

namespace {

bool is_translation(const Joint& joint, std::size_t i) {
  return !is_angle(joint.type, static_cast<int>(i));
}

// Springs that know no direction, on the three components of a rotation vector and of a free joint's
// translation, and no stops there: what a rotation of the world must leave alone.
void make_isotropic(Joint& joint, std::size_t first) {
  for (std::size_t i = first; i < first + 3; ++i) {
    Coordinate& c = joint.coordinates[i];
    const Coordinate& lead = joint.coordinates[first];
    c.stop.reset();
    c.damping = lead.damping;
    if (!lead.spring)
      c.spring.reset();
    else
      c.spring = CoordinateSpring{lead.spring->stiffness, c.spring ? c.spring->free : c.drawn, ""};
  }
}

Mechanism sample(std::uint32_t seed) {
  RandomOptions options;
  options.bodies = 2 + static_cast<int>(seed % 5);
  options.loops = static_cast<int>(seed % 3);
  options.parallel_axes = seed % 4 == 1;
  options.conservative = seed % 2 == 0;
  options.spring_share = 1;
  Mechanism m = reference::random_mechanism(seed, options);
  if (seed % 6 == 1) m = reference::with_damper_laws(m);
  for (Joint& joint : m.joints) {
    if (joint.type == JointType::spherical) make_isotropic(joint, 0);
    if (joint.type == JointType::free) {
      make_isotropic(joint, 0);
      make_isotropic(joint, 3);
    }
    for (std::size_t i = 0; i < joint.coordinates.size(); ++i) // stay near the drawn pose: one equilibrium
      if (joint.coordinates[i].spring) joint.coordinates[i].spring->stiffness *= 4;
  }
  return m;
}

Vec3 triple(const Joint& joint, std::size_t first) {
  return {joint.coordinates[first].drawn, joint.coordinates[first + 1].drawn,
          joint.coordinates[first + 2].drawn};
}

template <class Map>
void map_triple(Joint& joint, std::size_t first, const Map& map) {
  const Vec3 drawn = map(triple(joint, first));
  std::optional<Vec3> free;
  if (joint.coordinates[first].spring) {
    free.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*free)[static_cast<Eigen::Index>(i)] = joint.coordinates[first + i].spring->free;
    *free = map(*free);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    joint.coordinates[first + i].drawn = drawn[static_cast<Eigen::Index>(i)];
    if (free) joint.coordinates[first + i].spring->free = (*free)[static_cast<Eigen::Index>(i)];
  }
}

Mechanism moved(Mechanism m, const Quat& r, const Vec3& shift) {
  const auto place = [&](Vec3& p) { p = r * p + shift; };
  m.gravity = r * m.gravity;
  for (Body& b : m.bodies) {
    place(b.position);
    b.rotation = r * b.rotation;
  }
  for (Joint& j : m.joints) {
    place(j.at);
    j.axis = r * j.axis;
    j.axis2 = r * j.axis2;
    for (Vec3& p : j.points)
      place(p);
    const auto turn = [&](const Vec3& v) -> Vec3 { return r * v; };
    if (j.type == JointType::spherical) map_triple(j, 0, turn);
    if (j.type == JointType::free) {
      map_triple(j, 0, turn);
      map_triple(j, 3, turn);
    }
  }
  for (Force& f : m.forces) {
    for (Vec3& p : f.points)
      place(p);
    if (f.at) place(*f.at);
    if (f.frame == ForceFrame::world) f.vector = r * f.vector;
  }
  return m;
}

// Lengths in units of 1 / k m, and all that is measured with them.
Mechanism in_unit(Mechanism m, double k) {
  m.gravity *= k;
  for (Body& b : m.bodies) {
    b.position *= k;
    for (double& i : b.inertia)
      i *= k * k;
  }
  const auto unit = [&](const std::string& name) {
    const CoordinateReference c = find_coordinate(m, name);
    return is_angle(m.joints[static_cast<std::size_t>(c.joint)].type, c.coordinate) ? 1. : k;
  };
  for (Joint& j : m.joints) {
    j.at *= k;
    for (Vec3& p : j.points)
      p *= k;
    if (j.length) *j.length *= k;
    if (j.type == JointType::gear) {
      const double a = unit(j.joints[0]), b = unit(j.joints[1]);
      j.ratio *= b / a;
      if (j.offset) *j.offset *= b;
    }
    for (std::size_t i = 0; i < j.coordinates.size(); ++i) {
      Coordinate& c = j.coordinates[i];
      const double length = is_translation(j, i) ? k : 1, stiffness = is_translation(j, i) ? 1 : k * k;
      c.drawn *= length;
      c.damping *= stiffness;
      if (c.drive) c.drive->speed *= length;
      if (c.spring) {
        c.spring->stiffness *= stiffness;
        c.spring->free *= length;
      }
      if (c.stop) {
        c.stop->stiffness *= stiffness;
        if (c.stop->lower) *c.stop->lower *= length;
        if (c.stop->upper) *c.stop->upper *= length;
      }
    }
  }
  for (Force& f : m.forces) {
    for (Vec3& p : f.points)
      p *= k;
    if (f.at) *f.at *= k;
    if (f.free_length) *f.free_length *= k;
    f.vector *= f.type == ForceType::torque ? k * k : k;
    f.quadratic /= k;
  }
  return m;
}

void negate(Coordinate& c) {
  c.drawn = -c.drawn;
  if (c.spring) c.spring->free = -c.spring->free;
  if (c.drive) c.drive->speed = -c.drive->speed;
  if (!c.stop) return;
  std::swap(c.stop->lower, c.stop->upper);
  if (c.stop->lower) *c.stop->lower *= -1;
  if (c.stop->upper) *c.stop->upper *= -1;
}

// The joint seen from its other body: what moved one way now moves the other. False for joints whose
// coordinates along the parent's axes mean something else along the child's, and have springs there.
bool swap_bodies(Mechanism& m, std::size_t index) {
  Joint& j = m.joints[index];
  const std::string name = j.name;
  const auto acts = [&](std::size_t first, std::size_t count) {
    return std::any_of(j.coordinates.begin() + static_cast<std::ptrdiff_t>(first),
                       j.coordinates.begin() + static_cast<std::ptrdiff_t>(first + count),
                       [](const Coordinate& c) { return c.spring || c.stop || c.drive || c.damping != 0; });
  };
  // The same rotation vector, back, in axes turned by the drawn one.
  const auto turn_back = [&](std::size_t first) {
    const Vec3 drawn = triple(j, first);
    const Quat turned = exp_rotation<double>(drawn);
    map_triple(j, first, [&](const Vec3& v) -> Vec3 { return -(turned * v); });
  };
  switch (j.type) {
  case JointType::gear: return false;
  case JointType::planar:
    if (acts(0, 2)) return false;
    break;
  case JointType::free:
    if (acts(0, 3)) return false;
    turn_back(3);
    break;
  case JointType::spherical: turn_back(0); break;
  default: break;
  }
  // Gears count the coordinate by its own sign.
  const bool universal = j.type == JointType::universal;
  for (Joint& g : m.joints) {
    if (g.type != JointType::gear) continue;
    if (!g.offset) g.offset = drawn_offset(m, g);
    for (const std::size_t end : {0U, 1U}) {
      const CoordinateReference c = find_coordinate(m, g.joints[end]);
      if (c.joint != static_cast<int>(index)) continue;
      g.ratio = -g.ratio;
      if (end == 1) *g.offset = -*g.offset;
      if (universal) g.joints[end] = coordinate_name(j, 1 - c.coordinate);
    }
  }
  for (std::size_t i = 0; i < j.coordinates.size(); ++i)
    if (!is_rotation_vector(j.type, static_cast<int>(i))) negate(j.coordinates[i]);
  if (universal) {
    std::swap(j.axis, j.axis2);
    std::swap(j.coordinates[0], j.coordinates[1]);
  }
  std::swap(j.bodies[0], j.bodies[1]);
  std::swap(j.points[0], j.points[1]);
  return true;
}

bool gears_translation(const Mechanism& m) {
  return std::ranges::any_of(m.joints, [&](const Joint& j) {
    return j.type == JointType::gear && std::ranges::any_of(j.joints, [&](const std::string& end) {
             return m.joints[static_cast<std::size_t>(find_coordinate(m, end).joint)].type == JointType::free;
           });
  });
}

struct Answer {
  Status status = Status::not_converged;
  std::map<std::string, Pose> poses;
  bool plain = false; // isolated and well away from folds
  std::string message;
};

Answer answer_of(const Mechanism& m) {
  const Solution s = Analysis(m).solve();
  Answer a;
  a.status = s.status;
  a.message = s.message;
  if (s.status != Status::converged) return a;
  for (std::size_t b = 0; b < m.bodies.size(); ++b)
    a.poses[m.bodies[b].name] = s.poses[b];
  a.plain = s.neutral.empty() && s.condition && *s.condition < 1e7;
  return a;
}

// How far apart two answers put the bodies, the second drawn turned, shifted and in another unit.
double apart(const Answer& a, const Answer& b, const Quat& r = Quat::Identity(),
             const Vec3& shift = Vec3::Zero(), double unit = 1) {
  double worst = 0;
  for (const auto& [name, pose] : a.poses) {
    const Pose& other = b.poses.at(name);
    worst = std::max(worst, ((r * pose.position + shift) * unit - other.position).norm() / unit);
    worst = std::max(worst, (r * pose.rotation).angularDistance(other.rotation));
  }
  return worst;
}

constexpr std::uint32_t samples = 120;

// Calls check(seed, mechanism, answer) for the samples that have a plain answer. Solved once for all tests.
template <class Check>
void for_samples(const Check& check) {
  static const std::vector<std::pair<Mechanism, Answer>> all = [] {
    std::vector<std::pair<Mechanism, Answer>> list;
    for (std::uint32_t seed = 0; seed < samples; ++seed) {
      const Mechanism m = sample(seed);
      list.emplace_back(m, answer_of(m));
    }
    return list;
  }();
  for (std::uint32_t seed = 0; seed < samples; ++seed) {
    const auto& [m, a] = all[seed];
    if (a.status != Status::converged || !a.plain) continue;
    INFO("seed " << seed << ": " << a.message);
    check(seed, m, a);
  }
}

void check_same(const Answer& a, const Answer& b, const Quat& r = Quat::Identity(),
                const Vec3& shift = Vec3::Zero(), double unit = 1) {
  INFO("then: " << b.message);
  CHECK(b.status == Status::converged);
  if (b.status == Status::converged) CHECK(apart(a, b, r, shift, unit) < 1e-8);
}

} // namespace

TEST_CASE("a good share of the random mechanisms has a steady state") {
  int plain = 0;
  for_samples([&](std::uint32_t, const Mechanism&, const Answer&) { ++plain; });
  CHECK(plain > static_cast<int>(samples) * 3 / 4);
}

TEST_CASE("equilibria do not depend on the order of bodies") {
  for_samples([](std::uint32_t seed, Mechanism m, const Answer& a) {
    Dice(seed).shuffle(m.bodies);
    check_same(a, answer_of(m));
  });
}

TEST_CASE("equilibria do not depend on the order of joints and forces") {
  for_samples([](std::uint32_t seed, Mechanism m, const Answer& a) {
    Dice dice(seed);
    dice.shuffle(m.joints);
    dice.shuffle(m.forces);
    check_same(a, answer_of(m));
  });
}

TEST_CASE("equilibria do not depend on which body a joint names first") {
  int swapped = 0;
  for_samples([&](std::uint32_t seed, const Mechanism& m, const Answer& a) {
    for (std::size_t j = 0; j < m.joints.size(); ++j) {
      Mechanism other = m;
      if (!swap_bodies(other, j)) continue;
      INFO(m.joints[j].name << ", " << type_name(m.joints[j].type));
      check_same(a, answer_of(other));
      ++swapped;
    }
    Mechanism all = m;
    Dice dice(seed);
    for (std::size_t j = 0; j < m.joints.size(); ++j)
      if (dice.chance(0.5)) swap_bodies(all, j);
    check_same(a, answer_of(all));
  });
  CHECK(swapped > 200);
}

TEST_CASE("equilibria turn with the world") {
  for_samples([](std::uint32_t seed, const Mechanism& m, const Answer& a) {
    if (gears_translation(m)) return; // along one axis of the world
    const Quat r = Dice(seed).rotation();
    check_same(a, answer_of(moved(m, r, Vec3::Zero())), r);
  });
}

TEST_CASE("equilibria do not depend on where the world has its origin") {
  for_samples([](std::uint32_t seed, const Mechanism& m, const Answer& a) {
    const Vec3 shift = Dice(seed).box(1000);
    check_same(a, answer_of(moved(m, Quat::Identity(), shift)), Quat::Identity(), shift);
  });
}

TEST_CASE("equilibria do not depend on the unit of length") {
  for_samples([](std::uint32_t, const Mechanism& m, const Answer& a) {
    for (const double k : {1000., 0.01}) {
      CAPTURE(k);
      check_same(a, answer_of(in_unit(m, k)), Quat::Identity(), Vec3::Zero(), k);
    }
  });
}

TEST_CASE("equilibria do not depend on where loops are cut") {
  int choices = 0;
  for_samples([&](std::uint32_t, const Mechanism& m, const Answer& a) {
    const System system = compile(m);
    for (const CutChoice& choice : neighbouring_cuts(m, system)) {
      Mechanism other = m;
      std::string cut;
      for (const int j : choice.cut) {
        other.joints[static_cast<std::size_t>(j)].cut = true;
        cut += " " + other.joints[static_cast<std::size_t>(j)].name;
      }
      INFO("cut:" << cut);
      check_same(a, answer_of(other));
      ++choices;
    }
  });
  CHECK(choices > 40);
}
