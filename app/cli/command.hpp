// The subcommands of `flyball`, one file each.
//
// Every add_ function registers one subcommand: its options, its help and, as the last line of its footer, an
// example. It runs inside CLI11's callback and leaves one of the codes below in `exit_code`. Options live
// as long as the program's CLI::App, so they belong in a std::shared_ptr that the callback holds.
// SceneError and std::exception may leave the callback: main() prints them (see report_error.hpp).
#pragma once

#include <CLI/CLI.hpp>

namespace flyball::cli {

inline constexpr int exit_done = 0;      // also an unstable state, told as such
inline constexpr int exit_no_result = 1; // not converged, no steady state; the reason was printed
inline constexpr int exit_bad_input = 2; // usage, scene file or address

void add_solve(CLI::App& app, int& exit_code);
void add_sweep(CLI::App& app, int& exit_code);
void add_branch(CLI::App& app, int& exit_code);
void add_design(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);

} // namespace flyball::cli
