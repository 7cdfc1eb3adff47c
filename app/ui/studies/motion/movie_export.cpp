#include "app/ui/studies/motion/movie_export.hpp"

#include "app/ui/studies/modes/mode_movie.hpp"
#include "app/ui/studies/motion/run_movie.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"

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

// Null where none is shown any more.
std::unique_ptr<FilmedScene> filmed_scene(const Session& session, Filmed of) {
  const std::shared_ptr<const Mechanism>& mechanism =
      session.answer.ticket ? session.answer.mechanism : session.document.shared();
  if (of == Filmed::mode) {
    const VibrationMode* mode = moving_mode(session);
    if (!mode) return nullptr;
    return std::make_unique<ModeScene>(mechanism, session.answer.solution, *mode,
                                       session.study.modes.amplitude, steady_time(session));
  }
  const MotionRun* shown = shown_motion(session);
  if (!shown) return nullptr;
  std::optional<Solution> steady;
  if (converged(session)) steady = session.answer.solution;
  return std::make_unique<RunScene>(mechanism, shown->run, steady);
}

} // namespace

std::vector<double> requested_moments(const Session& session, const MovieRequest& request) {
  if (request.of == Filmed::mode) {
    const VibrationMode* mode = moving_mode(session);
    return mode ? swing_phases(*mode, request.rate, request.swings) : std::vector<double>{};
  }
  const MotionRun* shown = shown_motion(session);
  if (!shown) return {};
  return movie_times(*shown->run, {request.from, request.to, request.rate, request.factor});
}

void MovieExport::begin(const ViewContext& context, const MovieRequest& request) {
  std::unique_ptr<FilmedScene> scene = filmed_scene(context.session, request.of);
  if (!scene) return;
  const ViewFrame look = view_frame(context.session, context.ui, context.tool, context.view);
  file_ = request.file;
  film_.emplace(std::move(scene), requested_moments(context.session, request), request.file,
                MovieFormat{request.width, request.height, request.rate, 0}, look, context.view.samples);
}

void MovieExport::update(const ViewContext& context, MovieState& state, ViewRenderer& renderer) {
  if (!film_ && !state.request) return; // a stage that draws a picture beside this one's film tells nothing
  if (std::exchange(state.cancel, false)) film_.reset();
  try {
    if (const auto request = std::exchange(state.request, std::nullopt)) {
      film_.reset();
      state.problem.clear();
      state.done = false;
      begin(context, *request);
    }
    if (film_ && film_->step(renderer, longest_wait)) {
      context.session.notice = saved_words(file_, film_->frames());
      film_.reset();
      state.done = true;
    }
  } catch (const std::exception& error) {
    film_.reset();
    state.problem = error.what();
  }
  state.progress.reset();
  if (film_) state.progress = {film_->drawn(), film_->frames()};
}

} // namespace flyball
