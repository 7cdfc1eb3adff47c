// Simbody at the job: Motion::Steady for the drive, Constraint::Rod for the links, and the best of its
// integrators; without CPodes, which in Debian's 3.7 ends the program by an assertion on these mechanisms.
#include "tests/bench/peers/clock.hpp"
#include "tests/bench/peers/dampers.hpp"

#ifdef FLYBALL_HAVE_SIMBODY
#include <Simbody.h>

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
    drawn_ = system_.realizeTopology();
    system_.realizeModel(drawn_);
    for (std::size_t k = 0; k < children_.size(); ++k)
      if (!moving_[k]) child(k).setOneU(drawn_, 0, job.joints[k].speed);
  }

  void set_dampers(const std::vector<double>& c) {
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

  const Job& job_;
  MultibodySystem system_;
  SimbodyMatterSubsystem matter_;
  GeneralForceSubsystem forces_;
  std::vector<MobilizedBody> bodies_;
  std::vector<Force::MobilityLinearDamper> dampers_;
  std::vector<bool> moving_;
  std::vector<int> children_;
  State drawn_;
};

} // namespace

PeerResult run_simbody(const Job& job, Damping damping) {
  SimbodyJob simbody(job);
  PeerResult best;
  best.available = true;
  const bool large = job.chain;
  const double longest = 1e3;
  const std::size_t most = large ? 3000 : 4000;
  for (const auto& [method, name] : methods) {
    std::vector<Range> ranges{fixed_step(method) ? Range{1e-4, 1} : Range{1e-9, 0.1}};
    const std::vector<Range> d = damper_ranges(job, damping);
    ranges.insert(ranges.end(), d.begin(), d.end());
    std::vector<std::vector<double>> guesses;
    for (const double size :
         fixed_step(method) ? std::vector<double>{2e-3, 5e-4} : std::vector<double>{3e-2, 1e-3, 1e-5})
      for (const double scale : {1., 5.}) {
        std::vector<double> g(ranges.size(), scale);
        g[0] = size;
        if (damping == Damping::free && !job.chain)
          for (const JobJoint& joint : job.joints)
            if (!joint.driven)
              g[1 + static_cast<std::size_t>(joint.damper)] = std::max(1e-3, scale * joint.damping);
        guesses.push_back(std::move(g));
      }
    std::size_t longest_run = most;
    long evaluations = 0;
    const auto settle = [&, chosen = method](const std::vector<double>& x) {
      simbody.set_dampers(chosen_dampers(job, damping, &x[1]));
      const long before = simbody.evaluations();
      std::vector<double> errors = simbody.run(chosen, x[0], longest_run, longest);
      evaluations = simbody.evaluations() - before;
      return errors;
    };
    const Tuned tuned =
        tune(ranges, guesses, large ? 10 : 40, large ? 5 : 2.5, [&](const std::vector<double>& x) {
          const std::vector<double> errors = settle(x);
          const double settled = settling_step(errors, near_enough);
          if (settled < 0) return not_arrived(errors.back());
          longest_run = std::min(longest_run, static_cast<std::size_t>(6 * settled) + 60);
          return settled * static_cast<double>(evaluations) / static_cast<double>(errors.size());
        });
    PeerResult result;
    longest_run = most;
    const std::vector<double> errors = settle(tuned.values);
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
      result.settings = words.str();
    }
    const bool better = result.reached && (!best.reached || result.fastest_s < best.fastest_s);
    if (better || (!best.reached && (best.bias == 0 || result.bias < best.bias))) best = result;
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
