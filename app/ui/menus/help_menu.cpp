#include "app/ui/menus/menu_commands.hpp"

#include "app/report/versions.hpp"

#include <array>

namespace flyball::menus {

namespace {

void tell_about(App& app) {
  app.session.notice = "Flyball " + program_versions().front().second +
                       ", under the MIT license. The manual page of each command tells more: man flyball.";
}

const std::array help_commands{
    Command{.id = "help.palette",
            .title = "Find…",
            .help = "Commands, parts and numbers by name; \"spin 15\" sets a number.",
            .key = ctrl('P'),
            .run = [](App& app) { app.panels->palette.open(); }},
    Command{.id = "help.messages",
            .title = "Messages",
            .help = "What was told before, the latest first.",
            .run = [](App& app) { app.notice_log.showing = !app.notice_log.showing; },
            .checked = [](const App& app) { return app.notice_log.showing; }},
    Command{.id = "help.shortcuts",
            .title = "Shortcuts",
            .help = "Every key and what it does.",
            .key = plain('?'),
            .also = plain(keys::f1),
            .run = [](App& app) { app.panels->shortcuts.open = !app.panels->shortcuts.open; },
            .checked = [](const App& app) { return app.panels->shortcuts.open; },
            .words = "keyboard"},
    Command{.id = "help.tutorial",
            .title = "A governor from nothing",
            .help = "The tutorial: a first mechanism step by step, beside the view.",
            .run = [](App& app) { app.panels->tutorial.open = !app.panels->tutorial.open; },
            .checked = [](const App& app) { return app.panels->tutorial.open; },
            .words = "tutorial first steps learn"},
    Command{.id = "help.about",
            .title = "About",
            .help = "Version and license, and where more is told.",
            .run = tell_about,
            .words = "version license manual documentation"},
};

} // namespace

std::span<const Command> help() {
  return help_commands;
}

} // namespace flyball::menus
