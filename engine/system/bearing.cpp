#include "engine/system/bearing.hpp"

#include "engine/linear/interruption.hpp"
#include "engine/system/extended.hpp"
#include "engine/system/pair_hessian.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>

namespace flyball {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// One bearing at one state, and how a coordinate of its support moves it.
struct Linear {
  const BearingElement& e;
  const BearingParameters& p;
  const Kinematics<double>& k;
  BearingState<double> s;

  Linear(const BearingElement& element, const BearingParameters& parameters,
         const Kinematics<double>& kinematics)
      : e(element), p(parameters), k(kinematics), s(bearing_state(element, parameters, kinematics)) {}

  // x by unit of the coordinate.
  Vec6 direction(const PairPart& i) const {
    Vec6 x;
    x << s.axes.transpose() * i.column.at(s.point), s.turning * (s.axes.transpose() * i.column.turn());
    return i.second ? x : Vec6(-x);
  }

  // How x' changes with the coordinate.
  Vec6 rate_change(const PairPart& j, const ScrewRates& screw, const Vec6& by) const {
    const LinkState<double>&a = k.at(e.ends.a), &b = k.at(e.ends.b);
    const Vec3 va = k.velocity(e.ends.a, s.point), vb = k.velocity(e.ends.b, s.point);
    const Vec3 carried = a.w.cross(j.column.at(s.point)), turn = j.column.turn();
    const Vec3 turning = s.axes.transpose() * (b.w - a.w);
    Vec3 slip, spin;
    if (j.second) {
      slip = velocity_change(j, screw, s.point, vb) - carried;
      spin = screw.dw + turn.cross(b.w);
    } else {
      slip = (vb - va).cross(turn) - velocity_change(j, screw, s.point, va) + carried;
      spin = (b.w - a.w).cross(turn) - screw.dw - turn.cross(a.w);
    }
    Vec6 out;
    out << s.axes.transpose() * slip, s.turning * (s.axes.transpose() * spin) + turning_change(by) * turning;
    return out;
  }

  Mat3 turning_change(const Vec6& by) const {
    return e.size == 6 ? inverse_left_jacobian_derivative<double>(s.x.tail<3>(), by.tail<3>())
                       : Mat3(Mat3::Zero());
  }

  // d/dq_j of direction(i), times the forces along x.
  double bent(const PairPart& i, const PairPart& j, const Vec6& by, const Vec6& along) const {
    const Vec3 turn = j.column.turn();
    double out = point_hessian(s.force, s.point, i, j);
    if (e.size == 2) return out;
    if (i.second && !j.second)
      out += turn.cross(s.moment).dot(i.column.turn());
    else if (i.second && j.second && carries(j, i))
      out += s.moment.dot(turn.cross(i.column.turn()));
    else if (!i.second && !j.second && !carries(j, i))
      out -= turn.cross(s.moment).dot(i.column.turn());
    const Vec3 own = s.axes.transpose() * i.column.turn();
    return out + (i.second ? 1. : -1.) * along.tail<3>().dot(turning_change(by) * own);
  }

  // What the bearing asks of the second body: forces along x.
  Vec6 along() const { return p.stiffness * s.x + p.damping * s.dx; }

  // How the force or moment that it asks for changes with a coordinate, or with the coordinate's rate.
  Vec3 change(bool moment, const PairPart& j, const ScrewRates& screw) const {
    const Vec6 by = direction(j), forces = p.stiffness * by + p.damping * rate_change(j, screw, by);
    const Vec3 here = moment ? Vec3(s.turning.transpose() * forces.tail<3>() +
                                    turning_change(by).transpose() * along().tail<3>())
                             : Vec3(forces.head<3>());
    const Vec3 carried =
        j.second ? Vec3(Vec3::Zero()) : Vec3(j.column.turn().cross(moment ? s.moment : s.force));
    return s.axes * here + carried;
  }
  Vec3 change_by_rate(bool moment, const PairPart& j) const {
    const Vec6 forces = p.damping * direction(j);
    return s.axes * (moment ? Vec3(s.turning.transpose() * forces.tail<3>()) : Vec3(forces.head<3>()));
  }
};

bool is_moment(Result result) {
  return result >= Result::couple_x;
}

// Which component is asked for; 3 of the size.
int axis_of(Result result) {
  return static_cast<int>(result) - static_cast<int>(is_moment(result) ? Result::couple_x : Result::force_x);
}

} // namespace

template <class S>
BearingState<S> bearing_state(const BearingElement& e, const BearingParametersOf<S>& p,
                              const Kinematics<S>& k) {
  BearingState<S> s;
  const LinkState<S>&a = k.at(e.ends.a), &b = k.at(e.ends.b);
  const Mat3T<S> drawn = p.axes.template cast<S>();
  s.axes = a.R * drawn;
  s.point = k.point(e.ends.b, p.b);
  s.x.setZero();
  s.dx.setZero();
  s.x.template head<3>() = s.axes.transpose() * (s.point - k.point(e.ends.a, p.a));
  s.dx.template head<3>() =
      s.axes.transpose() * (k.velocity(e.ends.b, s.point) - k.velocity(e.ends.a, s.point));
  s.turning.setIdentity();
  if (e.size == 6) {
    const Vec3T<S> r = log_rotation(Eigen::Quaternion<S>(Mat3T<S>(s.axes.transpose() * (b.R * drawn))));
    s.turning = inverse_left_jacobian<S>(r);
    s.x.template tail<3>() = r;
    s.dx.template tail<3>() = s.turning * (s.axes.transpose() * (b.w - a.w));
  } else {
    s.x[2] = s.dx[2] = 0;
  }
  const Eigen::Matrix<S, 6, 1> along =
      p.stiffness.template cast<S>() * s.x + p.damping.template cast<S>() * s.dx;
  s.force = s.axes * along.template head<3>();
  s.moment = s.axes * (s.turning.transpose() * along.template tail<3>());
  return s;
}

template <class S>
S bearing_force(Result result, const BearingElement& e, const BearingParametersOf<S>& p,
                const Kinematics<S>& k) {
  const BearingState<S> s = bearing_state<S>(e, p, k);
  const Vec3T<S>& asked = is_moment(result) ? s.moment : s.force;
  const int axis = axis_of(result);
  return axis < 3 ? S(-asked[axis]) : S(asked.norm());
}

void bearing_force_rates(const System& system, const Parameters& p, Result result, std::size_t n,
                         const Kinematics<double>& k, bool with_rates,
                         const std::function<void(int v, double change)>& add) {
  const Linear bearing(system.bearings[n], p.bearings[n], k);
  const bool moment = is_moment(result);
  const int axis = axis_of(result);
  Vec3 along = (moment ? bearing.s.moment : bearing.s.force).stableNormalized();
  if (axis < 3) along = -Vec3::Unit(axis);
  for (const SupportColumn& c : bearing.e.ends.support) {
    const PairPart j = pair_part(c, k);
    add(c.v, along.dot(with_rates ? bearing.change_by_rate(moment, j)
                                  : bearing.change(moment, j, screw_rates(system, p, k, c.link, c.v))));
  }
  if (with_rates || axis == 3) return;
  // What carries both bodies turns what acts between them.
  const Vec3 turned = (moment ? bearing.s.moment : bearing.s.force).cross(along);
  for (int l = bearing.e.ends.a; l >= 0; l = system.links[static_cast<std::size_t>(l)].parent) {
    const Link& link = system.links[static_cast<std::size_t>(l)];
    if (link.v < 0 ||
        std::ranges::find(bearing.e.ends.support, l, &SupportColumn::link) != bearing.e.ends.support.end())
      continue;
    for (int v = link.v; v < link.v + (link.type == LinkType::spherical ? 3 : 1); ++v)
      add(v, turned.dot(k.columns[static_cast<std::size_t>(v)].turn()));
  }
}

double bearing_force_size(Result result, const BearingParameters& p, const BearingState<double>& s,
                          double reach) {
  Vec6 size = s.x.cwiseAbs();
  size.head<3>().array() += reach;
  size.tail<3>().array() += 1;
  const Vec6 along = p.stiffness.cwiseAbs() * size + p.damping.cwiseAbs() * s.dx.cwiseAbs();
  return is_moment(result) ? along.tail<3>().norm() : along.head<3>().norm();
}

template <class S>
void add_bearings(const System& system, const ParametersOf<S>& p, const Kinematics<S>& k,
                  Configuration<S>& f) {
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    const BearingElement& e = system.bearings[n];
    const BearingState<S> s = bearing_state<S>(e, p.bearings[n], k);
    for (const SupportColumn& c : e.ends.support) {
      const Column<S>& column = k.columns[static_cast<std::size_t>(c.v)];
      const S g = s.force.dot(column.at(s.point)) + s.moment.dot(column.turn());
      f[c.v] += c.second ? g : S(-g);
    }
  }
}

void add_bearing_sizes(const System& system, const Parameters& p, const Kinematics<double>& k,
                       Eigen::VectorXd& force) {
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    const BearingElement& e = system.bearings[n];
    const BearingState<double> s = bearing_state<double>(e, p.bearings[n], k);
    const double place = s.point.norm() + k.point(e.ends.a, p.bearings[n].a).norm();
    Vec6 size = s.x.cwiseAbs();
    size.head<3>().array() += place;
    size.tail<3>().array() += 1;
    const Vec6 along =
        p.bearings[n].stiffness.cwiseAbs() * size + p.bearings[n].damping.cwiseAbs() * s.dx.cwiseAbs();
    for (const SupportColumn& c : e.ends.support) {
      const Column<double>& column = k.columns[static_cast<std::size_t>(c.v)];
      const double push = along.head<3>().norm();
      force[c.v] += column.angular ? push * (s.point - column.o).norm() + along.tail<3>().norm() : push;
    }
  }
}

void add_bearing_stiffness(const System& system, const Parameters& p, const Kinematics<double>& k,
                           const std::vector<ScrewRates>& screws, Eigen::MatrixXd& out) {
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    interruption_point();
    const BearingParameters& f = p.bearings[n];
    const Linear bearing(system.bearings[n], f, k);
    const Vec6 along = bearing.along();
    for (const SupportColumn& cj : bearing.e.ends.support) {
      const PairPart j = pair_part(cj, k);
      const Vec6 by = bearing.direction(j);
      Vec6 change = f.stiffness * by;
      if (p.moving) change += f.damping * bearing.rate_change(j, screws[static_cast<std::size_t>(cj.v)], by);
      for (const SupportColumn& ci : bearing.e.ends.support) {
        const PairPart i = pair_part(ci, k);
        out(ci.v, cj.v) += bearing.direction(i).dot(change) + bearing.bent(i, j, by, along);
      }
    }
  }
}

void add_bearing_damping(const System& system, const Parameters& p, const Kinematics<double>& k,
                         Eigen::MatrixXd& out) {
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    const Linear bearing(system.bearings[n], p.bearings[n], k);
    for (const SupportColumn& cj : bearing.e.ends.support) {
      const Vec6 change = p.bearings[n].damping * bearing.direction(pair_part(cj, k));
      for (const SupportColumn& ci : bearing.e.ends.support)
        out(ci.v, cj.v) += bearing.direction(pair_part(ci, k)).dot(change);
    }
  }
}

double bearing_energy(const System& system, const Parameters& p, const Kinematics<double>& k) {
  double energy = 0;
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    const Vec6 x = bearing_state<double>(system.bearings[n], p.bearings[n], k).x;
    energy += x.dot(p.bearings[n].stiffness * x) / 2;
  }
  return energy;
}

BearingPowers bearing_powers(const System& system, const Parameters& p, const Kinematics<double>& k) {
  BearingPowers out;
  for (std::size_t n = 0; n < system.bearings.size(); ++n) {
    const BearingState<double> s = bearing_state<double>(system.bearings[n], p.bearings[n], k);
    const Mat6& stiffness = p.bearings[n].stiffness;
    out.dissipated += s.dx.dot(p.bearings[n].damping * s.dx);
    out.applied -= s.dx.dot((stiffness - stiffness.transpose()) * s.x) / 2;
  }
  return out;
}

template BearingState<double> bearing_state(const BearingElement&, const BearingParameters&,
                                            const Kinematics<double>&);
template BearingState<Dual> bearing_state(const BearingElement&, const BasicBearingParameters<Dual>&,
                                          const Kinematics<Dual>&);
template double bearing_force<double>(Result, const BearingElement&, const BearingParameters&,
                                      const Kinematics<double>&);
template Dual bearing_force<Dual>(Result, const BearingElement&, const BasicBearingParameters<Dual>&,
                                  const Kinematics<Dual>&);
template Extended bearing_force<Extended>(Result, const BearingElement&, const BearingParameters&,
                                          const Kinematics<Extended>&);
template void add_bearings<double>(const System&, const Parameters&, const Kinematics<double>&,
                                   Configuration<double>&);
template void add_bearings<Extended>(const System&, const Parameters&, const Kinematics<Extended>&,
                                     Configuration<Extended>&);
template void add_bearings<Dual>(const System&, const BasicParameters<Dual>&, const Kinematics<Dual>&,
                                 Configuration<Dual>&);

} // namespace flyball
