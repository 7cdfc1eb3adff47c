// Simbody at the job: Motion::Steady for the drive, Constraint::Rod for the links, and the best of its
// integrators; without CPodes, which in Debian's 3.7 ends the program by an assertion on these mechanisms.
#include "tests/bench/peers/clock.hpp"
#include "tests/bench/peers/dampers.hpp"

#ifdef FLYBALL_HAVE_SIMBODY
#include <Simbody.h>

#include <algorithm>
#include <iomanip>
#include <memory>
#include <sstream>

namespace flyball::peers {
namespace {

using namespace SimTK;

Vec3 vec(const Vec& v) {
  return {v[0], v[1], v[2]};
}

enum class Method { merson, runge_kutta_3, euler_2, verlet, fixed_euler };
constexpr std::pair<Method, const char*> methods[] = {{Method::merson, "Runge-Kutta-Merson"},
                                                      {Method::runge_kutta_3, "Runge-Kutta 3"},
                                                      {Method::euler_2, "semi-explicit Euler 2"},
                                                      {Method::verlet, "Verlet"},
                                                      {Method::fixed_euler, "semi-explicit Euler"}};

bool fixed_step(Method method) {
  return method == Method::fixed_euler;
}

// Resists every body's motion in proportion to its mass, the same way at any frequency: dampers in the hinges
// of a chain make equations too stiff for Simbody's explicit integrators. About a vertical axis that only
// turns the hinges' loads, not the angles.
class Drag : public Force::Custom::Implementation {
 public:
  Drag(const SimbodyMatterSubsystem& matter, const double& rate) : matter_(matter), rate_(rate) {}
  void calcForce(const State& state, Vector_<SpatialVec>& forces, Vector_<Vec3>&, Vector&) const override {
    for (MobilizedBodyIndex i(1); i < matter_.getNumBodies(); ++i) {
      const MobilizedBody& body = matter_.getMobilizedBody(i);
      forces[i][1] -= rate_ * body.getBodyMass(state) * body.getBodyOriginVelocity(state);
    }
  }
  Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  const SimbodyMatterSubsystem& matter_;
  const double& rate_; // 1/s
};

class SimbodyJob {
 public:
  explicit SimbodyJob(const Job& job) : job_(job), matter_(system_), forces_(system_) {
    Force::UniformGravity(forces_, matter_, vec(job.gravity));
    bodies_.resize(job.bodies.size());
    for (const JobJoint& joint : job.joints) {
      const JobBody& b = job.bodies[static_cast<std::size_t>(joint.child)];
      const auto& i = b.inertia;
      // Too thin for Simbody's taste: a point or a rod.
      const Inertia inertia(i[0] + 1e-14, i[1] + 1e-14, i[2] + 1e-14, i[3], i[4], i[5]);
      const Body::Rigid body(MassProperties(b.mass, Vec3(0), b.mass > 0 ? inertia : Inertia(0)));
      const Vec3 base =
          joint.parent < 0 ? Vec3(0) : vec(job.bodies[static_cast<std::size_t>(joint.parent)].position);
      const CoordinateAxis along = joint.slides ? CoordinateAxis(XAxis) : CoordinateAxis(ZAxis);
      const Rotation turn(UnitVec3(vec(joint.axis)), along);
      const Transform on_parent(turn, vec(joint.at) - base), on_child(turn, vec(joint.at) - vec(b.position));
      MobilizedBody& parent =
          joint.parent < 0 ? matter_.Ground() : bodies_[static_cast<std::size_t>(joint.parent)];
      MobilizedBody& child = bodies_[static_cast<std::size_t>(joint.child)];
      if (joint.slides)
        child = MobilizedBody::Slider(parent, on_parent, body, on_child);
      else
        child = MobilizedBody::Pin(parent, on_parent, body, on_child);
      if (joint.driven) Motion::Steady(child, joint.speed);
      if (joint.stiffness > 0)
        Force::MobilityLinearSpring(forces_, child, MobilizerQIndex(0), joint.stiffness,
                                    joint.free - joint.drawn);
      dampers_.emplace_back(forces_, child, MobilizerUIndex(0), 0);
      moving_.push_back(!joint.driven);
      children_.push_back(joint.child);
    }
    for (const JobLink& link : job.links) {
      const auto on = [&](int body, const Vec& at) {
        return vec(at) - vec(job.bodies[static_cast<std::size_t>(body)].position);
      };
      Constraint::Rod(bodies_[static_cast<std::size_t>(link.a)], on(link.a, link.on_a),
                      bodies_[static_cast<std::size_t>(link.b)], on(link.b, link.on_b), link.length);
    }
    if (job.chain) Force::Custom(forces_, new Drag(matter_, drag_)); // who owns it
    drawn_ = system_.realizeTopology();
    system_.realizeModel(drawn_);
    for (std::size_t k = 0; k < children_.size(); ++k)
      if (!moving_[k]) child(k).setOneU(drawn_, 0, job.joints[k].speed);
  }

  // `x` as damper_ranges() has them; of a chain a multiple of `chain_drag`.
  void set_dampers(Damping damping, const double* x) {
    if (job_.chain) {
      drag_ = x[0] * chain_drag;
      return;
    }
    const std::vector<double> c = chosen_dampers(job_, damping, x);
    for (std::size_t k = 0; k < c.size(); ++k)
      if (moving_[k]) dampers_[k].setDamping(drawn_, c[k]);
  }

  // `size` is the accuracy, or the step (s) of a method with a fixed one.
  std::unique_ptr<Integrator> integrator(Method method, double size) {
    std::unique_ptr<Integrator> made;
    switch (method) {
    case Method::merson: made = std::make_unique<RungeKuttaMersonIntegrator>(system_); break;
    case Method::runge_kutta_3: made = std::make_unique<RungeKutta3Integrator>(system_); break;
    case Method::euler_2: made = std::make_unique<SemiExplicitEuler2Integrator>(system_); break;
    case Method::verlet: made = std::make_unique<VerletIntegrator>(system_); break;
    case Method::fixed_euler: made = std::make_unique<SemiExplicitEulerIntegrator>(system_, size); break;
    }
    if (!fixed_step(method)) made->setAccuracy(size);
    made->setConstraintTolerance(1e-7);
    made->setReturnEveryInternalStep(true);
    made->setAllowInterpolation(false);
    return made;
  }

  // Errors after every step, until they have been small for as long again, or `most` steps.
  std::vector<double> run(Method method, double size, std::size_t most, double longest) {
    const auto integrate = integrator(method, size);
    std::vector<double> errors{1};
    std::size_t small = 0;
    try {
      integrate->initialize(drawn_);
      while (errors.size() < most) {
        integrate->stepTo(longest);
        const double e = error(integrate->getState());
        errors.push_back(e);
        if (!std::isfinite(e) || e > 1e3) break;
        if (e < near_enough && small == 0) small = errors.size();
        if (small > 0 && errors.size() > 2 * small + 20) break;
        if (integrate->getTime() >= longest) break;
      }
    } catch (const std::exception&) { // a step that cannot be made
      errors.push_back(1e6);
    }
    return errors;
  }

  void repeat(Method method, double size, long steps, double longest) {
    const auto integrate = integrator(method, size);
    integrate->initialize(drawn_);
    for (long i = 0; i < steps; ++i)
      integrate->stepTo(longest);
  }

  // What steps cost, as evaluations of accelerations; projections are done per step.
  long evaluations() const { return system_.getNumRealizationsOfThisStage(Stage::Acceleration); }

 private:
  MobilizedBody& child(std::size_t joint) { return bodies_[static_cast<std::size_t>(children_[joint])]; }

  double error(const State& state) {
    double worst = 0;
    for (std::size_t k = 0; k < children_.size(); ++k)
      if (moving_[k])
        worst = std::max(worst,
                         std::abs(child(k).getOneQ(state, 0) + job_.joints[k].drawn - job_.joints[k].target));
    return worst;
  }

  static constexpr double chain_drag = 6; // 1/s: about critical for a chain of 1 m at 2 rad/s
  const Job& job_;
  double drag_ = 0; // 1/s
  MultibodySystem system_;
  SimbodyMatterSubsystem matter_;
  GeneralForceSubsystem forces_;
  std::vector<MobilizedBody> bodies_;
  std::vector<Force::MobilityLinearDamper> dampers_;
  std::vector<bool> moving_;
  std::vector<int> children_;
  State drawn_;
};

std::vector<std::vector<double>> guesses(const Job& job, Damping damping, Method method) {
  const std::vector<double> sizes =
      fixed_step(method) ? std::vector<double>{1.8e-3, 5e-4} : std::vector<double>{3e-2, 1e-3, 1e-5};
  const std::vector<double> scales = job.chain ? std::vector<double>{1} : std::vector<double>{1, 5, 0.2};
  std::vector<std::vector<double>> all;
  for (const double size : sizes)
    for (const double scale : scales) {
      std::vector<double> g(1 + damper_ranges(job, damping).size(), scale);
      g[0] = size;
      if (damping == Damping::free)
        for (const JobJoint& joint : job.joints)
          if (!joint.driven)
            g[1 + static_cast<std::size_t>(joint.damper)] = std::max(1e-3, scale * joint.damping);
      all.push_back(std::move(g));
    }
  return all;
}

} // namespace

PeerResult run_simbody(const Job& job, Damping damping) {
  SimbodyJob simbody(job);
  const double longest = 1e3;
  constexpr std::size_t most = 4000; // steps
  std::size_t longest_run = most;
  long evaluations = 0;
  const auto settle = [&](Method method, const std::vector<double>& x) {
    simbody.set_dampers(damping, &x[1]);
    const long before = simbody.evaluations();
    std::vector<double> errors = simbody.run(method, x[0], longest_run, longest);
    evaluations = simbody.evaluations() - before;
    return errors;
  };
  const auto scan = [&](Method method, const std::vector<std::vector<double>>& guesses, int samples,
                        double seconds) {
    longest_run = most;
    std::vector<Range> ranges{fixed_step(method) ? Range{1e-4, 1} : Range{1e-9, 0.1}};
    const std::vector<Range> d = damper_ranges(job, damping);
    ranges.insert(ranges.end(), d.begin(), d.end());
    return tune(ranges, guesses, samples, seconds, [&](const std::vector<double>& x) {
      const std::vector<double> errors = settle(method, x);
      const double settled = settling_step(errors, near_enough);
      if (settled < 0) return not_arrived(errors.back());
      longest_run = std::min(longest_run, static_cast<std::size_t>(6 * settled) + 60);
      return settled * static_cast<double>(evaluations) / static_cast<double>(errors.size());
    });
  };

  // A short scan of every method, a long one of the two best.
  struct Candidate {
    Method method;
    const char* name;
    Tuned tuned;
  };
  std::vector<Candidate> candidates;
  for (const auto& [method, name] : methods)
    candidates.push_back({method, name, scan(method, guesses(job, damping, method), 0, tuning_s / 5)});
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.tuned.cost < b.tuned.cost; });
  PeerResult best;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [method, name, first] = candidates[i];
    const Tuned tuned = scan(method, {first.values}, job.chain ? 0 : 40, tuning_s);
    PeerResult result;
    longest_run = most;
    const std::vector<double> errors = settle(method, tuned.values);
    const double settled = settling_step(errors, near_enough);
    result.available = true;
    result.bias = errors.back();
    result.reached = settled >= 0;
    if (result.reached) {
      result.steps = static_cast<long>(std::ceil(settled));
      const Times times =
          time_of([&, chosen = method] { simbody.repeat(chosen, tuned.values[0], result.steps, longest); });
      result.fastest_s = times.fastest_s;
      result.median_s = times.median_s;
      std::ostringstream words;
      words << std::setprecision(2) << name << (fixed_step(method) ? ", step " : ", accuracy ")
            << tuned.values[0] << (fixed_step(method) ? " s" : "");
      if (damping == Damping::critical)
        words << (job.chain ? ", drag × " : ", dampers × ") << tuned.values[1];
      result.settings = words.str();
    }
    const bool better = result.reached && (!best.reached || result.fastest_s < best.fastest_s);
    if (better || !best.available || (!best.reached && result.bias < best.bias)) best = result;
  }
  return best;
}

} // namespace flyball::peers

#else

namespace flyball::peers {
PeerResult run_simbody(const Job&, Damping) {
  return {};
}
} // namespace flyball::peers

#endif
