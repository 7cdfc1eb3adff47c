#include "engine/study/look_around.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace flyball {
namespace {

// How far is looked, in parts of the ranges; what goes with the fourth power shows at the second alone.
constexpr double distances[]{1e-3, 1e-2, 1e-1};
constexpr double still_sloping = 1e-3; // of the slope, along what keeps the residuals, where no search ends

class Look {
 public:
  Look(const Eigen::VectorXd& x, const PlaceBeside& here, const EvaluateBeside& evaluate)
      : x_(x), here_(here), evaluate_(evaluate) {}

  Surroundings run() {
    if (!choose_ways()) return std::move(out_);
    value_ = lagrangian(here_);
    // Less would be lost in what the residuals are kept to.
    noticeable_ = 1e-14 + 1e-9 * std::abs(here_.objective);
    lowest_ = value_ - noticeable_;
    const Eigen::MatrixXd measured = look_along_ways(), curvature = (measured + measured.transpose()) / 2;
    SymmetricEigen eigen;
    if (!out_.lower && eigen.compute(curvature) && eigen.values()[0] < 0) {
      const Eigen::VectorXd least = (ways_ * eigen.vectors().col(0)).normalized();
      look(least);
      look(-least);
    }
    if (!out_.lower) look_between(curvature);
    out_.flat = looked_ > 0 && level_ == looked_;
    return std::move(out_);
  }

 private:
  struct Seen {
    double distance = 0;
    Eigen::VectorXd slope; // of the Lagrangian; empty where it is not known
    double rise = 0;       // of it
  };

  // False where there are none, or the search has not ended.
  bool choose_ways() {
    const Eigen::Index n = x_.size(), kept = here_.residuals.size();
    ways_ = Eigen::MatrixXd::Identity(n, n);
    if (kept == 0) return true;
    std::vector<Eigen::Index> inside; // numbers that stand at no end of their range
    for (Eigen::Index i = 0; i < n; ++i)
      if (x_[i] > 0 && x_[i] < 1) inside.push_back(i);
    if (inside.empty()) return false;
    const Eigen::MatrixXd constraints = here_.slopes.topRows(kept)(Eigen::all, inside);
    const Eigen::VectorXd slope = here_.slopes.row(kept)(inside).transpose();
    const auto basis = null_space(constraints);
    const auto by = least_squares(constraints.transpose(), slope);
    if (!basis || !by || basis->cols() == 0) return false;
    multipliers_ = *by;
    out_.slopes = (slope - constraints.transpose() * multipliers_).norm() > still_sloping * slope.norm();
    if (out_.slopes) return false;
    ways_.setZero(n, basis->cols());
    ways_(inside, Eigen::all) = *basis;
    ways_.colwise().normalize();
    return true;
  }

  // The objective less what the residuals account for.
  double lagrangian(const PlaceBeside& place) const {
    return place.objective - multipliers_.dot(place.residuals);
  }
  Eigen::VectorXd lagrangian_slope(const PlaceBeside& place) const {
    const Eigen::Index kept = place.residuals.size();
    return place.slopes.row(kept).transpose() - place.slopes.topRows(kept).transpose() * multipliers_;
  }

  // As far along the way as it takes to see a change. Nothing where that leads out of the ranges, or there is
  // no value; where it is to keep to the way, nor where the ranges let it go along a part of that alone.
  std::optional<Seen> look(const Eigen::VectorXd& way, bool keep_to_it = false) {
    std::optional<Seen> seen;
    bool level = true;
    for (const double distance : distances) {
      const Eigen::VectorXd to = (x_ + distance * way).cwiseMax(0).cwiseMin(1), step = to - x_;
      if (step.norm() < 0.5 * distance) break;
      if (keep_to_it && (step - distance * way).norm() > 0.5 * distance) break;
      const std::optional<PlaceBeside> there = evaluate_(to);
      if (!there) break;
      const double astray = there->residuals.squaredNorm(); // whose curvature the multipliers do not know
      const double found = lagrangian(*there) + astray;
      seen = Seen{distance, {}, found - value_};
      if (there->slopes.size() > 0) seen->slope = lagrangian_slope(*there);
      if (found < lowest_) {
        lowest_ = found;
        out_.lower = to;
      }
      level = std::abs(found - value_) <= noticeable_ + 2 * astray;
      if (!level) break;
    }
    if (seen) {
      ++looked_;
      level_ += level;
    }
    return seen;
  }

  // Along each to and fro. The curvature of the Lagrangian (ways, ways), zero along those where it is not
  // known; from an end of a range by what lies on one side.
  Eigen::MatrixXd look_along_ways() {
    const Eigen::Index count = ways_.cols();
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(count, count);
    square_.assign(static_cast<std::size_t>(count), false);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto forth = look(ways_.col(i)), back = look(-ways_.col(i));
      const bool up = forth && forth->slope.size() > 0, down = back && back->slope.size() > 0;
      const Seen middle{0, lagrangian_slope(here_), 0};
      if (!up && !down) continue;
      const Seen &from = down ? *back : middle, &to = up ? *forth : middle;
      curvature.col(i) = ways_.transpose() * (to.slope - from.slope) / (from.distance + to.distance);
      if (!up || !down) continue;
      // A fourth power rises by half of what its slopes tell.
      const double told = curvature(i, i) * distances[0] * distances[0];
      square_[static_cast<std::size_t>(i)] = forth->distance == distances[0] &&
                                             back->distance == distances[0] &&
                                             std::abs(forth->rise + back->rise - told) < 0.1 * told;
    }
    return curvature;
  }

  // At the corners of the ranges, and where curvature tells little, as of fourth powers, less may lie between
  // two ways. Along both to and fro has been looked, so that of a diagonal only the whole of it is new.
  void look_between(const Eigen::MatrixXd& curvature) {
    for (Eigen::Index i = 0; i < ways_.cols(); ++i)
      for (Eigen::Index k = 0; k < i; ++k) {
        if (rises_between(i, k, curvature)) continue;
        for (const double side : {1., -1.}) {
          const Eigen::VectorXd way = (ways_.col(i) + side * ways_.col(k)).normalized();
          look(way, true);
          look(-way, true);
        }
      }
  }

  // Whether the curvature says so of all that lies between two ways, as far as is looked first.
  bool rises_between(Eigen::Index i, Eigen::Index k, const Eigen::MatrixXd& curvature) const {
    constexpr double clearly = 1e-2; // of the larger curvature
    if (!square_[static_cast<std::size_t>(i)] || !square_[static_cast<std::size_t>(k)]) return false;
    for (Eigen::Index at = 0; at < x_.size(); ++at)
      if ((ways_(at, i) != 0 || ways_(at, k) != 0) && !(x_[at] > 0 && x_[at] < 1)) return false;
    const double a = curvature(i, i), b = curvature(k, k), c = curvature(i, k), middle = (a + b) / 2,
                 least = middle - std::hypot((a - b) / 2, c);
    return least > clearly * std::max(a, b) && least * distances[0] * distances[0] / 2 > noticeable_;
  }

  const Eigen::VectorXd& x_;
  const PlaceBeside& here_;
  const EvaluateBeside& evaluate_;
  Eigen::MatrixXd ways_;     // (n, ways), each of length one
  std::vector<bool> square_; // by way, whether it rises close by with the square, as curvature tells
  Eigen::VectorXd multipliers_;
  double value_ = 0, noticeable_ = 0, lowest_ = 0;
  int looked_ = 0, level_ = 0;
  Surroundings out_;
};

} // namespace

Surroundings look_around(const Eigen::VectorXd& x, const PlaceBeside& here, const EvaluateBeside& evaluate) {
  return Look(x, here, evaluate).run();
}

} // namespace flyball
