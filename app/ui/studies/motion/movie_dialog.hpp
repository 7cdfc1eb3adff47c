// Asks what a film of the run or of a mode is to be, and tells how far it is.
#pragma once

#include "app/ui/studies/motion/movie_state.hpp"
#include "app/ui/widgets/file_query.hpp"

namespace flyball {

struct DialogState;
struct Session;
struct Ui;

class MovieDialog {
 public:
  void open(const Session& session, DialogState& dialog, MovieState& movie, Filmed of);
  void draw(Session& session, Ui& ui, DialogState& dialog, MovieState& movie);
  FileQuery& query() { return query_; } // may be filled in beforehand

 private:
  void choices(Session& session, Ui& ui, MovieState& movie);

  FileQuery query_;
  MovieState before_; // as chosen before it was opened
};

} // namespace flyball
