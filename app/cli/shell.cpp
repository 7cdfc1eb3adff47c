// Commands about the commands: completion for shells, and the manual's pages.
#include "app/cli/command.hpp"
#include "app/cli/completion.hpp"
#include "app/cli/man_page.hpp"
#include "app/cli/output.hpp"
#include "engine/mechanism/file.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace flyball::cli {

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print a script by which a shell completes commands");
  command->add_option("shell", *shell, "The shell")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->required();
  command->footer("Example: source <(flyball completion bash)");
  command->callback([shell, &app] {
    const ProgramDescription program = describe(app);
    print_text(*shell == "bash"  ? bash_completion(program)
               : *shell == "zsh" ? zsh_completion(program)
                                 : fish_completion(program));
  });
}

void add_manual(CLI::App& app) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("manual", "Write the manual's pages into a folder")->group("");
  command->add_option("folder", *folder)->required();
  command->callback([folder, &app] {
    const ProgramDescription program = describe(app);
    std::filesystem::create_directories(*folder);
    write_bytes(*folder / "flyball.1", man_page(program));
    for (const CommandDescription& each : program.commands)
      write_bytes(*folder / ("flyball-" + each.name + ".1"), man_page(each));
  });
}

} // namespace flyball::cli
