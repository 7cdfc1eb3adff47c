#include "app/ui/studies/film.hpp"

namespace flyball {

namespace {

MovieFormat of_frames(MovieFormat format, std::size_t frames) {
  format.frames = frames;
  return format;
}

} // namespace

Bounds bounds(FilmedScene& scene, const std::vector<double>& moments) {
  Bounds bounds;
  for (const double moment : moments) {
    const ViewFrame seen = scene.frame(moment, {});
    bounds.add(scene_of(seen).bounds);
    for (const Instance& instance : build_ghost(*seen.mechanism, seen.motion, {}))
      bounds.add(instance_bounds(instance));
  }
  return bounds;
}

std::optional<Analysis> analysis_at(std::shared_ptr<const Mechanism> mechanism, const Solution& steady) {
  Analysis analysis(std::move(mechanism));
  SolveOptions options;
  options.nearest = true;
  options.details = false;
  options.start = start_values(steady.coordinates);
  if (analysis.solve(options).status != Status::converged) return std::nullopt;
  return analysis;
}

Film::Film(std::unique_ptr<FilmedScene> scene, std::vector<double> moments, const std::filesystem::path& file,
           const MovieFormat& format, const ViewFrame& look, int samples)
    : scene_(std::move(scene)), moments_(std::move(moments)), format_(of_frames(format, moments_.size())),
      look_(look), ghost_(look.ghost.begin(), look.ghost.end()), samples_(samples), writer_(file, format_) {
  look_.ghost = ghost_;
  look_.selected.clear();
  look_.hovered = {};
  look_.loads = nullptr; // of the one moment that is seen, and the window's
  look_.loads_turning = {};
  look_.loads_motion = nullptr;
  look_.cut_joints = {};
}

bool Film::step(ViewRenderer& renderer, double seconds) {
  if (!writer_.ready(seconds)) return false;
  if (drawn_ == moments_.size()) return writer_.finish(seconds);
  if (!target_) target_.emplace(format_.width, format_.height, samples_);
  renderer.draw(scene_->frame(moments_[drawn_], look_), *target_);
  writer_.add(target_->read());
  ++drawn_;
  return false;
}

} // namespace flyball
