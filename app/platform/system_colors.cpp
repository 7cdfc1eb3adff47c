#include "app/platform/system_colors.hpp"

#include "app/platform/printed_by.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

namespace flyball {

namespace {

constexpr std::chrono::milliseconds limit_of_answer{1500};

std::optional<std::string> ask_portal(const char* key, const std::function<bool()>& given_up) {
  return printed_by({"gdbus", "call", "--session", "--timeout", "1", "--dest",
                     "org.freedesktop.portal.Desktop", "--object-path", "/org/freedesktop/portal/desktop",
                     "--method", "org.freedesktop.portal.Settings.Read", "org.freedesktop.appearance", key},
                    limit_of_answer, given_up);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::filesystem::path configuration_folder() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder) return folder;
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home ? home : "") / ".config";
}

std::optional<DesktopColors> look_up(const std::function<bool()>& given_up) {
  if (const char* bus = std::getenv("DBUS_SESSION_BUS_ADDRESS"); bus && *bus) {
    const std::string scheme = ask_portal("color-scheme", given_up).value_or("");
    if (given_up()) return std::nullopt;
    const std::string contrast = scheme.empty() ? "" : ask_portal("contrast", given_up).value_or("");
    if (const auto found = read_portal(scheme, contrast)) return found;
  }
  if (const char* theme = std::getenv("GTK_THEME"); theme && *theme) return read_gtk_theme(theme);
  for (const char* release : {"gtk-4.0", "gtk-3.0"})
    if (const auto found = read_gtk_settings(text_of(configuration_folder() / release / "settings.ini")))
      return found;
  return std::nullopt;
}

// The number in "(<<uint32 1>>,)".
int number_in(std::string_view answer) {
  const std::size_t at = answer.find("uint32 ");
  return at == std::string_view::npos ? 0 : std::atoi(std::string(answer.substr(at + 7)).c_str());
}

} // namespace

std::optional<DesktopColors> read_portal(std::string_view scheme, std::string_view contrast) {
  if (number_in(contrast) == 1) return DesktopColors::high_contrast;
  switch (number_in(scheme)) {
  case 1: return DesktopColors::dark;
  case 2: return DesktopColors::light;
  default: return std::nullopt;
  }
}

std::optional<DesktopColors> read_gtk_theme(std::string name) {
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.empty()) return std::nullopt;
  if (name.find("highcontrast") != std::string::npos) return DesktopColors::high_contrast;
  return name.find("dark") != std::string::npos ? DesktopColors::dark : DesktopColors::light;
}

std::optional<DesktopColors> read_gtk_settings(std::string_view ini) {
  std::istringstream lines{std::string(ini)};
  std::optional<DesktopColors> found;
  for (std::string line; std::getline(lines, line);) {
    std::erase_if(line, [](unsigned char c) { return std::isspace(c) || c == '"'; });
    const std::size_t at = line.find('=');
    if (at == std::string::npos) continue;
    const std::string key = line.substr(0, at), value = line.substr(at + 1);
    if (key == "gtk-theme-name" && found != DesktopColors::dark) found = read_gtk_theme(value);
    if (key == "gtk-application-prefer-dark-theme" && (value == "1" || value == "true"))
      found = DesktopColors::dark;
  }
  return found;
}

struct SystemColors::State {
  std::function<void()> on_news;
  std::mutex mutex;
  std::optional<DesktopColors> answer; // guarded by `mutex`
  std::atomic<bool> asking = false;
  std::jthread thread; // last: it uses the others
};

SystemColors::SystemColors(std::function<void()> on_news) : state_(std::make_unique<State>()) {
  state_->on_news = std::move(on_news);
}

SystemColors::~SystemColors() = default;

void SystemColors::ask() {
  if (state_->asking.exchange(true)) return;
  state_->thread = std::jthread([state = state_.get()](const std::stop_token& stop) {
    const auto found = look_up([&] { return stop.stop_requested(); });
    if (found) {
      const std::lock_guard lock(state->mutex);
      state->answer = found;
    }
    state->asking = false;
    if (found && !stop.stop_requested()) state->on_news();
  });
}

std::optional<DesktopColors> SystemColors::take() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->answer, std::nullopt);
}

} // namespace flyball
