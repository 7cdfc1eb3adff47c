#include "app/ui/studies/motion/movie_export.hpp"

#include <exception>

namespace flyball {

namespace {

constexpr double longest_wait = 0.005; // s a frame of the window may be held up by ffmpeg

// Where it is, in words.
std::string saved_words(const std::filesystem::path& file, std::size_t frames) {
  if (movie_kind(file) != MovieKind::frames) return "Saved " + file.string();
  const std::string first = frame_file(file, 0, frames).string();
  if (frames == 1) return "Saved " + first;
  return "Saved " + std::to_string(frames) + " frames, " + first + " to " +
         frame_file(file, frames - 1, frames).filename().string();
}

} // namespace

std::vector<double> requested_times(const Session& session, const MovieRequest& request) {
  const MotionRun* shown = shown_motion(session);
  if (!shown) return {};
  return movie_times(*shown->run, {request.from, request.to, request.rate, request.factor});
}

void MovieExport::begin(App& app, const MovieRequest& request) {
  const MotionRun* shown = shown_motion(app);
  if (!shown) return;
  std::optional<Solution> steady;
  if (converged(app)) steady = app.answer.solution;
  const std::shared_ptr<const Mechanism>& mechanism =
      app.answer.ticket ? app.answer.mechanism : app.document.shared();
  const ViewFrame look = view_frame(app);
  file_ = request.file;
  movie_.emplace(RunScene(mechanism, shown->run, steady), requested_times(app, request), request.file,
                 MovieFormat{request.width, request.height, request.rate, 0}, look, app.view.samples);
}

void MovieExport::update(App& app, ViewRenderer& renderer) {
  MovieState& state = app.movie;
  if (!movie_ && !state.request) return; // a stage that draws a picture beside this one's film tells nothing
  if (std::exchange(state.cancel, false)) movie_.reset();
  try {
    if (const auto request = std::exchange(state.request, std::nullopt)) {
      movie_.reset();
      state.problem.clear();
      state.done = false;
      begin(app, *request);
    }
    if (movie_ && movie_->step(renderer, longest_wait)) {
      app.notice = saved_words(file_, movie_->frames());
      movie_.reset();
      state.done = true;
    }
  } catch (const std::exception& error) {
    movie_.reset();
    state.problem = error.what();
  }
  state.progress.reset();
  if (movie_) state.progress = {movie_->drawn(), movie_->frames()};
}

} // namespace flyball
