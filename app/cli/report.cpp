#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/time_limit.hpp"
#include "app/render/gl.hpp"
#include "app/report/page.hpp"
#include "engine/mechanism/file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace flyball::cli {
namespace {

struct Options {
  SceneArgument scene;
  std::filesystem::path out;
  std::vector<std::string> plotted;
  std::string size = "1440x900";
  double time_limit = usual_time_limit;
};

// Where nothing can be drawn the report says so.
ReportPicture both_pictures(const Mechanism& mechanism, const Options& options) {
  PictureOptions wanted;
  constexpr int largest = 4096; // pixels a side
  read_size(options.size, largest, wanted.width, wanted.height);
  ReportPicture out;
  try {
    out.light = encode_png(draw_picture(mechanism, options.scene.file, wanted).image);
    wanted.theme = Theme::dark;
    out.dark = encode_png(draw_picture(mechanism, options.scene.file, wanted).image);
    out.width = wanted.width;
    out.height = wanted.height;
  } catch (const GlError& error) {
    out.problem = error.what();
  }
  return out;
}

Ending run_report(const Options& options) {
  check_outputs(options.scene.file, {{"--out", options.out}});
  std::optional<ProgressBar> progress(std::in_place, "reading");
  const auto mechanism = std::make_shared<const Mechanism>(options.scene.load());
  const TimeLimit limit(options.time_limit);
  ReportOptions wanted;
  wanted.plotted = options.plotted;
  wanted.cancel = &limit.over();
  wanted.progress = progress->reporter();
  ReportContents contents;
  try {
    contents = report_contents(mechanism, wanted);
  } catch (const SceneError& error) {
    if (error.where().starts_with("--")) throw;
    throw options.scene.in_file(error);
  }
  progress->show({"drawing", -1});
  contents.picture = both_pictures(*mechanism, options);
  if (options.scene.file != "-") contents.scene = options.scene.file.filename().string();
  contents.date = report_date();
  write_bytes(options.out, report_page(contents));
  progress.reset();
  // Standard output may be where the page goes.
  if (std::filesystem::is_regular_file(options.out)) print_text(options.out.string() + "\n");
  const bool found = contents.solution.status == Status::converged;
  return end_with(found && !contents.cut_short, options.scene.file,
                  contents.solution.message + (found ? " The time limit cut the curves short." : ""));
}

} // namespace

void add_report(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "report", "Write all about the steady state into one HTML page: picture, loads, modes, curves");
  options->scene.add_to(*command);
  command->add_option("-o,--out", options->out, "HTML file to write (-: standard output)")->required();
  command
      ->add_option("--plot", options->plotted,
                   "What the response curves show: a coordinate (joint, or joint.index) or a measure; may be "
                   "given again "
                   "(default: the first angle and the first length)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--size", options->size, "Pixels of the picture")->capture_default_str();
  add_time_limit(*command, options->time_limit);
  command->footer("Example: flyball report governor.json -o governor.html");
  command->callback([options, &ending] { ending = run_report(*options); });
}

} // namespace flyball::cli
