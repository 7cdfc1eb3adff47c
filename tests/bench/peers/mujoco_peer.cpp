// MuJoCo at the job: a driven joint keeps its speed by an armature of 1e12 kg m^2, links are tendons of fixed
// length (soft, as all of MuJoCo's constraints), a massless body is merged into the one it carries.
#include "tests/bench/peers/clock.hpp"
#include "tests/bench/peers/dampers.hpp"
#include "tests/bench/peers/tune.hpp"

#ifdef FLYBALL_HAVE_MUJOCO
#include <mujoco/mujoco.h>

#include <cstring>
#include <iomanip>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace flyball::peers {
namespace {

struct Free {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

std::string text(const Vec& v) {
  std::ostringstream out;
  out << std::setprecision(17) << v[0] << ' ' << v[1] << ' ' << v[2];
  return out.str();
}

Vec less(const Vec& a, const Vec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

class Writer {
 public:
  explicit Writer(const Job& job) : job_(job) {}

  // The model first, then the files that it includes: XML is not nested more than a hundred deep there.
  std::vector<std::string> write() {
    out_ << std::setprecision(17) << "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>"
         << "<option gravity=\"" << text(job_.gravity) << "\"><flag contact=\"disable\" limit=\"disable\" "
         << "frictionloss=\"disable\" actuation=\"disable\" sensor=\"disable\" refsafe=\"disable\"/></option>"
         << "<worldbody>";
    children(-1, {0, 0, 0});
    out_ << "</worldbody>";
    if (!job_.links.empty()) links();
    out_ << "</mujoco>";
    files_.insert(files_.begin(), out_.str());
    return files_;
  }

 private:
  void children(int parent, const Vec& base) {
    for (const JobJoint& joint : job_.joints)
      if (joint.parent == parent) body(joint, base);
  }

  void body(const JobJoint& joint, const Vec& base) {
    std::vector<const JobJoint*> joints{&joint};
    while (job_.bodies[static_cast<std::size_t>(joints.back()->child)].mass <= 0)
      joints.push_back(&carried(joints.back()->child));
    const int index = joints.back()->child;
    const JobBody& b = job_.bodies[static_cast<std::size_t>(index)];
    out_ << "<body name=\"" << b.name << "\" pos=\"" << text(less(b.position, base))
         << "\"><inertial pos=\"0 0 0\" "
         << "mass=\"" << b.mass << "\" fullinertia=\"";
    for (std::size_t i = 0; i < 6; ++i)
      out_ << (i < 3 ? b.inertia[i] + 1e-14 : b.inertia[i]) << (i < 5 ? " " : "\"/>"); // thin, but no line
    for (const JobJoint* j : joints) {
      out_ << "<joint name=\"" << j->name << "\" type=\"" << (j->slides ? "slide" : "hinge") << "\" pos=\""
           << text(less(j->at, b.position)) << "\" axis=\"" << text(j->axis) << "\" ref=\"" << j->drawn
           << '"';
      if (j->driven) out_ << " armature=\"1e12\"";
      if (j->stiffness > 0) out_ << " stiffness=\"" << j->stiffness << "\" springref=\"" << j->free << '"';
      out_ << "/>";
    }
    for (std::size_t k = 0; k < job_.links.size(); ++k) {
      const JobLink& link = job_.links[k];
      if (link.a == index) site(k, 'a', less(link.on_a, b.position));
      if (link.b == index) site(k, 'b', less(link.on_b, b.position));
    }
    if (++depth_ % 40 == 0) {
      std::ostringstream around = std::exchange(out_, std::ostringstream());
      out_ << std::setprecision(17) << "<mujocoinclude>";
      children(index, b.position);
      out_ << "</mujocoinclude>";
      files_.push_back(out_.str());
      out_ = std::move(around);
      out_ << "<include file=\"part" << files_.size() << ".xml\"/>";
    } else {
      children(index, b.position);
    }
    --depth_;
    out_ << "</body>";
  }

  const JobJoint& carried(int parent) const {
    for (const JobJoint& j : job_.joints)
      if (j.parent == parent) return j;
    throw std::invalid_argument("a massless body carries nothing");
  }

  void site(std::size_t link, char end, const Vec& at) {
    out_ << "<site name=\"" << end << link << "\" pos=\"" << text(at) << "\"/>";
  }

  void links() {
    out_ << "<tendon>";
    for (std::size_t k = 0; k < job_.links.size(); ++k)
      out_ << "<spatial name=\"t" << k << "\"><site site=\"a" << k << "\"/><site site=\"b" << k
           << "\"/></spatial>";
    out_ << "</tendon><equality>";
    for (std::size_t k = 0; k < job_.links.size(); ++k) {
      const Vec d = less(job_.links[k].on_a, job_.links[k].on_b);
      const double drawn = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      out_ << "<tendon tendon1=\"t" << k << "\" polycoef=\"" << job_.links[k].length - drawn << " 0 0 0 0\" "
           << "solimp=\"0.9999 0.9999 0.001 0.5 2\"/>";
    }
    out_ << "</equality>";
  }

  const Job& job_;
  std::ostringstream out_;
  std::vector<std::string> files_;
  int depth_ = 0;
};

std::unique_ptr<mjModel, Free> load(const std::vector<std::string>& texts) {
  const auto files = std::make_unique<mjVFS>(); // too large for the stack
  mj_defaultVFS(files.get());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string name = i == 0 ? "model.xml" : "part" + std::to_string(i) + ".xml";
    mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(texts[i].size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), name.c_str())], texts[i].data(), texts[i].size());
  }
  char error[1000] = "";
  std::unique_ptr<mjModel, Free> model(mj_loadXML("model.xml", files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) throw std::invalid_argument(error);
  return model;
}

void ignore(const char*) {}

class MujocoJob {
 public:
  MujocoJob(const Job& job, Damping damping)
      : job_(job), damping_(damping), model_(load(Writer(job).write())), data_(mj_makeData(model_.get())) {
    mju_user_warning = ignore; // steps too large are tried, too
    model_->opt.solver = mjSOL_NEWTON;
    model_->opt.jacobian = mjJAC_DENSE;
    for (std::size_t k = 0; k < job.joints.size(); ++k) {
      const int id = mj_name2id(model_.get(), mjOBJ_JOINT, job.joints[k].name.c_str());
      position_.push_back(model_->jnt_qposadr[id]);
      dof_.push_back(model_->jnt_dofadr[id]);
      if (!job.joints[k].driven) moving_.push_back(k);
    }
    largest_ = job.chain ? 1500 : 2500;
  }

  // The step, dampers, and stiffness and damping of the links in units of the step.
  std::vector<Range> ranges() const {
    std::vector<Range> r{{1e-4, job_.chain ? 1 : 1e3}};
    const std::vector<Range> d = damper_ranges(job_, damping_);
    r.insert(r.end(), d.begin(), d.end());
    if (!job_.links.empty()) r.insert(r.end(), {{1e-3, 4}, {0.05, 2}});
    return r;
  }
  std::vector<std::vector<double>> guesses() const {
    std::vector<std::vector<double>> all;
    if (job_.chain) {
      for (const double h : {0.1, 0.15})
        all.push_back({h, 1});
      return all;
    }
    if (!job_.links.empty() && job_.dampers == 2) // the governor, from a scan of 3000 samples
      all.push_back(damping_ == Damping::free ? std::vector<double>{0.014, 120, 750, 1.3, 0.65}
                                              : std::vector<double>{0.016, 9, 1.9, 1});
    for (const double h : {2e-3, 0.03, 0.3, 3.}) {
      std::vector<double> g{h};
      if (damping_ == Damping::free)
        g.resize(1 + static_cast<std::size_t>(job_.dampers), 30);
      else
        g.push_back(1);
      if (damping_ == Damping::free)
        for (const JobJoint& joint : job_.joints)
          if (!joint.driven && joint.stiffness > 0)
            g[1 + static_cast<std::size_t>(joint.damper)] = joint.stiffness;
      if (!job_.links.empty()) g.insert(g.end(), {1, 1});
      all.push_back(std::move(g));
    }
    return all;
  }

  // `best` is the lowest cost so far; runs of several times as many steps are given up.
  double cost(const std::vector<double>& x, int integrator, double& best) {
    apply(x, integrator);
    double worst = 0;
    // Settings must serve starts beside the drawn pose, too, or the scan would hide the answer in the
    // dampers.
    for (const double beside : job_.chain ? std::vector<double>{0} : std::vector<double>{0, 0.02, -0.02}) {
      const std::vector<double> errors =
          run(std::min(largest_, static_cast<std::size_t>(6 * best) + 60), beside);
      const double settled = settling_step(errors, near_enough);
      if (settled < 0) return not_arrived(errors.back());
      worst = std::max(worst, settled);
    }
    best = std::min(best, worst);
    return worst;
  }

  PeerResult measure(const Tuned& tuned, int integrator) {
    apply(tuned.values, integrator);
    PeerResult result;
    result.available = true;
    const std::vector<double> errors = run(largest_);
    const double settled = settling_step(errors, near_enough);
    result.bias = errors.back();
    result.reached = settled >= 0;
    if (!result.reached) return result;
    result.steps = static_cast<long>(std::ceil(settled));
    const Times times = time_of([&] {
      start();
      for (long i = 0; i < result.steps; ++i)
        mj_step(model_.get(), data_.get());
    });
    result.fastest_s = times.fastest_s;
    result.median_s = times.median_s;
    std::ostringstream words;
    words << std::setprecision(3) << (integrator == mjINT_EULER ? "Euler" : "implicit") << ", step "
          << tuned.values[0] << " s";
    if (damping_ == Damping::critical) words << ", dampers × " << tuned.values[1];
    result.settings = words.str();
    return result;
  }

 private:
  void apply(const std::vector<double>& x, int integrator) {
    model_->opt.integrator = integrator;
    const double h = model_->opt.timestep = x[0];
    // Implicit damping acts as a stiffness times the step; dampers that are free are scanned as stiffnesses.
    const double unit = damping_ == Damping::critical ? 1 : h;
    const std::vector<double> dampers = chosen_dampers(job_, damping_, &x[1]);
    for (std::size_t k = 0; k < dampers.size(); ++k)
      model_->dof_damping[dof_[k]] = unit * dampers[k];
    const std::size_t used = 1 + damper_ranges(job_, damping_).size();
    for (int e = 0; e < model_->neq; ++e) {
      model_->eq_solref[mjNREF * e] = -x[used] / (h * h);
      model_->eq_solref[mjNREF * e + 1] = -x[used + 1] / h;
    }
  }

  void start(double beside = 0) {
    for (std::size_t k = 0; k < job_.joints.size(); ++k) {
      data_->qpos[position_[k]] = job_.joints[k].drawn + (job_.joints[k].driven ? 0 : beside);
      data_->qvel[dof_[k]] = job_.joints[k].speed;
    }
    mju_zero(data_->qacc_warmstart, model_->nv);
    data_->time = 0;
  }

  double error() const {
    double worst = 0;
    for (const std::size_t k : moving_)
      worst = std::max(worst, std::abs(data_->qpos[position_[k]] - job_.joints[k].target));
    return worst;
  }

  // Errors after every step; goes on for as long again after they first are small, to see that they stay so.
  std::vector<double> run(std::size_t most, double beside = 0) {
    mj_resetData(model_.get(), data_.get());
    start(beside);
    std::vector<double> errors{error()};
    std::size_t small = 0;
    while (errors.size() < most) {
      mj_step(model_.get(), data_.get());
      const double e = error();
      if (data_->warning[mjWARN_BADQACC].number > 0 || data_->warning[mjWARN_BADQPOS].number > 0 ||
          !std::isfinite(e) || e > 1e3) {
        errors.push_back(1e6);
        break;
      }
      errors.push_back(e);
      if (e < near_enough && small == 0) small = errors.size();
      if (small > 0 && errors.size() > 2 * small + 20) break;
    }
    return errors;
  }

  const Job& job_;
  Damping damping_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::vector<int> position_, dof_;
  std::vector<std::size_t> moving_;
  std::size_t largest_ = 0;
};

} // namespace

PeerResult run_mujoco(const Job& job, Damping damping) {
  MujocoJob mujoco(job, damping);
  PeerResult best;
  best.available = true;
  for (const int integrator : {mjINT_EULER, mjINT_IMPLICIT}) {
    double fewest = 1e6;
    const Tuned tuned =
        tune(mujoco.ranges(), mujoco.guesses(), job.chain ? 0 : 600, tuning_s,
             [&](const std::vector<double>& x) { return mujoco.cost(x, integrator, fewest); });
    const PeerResult result = mujoco.measure(tuned, integrator);
    const bool better = result.reached && (!best.reached || result.fastest_s < best.fastest_s);
    if (better || (!best.reached && (best.bias == 0 || result.bias < best.bias))) best = result;
  }
  return best;
}

} // namespace flyball::peers

#else

namespace flyball::peers {
PeerResult run_mujoco(const Job&, Damping) {
  return {};
}
} // namespace flyball::peers

#endif
