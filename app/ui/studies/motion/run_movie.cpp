#include "app/ui/studies/motion/run_movie.hpp"

#include "app/session/motion.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

std::vector<double> movie_times(const Run& run, const MovieTiming& timing) {
  std::vector<double> times;
  if (run.time.empty()) return times;
  const double from = std::clamp(timing.from, run.time.front(), run.time.back());
  const double to = std::clamp(timing.to, from, run.time.back());
  const double step = timing.factor / timing.rate;
  // The last moment counts where a frame falls on it but for rounding.
  const double last = std::min(std::floor((to - from) / step + 1e-9), static_cast<double>(most_movie_frames));
  for (std::size_t i = 0; static_cast<double>(i) <= last; ++i)
    times.push_back(std::min(from + static_cast<double>(i) * step, to));
  return times;
}

RunScene::RunScene(std::shared_ptr<const Mechanism> mechanism, std::shared_ptr<const Run> run,
                   const std::optional<Solution>& steady)
    : mechanism_(std::move(mechanism)), run_(std::move(run)) {
  if (steady) analysis_ = analysis_at(mechanism_, *steady);
  if (analysis_) cut_joints_ = analysis_->summary().cut_joints;
}

ViewFrame RunScene::frame(double moment, const ViewFrame& look) {
  ViewFrame frame = look;
  frame.mechanism = mechanism_.get();
  frame.cut_joints = cut_joints_;
  motion_ = poses_at(*run_, moment);
  frame.motion = {};
  frame.poses = motion_;
  if (!analysis_) return frame;
  steady_ = analysis_->poses_at(steady_time(*run_, *mechanism_, moment));
  frame.poses = steady_;
  frame.motion = motion_;
  return frame;
}

} // namespace flyball
