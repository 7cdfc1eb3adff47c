// The subcommands of `flyball`, one file each.
//
// Every add_ function registers one subcommand: its options, its help and, as the last line of its footer, an
// example. It runs inside CLI11's callback and leaves in `ending` how it ended. Options live
// as long as the program's CLI::App, so they belong in a std::shared_ptr that the callback holds.
// SceneError and std::exception may leave the callback: main() prints them (see report_error.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace flyball::cli {

inline constexpr int exit_done = 0;      // also an unstable state, told as such
inline constexpr int exit_no_result = 1; // not converged, no steady state; the reason was printed
inline constexpr int exit_bad_input = 2; // usage, scene file or address

// How a command ended. main() prints the reason on standard error, wherever the rest of the output went.
struct Ending {
  int exit_code = exit_done;
  std::string reason; // why there is no result
};
// Done where there is a result; else the reason, which is about the scene in that file.
Ending end_with(bool result, const std::filesystem::path& scene, std::string_view reason);
// Prints the reason; returns the exit code.
int finish(const Ending& ending);

void add_solve(CLI::App& app, Ending& ending);
void add_sweep(CLI::App& app, Ending& ending);
void add_merge(CLI::App& app, Ending& ending);
void add_branch(CLI::App& app, Ending& ending);
void add_modes(CLI::App& app, Ending& ending);
void add_hunting(CLI::App& app, Ending& ending);
void add_campbell(CLI::App& app, Ending& ending);
void add_design(CLI::App& app, Ending& ending);
void add_spread(CLI::App& app, Ending& ending);
void add_linearize(CLI::App& app, Ending& ending);
void add_simulate(CLI::App& app, Ending& ending);
void add_compare(CLI::App& app, Ending& ending);
void add_render(CLI::App& app, Ending& ending);
void add_report(CLI::App& app, Ending& ending);
void add_check(CLI::App& app, Ending& ending);
// `completion`, and `manual`, which only the build asks for: about the commands that `app` has.
void add_completion(CLI::App& app);
void add_manual(CLI::App& app);

} // namespace flyball::cli
