// Light or dark as the desktop is, without waiting for it.
#include "app/platform/printed_by.hpp"
#include "app/platform/system_colors.hpp"
#include "tests/catch.hpp"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <unistd.h>

using namespace flyball;
using namespace std::chrono_literals;

TEST_CASE("the desktop portal's answers", "[platform]") {
  CHECK(read_portal("(<<uint32 1>>,)\n", "") == DesktopColors::dark);
  CHECK(read_portal("(<<uint32 2>>,)\n", "(<<uint32 0>>,)\n") == DesktopColors::light);
  CHECK(read_portal("(<<uint32 1>>,)\n", "(<<uint32 1>>,)\n") == DesktopColors::high_contrast);
  CHECK_FALSE(read_portal("(<<uint32 0>>,)\n", ""));
  CHECK_FALSE(read_portal("", ""));
  CHECK_FALSE(read_portal("Error: no such interface", ""));
}

TEST_CASE("GTK's settings where there is no portal", "[platform]") {
  CHECK(read_gtk_settings("[Settings]\ngtk-theme-name=Adwaita\ngtk-application-prefer-dark-theme=1\n") ==
        DesktopColors::dark);
  CHECK(read_gtk_settings("gtk-application-prefer-dark-theme = true\ngtk-theme-name=Adwaita\n") ==
        DesktopColors::dark);
  CHECK(read_gtk_settings("[Settings]\ngtk-theme-name=Yaru\n") == DesktopColors::light);
  CHECK(read_gtk_settings("gtk-theme-name=\"HighContrastInverse\"\n") == DesktopColors::high_contrast);
  CHECK_FALSE(read_gtk_settings(""));
  CHECK_FALSE(read_gtk_settings("gtk-font-name=Cantarell 11\n"));
  CHECK(read_gtk_theme("Adwaita:dark") == DesktopColors::dark);
}

TEST_CASE("what a program prints, but only in time", "[platform]") {
  CHECK(printed_by({"printf", "two words"}, 5s) == "two words");
  CHECK_FALSE(printed_by({"false"}, 5s));
  CHECK_FALSE(printed_by({"no-such-program-anywhere"}, 5s));
  const auto begun = std::chrono::steady_clock::now();
  CHECK_FALSE(printed_by({"sleep", "60"}, 100ms));
  CHECK_FALSE(printed_by({"sleep", "60"}, 60s, [] { return true; }));
  CHECK(std::chrono::steady_clock::now() - begun < 20s);
}

TEST_CASE("the desktop is asked beside everything else", "[platform]") {
  // A desktop of its own, which is dark and takes its time.
  const auto folder =
      std::filesystem::temp_directory_path() / ("flyball-colors-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "gdbus") << "#!/bin/sh\ncase \"$*\" in *contrast*) n=0;; *) n=1; sleep 0.3;; esac\n"
                                     "echo \"(<<uint32 $n>>,)\"\n";
  std::filesystem::permissions(folder / "gdbus", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  ::setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere", 1);
  {
    std::atomic<bool> told = false;
    SystemColors colors([&] { told = true; });
    colors.ask();
    CHECK_FALSE(colors.take()); // nobody waits
    for (int i = 0; i < 500 && !told; ++i)
      std::this_thread::sleep_for(20ms);
    CHECK(told);
    CHECK(colors.take() == DesktopColors::dark);
    CHECK_FALSE(colors.take()); // once
  }
  ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
  ::setenv("PATH", path.c_str(), 1);
  std::filesystem::remove_all(folder);
}
