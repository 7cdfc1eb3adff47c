#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "engine/mechanism/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

namespace flyball::cli {

namespace {

struct RenderOptions {
  std::filesystem::path scene, out;
  std::string free_body, lengths = "automatic", size = "1280x720", pose = "equilibrium", theme = "light";
  float scale = 1;
  int mode = 0;
  double amplitude = 0.15;
  bool interface = false, plain = false, loads = false;
};

Ending run_render(const RenderOptions& options) {
  check_outputs(options.scene, {{"--out", options.out}});
  PictureOptions wanted;
  wanted.interface = options.interface;
  wanted.drawn_pose = options.pose == "drawn";
  wanted.scale = options.scale;
  wanted.theme = options.theme == "dark"    ? Theme::dark
                 : options.theme == "light" ? Theme::light
                                            : Theme::high_contrast;
  wanted.loads = options.loads;
  if (options.lengths != "automatic")
    wanted.load_lengths =
        options.lengths == "cube-root" ? LoadLengths::by_cube_root : LoadLengths::in_proportion;
  wanted.free_body = options.free_body;
  wanted.antialiased = !options.plain;
  wanted.mode = options.mode;
  wanted.amplitude = options.amplitude;
  constexpr int largest = 16384; // pixels a side
  read_size(options.size, largest, wanted.width, wanted.height);
  std::string ending = options.out.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (!ending.empty() && ending != ".png")
    throw SceneError("", fmt::format("--out: pictures are PNG files, found {}", options.out.string()));
  std::optional<ProgressBar> progress(std::in_place, "drawing");
  const Picture picture = draw_picture(options.scene, wanted);
  write_png(options.out, picture.image);
  progress.reset();
  // Standard output may be where the picture goes.
  if (std::filesystem::is_regular_file(options.out))
    print_text(fmt::format("{}: {} x {} pixels, drawn by {}\n", options.out.string(), wanted.width,
                           wanted.height, picture.drawn_by));
  if (wanted.drawn_pose) return {};
  if (picture.answer.error) throw *picture.answer.error;
  return end_with(picture.answer.solution.status == Status::converged, options.scene,
                  picture.answer.solution.message + " (the picture shows the drawn pose)");
}

} // namespace

void add_render(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Draw a scene into a PNG, without a display");
  command->add_option("scene", options->scene, "Scene file (-: standard input)")->required();
  command->add_option("-o,--out", options->out, "PNG file to write")->required();
  command->add_option("--size", options->size, "Pixels")->capture_default_str();
  command->add_flag("--ui", options->interface, "The window with its panels rather than the view alone");
  command
      ->add_option("--pose", options->pose,
                   "drawn or equilibrium; a scene without equilibrium is drawn as it is in the file, and the "
                   "exit code is 1")
      ->check(CLI::IsMember({"drawn", "equilibrium"}))
      ->capture_default_str();
  command->add_option("--scale", options->scale, "Pixels a point has")
      ->check(CLI::Range(0.5, 4.0))
      ->capture_default_str();
  command->add_option("--theme", options->theme, "Colours")
      ->check(CLI::IsMember({"light", "dark", "high-contrast"}))
      ->capture_default_str();
  CLI::Option* loads =
      command->add_flag("--loads", options->loads,
                        "With arrows of reactions, drive torques, springs' forces and inertial loads, all "
                        "forces to one scale and all moments to one");
  command
      ->add_option(
          "--lengths", options->lengths,
          "Of arrows: in proportion, or by the cube root, which shows small forces beside large ones; "
          "automatic: in proportion where at least half of them can be seen so")
      ->check(CLI::IsMember({"automatic", "in-proportion", "cube-root"}))
      ->capture_default_str()
      ->needs(loads);
  command->add_option("--free-body", options->free_body, "With the free-body diagram of this body");
  CLI::Option* mode =
      command
          ->add_option("--mode", options->mode,
                       "With this mode's shape: both ends of its swing in amber beside the equilibrium; "
                       "flyball modes numbers them and makes films")
          ->check(above_zero())
          ->excludes("--free-body");
  command
      ->add_option("--amplitude", options->amplitude,
                   "Of the coordinate that moves most in the mode: rad, or parts of the mechanism's size")
      ->check(above_zero())
      ->needs(mode)
      ->capture_default_str();
  command->add_flag("--no-msaa", options->plain, "Without anti-aliasing of the view: faster");
  command->footer("Examples: flyball render governor.json -o governor.png --ui --size 1280x800\n"
                  "          flyball render governor.json -o swing.png --mode 1");
  command->callback([options, &ending] { ending = run_render(*options); });
}

} // namespace flyball::cli
