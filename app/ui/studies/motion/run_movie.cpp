#include "app/ui/studies/motion/run_movie.hpp"

#include "app/session/motion.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

// The same steady state again, ready to be turned.
std::optional<Analysis> analysis_at(std::shared_ptr<const Mechanism> mechanism, const Solution& steady) {
  Analysis analysis(std::move(mechanism));
  SolveOptions options;
  options.nearest = true;
  options.details = false;
  options.start = start_values(steady.coordinates);
  if (analysis.solve(options).status != Status::converged) return std::nullopt;
  return analysis;
}

MovieFormat of_frames(MovieFormat format, std::size_t frames) {
  format.frames = frames;
  return format;
}

} // namespace

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

ViewFrame RunScene::frame(double time, const ViewFrame& look) {
  ViewFrame frame = look;
  frame.mechanism = mechanism_.get();
  frame.cut_joints = cut_joints_;
  motion_ = poses_at(*run_, time);
  frame.motion = {};
  frame.poses = motion_;
  if (!analysis_) return frame;
  steady_ = analysis_->poses_at(steady_time(*run_, *mechanism_, time));
  frame.poses = steady_;
  frame.motion = motion_;
  return frame;
}

Bounds RunScene::bounds(const std::vector<double>& times) {
  Bounds bounds;
  for (const double time : times) {
    const ViewFrame seen = frame(time, {});
    bounds.add(scene_of(seen).bounds);
    for (const Instance& instance : build_ghost(*mechanism_, seen.motion, {}))
      bounds.add(instance_bounds(instance));
  }
  return bounds;
}

RunMovie::RunMovie(RunScene scene, std::vector<double> times, const std::filesystem::path& file,
                   const MovieFormat& format, const ViewFrame& look, int samples)
    : scene_(std::move(scene)), times_(std::move(times)), format_(of_frames(format, times_.size())),
      look_(look), ghost_(look.ghost.begin(), look.ghost.end()), samples_(samples), writer_(file, format_) {
  look_.ghost = ghost_;
  look_.selected.clear();
  look_.hovered = {};
}

bool RunMovie::step(ViewRenderer& renderer, double seconds) {
  if (!writer_.ready(seconds)) return false;
  if (drawn_ == times_.size()) return writer_.finish(seconds);
  if (!target_) target_.emplace(format_.width, format_.height, samples_);
  renderer.draw(scene_.frame(times_[drawn_], look_), *target_);
  writer_.add(target_->read());
  ++drawn_;
  return false;
}

} // namespace flyball
