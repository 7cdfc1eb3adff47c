// Makes the film that the state asks for, one of its frames between two of the window's, so that the window
// goes on. Needs a current OpenGL context for its whole life.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/studies/film.hpp"
#include "app/ui/studies/motion/movie_state.hpp"

namespace flyball {

struct ViewContext;

// The moments that a film of the request shows: of the run (s), or phases of the mode (rad); none where none
// is shown.
std::vector<double> requested_moments(const Session& session, const MovieRequest& request);

class MovieExport {
 public:
  // Begins, draws the next frame, or gives up, and tells the state. The end is a notice.
  void update(const ViewContext& context, MovieState& state, ViewRenderer& renderer);

 private:
  void begin(const ViewContext& context, const MovieRequest& request);

  std::optional<Film> film_;
  std::filesystem::path file_;
};

} // namespace flyball
