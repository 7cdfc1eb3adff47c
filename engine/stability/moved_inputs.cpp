#include "engine/stability/moved_inputs.hpp"

#include "engine/linear/largest.hpp"
#include "engine/solve/newton.hpp"
#include "engine/system/drive_torque.hpp"

#include <optional>
#include <vector>

namespace flyball {
namespace {

constexpr double moves = 1e-8; // of a radian, of the reach or of the speeds there are

// Rates of three numbers each along all coordinates.
using VectorRates = Eigen::Matrix<double, Eigen::Dynamic, 3>;

struct PointsInMotion {
  const System& system;
  const Kinematics<double>& k;

  VectorRates along(const TrackedPoint& point, Vec3 PointRates::*of) const {
    VectorRates out = VectorRates::Zero(system.nv, 3);
    visit_point_rates(system, k, point,
                      [&](int v, const PointRates& rates) { out.row(v) += (rates.*of).transpose(); });
    return out;
  }
  VectorRates apart(const TrackedPoint& a, const TrackedPoint& b) const {
    return along(b, &PointRates::position) - along(a, &PointRates::position);
  }
  Vec3 way(const TrackedPoint& a, const TrackedPoint& b) const {
    return k.point(b.link, b.at) - k.point(a.link, a.at);
  }
};

// Rates of the cross product of the unit vectors along two arms.
VectorRates turn_of_arms(const PointsInMotion& motion, const TrackedPoints& points) {
  const Vec3 u = motion.way(points[1], points[0]), w = motion.way(points[1], points[2]);
  const Vec3 a = u.normalized(), b = w.normalized();
  const VectorRates du = motion.apart(points[1], points[0]), dw = motion.apart(points[1], points[2]);
  VectorRates out(du.rows(), 3);
  for (Eigen::Index v = 0; v < du.rows(); ++v) {
    const Vec3 x = du.row(v), y = dw.row(v);
    const Vec3 da = (x - x.dot(a) * a) / u.norm(), db = (y - y.dot(b) * b) / w.norm();
    out.row(v) = (da.cross(b) + a.cross(db)).transpose();
  }
  return out;
}

// What an input is, or is the size of.
std::vector<Result> parts_of(const DriveLaw::Input& input) {
  using enum Result;
  const Result asked = input.quantity.result;
  if (asked == force && input.bearing < 0) return {tension};
  if (asked == force) return {force_x, force_y, force_z};
  if (asked == couple) return {couple_x, couple_y, couple_z};
  return {asked};
}

// How coordinates and their rates change an input, or what it is the size of.
struct InputRates {
  std::vector<Eigen::VectorXd> by_places, by_rates; // scaled, of coordinates; none that is nothing
};

InputRates rates_of(const Problem& problem, const DriveLaw& law, const DriveLawParameters& numbers,
                    std::size_t i, const Eigen::VectorXd& q, const Kinematics<double>& k) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  const DriveLaw::Input& input = law.inputs[i];
  const Result asked = input.quantity.result;
  InputRates out;
  const auto take = [&](const Eigen::VectorXd& by, double size, std::vector<Eigen::VectorXd>& to) {
    if (!(size > 0)) return;
    const Eigen::VectorXd scaled = by.cwiseProduct(problem.scaling.column) / size;
    if (largest_size(scaled) > moves) to.push_back(scaled);
  };
  const auto take_vector = [&](const VectorRates& by, double size, std::vector<Eigen::VectorXd>& to) {
    for (const Eigen::Index axis : {0, 1, 2})
      take(by.col(axis), size, to);
  };
  if (input.coordinate >= 0) {
    const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
    const Link& link = system.links[static_cast<std::size_t>(c.link)];
    if (link.v < 0) return out;
    const int count = link.type == LinkType::spherical ? 3 : 1;
    for (int v = link.v; v < link.v + count; ++v)
      take(Eigen::VectorXd::Unit(system.nv, v), problem.scaling.column[v],
           input.rate() ? out.by_rates : out.by_places);
    return out;
  }
  const PointsInMotion motion{system, k};
  const TrackedPoints& points = numbers.points[i];
  const double size = asked == Result::angle ? 1 : p.length;
  const bool kink = stands_on_own_kink(system, p, law, numbers, i, q, k);
  const bool vanishes =
      kink && input.bearing < 0 &&
      (asked != Result::force || motion.way(points[0], points[1]).norm() <= moves * p.length);
  if (asked == Result::angle && kink) {
    take_vector(turn_of_arms(motion, points), size, out.by_places);
  } else if (asked == Result::speed && kink) {
    take_vector(motion.along(points[0], &PointRates::velocity),
                law_input_size(system, p, law, numbers, i, q, k), out.by_places);
    take_vector(motion.along(points[0], &PointRates::position), size, out.by_rates);
  } else if (vanishes) {
    take_vector(motion.apart(points[0], points[1]), size, out.by_places);
  } else {
    const double most = law_input_size(system, p, law, numbers, i, q, k);
    for (const Result part : parts_of(input)) {
      DriveLaw::Input alone = input;
      alone.quantity.result = part;
      for (const bool with_rates : {false, true}) {
        Eigen::VectorXd by = Eigen::VectorXd::Zero(system.nv);
        add_input_rates(system, p, alone, points, k, with_rates, [&](int v, double rate) { by[v] += rate; });
        take(by, with_rates && is_of_velocity(asked) ? size : most,
             with_rates ? out.by_rates : out.by_places);
      }
    }
  }
  return out;
}

// What the loops leave of these, row by row; those of which they leave nothing are taken out.
void keep_loops_closed(const Problem& problem, const Eigen::VectorXd& q,
                       std::vector<Eigen::VectorXd>& rates) {
  if (rates.empty() || problem.system.rows == 0) return;
  Workspace w;
  evaluate(problem, {q, Eigen::VectorXd::Zero(problem.system.rows)}, 0, w);
  factor_constraints(problem, w);
  Eigen::VectorXd left;
  std::erase_if(rates, [&](Eigen::VectorXd& rate) {
    w.kkt(problem).project(rate, left);
    const bool none = !(largest_size(left) > moves * largest_size(rate));
    rate = left;
    return none;
  });
}

} // namespace

bool is_moved(const Problem& problem, const DriveLaw& law, const DriveLawParameters& numbers, std::size_t i,
              const Eigen::VectorXd& q, const Kinematics<double>& k) {
  InputRates rates = rates_of(problem, law, numbers, i, q, k);
  keep_loops_closed(problem, q, rates.by_places);
  if (!rates.by_places.empty()) return true;
  keep_loops_closed(problem, q, rates.by_rates);
  return !rates.by_rates.empty();
}

std::optional<Eigen::VectorXd> single_motion(const Problem& problem, const DriveLaw& law,
                                             const DriveLawParameters& numbers, std::size_t i,
                                             const Eigen::VectorXd& q, const Kinematics<double>& k) {
  InputRates rates = rates_of(problem, law, numbers, i, q, k);
  keep_loops_closed(problem, q, rates.by_rates);
  keep_loops_closed(problem, q, rates.by_places);
  if (!rates.by_rates.empty() || rates.by_places.empty()) return {};
  const Eigen::VectorXd* largest = &rates.by_places.front();
  for (const Eigen::VectorXd& rate : rates.by_places)
    if (rate.norm() > largest->norm()) largest = &rate;
  const Eigen::VectorXd direction = largest->normalized();
  for (const Eigen::VectorXd& rate : rates.by_places)
    if ((rate - rate.dot(direction) * direction).norm() > moves * largest->norm()) return {};
  return direction;
}

} // namespace flyball
