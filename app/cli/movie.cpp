#include "app/cli/movie.hpp"

#include "app/cli/progress.hpp"
#include "app/render/offscreen.hpp"
#include "app/ui/studies/motion/run_movie.hpp"
#include "engine/mechanism/error.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <limits>

namespace flyball::cli {

namespace {

// The signal that came, while somebody holds a Signals.
std::atomic<int> came = 0;
static_assert(std::atomic<int>::is_always_lock_free, "or a signal's handler may not touch it");

// Puts signals to end off until what is under way has been tidied up; then they take their usual course.
class Signals {
 public:
  Signals() {
    came = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      struct sigaction note {};
      note.sa_handler = [](int signal) { came = signal; };
      sigemptyset(&note.sa_mask);
      sigaction(all[i], nullptr, &former_[i]);
      if (former_[i].sa_handler != SIG_IGN) sigaction(all[i], &note, nullptr); // nohup
    }
  }
  ~Signals() {
    for (std::size_t i = 0; i < all.size(); ++i)
      sigaction(all[i], &former_[i], nullptr);
    if (came != 0) std::raise(came);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  static bool came_one() { return came != 0; }

 private:
  static constexpr std::array all{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, 3> former_{};
};

MovieFormat format_of(const MovieOptions& options, std::size_t frames) {
  return {options.width, options.height, options.rate, frames};
}

// Sees all of it, from the direction the scene asks for.
ViewCamera camera_for(const Mechanism& mechanism, RunScene& scene, const std::vector<double>& times,
                      const MovieOptions& options) {
  const ViewSize size{static_cast<double>(options.width), static_cast<double>(options.height)};
  const Bounds bounds = scene.bounds(times);
  ViewCamera camera = initial_camera(mechanism, bounds, size);
  camera.fit(bounds, size);
  return camera;
}

} // namespace

void check_movie(const MovieOptions& options, double duration) {
  const double frames = duration / options.factor * options.rate + 1;
  const auto count = frames < static_cast<double>(most_movie_frames) ? static_cast<std::size_t>(frames)
                                                                     : most_movie_frames + 1;
  if (const std::string problem = movie_problem(options.file, format_of(options, count)); !problem.empty())
    throw SceneError("--movie " + options.file.string(), problem);
}

void draw_movie(const Mechanism& mechanism, std::shared_ptr<const Run> run,
                const std::optional<Solution>& steady, const MovieOptions& options) {
  const OffscreenContext context;
  ViewRenderer renderer;
  const std::vector<double> times =
      movie_times(*run, {run->time.front(), run->time.back(), options.rate, options.factor});
  RunScene scene(std::make_shared<const Mechanism>(mechanism), std::move(run), steady);
  ViewFrame look;
  look.camera = camera_for(mechanism, scene, times, options);
  const Signals signals;
  ProgressBar progress("drawing");
  RunMovie movie(std::move(scene), times, options.file, format_of(options, times.size()), look, 4);
  constexpr double between_signals = 0.1; // s
  while (!Signals::came_one() && !movie.step(renderer, between_signals))
    progress.show("drawing", movie.drawn(), movie.frames());
}

} // namespace flyball::cli
