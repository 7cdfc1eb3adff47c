#include "app/ui/panels/palette_entries.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/session/number_text.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/quantity.hpp"
#include "app/session/session.hpp"
#include "app/session/units.hpp"
#include "engine/mechanism/address.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace flyball {

namespace {

constexpr std::size_t most_entries = 200;
// Added to how well it answers: a command that is not possible now comes before letters that are scattered
// over a name.
constexpr int recently_used = 30, disabled_command = -50;
// Numbers that a slider moves are likelier meant than others that answer alike, most of all where a number is
// typed behind the name.
constexpr int with_slider = 5, slider_and_number = 25;

bool has_slider(const Session& session, const std::string& address) {
  return std::ranges::find(session.parameters, address, &ParameterControl::address) !=
         session.parameters.end();
}

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
    index.entries.push_back(part_entry(PartKind::force, force.name, force_noun(force)));
  for (const std::string& address : parameter_addresses(mechanism)) {
    PaletteEntry entry;
    entry.name = "number/" + address;
    entry.title = number_phrase(mechanism, address);
    entry.more = words_of_address(address);
    entry.address = address;
    index.entries.push_back(std::move(entry));
  }
}

PaletteEntry command_entry(const CommandRunner& commands, const Command& command) {
  PaletteEntry entry;
  entry.name = command.id;
  entry.title = commands.label(command);
  entry.enabled = commands.enabled(command);
  entry.about = commands.about(command);
  entry.more = command.help + (command.words ? std::string(" ") + command.words : std::string());
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

} // namespace

std::string number_words(const Session& session, const std::string& si_unit, double value) {
  const ShownUnit unit = shown_unit(si_unit, session.units);
  return short_text(unit.shown(value), 6) + (unit.text.empty() ? "" : " " + unit.text);
}

namespace {

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

int recent_bonus(const std::vector<std::string>& recent, const std::string& name) {
  const auto found = std::ranges::find(recent, name);
  if (found == recent.end()) return 0;
  return recently_used - static_cast<int>(found - recent.begin());
}

// Whether the entry answers, with what it makes of a number behind its name.
void try_entry(const Session& session, const std::vector<std::string>& recent, const std::string& search,
               const PaletteEntry& entry, std::vector<Ranked>& ranked) {
  if (FuzzyMatch match = fuzzy_match(search, entry.title, entry.more)) {
    const bool slider = !entry.address.empty() && has_slider(session, entry.address);
    ranked.push_back({match.score + recent_bonus(recent, entry.name) +
                          (entry.enabled ? 0 : disabled_command) + (slider ? with_slider : 0),
                      entry});
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
  const bool slider = has_slider(session, entry.address);
  ranked.push_back(
      {match.score + recent_bonus(recent, entry.name) + (slider ? slider_and_number : 0), entry});
  ranked.back().entry.marks = std::move(match.marks);
  ranked.back().entry.value = typed.value;
}

} // namespace

bool is_blank(const std::string& search) {
  return search.find_first_not_of(' ') == std::string::npos;
}

const std::vector<PaletteEntry>& palette_entries(const Session& session, const CommandRunner& commands,
                                                 PaletteIndex& index, const std::string& search,
                                                 const std::vector<std::string>& recent) {
  read_mechanism(session, index);
  if (index.fresh && index.search == search) return index.found;
  std::vector<Ranked> ranked;
  for (const Command& command : flyball::commands())
    try_entry(session, recent, search, command_entry(commands, command), ranked);
  for (const PaletteEntry& entry : index.entries)
    if (!is_blank(search) || recent_bonus(recent, entry.name) > 0)
      try_entry(session, recent, search, entry, ranked);
  std::ranges::stable_sort(ranked, [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
  if (ranked.size() > most_entries) ranked.resize(most_entries);
  index.found.clear();
  for (Ranked& each : ranked) {
    if (!each.entry.address.empty()) describe_number(session, each.entry);
    index.found.push_back(std::move(each.entry));
  }
  index.search = search;
  index.fresh = true;
  return index.found;
}

} // namespace flyball
