#include "engine/solve/drive_cuts.hpp"

#include "engine/kkt/constraint_space.hpp"
#include "engine/kkt/problem.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/drive_rates.hpp"
#include "engine/system/implied_rates.hpp"
#include "engine/system/kept_momentum.hpp"
#include "engine/system/residual.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace flyball {
namespace {

// How the cut joints fare when the drives go on a little from the drawn pose with all else at rest.
struct DrivenCuts {
  int opened = 0;           // cuts that the drives pull open
  std::vector<int> open;    // these
  std::vector<bool> turned; // by cut: its ends move against each other, and it stays closed
  bool varies = false;      // some cut turned, and with it what forces act on: balance_varies()
};

constexpr int few = 200; // coordinates, of which the null space costs nothing beside the rest

// s, at which what the drives do to cuts shows: of each 0.05 rad of its turn, and of several their phases.
std::vector<double> times_of_judging(const std::vector<DriveRate>& rates) {
  std::vector<double> out;
  for (const DriveRate& one : rates)
    out.push_back(0.05 / one.rate);
  if (rates.size() > 1)
    for (const double time : phase_times(rates))
      out.push_back(time);
  return out;
}

// Whether forces along the directions that loops leave change as drives at these rates go on with all else at
// rest: weights are carried round, and whatever balances them does so for a moment.
bool balance_varies(const System& system, const Parameters& p, const Scaling& scaling,
                    const Eigen::VectorXd& q, const std::vector<DriveRate>& rates) {
  const Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.rows);
  Kinematics<double> k;
  Residual<double> r;
  Linearization l;
  Magnitudes sizes;
  ConstraintSpace space;
  std::optional<Eigen::VectorXd> first;
  std::vector<double> times = phase_times(rates);
  times.insert(times.begin(), 0);
  for (const double time : times) {
    forward<double>(system, p, q, time, k);
    evaluate_residual<double>(system, p, q, lambda, k, r);
    evaluate_magnitudes(system, p, q, lambda, k, sizes);
    linearize_constraints(system, p, k, l);
    space.factor(scaling.row.asDiagonal() * l.constraint * scaling.column.asDiagonal(), 1e-9, row_rounding);
    const Eigen::MatrixXd& basis = space.basis();
    Eigen::VectorXd f = basis * (basis.transpose() * r.f.cwiseProduct(scaling.column));
    if (!first)
      first = std::move(f);
    else if ((f - *first).norm() >
             (1e-6 + angle_rounding(rates, time)) * sizes.force.cwiseProduct(scaling.column).norm())
      return true;
  }
  return false;
}

// Speeds that are to be found begin as drawn, or apart from each other and from given ones: where two begin
// alike, as the wheels of a differential, whatever turns by their difference seems to stand.
enum class Begin { as_drawn, apart };

// Factors of which no two are alike, nor one twice another, however many there are.
double unlike(int i) {
  return 1.5 + 0.4 * std::sin(1.1 + 2.3 * i);
}

Parameters bound(const System& system, const Mechanism& mechanism, Begin begin) {
  Parameters p;
  bind(system, mechanism, p);
  if (begin == Begin::as_drawn) return p;
  int drives = 0;
  const auto factor = [&] { return unlike(drives++); };
  for (const DriveTorqueElement& torque : system.torques) {
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    if (torque.implied || !finds_speed(link)) continue;
    LinkParameters& l = p.links[static_cast<std::size_t>(torque.link)];
    if (l.speed == 0) l.speed = l.gear_ratio;
    l.speed *= factor();
  }
  if (system.torques.empty()) return p;
  std::vector<double> factors(system.drives.size(), 1);
  for (std::size_t d = 0; d < system.drives.size(); ++d)
    if (system.drives[d].motor == static_cast<int>(d)) factors[d] = factor();
  for (const DrivenCoordinate& d : system.drives) {
    if (finds_speed(system.links[static_cast<std::size_t>(d.link)])) continue;
    LinkParameters& l = p.links[static_cast<std::size_t>(d.link)];
    l.speed = (l.speed != 0 ? l.speed : l.gear_ratio) * factors[static_cast<std::size_t>(d.motor)];
  }
  return p;
}

// As drawn, but for dampers that are unlike each other: where they are alike, as at the wheels of a
// differential, they may push nothing that they push as soon as one of them is another.
Parameters with_unlike_dampers(const System& system, const Mechanism& mechanism) {
  Parameters p = bound(system, mechanism, Begin::as_drawn);
  int dampers = 0;
  for (LinkParameters& link : p.links)
    for (CoordinateForce& force : link.force)
      force.damping *= unlike(dampers++);
  for (CutDamperParameters& damper : p.cut_dampers)
    damper.damping *= unlike(dampers++);
  return p;
}

DrivenCuts drive_cuts(const System& system, const Mechanism& mechanism, Begin begin = Begin::as_drawn) {
  DrivenCuts out;
  out.turned.resize(system.cuts.size());
  if (system.rows == 0 || system.drives.empty()) return out;
  Parameters p = bound(system, mechanism, begin);
  Scaling scaling;
  set_scaling(system, p, scaling);
  // A drive that stands still now may be set going by a slider, and the cuts must do for that, too.
  for (const DrivenCoordinate& d : system.drives)
    if (LinkParameters& l = p.links[static_cast<std::size_t>(d.link)]; l.speed == 0) l.speed = l.gear_ratio;
  if (system.nv <= few)
    set_closing_rates(system, p);
  else
    set_implied_rates(system, p);
  Configuration<double> q;
  drawn_configuration(system, p, q);
  const Eigen::VectorXd lambda = Eigen::VectorXd::Zero(system.rows);
  Kinematics<double> drawn, later;
  Residual<double> of_drawn, of_later;
  const auto evaluate_at = [&](double time, Kinematics<double>& k, Residual<double>& r) {
    forward<double>(system, p, q, time, k);
    evaluate_residual<double>(system, p, q, lambda, k, r);
    set_closures(system, p, q, k, r.phi);
  };
  evaluate_at(0, drawn, of_drawn);
  const std::vector<DriveRate> rates = drive_rates(system, p);
  std::vector<bool> open(system.cuts.size());
  for (const double time : times_of_judging(rates)) {
    evaluate_at(time, later, of_later);
    const double least = 1e-6 + 64 * angle_rounding(rates, time);
    for (std::size_t c = 0; c < system.cuts.size(); ++c) {
      const CutJoint& cut = system.cuts[c];
      const auto n = static_cast<Eigen::Index>(cut.rows.size());
      const auto change = (of_later.phi - of_drawn.phi).cwiseProduct(scaling.row).segment(cut.first_row, n);
      const auto relative = [&](const Kinematics<double>& k) {
        return Mat3(k.at(cut.ends.a).R.transpose() * k.at(cut.ends.b).R);
      };
      if (n > 0 && change.lpNorm<Eigen::Infinity>() > least)
        open[c] = true;
      else if (cut.type != JointType::gear && (relative(later) - relative(drawn)).norm() > least)
        out.turned[c] = true;
    }
  }
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    if (!open[c]) continue;
    ++out.opened;
    out.open.push_back(static_cast<int>(c));
    out.turned[c] = false;
  }
  out.varies = out.opened == 0 && system.nv <= few &&
               std::ranges::find(out.turned, true) != out.turned.end() &&
               balance_varies(system, p, scaling, q, rates);
  return out;
}

// The same cuts, and the same that turns at rates of its own.
CutChoice choice_of(const System& system) {
  CutChoice choice;
  for (const CutJoint& cut : system.cuts)
    if (cut.type != JointType::gear) choice.cut.push_back(cut.joint);
  for (const DriveTorqueElement& torque : system.torques)
    if (const Link& link = system.links[static_cast<std::size_t>(torque.link)]; torque.implied)
      choice.turning.push_back(
          {system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint, link.coordinate});
  return choice;
}

// With the same cuts, and more that turns at rates of its own. Nothing where nothing more does, or the drives
// pull open what they did not before.
std::optional<System> with_turning(const System& system, const Mechanism& mechanism,
                                   const std::vector<CoordinateReference>& more) {
  if (more.empty()) return {};
  CutChoice choice = choice_of(system);
  choice.turning.insert(choice.turning.end(), more.begin(), more.end());
  try {
    return compile(mechanism, choice);
  } catch (const SceneError&) {
    return {};
  }
}

// What a drive keeps is the momentum of what hangs from it alone. A loop through it that the drives pull
// open, or that turns others as it turns, passes that momentum on.
void expect_no_loop_on_momenta(const System& system, const Mechanism& mechanism,
                               const std::vector<int>& open) {
  if (!keeps_momentum(system) || system.rows == 0) return;
  const Parameters p = bound(system, mechanism, Begin::as_drawn);
  Eigen::VectorXd q;
  drawn_configuration(system, p, q);
  Kinematics<double> k;
  forward<double>(system, p, q, 0, k);
  // Whether the rate of entry v of q_R opens a joint that closes its loop by rates.
  const auto turns_others = [&](std::size_t c, int v) {
    const CutJoint& cut = system.cuts[c];
    double most = 0;
    if (cut.by_rates)
      for (const ConstraintRow& row : cut.rows)
        row_gradient(cut, p.cuts[c], row, k, [&](int entry, double g) {
          const bool length = row.type == RowType::point || row.type == RowType::distance;
          if (entry == v) most = std::max(most, std::abs(g) / (length ? p.length : 1));
        });
    return most > 1e-9;
  };
  for (const DriveTorqueElement& torque : system.torques) {
    if (!torque.keeps_momentum) continue;
    const Link& link = system.links[static_cast<std::size_t>(torque.link)];
    for (std::size_t c = 0; c < system.cuts.size(); ++c) {
      const CutJoint& cut = system.cuts[c];
      const auto& support = cut.ends.support;
      const bool pulled = std::ranges::find(open, static_cast<int>(c)) != open.end() &&
                          std::ranges::find(support, torque.link, &SupportColumn::link) != support.end();
      if (!pulled && !(finds_speed(link) && turns_others(c, link.v))) continue;
      const std::string& drive = system.tree_joints[static_cast<std::size_t>(link.tree_joint)].name;
      throw SceneError("joints." + drive + ".drive.keeps",
                       "expected speed, or no loop that makes others turn with " + drive + ": through " +
                           mechanism.joints[static_cast<std::size_t>(cut.joint)].name +
                           " its momentum passes to them");
    }
  }
}

} // namespace

System compile_for_drives(const Mechanism& mechanism) {
  System best = compile(mechanism);
  const System first = best;
  DrivenCuts fate = drive_cuts(best, mechanism);
  std::deque<CutChoice> queue;
  std::vector<std::vector<int>> seen;
  const auto enqueue = [&](const System& from) {
    for (CutChoice& c : neighbouring_cuts(mechanism, from)) {
      std::ranges::sort(c.cut);
      if (std::ranges::find(seen, c.cut) != seen.end()) continue;
      seen.push_back(c.cut);
      queue.push_back(std::move(c));
    }
  };
  if (fate.opened > 0) enqueue(best);
  for (int tried = 0; tried < 500 && !queue.empty() && fate.opened > 0; ++tried) {
    const CutChoice choice = std::move(queue.front());
    queue.pop_front();
    System other;
    try {
      other = compile(mechanism, choice);
    } catch (const SceneError&) {
      continue; // not admissible: a drive would be cut
    }
    if (DrivenCuts there = drive_cuts(other, mechanism); there.opened < fate.opened) {
      fate = std::move(there);
      best = other;
    }
    enqueue(other);
  }
  const auto let_turn = [&](const System& from, const std::vector<CoordinateReference>& more,
                            Begin begin = Begin::as_drawn) {
    std::optional<System> turning = with_turning(from, mechanism, more);
    if (!turning || (begin == Begin::apart && drive_cuts(*turning, mechanism, begin).opened > 0)) return;
    if (DrivenCuts there = drive_cuts(*turning, mechanism); there.opened == 0) {
      fate = std::move(there);
      best = std::move(*turning);
    }
  };
  const System second = best;
  for (const auto& [from, beside] : {std::pair{&first, true}, std::pair{&first, false},
                                     std::pair{&second, true}, std::pair{&second, false}})
    if (fate.opened > 0)
      let_turn(*from, implied_turning(*from, bound(*from, mechanism, Begin::as_drawn), beside));
  // What stays closed as drawn, with speeds that are to be found, has to at others, too.
  const System drawn = best;
  if (fate.opened == 0 && !drawn.torques.empty() && drive_cuts(drawn, mechanism, Begin::apart).opened > 0)
    for (const bool beside : {false, true})
      let_turn(drawn, implied_turning(drawn, bound(drawn, mechanism, Begin::apart), beside), Begin::apart);
  // A bearing on a shaft that turns and another on the ground hold a pendulum alike: where it would be
  // carried round it may hang as well.
  const System carried = best;
  if (fate.varies)
    for (const CutChoice& choice : neighbouring_cuts(mechanism, carried)) {
      try {
        System other = compile(mechanism, choice);
        DrivenCuts there = drive_cuts(other, mechanism);
        if (there.opened > 0 || there.varies) continue;
        fate = std::move(there);
        best = std::move(other);
        break;
      } catch (const SceneError&) {
        continue; // not admissible: a drive would be cut
      }
    }
  if (fate.opened == 0 && !best.drives.empty() && best.nv <= few && !keeps_momentum(best)) {
    const System standing = best;
    std::vector<CoordinateReference> pushed =
        slipping_turning(standing, bound(standing, mechanism, Begin::as_drawn));
    if (pushed.empty()) pushed = slipping_turning(standing, with_unlike_dampers(standing, mechanism));
    let_turn(standing, pushed);
  }
  expect_no_loop_on_momenta(best, mechanism, fate.open);
  for (std::size_t c = 0; c < best.cuts.size(); ++c)
    best.cuts[c].turns = fate.turned[c] && best.cuts[c].type != JointType::distance;
  return best;
}

System compile_for_motion(const Mechanism& mechanism, const System& steady) {
  if (steady.torques.empty()) return steady;
  return compile(mechanism, choice_of(steady), TorqueDriven::moves_freely);
}

bool same_choice(const System& a, const System& b) {
  const CutChoice of_a = choice_of(a), of_b = choice_of(b);
  return of_a.cut == of_b.cut && of_a.turning == of_b.turning;
}

} // namespace flyball
