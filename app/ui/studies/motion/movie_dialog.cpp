#include "app/ui/studies/motion/movie_dialog.hpp"

#include "app/session/session.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/studies/motion/movie_export.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/size_fields.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

constexpr int smallest_movie = 16;   // pixels
constexpr float fields_column = 148; // points, where the fields of quantity rows begin, too

constexpr std::array movie_sizes{PictureSize{"360p", "640 × 360", 640, 360},
                                 PictureSize{"720p", "1280 × 720", 1280, 720},
                                 PictureSize{"1080p", "1920 × 1080", 1920, 1080}};

struct Ending {
  const char* name;
  const char* text;
  const char* ending;
};
constexpr std::array endings{Ending{"movie/mp4", "MP4", ".mp4"}, Ending{"movie/gif", "GIF", ".gif"},
                             Ending{"movie/png", "Numbered PNG", ".png"}};

MovieRequest request_of(const Session& session, const FileQuery& query, const MovieState& movie) {

  MovieRequest request{movie.of,     typed_path(query), movie.width, movie.height, movie.rate,
                       movie.factor, movie.from,        movie.to,    movie.swings};
  if (const MotionRun* shown = shown_motion(session); shown && movie.whole) {
    request.from = shown->run->time.front();
    request.to = shown->run->time.back();
  }
  return request;
}

// What may be there already and would be replaced.
std::filesystem::path first_file(const std::filesystem::path& file, std::size_t frames) {
  return movie_kind(file) == MovieKind::frames ? frame_file(file, 0, frames) : file;
}

// Buttons that change the name's ending. Those that need ffmpeg are there without it, too, as it can be
// installed.
void ending_buttons(Ui& ui, FileQuery& query) {
  const std::filesystem::path file = typed_path(query);
  const bool able = ffmpeg_available();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("As");
  ImGui::SameLine(fields_column * ui.scale);
  for (const Ending& each : endings) {
    const bool now = movie_kind(file) == movie_kind("film" + std::string(each.ending));
    const bool possible = able || movie_kind("film" + std::string(each.ending)) == MovieKind::frames;
    ImGui::BeginDisabled(!possible);
    if (text_button(ui, each.name, each.text, now)) {
      std::filesystem::path typed = query.path;
      if (movie_kind(typed)) typed.replace_extension();
      query.path = typed.string() + each.ending;
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
  }
  ImGui::NewLine();
  if (!able)
    paragraph("MP4 and GIF need ffmpeg, which is not installed (package ffmpeg). Numbered PNG pictures do "
              "without it.",
              colors_of(ui).dim);
}

void swing_fields(Session& session, Ui& ui, MovieState& movie) {
  double swings = movie.swings;
  plain_quantity_field(session, ui, "movie/swings", "Swings", "",
                       "How often it swings; the film's end goes on with its beginning.", swings,
                       Least::above_zero);
  constexpr double most = 10000;
  movie.swings = static_cast<int>(std::round(std::clamp(swings, 1., most)));
}

void time_fields(Session& session, Ui& ui, MovieState& movie, const Run& run) {

  plain_quantity_field(session, ui, "movie/factor", "Speed factor", "",
                       "Seconds of the run that a second of the film shows: below 1 is slow motion.",
                       movie.factor, Least::above_zero);
  if (check_row(ui, "movie/whole", "Whole run", movie.whole,
                "From the beginning to the end, or a part of it.")) {
    movie.whole = !movie.whole;
    movie.from = run.time.front();
    movie.to = run.time.back();
  }
  if (movie.whole) return;
  plain_quantity_field(session, ui, "movie/from", "From", "s", "The first moment shown.", movie.from);
  plain_quantity_field(session, ui, "movie/to", "To", "s", "The last moment shown.", movie.to);
}

// Whether what is to be filmed is still shown, and whole.
bool shown(const Session& session, const MovieState& movie) {
  return movie.of == Filmed::mode ? moving_mode(session) != nullptr : session.motion.on;
}
bool complete(const Session& session, const MovieState& movie) {
  if (movie.of == Filmed::mode) return modes_are_current(session);
  const MotionRun* run = shown_motion(session);
  return run && run->finished;
}

// Why it cannot be made, or "". A folder that is not there yet is none of it: the dialog asks to make it;
// then one that is there, `folder`, says whether anything else is.
std::string problem_of(const Session& session, const MovieState& movie, const MovieRequest& request,
                       std::size_t frames, const std::filesystem::path& folder) {
  if (!complete(session, movie))
    return movie.of == Filmed::mode    ? "The modes are of the state before the last changes."
           : computing_motion(session) ? "The run is still being computed."
                                       : "There is no run.";
  if (request.of == Filmed::run && !(request.from < request.to) && !movie.whole)
    return "It ends before it begins.";
  if (std::min(request.width, request.height) < smallest_movie) return "At least 16 pixels a side.";
  std::error_code ignored;
  const bool there = std::filesystem::is_directory(request.file.parent_path(), ignored);
  const std::filesystem::path file = there ? request.file : folder / request.file.filename();
  return movie_problem(file, {request.width, request.height, request.rate, frames});
}

void progress(Ui& ui, MovieState& movie, const MovieState::Progress& at) {
  const std::string text =
      at.drawn < at.frames
          ? "Frame " + std::to_string(at.drawn) + " of " + std::to_string(at.frames)
          : "All " + std::to_string(at.frames) + " frames are drawn; ffmpeg is finishing the file";
  paragraph(text, colors_of(ui).text);
  const float s = ui.scale, width = ImGui::GetContentRegionAvail().x, height = 6 * s;
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float share = static_cast<float>(at.drawn) / static_cast<float>(std::max<std::size_t>(at.frames, 1));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, {from.x + width, from.y + height}, packed(colors_of(ui).raised), height / 2);
  list.AddRectFilled(from, {from.x + std::max(width * share, height), from.y + height},
                     packed(colors_of(ui).accent), height / 2);
  ImGui::Dummy({width, height});
  note_widget(ui.widgets, "movie/progress");
  ImGui::Dummy({0, 2 * s});
  if (text_button(ui, "movie/cancel", "Cancel") || escape_pressed()) movie.cancel = true;
}

} // namespace

void MovieDialog::choices(Session& session, Ui& ui, MovieState& movie) {
  bool accepted = path_field(ui, query_, "movie", "Name");
  ending_buttons(ui, query_);
  size_fields(ui, "movie", movie_sizes, fields_column, movie.width, movie.height);
  plain_quantity_field(session, ui, "movie/rate", "Frames a second", "",
                       "Of the film: 25 to 60 look smooth, a GIF has at most 50.", movie.rate,
                       Least::above_zero);
  if (movie.of == Filmed::mode)
    swing_fields(session, ui, movie);
  else if (const MotionRun* run = shown_motion(session))
    time_fields(session, ui, movie, *run->run);

  const MovieRequest request = request_of(session, query_, movie);
  const std::size_t frames = requested_moments(session, request).size();
  const std::string problem = problem_of(session, movie, request, frames, query_.list.shown);
  const std::filesystem::path first = first_file(request.file, frames);
  ImGui::Dummy({0, 2 * ui.scale});
  if (!problem.empty())
    paragraph(problem, complete(session, movie) ? colors_of(ui).bad : colors_of(ui).dim);
  else
    paragraph(std::to_string(frames) + " frames, " +
                  short_text(static_cast<double>(frames) / request.rate, 4) + " s long" +
                  (movie.of == Filmed::mode ? ", with the amplitude that is shown"
                                            : ": from " + short_text(request.from) + " s to " +
                                                  short_text(request.to) + " s of the run"),
              colors_of(ui).dim);
  if (!movie.problem.empty()) paragraph("Not saved: " + movie.problem, colors_of(ui).bad);
  const char* asked = asked_before_writing(ui, query_, first);
  if (!asked && !query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  ImGui::BeginDisabled(!problem.empty());
  accepted = text_button(ui, "movie/save", asked ? asked : "Export", true) || accepted;
  ImGui::EndDisabled();
  if (accepted && problem.empty() && may_write_to(session, query_, first)) {
    play(session, false); // all the time there is goes into the film
    movie.request = request;
    movie.problem.clear();
  }
  ImGui::SameLine();
  if (text_button(ui, "movie/cancel", "Cancel") || escape_pressed()) {
    movie = before_;
    close_dialog();
  }
}

void MovieDialog::open(const Session& session, DialogState& dialog, MovieState& movie, Filmed of) {
  movie.of = of;
  if (!shown(session, movie)) return;
  dialog.wanted = Dialog::export_run;
  show_folder(query_, usual_folder(session));
  query_.asked.clear();
  movie.problem.clear();
  movie.done = false;
  before_ = movie;
  const std::string stem = file_stem(session);
  const char* const ending = ffmpeg_available() ? ".mp4" : ".png";
  const std::string which =
      of == Filmed::mode ? "-mode-" + std::to_string(*session.study.modes.chosen + 1) : std::string();
  query_.path = (query_.list.shown / ("flyball-" + stem + which + ending)).string();
}

void MovieDialog::draw(Session& session, Ui& ui, DialogState& dialog, MovieState& movie) {
  if (!begin_dialog(ui, dialog, Dialog::export_run,
                    movie.of == Filmed::mode ? "Export the mode" : "Export the run", 480))
    return;
  if (movie.request || movie.progress)
    progress(ui, movie, movie.progress.value_or(MovieState::Progress{}));
  else if (movie.done || !shown(session, movie)) // nothing is: another document
    close_dialog();
  else
    choices(session, ui, movie);
  end_dialog();
}

} // namespace flyball
