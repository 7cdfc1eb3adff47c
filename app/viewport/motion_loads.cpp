#include "app/viewport/motion_loads.hpp"

#include "engine/dynamics/motion_model.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>

namespace flyball {

namespace {

// Of one moment: sample `first` and the next, which has this share.
struct Moment {
  std::size_t first = 0;
  double share = 0;

  Moment(const std::vector<double>& times, double time) {
    if (times.size() < 2) return;
    const auto after = std::ranges::upper_bound(times, time);
    const auto next =
        std::clamp<std::ptrdiff_t>(after - times.begin(), 1, static_cast<std::ptrdiff_t>(times.size()) - 1);
    first = static_cast<std::size_t>(next) - 1;
    const double from = times[first], step = times[first + 1] - from;
    share = step > 0 ? std::clamp((time - from) / step, 0., 1.) : 1; // two at one time: of a jump the later
  }

  template <class T>
  T of(const std::vector<T>& samples) const {
    if (first + 1 >= samples.size()) return samples.at(first);
    return T((1 - share) * samples[first] + share * samples[first + 1]);
  }
};

class MotionCollector {
 public:
  MotionCollector(const Assembly& assembly, const Run& motion) : assembly_(assembly), motion_(motion) {
    const std::vector<Joint>& joints = assembly.mechanism.joints;
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints_.emplace(joints[i].name, i);
  }

  std::vector<Load> at(const Moment& moment) const {
    std::vector<Load> loads;
    const auto add = [&](Load load) {
      if (load.vector.allFinite() && load.vector.stableNorm() > 0) loads.push_back(std::move(load));
    };
    const auto add_along = [&](LoadKind kind, const std::string& name, int index, double value) {
      if (const auto joint = joints_.find(name); joint != joints_.end())
        add(load_along(assembly_, kind, joint->second, static_cast<std::size_t>(index), value));
    };
    const auto add_both = [&](const auto& track, const Vec3& place, const PartId& part) {
      add({LoadKind::reaction, false, place, moment.of(track.force), part});
      add({LoadKind::reaction, true, place, moment.of(track.torque), part});
    };
    for (const ReactionTrack& track : motion_.reactions)
      if (const auto joint = joints_.find(track.joint); joint != joints_.end())
        add_both(track, reaction_place(assembly_, joint->second),
                 {PartKind::joint, static_cast<int>(joint->second)});
    for (const BearingTrack& track : motion_.bearings)
      if (const int force = force_index(assembly_.mechanism, track.bearing); force >= 0)
        add_both(track, bearing_place(assembly_, static_cast<std::size_t>(force)), {PartKind::force, force});
    for (const DriveTrack& track : motion_.drives) {
      const double load = track.load.empty() ? 0 : moment.of(track.load);
      add_along(LoadKind::drive, track.joint, track.index, moment.of(track.torque) + load);
      add_along(LoadKind::applied, track.joint, track.index, -load);
    }
    for (const SpringTrack& track : motion_.springs) {
      const double spring = moment.of(track.spring) + moment.of(track.stop), damper = moment.of(track.damper);
      if (track.between_points) {
        for (const Load& load : tension(track.joint, spring + damper))
          add(load);
        continue;
      }
      add_along(LoadKind::spring, track.joint, track.index, spring);
      add_along(LoadKind::damper, track.joint, track.index, damper);
    }
    for (const GearTrack& track : motion_.gears)
      if (const auto gear = joints_.find(track.joint); gear != joints_.end()) {
        const Joint& of = assembly_.mechanism.joints[gear->second];
        for (const auto& [name, values] : {std::pair(&of.joints[0], &track.a), {&of.joints[1], &track.b}})
          if (const CoordinateReference c = find_coordinate(assembly_.mechanism, *name); c.joint >= 0) {
            Load load = load_along(assembly_, LoadKind::gear, static_cast<std::size_t>(c.joint),
                                   static_cast<std::size_t>(c.coordinate), moment.of(*values));
            load.part = {PartKind::joint, static_cast<int>(gear->second)};
            add(std::move(load));
          }
      }
    return loads;
  }

 private:
  // Of a spring between two points, on each body.
  std::vector<Load> tension(const std::string& name, double size) const {
    const int index = force_index(assembly_.mechanism, name);
    if (index < 0) return {};
    const Force& force = assembly_.mechanism.forces[static_cast<std::size_t>(index)];
    const auto [first, second] = assembly_.force_bodies[static_cast<std::size_t>(index)];
    const Vec3 a = assembly_.point(first, force.points[0]), b = assembly_.point(second, force.points[1]),
               pull = size * (b - a).stableNormalized();
    std::vector<Load> loads;
    if (first >= 0) loads.push_back({LoadKind::spring, false, a, pull, {PartKind::force, index}});
    if (second >= 0) loads.push_back({LoadKind::spring, false, b, -pull, {PartKind::force, index}});
    return loads;
  }

  const Assembly& assembly_;
  const Run& motion_;
  std::unordered_map<std::string_view, std::size_t> joints_;
};

// Of each body, one after the other: its mass centre, and that moved by 1 m along x and y of the world in the
// drawn pose, which tell how the body turns.
constexpr std::size_t points_a_body = 3;
std::vector<BodyPoint> telling_points(const Mechanism& mechanism) {
  std::vector<BodyPoint> points;
  for (const Body& body : mechanism.bodies)
    for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)})
      points.push_back({body.name, body.position + aside});
  return points;
}

// From the last sample to the time (s), with all outputs there. Without samples where it does not get there.
Run run_to(const Run& motion, double time) {
  const auto after = std::ranges::upper_bound(motion.time, time);
  const auto sample = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - motion.time.begin(), 1) - 1);
  auto segment = motion.segments.rbegin();
  while (segment->first > sample && segment + 1 != motion.segments.rend())
    ++segment;
  SimulationOptions options;
  options.start = Start::state;
  options.state = state_at(motion, sample);
  options.rate = 0;
  options.tolerance = 1e-9;
  options.method = motion.method;
  options.damped = motion.damped;
  options.reactions = true;
  options.measures = false;
  options.points = telling_points(segment->model->mechanism);
  try {
    Simulator simulator(*segment->model, options);
    if (simulator.advance(time, true)) return simulator.run();
  } catch (const SceneError&) { // it has no such moment
  }
  return {};
}

// What loads_of() asks of a steady state.
struct AsSteady {
  Solution solution;
  std::vector<AngularMotion> turning;
};

// How a body turns, by the motion of its points relative to the first, of which the others are at right
// angles and 1 m away.
AngularMotion turning_by(const std::array<PointMotion, points_a_body>& points) {
  const Vec3 x = points[1].position - points[0].position, y = points[2].position - points[0].position,
             z = x.cross(y);
  // w from what w x r is of x and y.
  const auto from = [&](const Vec3& of_x, const Vec3& of_y) {
    return Vec3(of_y.dot(z) * x - of_x.dot(z) * y + of_x.dot(y) * z);
  };
  AngularMotion turning;
  turning.velocity = from(points[1].velocity - points[0].velocity, points[2].velocity - points[0].velocity);
  const Vec3& w = turning.velocity;
  turning.acceleration = from(points[1].acceleration - points[0].acceleration - w.cross(w.cross(x)),
                              points[2].acceleration - points[0].acceleration - w.cross(w.cross(y)));
  return turning;
}

// The last sample of a run with the points above; nothing where accelerations of what has mass are not known.
std::optional<AsSteady> as_steady(const Mechanism& mechanism, const Run& run) {
  if (run.time.empty() || run.points.size() != points_a_body * mechanism.bodies.size()) return {};
  AsSteady out;
  Solution& solution = out.solution;
  for (const CoordinateTrack& track : run.coordinates) {
    CoordinateSolution& c = solution.coordinates.emplace_back();
    c.joint = track.joint;
    c.index = track.index;
    c.count = track.count;
    c.angle = track.angle;
    c.value = track.value.back();
  }
  for (const DriveTrack& track : run.drives) {
    DriveTorque& drive = solution.drive_torques.emplace_back();
    drive.joint = track.joint;
    drive.index = track.index;
    drive.count = track.count;
    drive.angle = track.angle;
    drive.value = track.torque.back();
    if (!track.load.empty())
      drive.given = DriveTorque::Given{track.torque.back() + track.load.back(), track.load.back()};
  }
  for (const ReactionTrack& track : run.reactions) {
    Reaction& reaction = solution.reactions.emplace_back();
    reaction.joint = track.joint;
    reaction.force = track.force.back();
    reaction.torque = track.torque.back();
  }
  for (const BearingTrack& track : run.bearings) {
    BearingForce& bearing = solution.bearings.emplace_back();
    bearing.bearing = track.bearing;
    bearing.force = track.force.back();
    bearing.torque = track.torque.back();
  }
  for (const GearTrack& track : run.gears) {
    if (!std::isfinite(track.a.back()) || !std::isfinite(track.b.back())) continue;
    GearReaction& gear = solution.gears.emplace_back();
    gear.joint = track.joint;
    gear.a = track.a.back();
    gear.b = track.b.back();
  }
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const Body& body = mechanism.bodies[b];
    const bool inert = body.mass > 0 || std::ranges::any_of(body.inertia, [](double i) { return i != 0; });
    std::array<PointMotion, points_a_body> points;
    for (std::size_t i = 0; i < points_a_body; ++i) {
      const PointTrack& track = run.points[points_a_body * b + i];
      if (inert && track.acceleration.empty()) return {};
      points[i] = {track.position.back(), track.velocity.back(),
                   track.acceleration.empty() ? Vec3(0, 0, 0) : track.acceleration.back()};
    }
    solution.centres.push_back(points[0]);
    out.turning.push_back(turning_by(points));
  }
  return out;
}

} // namespace

std::vector<Load> loads_at(const Assembly& assembly, const Run& motion, double time) {
  if (motion.time.empty()) return {};
  return MotionCollector(assembly, motion).at(Moment(motion.time, time));
}

std::optional<std::vector<Load>> diagram_at(const Assembly& assembly, const Run& motion, double time,
                                            int body) {
  constexpr std::size_t most_bodies = 50; // the window waits for it
  if (motion.time.empty() || motion.segments.empty() || assembly.mechanism.bodies.size() > most_bodies)
    return {};
  const std::optional<AsSteady> now = as_steady(assembly.mechanism, run_to(motion, time));
  if (!now) return {};
  return loads_of(assembly, now->solution, now->turning, body);
}

LoadScales diagram_scales(const Assembly& assembly, const Run& motion, int body,
                          const std::vector<Load>& diagram) {
  LoadScales scales = load_scales(assembly, diagram, LoadLengths::in_proportion);
  const auto take = [&](const auto& track, const std::array<int, 2>& bodies) {
    if (bodies[0] != body && bodies[1] != body) return;
    for (const Vec3& force : track.force)
      scales.leave_room(false, force.norm());
    for (const Vec3& torque : track.torque)
      scales.leave_room(true, torque.norm());
  };
  for (const ReactionTrack& track : motion.reactions)
    if (const int joint = joint_index(assembly.mechanism, track.joint); joint >= 0)
      take(track, assembly.joint_bodies[static_cast<std::size_t>(joint)]);
  for (const BearingTrack& track : motion.bearings)
    if (const int force = force_index(assembly.mechanism, track.bearing); force >= 0)
      take(track, assembly.force_bodies[static_cast<std::size_t>(force)]);
  return scales;
}

LoadScales motion_load_scales(const Assembly& assembly, const Run& motion,
                              std::optional<LoadLengths> lengths) {
  std::vector<Load> largest; // of each track
  const auto add = [&](LoadKind kind, bool moment, std::size_t samples, const auto& size_at) {
    double most = 0;
    for (std::size_t i = 0; i < samples; ++i)
      if (const double size = size_at(i); size > most) most = size; // what is not known is no number
    largest.push_back({kind, moment, Vec3::Zero(), most * Vec3::UnitX(), {}});
  };
  const auto add_vectors = [&](bool moment, const std::vector<Vec3>& vectors) {
    add(LoadKind::reaction, moment, vectors.size(), [&](std::size_t i) { return vectors[i].norm(); });
  };
  const auto add_numbers = [&](LoadKind kind, bool moment, const std::vector<double>& numbers) {
    add(kind, moment, numbers.size(), [&](std::size_t i) { return std::abs(numbers[i]); });
  };
  for (const ReactionTrack& track : motion.reactions) {
    add_vectors(false, track.force);
    add_vectors(true, track.torque);
  }
  for (const BearingTrack& track : motion.bearings) {
    add_vectors(false, track.force);
    add_vectors(true, track.torque);
  }
  for (const DriveTrack& track : motion.drives) {
    add(LoadKind::drive, track.angle, track.torque.size(),
        [&](std::size_t i) { return std::abs(track.torque[i] + (track.load.empty() ? 0 : track.load[i])); });
    add_numbers(LoadKind::applied, track.angle, track.load);
  }
  for (const SpringTrack& track : motion.springs) {
    const bool both = track.between_points; // spring and damper are one arrow
    add(LoadKind::spring, track.angle, track.spring.size(), [&](std::size_t i) {
      return std::abs(track.spring[i] + track.stop[i] + (both ? track.damper[i] : 0));
    });
    if (!both) add_numbers(LoadKind::damper, track.angle, track.damper);
  }
  for (const GearTrack& track : motion.gears) {
    add_numbers(LoadKind::gear, track.angle_a, track.a);
    add_numbers(LoadKind::gear, track.angle_b, track.b);
  }
  return load_scales(assembly, largest, lengths);
}

} // namespace flyball
