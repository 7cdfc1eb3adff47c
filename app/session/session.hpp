// What a person works on, whether or not a window shows it: the document, its steady state, solved in the
// background, and the studies of it. A plain state that commands change and update() moves on.
#pragma once

#include "app/document/document.hpp"
#include "app/live/live_solver.hpp"
#include "app/session/files.hpp"
#include "app/session/goals.hpp"
#include "app/session/motion.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/session_options.hpp"
#include "app/session/studies.hpp"
#include "app/session/units.hpp"
#include "engine/mechanism/error.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct Playback {
  bool playing = false;
  double time = 0;   // s after the drawn drive phase
  double factor = 1; // seconds shown a second; below one is slow motion
};

// Building shows the drawn pose, which is what is edited, with the equilibrium beside it as a ghost;
// exploring shows the equilibrium, which is what sliders move.
enum class Mode { explore, build };

// Points of bodies that are told of beside the mass centres, one a body, by its name: in world coordinates of
// the drawn pose (m).
using ToldPoints = std::map<std::string, Vec3, std::less<>>;

struct Session {
  explicit Session(SessionOptions options);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  SessionOptions options;
  Document document;
  FileState files;
  std::string problem; // why the file last asked for could not be opened
  std::vector<ParameterControl> parameters;
  std::vector<SceneError> mistakes; // of the document; while there are any it is not solved
  std::vector<SceneError> warnings; // of the document; where there are no mistakes

  LiveSolver live;
  LiveAnswer answer;
  std::vector<Pose> drawn, poses; // drawn: of the document; poses: of the answer at playback.time; empty
                                  // where there is none
  bool moved_time = false;        // playback.time changed: poses are to be asked for
  // Tickets: of the newest request (the largest number where the document is not fit to be solved), of the
  // last that was asked, and of the first since the document was opened.
  std::uint64_t awaited = std::numeric_limits<std::uint64_t>::max(), asked = 0, opened = 0;
  // Of the last request under a hand that pulls: up to it what no longer stands is no answer (see runs_away()
  // in session.cpp), and whether the last one was none for that.
  std::uint64_t pulled = 0;
  bool pulled_too_far = false;
  double waited = 0;         // s for an answer to it; 0 where there is one
  bool on_branch = false;    // a hand has chosen the equilibrium: sliders follow its branch, stable or not
  std::uint64_t gesture = 1; // of the hand: rises with every press of a button or key

  Mode mode = Mode::explore;
  Playback playback;
  std::vector<double> speeds; // that the drives prescribe, by which playback.time is their phase
  ToldPoints points;
  StudyState study;
  MotionState motion;
  GoalState goals;
  std::shared_ptr<const Mechanism> named; // whose names all has that is chosen beside the document
  DisplayUnits units;
  std::string notice;  // what was last done, in words; whoever shows it takes it away
  std::string failure; // the notice that tells what went wrong; see show_error()

  const Mechanism& mechanism() const { return document.mechanism(); }
  const Selection& selection() const { return document.selection(); }

  // For whoever shows the session; may be empty. After another document has taken the place of what was open.
  std::function<void(bool same_file)> on_document_opened;
  // After set_mode().
  std::function<void()> on_mode_chosen;
  // After an edit of `before` that may have renamed parts.
  std::function<void(const Mechanism& before)> on_edited;
};

// Takes a document's place; what was open is gone (leave_document() of a window asks first).
void open_document(Session& session, Document document);

// An edit: a step that can be undone, solved at once. `change` gets the mechanism as it is stored and the
// selection, and may throw SceneError: then nothing has changed and the notice says why. Edits of the same
// name while a button is held (session.gesture) are one step.
void edit(Session& session, const std::string& name,
          const std::function<void(Mechanism&, Selection&)>& change);
// Another mechanism as a file has it: a step of its own, which no expression refuses.
void replace_mechanism(Session& session, const std::string& name, Mechanism mechanism,
                       const std::optional<NamedHues>& hues = {});
void undo(Session& session);
void redo(Session& session);
void go_to_step(Session& session, std::size_t step);
void select(Session& session, Selection selection);
// An edit of one number at an address as in a scene file; while exploring, solved from the last answer.
void edit_parameter(Session& session, const std::string& address, double value);
// Tries a number while exploring, which changes nothing of what is stored; solves at once from the last
// answer. While building it is an edit. Not finite values and unknown addresses are ignored.
void change_parameter(Session& session, const std::string& address, double value);
// The same of several, as one step of this name.
void change_parameters(Session& session, const std::string& step, const Explored& values);
// The same, solved from these coordinates ("joint" or "joint.index" and rad or m).
void go_to_numbers(Session& session, const std::string& step, const Explored& values,
                   std::vector<std::pair<std::string, double>> start);
// What is explored becomes the document's, or goes back to what is stored. Both can be undone.
void keep_explored(Session& session);
void drop_explored(Session& session);
// "speed of spin 15 rad/s": each value that is explored, and what is stored of it.
std::vector<std::string> explored_words(const Session& session);
// The same with the mechanism in the equilibrium nearest to these coordinates ("joint" or "joint.index" and
// rad or m), on whatever branch, stable or not. Sliders then follow that branch, until it ends, the drawn
// pose is started from again or something else is edited. Without an address no number is changed.
void go_to_state(Session& session, const std::string& address, double value,
                 std::vector<std::pair<std::string, double>> start);
void solve_from_drawn_pose(Session& session);
// A point of the body that is told of beside its mass centre, in the results and in the motion (see
// ToldPoints); none: its mass centre alone. No edit.
void tell_point(Session& session, const std::string& body, const std::optional<Vec3>& at);
// Those of the bodies that there are.
std::vector<BodyPoint> told_points(const Session& session);

void set_mode(Session& session, Mode mode);
void play(Session& session, bool playing);
void rewind(Session& session);

// Takes what the background has found and moves the time on by `seconds`.
void update(Session& session, double seconds);

// Whether the last answer is a steady state; whether the one to the newest request is still to come.
bool converged(const Session& session);
bool solving(const Session& session);
// Whether anything moves by itself.
bool in_motion(const Session& session);
// Whether the motion is wanted in a view of its own.
bool motion_beside(const Session& session);

// A notice that stays until it is put away: what went wrong.
void show_error(Session& session, std::string text);
bool is_error(const Session& session);

} // namespace flyball
