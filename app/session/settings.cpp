#include "app/session/settings.hpp"

#include "app/document/state_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace flyball {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path file_in(const fs::path& state_folder) {
  return state_folder / "settings.json";
}

template <class Value>
using Words = std::pair<std::string_view, Value>;
constexpr std::array<Words<AngleUnit>, 2> angles{{{"deg", AngleUnit::degree}, {"rad", AngleUnit::radian}}};
constexpr std::array<Words<LengthUnit>, 2> lengths{
    {{"m", LengthUnit::metre}, {"mm", LengthUnit::millimetre}}};
constexpr std::array<Words<SpeedUnit>, 3> speeds{
    {{"rad/s", SpeedUnit::radian}, {"deg/s", SpeedUnit::degree}, {"rpm", SpeedUnit::rpm}}};

constexpr std::array<Words<Navigation>, 3> navigations{
    {{"own", Navigation::own}, {"blender", Navigation::blender}, {"cad", Navigation::cad}}};
constexpr std::array<Words<ThemeChoice>, 4> themes{{{"system", ThemeChoice::system},
                                                    {"light", ThemeChoice::light},
                                                    {"dark", ThemeChoice::dark},
                                                    {"high-contrast", ThemeChoice::high_contrast}}};

template <class Table, class Value>
void read(const json& from, const char* key, const Table& words, Value& value) {
  const auto found = from.find(key);
  if (found == from.end() || !found->is_string()) return;
  for (const auto& [word, meaning] : words)
    if (found->template get_ref<const std::string&>() == word) value = meaning;
}

void read(const json& from, const char* key, bool& value) {
  if (const auto found = from.find(key); found != from.end() && found->is_boolean())
    value = found->get<bool>();
}

template <class Table, class Value>
std::string word_for(const Table& words, Value value) {
  for (const auto& [word, meaning] : words)
    if (meaning == value) return std::string(word);
  return {};
}

} // namespace

Settings read_settings(const fs::path& state_folder) {
  Settings settings;
  if (state_folder.empty()) return settings;
  const json file = read_state(file_in(state_folder));
  if (!file.is_object()) return settings;
  read(file, "angle", angles, settings.units.angle);
  read(file, "length", lengths, settings.units.length);
  read(file, "speed", speeds, settings.units.speed);
  read(file, "navigation", navigations, settings.navigation);
  read(file, "theme", themes, settings.theme);
  read(file, "legend", settings.legend);
  read(file, "ghost", settings.ghost);
  read(file, "grid", settings.grid);
  read(file, "shadow", settings.shadow);
  if (const auto zoom = file.find("zoom"); zoom != file.end() && zoom->is_number())
    settings.zoom = std::clamp(zoom->get<double>(), least_zoom, most_zoom);
  return settings;
}

void keep_settings(const fs::path& state_folder, const Settings& settings) {
  if (state_folder.empty()) return;
  const json file = {{"angle", word_for(angles, settings.units.angle)},
                     {"length", word_for(lengths, settings.units.length)},
                     {"speed", word_for(speeds, settings.units.speed)},
                     {"navigation", word_for(navigations, settings.navigation)},
                     {"legend", settings.legend},
                     {"ghost", settings.ghost},
                     {"grid", settings.grid},
                     {"shadow", settings.shadow},
                     {"theme", word_for(themes, settings.theme)},
                     {"zoom", settings.zoom}};
  write_state(file_in(state_folder), file);
}

std::optional<ThemeChoice> theme_choice_of(std::string_view word) {
  for (const auto& [name, choice] : themes)
    if (name == word) return choice;
  return std::nullopt;
}

} // namespace flyball
