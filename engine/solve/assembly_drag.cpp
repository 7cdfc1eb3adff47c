#include "engine/solve/assembly_drag.hpp"

#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/solve/newton.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/point_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flyball {
namespace {

constexpr double longest_step = 0.3;  // scaled: loops stay on their branch
constexpr double farthest_pull = 0.5; // of the reach: of a target farther away the direction alone counts
constexpr double along_sight = 0.1;   // share with which a distance along the line of sight counts
constexpr double first_damping = 1e-3, least_damping = 1e-7, most_damping = 1e9;
constexpr double shortest_step = 1e-12; // scaled
constexpr double least_gain = 1e-14;    // of the squared distance
constexpr double on_target = 1e-14;     // of the reach
constexpr double stop_rounding = 1e-12; // scaled
constexpr double price_of_stop = 1e4;   // of the square of what a stop is passed by

// The mechanism's geometry: no forces, no drives, and every body of the same mass and of the inertia of its
// size, so that the metric counts the motion of each alike.
Mechanism geometry_of(const Mechanism& mechanism) {
  Mechanism out;
  out.bodies = mechanism.bodies;
  out.joints = mechanism.joints;
  std::vector<double> square(out.bodies.size());
  std::vector<int> count(out.bodies.size());
  Eigen::AlignedBox3d box;
  const auto add = [&](const std::string& name, const Vec3& point) {
    box.extend(point);
    const int body = body_index(mechanism, name);
    if (body < 0) return;
    const auto b = static_cast<std::size_t>(body);
    square[b] += (point - mechanism.bodies[b].position).squaredNorm();
    ++count[b];
  };
  for (Joint& joint : out.joints) {
    for (Coordinate& c : joint.coordinates)
      c = {.drawn = c.drawn, .spring = {}, .stop = {}, .drive = {}};
    for (std::size_t end = 0; end < 2 && joint.type != JointType::gear; ++end)
      add(joint.bodies[end], joint.type == JointType::distance ? joint.points[end] : joint.at);
  }
  for (const Body& body : out.bodies)
    box.extend(body.position);
  const double reach = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
  const double least = reach > 0 ? 0.05 * reach : 1;
  for (std::size_t b = 0; b < out.bodies.size(); ++b) {
    const double mean = count[b] > 0 ? square[b] / count[b] : 0;
    const double inertia = std::max(mean, least * least);
    out.bodies[b].mass = 1;
    out.bodies[b].inertia = {inertia, inertia, inertia, 0, 0, 0};
  }
  return out;
}

// A coordinate of a joint, where it stands, and how far it may go.
struct Tracked {
  int joint = -1; // of the mechanism; -1: a joint that only the tree has
  int index = 0;
  int coordinate = -1, cut = -1; // as ReportedCoordinate
  bool wraps = false;            // whole turns do not matter
  bool angle = true, rotation_vector = false;
  double value = 0; // rad or m, whole turns included
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  bool stops() const { return std::isfinite(lower) || std::isfinite(upper); }
};

// What is to become zero: `away` (m) and its scaled Jacobian, in which the wanted change has the same sign.
struct Task {
  Eigen::VectorXd away;
  Eigen::MatrixXd jacobian; // (away.size(), n)
};

} // namespace

struct AssemblyDrag::State {
  explicit State(const Mechanism& original) : mechanism(geometry_of(original)), system(compile(mechanism)) {
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, z.q);
    z.lambda.setZero(system.rows);
    none.setZero(system.rows);
    list_coordinates(original);
    assembled = assemble(problem(), z.q, 0, trial);
    place(z.q, trial);
    read_coordinates();
    // What is drawn beyond a stop may stay there, but goes no farther.
    for (Tracked& c : coordinates) {
      c.lower = std::min(c.lower, c.value);
      c.upper = std::max(c.upper, c.value);
    }
  }

  Problem problem() const { return {system, parameters, scaling, nullptr, system.kkt_form}; }

  void place(const Eigen::VectorXd& q, Workspace& there) const {
    forward<double>(system, parameters, q, 0, there.kinematics);
  }

  void list_coordinates(const Mechanism& original) {
    std::vector<std::vector<bool>> geared(original.joints.size());
    for (std::size_t j = 0; j < original.joints.size(); ++j)
      geared[j].resize(6);
    for (const Joint& gear : original.joints)
      for (std::size_t end = 0; end < 2 && gear.type == JointType::gear; ++end)
        if (const CoordinateReference r = find_coordinate(original, gear.joints[end]); r.joint >= 0)
          geared[static_cast<std::size_t>(r.joint)][static_cast<std::size_t>(r.coordinate)] = true;
    for (const ReportedCoordinate& r : system.reported) {
      Tracked& c = coordinates.emplace_back();
      c.index = r.index;
      c.coordinate = r.coordinate;
      c.cut = r.cut;
      c.angle = r.angle;
      c.joint = joint_index(original, r.joint);
      if (c.joint < 0) continue;
      const Joint& joint = original.joints[static_cast<std::size_t>(c.joint)];
      const auto i = static_cast<std::size_t>(r.index);
      const Coordinate& drawn = joint.coordinates[i];
      c.value = drawn.drawn;
      c.rotation_vector = is_rotation_vector(joint.type, r.index);
      c.wraps = r.angle && !c.rotation_vector && !drawn.spring && !drawn.stop &&
                !geared[static_cast<std::size_t>(c.joint)][i];
      if (!drawn.stop) continue;
      c.lower = drawn.stop->lower.value_or(c.lower);
      c.upper = drawn.stop->upper.value_or(c.upper);
    }
  }

  double value_of(const Tracked& c, const Eigen::VectorXd& q, const Kinematics<double>& k) const {
    if (c.cut < 0)
      return coordinate_value(system, parameters, q,
                              system.coordinates[static_cast<std::size_t>(c.coordinate)]);
    const auto cut = static_cast<std::size_t>(c.cut);
    const double value =
        joint_coordinates(system.cuts[cut], parameters.cuts[cut], k).value[static_cast<std::size_t>(c.index)];
    // Measured without whole turns: with those that it has made since.
    return c.angle && !c.rotation_vector ? c.value + std::remainder(value - c.value, 2 * std::numbers::pi)
                                         : value;
  }

  void read_coordinates() {
    for (Tracked& c : coordinates)
      c.value = value_of(c, z.q, trial.kinematics);
  }

  // By the scaled step, in rad or m.
  void gradient_of(const Tracked& c, const Kinematics<double>& k, Eigen::VectorXd& out) const {
    if (c.cut < 0) {
      out = coordinate_gradient(system, parameters, z.q,
                                system.coordinates[static_cast<std::size_t>(c.coordinate)]);
    } else {
      const auto n = static_cast<std::size_t>(c.cut);
      const CutJoint& cut = system.cuts[n];
      const CutParameters& numbers = parameters.cuts[n];
      const Eigen::Matrix<double, 1, 6> rate = joint_coordinates(cut, numbers, k).rate.row(c.index);
      out.setZero(system.nv);
      for (const SupportColumn& column : cut.ends.support)
        out[column.v] += rate.dot(relative_velocity(cut, numbers, k, column));
    }
    out.array() *= scaling.column.array();
  }

  // Of a coordinate, in which all of them count as lengths.
  double unit_of(const Tracked& c) const { return c.angle ? parameters.length : 1; }

  // How far stops are passed, the sum of squares.
  double passed(const Eigen::VectorXd& q, const Kinematics<double>& k) const {
    double sum = 0;
    for (const Tracked& c : coordinates) {
      if (!c.stops()) continue;
      const double value = value_of(c, q, k);
      const double by = std::max({0., c.lower - value, value - c.upper}) * unit_of(c);
      sum += by * by;
    }
    return sum;
  }

  // One whose step would lead beyond its stop, or along it.
  struct Bound {
    const Tracked* coordinate = nullptr;
    Eigen::VectorXd gradient, response; // response: K^-1 gradient
    double left = 0;                    // to the stop that it meets
    bool upper = false, solved = false;
  };

  void solve_for(const Eigen::VectorXd& rhs, Eigen::VectorXd& x) {
    KktSystem& kkt = w.kkt(problem());
    kkt.solve(rhs, none, x, multipliers);
  }

  void take_bounds() {
    bounds.resize(coordinates.size());
    std::size_t n = 0;
    for (const Tracked& c : coordinates) {
      if (!c.stops()) continue;
      Bound& b = bounds[n];
      b.coordinate = &c;
      gradient_of(c, w.kinematics, b.gradient);
      b.solved = false;
      ++n;
    }
    bounds.resize(n);
  }

  // Which stop the step leads beyond, farthest of all; none: bounds.size().
  std::size_t worst_bound() {
    std::size_t worst = bounds.size();
    double most = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      if (std::ranges::find(active, i) != active.end()) continue;
      Bound& b = bounds[i];
      const Tracked& c = *b.coordinate;
      const double to = c.value + b.gradient.dot(step);
      const double below = c.lower - to, above = to - c.upper;
      const double by = std::max(below, above) * unit_of(c) / parameters.length;
      if (by <= std::max(stop_rounding, most)) continue;
      most = by;
      worst = i;
      b.upper = above > below;
      b.left = (b.upper ? c.upper : c.lower) - c.value;
    }
    return worst;
  }

  // The step with the stops in `active` held; their forces in `held`.
  bool solve_step(double damping) {
    const Eigen::Index m = task.away.size(), k = static_cast<Eigen::Index>(active.size());
    small.setZero(m + k, m + k);
    small_rhs.setZero(m + k);
    small.topLeftCorner(m, m) = task.jacobian * responses;
    small.topLeftCorner(m, m).diagonal().array() += damping;
    small_rhs.head(m) = damping * pull;
    for (Eigen::Index j = 0; j < k; ++j) {
      Bound& b = bounds[active[static_cast<std::size_t>(j)]];
      if (!b.solved) solve_for(b.gradient, b.response);
      b.solved = true;
      small.col(m + j).head(m) = task.jacobian * b.response;
      for (Eigen::Index i = 0; i < k; ++i)
        small(m + i, m + j) = bounds[active[static_cast<std::size_t>(i)]].gradient.dot(b.response);
      small.row(m + j).head(m) = b.gradient.transpose() * responses;
      small_rhs[m + j] = damping * b.left;
    }
    if (!decomposition.compute(small)) return false;
    decomposition.solve(small_rhs, held);
    step = responses * held.head(m);
    for (Eigen::Index j = 0; j < k; ++j)
      step += held[m + j] * bounds[active[static_cast<std::size_t>(j)]].response;
    step /= damping;
    return step.allFinite();
  }

  bool find_step(double damping) {
    active.clear();
    const std::size_t most = 4 * bounds.size() + 4;
    for (std::size_t i = 0; i < most; ++i) {
      if (!solve_step(damping)) return false;
      // A stop only pushes: one that would pull is let go.
      const Eigen::Index m = task.away.size();
      std::size_t pulls = active.size();
      double strongest = 0;
      for (std::size_t j = 0; j < active.size(); ++j) {
        const double force = held[m + static_cast<Eigen::Index>(j)] * (bounds[active[j]].upper ? 1 : -1);
        if (force <= strongest) continue;
        strongest = force;
        pulls = j;
      }
      if (pulls < active.size() && 2 * i < most) {
        active.erase(active.begin() + static_cast<std::ptrdiff_t>(pulls));
        continue;
      }
      const std::size_t worst = worst_bound();
      if (worst == bounds.size()) return true;
      active.push_back(worst);
    }
    return true;
  }

  // `measure` fills task.away at a configuration with its kinematics, `linearise` task.jacobian.
  template <class Measure, class Linearise>
  DragOutcome run(Measure measure, Linearise linearise) {
    DragOutcome out;
    const Problem p = problem();
    measure(z.q, trial.kinematics);
    if (!assembled || system.nv == 0) {
      out.settled = true;
      return out;
    }
    double damping = first_damping;
    const int most = std::clamp(20000 / system.nv, 8, 60);
    for (int i = 0; i < most && !out.settled; ++i) {
      evaluate(p, z, 0, w);
      measure(z.q, w.kinematics);
      const double beyond = passed(z.q, w.kinematics);
      const double merit = task.away.squaredNorm() + price_of_stop * beyond;
      if (std::sqrt(merit) <= on_target * parameters.length) {
        out.settled = true;
        break;
      }
      linearise(w.kinematics);
      KktSystem& kkt = w.kkt(p);
      kkt.linearize(p, z, w);
      kkt.factor(1);
      responses.resize(system.nv, task.away.size());
      for (Eigen::Index r = 0; r < task.away.size(); ++r) {
        solve_for(task.jacobian.row(r).transpose(), response);
        responses.col(r) = response;
      }
      take_bounds();
      const double distance = task.away.norm(), most_pull = farthest_pull * parameters.length;
      pull = distance > most_pull ? Eigen::VectorXd(task.away * (most_pull / distance)) : task.away;
      out.settled = true; // unless a step is found
      for (; damping < most_damping; damping *= 8) {
        if (!find_step(damping)) continue;
        const double size = step.lpNorm<Eigen::Infinity>();
        if (size < shortest_step) break;
        if (size > longest_step) step *= longest_step / size;
        moved = z.q;
        w.step = step.cwiseProduct(scaling.column);
        retract<double>(system, w.step, moved);
        if (!assemble(p, moved, 0, trial)) continue;
        place(moved, trial);
        measure(moved, trial.kinematics);
        const double gained =
            merit - task.away.squaredNorm() - price_of_stop * passed(moved, trial.kinematics);
        if (!(gained > 0)) continue;
        z.q = moved;
        read_coordinates();
        out.settled = gained < least_gain * merit;
        damping = std::max(damping / 10, least_damping);
        break;
      }
      out.at_stop = !active.empty();
    }
    place(z.q, trial);
    measure(z.q, trial.kinematics);
    return out;
  }

  const Tracked& tracked(std::string_view joint, int index) const {
    const int j = joint_index(mechanism, joint);
    for (const Tracked& c : coordinates)
      if (j >= 0 && c.joint == j && c.index == index) return c;
    throw SceneError("joints." + std::string(joint), "there is no coordinate " + std::to_string(index));
  }

  Vec3 at(const TrackedPoint& point, const Kinematics<double>& k) const {
    return parameters.origin + k.point(point.link, point.at);
  }

  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Unknowns z; // where it is
  std::vector<Tracked> coordinates;
  bool assembled = false;

  // trial: of configurations looked at, at last that of z.
  Workspace w, trial;
  Task task;
  Eigen::MatrixXd responses, small; // responses: K^-1 of the task's rows
  Eigen::VectorXd none, multipliers, response, pull, small_rhs, held, step, moved;
  CompleteOrthogonal decomposition;
  std::vector<Bound> bounds;
  std::vector<std::size_t> active; // of the bounds
};

AssemblyDrag::AssemblyDrag(const Mechanism& mechanism) : state_(std::make_unique<State>(mechanism)) {}
AssemblyDrag::~AssemblyDrag() = default;
AssemblyDrag::AssemblyDrag(AssemblyDrag&&) noexcept = default;
AssemblyDrag& AssemblyDrag::operator=(AssemblyDrag&&) noexcept = default;

bool AssemblyDrag::assembled() const {
  return state_->assembled;
}

DragOutcome AssemblyDrag::pull(const BodyPoint& grabbed, const PullTarget& target) {
  State& s = *state_;
  const TrackedPoint point = find_point(s.system, s.mechanism, s.parameters, grabbed);
  const Vec3 sight = target.sight;
  const Mat3 weight = Mat3::Identity() - (1 - along_sight) * sight * sight.transpose();
  const auto measure = [&](const Eigen::VectorXd&, const Kinematics<double>& k) {
    s.task.away = weight * (target.at - s.at(point, k));
  };
  const auto linearise = [&](const Kinematics<double>& k) {
    s.task.jacobian.setZero(3, s.system.nv);
    const Vec3 p = k.point(point.link, point.at);
    for (int l = point.link; l >= 0; l = s.system.links[static_cast<std::size_t>(l)].parent) {
      const Link& link = s.system.links[static_cast<std::size_t>(l)];
      if (link.v < 0) continue;
      for (int v = link.v; v < link.v + (link.type == LinkType::spherical ? 3 : 1); ++v)
        s.task.jacobian.col(v) = weight * k.columns[static_cast<std::size_t>(v)].at(p) * s.scaling.column[v];
    }
  };
  DragOutcome out = s.run(measure, linearise);
  out.away = (target.at - s.at(point, s.trial.kinematics)).norm();
  return out;
}

DragOutcome AssemblyDrag::move(std::string_view joint, int index, double value) {
  State& s = *state_;
  const Tracked& c = s.tracked(joint, index);
  const double unit = s.unit_of(c);
  const auto measure = [&](const Eigen::VectorXd& q, const Kinematics<double>& k) {
    s.task.away.setConstant(1, unit * (value - s.value_of(c, q, k)));
  };
  const auto linearise = [&](const Kinematics<double>& k) {
    s.gradient_of(c, k, s.response);
    s.task.jacobian = unit * s.response.transpose();
  };
  DragOutcome out = s.run(measure, linearise);
  out.away = std::abs(value - c.value);
  return out;
}

MechanismPose AssemblyDrag::pose() const {
  const State& s = *state_;
  MechanismPose out;
  body_poses(s.system, s.mechanism, s.parameters, s.trial.kinematics, out.bodies);
  out.coordinates.resize(s.mechanism.joints.size());
  for (std::size_t j = 0; j < s.mechanism.joints.size(); ++j) {
    const Joint& joint = s.mechanism.joints[j];
    for (std::size_t i = 0; i < joint.coordinates.size() && i < 6; ++i)
      out.coordinates[j][i] = joint.coordinates[i].drawn;
  }
  for (const Tracked& c : s.coordinates)
    if (c.joint >= 0)
      out.coordinates[static_cast<std::size_t>(c.joint)][static_cast<std::size_t>(c.index)] =
          c.wraps ? wrapped_angle(c.value) : c.value;
  return out;
}

Vec3 AssemblyDrag::position(const BodyPoint& point) const {
  const State& s = *state_;
  return s.at(find_point(s.system, s.mechanism, s.parameters, point), s.trial.kinematics);
}

std::optional<Vec3> AssemblyDrag::plane_of(const BodyPoint& point) const {
  constexpr double aligned = 1e-9;
  const State& s = *state_;
  const Kinematics<double>& k = s.trial.kinematics;
  std::vector<Vec3> turns, slides;
  for (int l = find_point(s.system, s.mechanism, s.parameters, point).link; l >= 0;
       l = s.system.links[static_cast<std::size_t>(l)].parent) {
    const Link& link = s.system.links[static_cast<std::size_t>(l)];
    if (link.v < 0) continue;
    if (link.type == LinkType::spherical) return {};
    const Column<double>& column = k.columns[static_cast<std::size_t>(link.v)];
    (column.angular ? turns : slides).push_back(column.axis);
  }
  Vec3 normal = Vec3::Zero();
  if (!turns.empty())
    normal = turns.front();
  else
    for (const Vec3& slide : slides)
      if (const Vec3 across = slides.front().cross(slide); across.norm() > normal.norm()) normal = across;
  if (normal.norm() < aligned) return {};
  normal.normalize();
  for (const Vec3& axis : turns)
    if (axis.cross(normal).norm() > aligned) return {};
  for (const Vec3& axis : slides)
    if (std::abs(axis.dot(normal)) > aligned) return {};
  return normal;
}

} // namespace flyball
