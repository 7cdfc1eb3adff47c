// Whether the desktop is light or dark. The one file that knows how to ask.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flyball {

enum class DesktopColors { light, dark, high_contrast };

// Asks the desktop on a thread of its own, so that nobody waits.
class SystemColors {
 public:
  // `on_news` is called from that thread.
  explicit SystemColors(std::function<void()> on_news);
  ~SystemColors(); // gives up what is still being asked
  SystemColors(const SystemColors&) = delete;
  SystemColors& operator=(const SystemColors&) = delete;

  void ask();                          // unless it is being asked already
  std::optional<DesktopColors> take(); // the answer, once

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Of the desktop portal's answers about color-scheme and contrast in org.freedesktop.appearance, as gdbus
// prints them: "(<<uint32 1>>,)". Nothing where it has no preference.
std::optional<DesktopColors> read_portal(std::string_view scheme, std::string_view contrast);
// Of GTK's settings.ini, and of the name of its theme.
std::optional<DesktopColors> read_gtk_settings(std::string_view ini);
std::optional<DesktopColors> read_gtk_theme(std::string name);

} // namespace flyball
