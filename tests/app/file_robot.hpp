// Documents and files as a person meets them, for the tests of what happens to both.
#pragma once

#include "robot.hpp"
#include "temporary_folder.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/file_commands.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/support/scenes.hpp"

namespace flyball::test {

namespace fs = std::filesystem;

inline constexpr const char* speed = "joints.spin.drive.speed";
inline constexpr int key_down = 264, key_right = 262;

// A program that ended without saying goodbye: its name is no running process.
inline constexpr const char* crashed = "another machine:1:1";

// The program with a state folder, and time that passes when it is told to.
class FileRobot : public Robot {
 public:
  explicit FileRobot(const TemporaryFolder& folder, const char* owner = nullptr) {
    imgui_compat::map_key(ImGuiKey_DownArrow, key_down);
    imgui_compat::map_key(ImGuiKey_RightArrow, key_right);
    app.session.options.state = folder / "state";
    if (owner) app.session.files.owner = owner;
    begin_files(app.session, app.dialog);
    frames(3);
  }
  void pass(double seconds) {
    for (double t = 0; t < seconds; t += 0.25) {
      update_files(app.session, 0.25);
      app.session.files.autosave.wait();
    }
    frames(3);
  }
  void set_speed(double value) {
    ++app.session.gesture;
    edit_parameter(app.session, speed, value);
    frames(1);
  }
  double speed_now() const { return get_parameter(app.session.mechanism(), speed); }
  bool shows(const std::string& widget) const { return app.ui.widgets.contains(widget); }
  void open(const fs::path& file) {
    open_file(app, file);
    frames(3);
  }
};

inline fs::path governor_in(const TemporaryFolder& folder, const char* name = "governor.json") {
  fs::copy_file(shipped_file("governor"), folder / name);
  return folder / name;
}

inline double speed_in(const fs::path& file) {
  return get_parameter(parse_scene(read_bytes(file)), speed);
}

inline void set_speed_in(const fs::path& file, double value) {
  Mechanism mechanism = parse_scene(read_bytes(file));
  set_parameter(mechanism, speed, value);
  save_scene(mechanism, file);
}

// The governor, opened from a folder of its own.
struct OpenGovernor {
  const TemporaryFolder folder;
  const fs::path file = governor_in(folder);
  FileRobot robot{folder};
  App& app = robot.app;
  OpenGovernor() { robot.open(file); }
};

// Unsaved work on a file, by a program that then crashed.
inline void crash_at_speed(const TemporaryFolder& folder, const fs::path& file, double value) {
  FileRobot robot(folder, crashed);
  robot.open(file);
  robot.set_speed(value);
  robot.pass(2);
}

// Of hidden files in the folder, those that end so.
inline std::size_t hidden(const TemporaryFolder& folder, const std::string& end) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    count += name.starts_with('.') && name.ends_with(end) ? 1 : 0;
  }
  return count;
}

} // namespace flyball::test
