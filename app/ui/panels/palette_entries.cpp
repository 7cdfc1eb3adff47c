#include "app/ui/panels/palette_entries.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/session/number_text.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/quantity.hpp"
#include "app/session/units.hpp"
#include "app/ui/app.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/layout.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace flyball {

namespace {

constexpr std::size_t most_entries = 200, most_recent = 20;
constexpr int recently_used = 30, disabled_command = -1000; // added to how well it answers

std::string words_of_address(std::string address) {
  std::ranges::replace(address, '.', ' ');
  std::ranges::replace(address, '_', ' ');
  return address;
}

PaletteEntry part_entry(PartKind kind, const std::string& name, const std::string& what) {
  const char* list = kind == PartKind::body ? "body" : kind == PartKind::joint ? "joint" : "force";
  PaletteEntry entry;
  entry.name = std::string("part/") + list + "/" + name;
  entry.title = name;
  entry.about = what + ": select it and bring it into view";
  entry.more = what;
  entry.part = {kind, name};
  return entry;
}

void read_mechanism(const Session& session, PaletteIndex& index) {
  if (index.revision == session.document.revision()) return;
  const Mechanism& mechanism = session.mechanism();
  index = {.revision = session.document.revision(), .entries = {}, .search = {}, .found = {}, .fresh = false};
  for (const Body& body : mechanism.bodies)
    index.entries.push_back(part_entry(PartKind::body, body.name, "body"));
  for (const Joint& joint : mechanism.joints)
    index.entries.push_back(part_entry(PartKind::joint, joint.name, joint_noun(joint)));
  for (const Force& force : mechanism.forces)
    index.entries.push_back(part_entry(PartKind::force, force.name, std::string(type_name(force.type))));
  for (const std::string& address : parameter_addresses(mechanism)) {
    PaletteEntry entry;
    entry.name = "number/" + address;
    entry.title = parameter_phrase(address);
    entry.more = words_of_address(address);
    entry.address = address;
    index.entries.push_back(std::move(entry));
  }
}

PaletteEntry command_entry(const App& app, const Command& command) {
  PaletteEntry entry;
  entry.name = command.id;
  entry.title = label_of(app, command);
  entry.enabled = is_enabled(app, command);
  entry.about = entry.enabled ? command.help : "Not now: there is nothing selected that it applies to.";
  entry.more = command.help;
  entry.right = key_text(command.key);
  entry.command = &command;
  return entry;
}

// "speed of spin 15 rad/s": the words, and from the first one that begins with a digit on the number.
std::pair<std::string, std::string> words_and_number(const std::string& search) {
  for (std::size_t at = 1; at < search.size(); ++at) {
    const char c = search[at];
    const bool sign = (c == '-' || c == '+' || c == '.') && at + 1 < search.size();
    const bool begins = std::isdigit(static_cast<unsigned char>(sign ? search[at + 1] : c)) != 0;
    if (search[at - 1] == ' ' && begins) return {search.substr(0, at - 1), search.substr(at)};
  }
  return {search, ""};
}

std::string number_words(const Session& session, const std::string& si_unit, double value) {
  const ShownUnit unit = shown_unit(si_unit, session.units);
  return short_text(unit.shown(value), 6) + (unit.text.empty() ? "" : " " + unit.text);
}

void describe_number(const Session& session, PaletteEntry& entry) {
  const std::string unit = parameter_unit(session.mechanism(), entry.address);
  const double now = get_parameter(session.mechanism(), entry.address);
  entry.right = number_words(session, unit, now);
  entry.about = "go to it; with a number behind its name, set it";
  if (!entry.value) return;
  entry.right += " → " + number_words(session, unit, *entry.value);
  entry.about = "Enter sets it";
}

struct Ranked {
  int score = 0;
  PaletteEntry entry;
};

int recent_bonus(const CommandState& commands, const std::string& name) {
  const auto found = std::ranges::find(commands.recent, name);
  if (found == commands.recent.end()) return 0;
  return recently_used - static_cast<int>(found - commands.recent.begin());
}

// Whether the entry answers, with what it makes of a number behind its name.
void try_entry(const Session& session, const CommandState& commands, const std::string& search,
               const PaletteEntry& entry, std::vector<Ranked>& ranked) {
  if (FuzzyMatch match = fuzzy_match(search, entry.title, entry.more)) {
    ranked.push_back(
        {match.score + recent_bonus(commands, entry.name) + (entry.enabled ? 0 : disabled_command), entry});
    ranked.back().entry.marks = std::move(match.marks);
    return;
  }
  if (entry.address.empty()) return;
  const auto [words, number] = words_and_number(search);
  if (number.empty()) return;
  FuzzyMatch match = fuzzy_match(words, entry.title, entry.more);
  if (!match) return;
  const std::string unit = parameter_unit(session.mechanism(), entry.address);
  const Quantity typed = parse_quantity(number, unit, shown_unit(unit, session.units).text);
  if (!typed) return;
  // Numbers with a slider are what is most likely meant.
  const bool slider = std::ranges::find(session.parameters, entry.address, &ParameterControl::address) !=
                      session.parameters.end();
  ranked.push_back({match.score + recent_bonus(commands, entry.name) + (slider ? 25 : 0), entry});
  ranked.back().entry.marks = std::move(match.marks);
  ranked.back().entry.value = typed.value;
}

bool starts_empty(const std::string& search) {
  return search.find_first_not_of(' ') == std::string::npos;
}

// The part of the mechanism whose number it is; none for the scene's own.
Part part_of_address(const std::string& address) {
  const std::size_t from = address.find('.'), to = address.find('.', from + 1);
  if (from == std::string::npos || to == std::string::npos) return {};
  const std::string name = address.substr(from + 1, to - from - 1);
  if (address.starts_with("bodies.")) return {PartKind::body, name};
  if (address.starts_with("joints.")) return {PartKind::joint, name};
  if (address.starts_with("forces.")) return {PartKind::force, name};
  return {};
}

void fit_part(App& app, const Part& part) {
  const PartId id = find_part(*shown_mechanism(app.session, app.tool), part);
  const SceneList& scene = shown_scene(app)->solid;
  Bounds bounds;
  for (const Instance& instance : scene.instances)
    if (instance.part == id) bounds.add(instance_bounds(instance));
  if (id.kind == PartKind::none || bounds.empty) return;
  // With something of what is around it.
  const Vec3 around = Vec3::Constant(0.12 * (scene.bounds.upper - scene.bounds.lower).norm());
  const Vec3 middle = bounds.center();
  bounds.add(Vec3(middle - around));
  bounds.add(Vec3(middle + around));
  const WidgetRect& view = app.ui.keyboard.view;
  if (view.to.x <= view.from.x) return;
  app.view.camera.fit(
      bounds, {static_cast<double>(view.to.x - view.from.x), static_cast<double>(view.to.y - view.from.y)});
  app.view.fit = false;
}

void go_to_number(App& app, const std::string& address) {
  const auto control = std::ranges::find(app.session.parameters, address, &ParameterControl::address);
  if (control != app.session.parameters.end()) {
    set_mode(app.session, Mode::explore);
    PanelState& panels = app.panels;
    bool* sections[] = {&panels.pinned, &panels.drives, &panels.springs, &panels.dampers};
    *sections[static_cast<std::size_t>(control->group)] = true;
  } else {
    const Part part = part_of_address(address);
    select(app.session, part.kind == PartKind::none ? Selection{} : Selection{{part}});
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    if (layout_of(app, screen.x, screen.y).inspector.width <= 0) set_mode(app.session, Mode::build);
  }
  seek_number(app.ui, address);
}

} // namespace

const std::vector<PaletteEntry>& palette_entries(App& app) {
  if (!app.commands.index) app.commands.index = std::make_shared<PaletteIndex>();
  PaletteIndex& index = *app.commands.index;
  read_mechanism(app.session, index);
  const std::string& search = app.commands.search;
  if (index.fresh && index.search == search) return index.found;
  std::vector<Ranked> ranked;
  for (const Command& command : commands())
    try_entry(app.session, app.commands, search, command_entry(app, command), ranked);
  for (const PaletteEntry& entry : index.entries)
    if (!starts_empty(search) || recent_bonus(app.commands, entry.name) > 0)
      try_entry(app.session, app.commands, search, entry, ranked);
  std::ranges::stable_sort(ranked, [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
  if (ranked.size() > most_entries) ranked.resize(most_entries);
  index.found.clear();
  for (Ranked& each : ranked) {
    if (!each.entry.address.empty()) describe_number(app.session, each.entry);
    index.found.push_back(std::move(each.entry));
  }
  index.search = search;
  index.fresh = true;
  return index.found;
}

void use_palette_entry(App& app, const PaletteEntry& chosen) {
  const PaletteEntry entry = chosen; // the list is made anew by what it does
  std::vector<std::string>& recent = app.commands.recent;
  std::erase(recent, entry.name);
  recent.insert(recent.begin(), entry.name);
  if (recent.size() > most_recent) recent.resize(most_recent);
  if (entry.command) return entry.command->run(app);
  if (entry.part.kind != PartKind::none) {
    select(app.session, {{entry.part}});
    return fit_part(app, entry.part);
  }
  if (!entry.value) return go_to_number(app, entry.address);
  change_parameter(app.session, entry.address, *entry.value);
  app.session.notice =
      entry.title + ": " +
      number_words(app.session, parameter_unit(app.session.mechanism(), entry.address), *entry.value);
}

} // namespace flyball
