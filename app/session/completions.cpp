#include "app/session/completions.hpp"

#include "app/session/number_text.hpp"
#include "engine/mechanism/expression_functions.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cctype>

namespace flyball {

namespace {

bool is_of_word(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) || c == '_' || c == '.' || byte >= 0x80;
}

bool begins_with(std::string_view name, std::string_view word) {
  return name.size() >= word.size() &&
         std::ranges::equal(word, name.substr(0, word.size()), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         });
}

// The function between whose brackets the place is; null: none, or another.
const ResultFunction* function_around(std::string_view before) {
  int open = 0;
  for (std::size_t i = before.size(); i-- > 0;) {
    if (before[i] == ')') --open;
    if (before[i] != '(' || ++open <= 0) continue;
    std::size_t begin = i;
    while (begin > 0 && is_of_word(before[begin - 1]))
      --begin;
    const std::string_view name = before.substr(begin, i - begin);
    const auto found = std::ranges::find(result_functions(), name, &ResultFunction::name);
    return found == result_functions().end() ? nullptr : &*found;
  }
  return nullptr;
}

void add_arguments(const Mechanism& mechanism, ArgumentKind kind, std::vector<Completion>& all) {
  if (kind == ArgumentKind::coordinate)
    for (const Joint& joint : mechanism.joints)
      for (std::size_t i = 0; i < joint.coordinates.size(); ++i)
        all.push_back({coordinate_argument(coordinate_label(joint.name, static_cast<int>(i),
                                                            static_cast<int>(joint.coordinates.size()))),
                       "coordinate"});
  if (kind == ArgumentKind::joint)
    for (const Joint& joint : mechanism.joints)
      all.push_back({argument_text(joint.name), "joint"});
  if (kind == ArgumentKind::force)
    for (const Force& force : mechanism.forces)
      all.push_back({argument_text(force.name), "force"});
  if (kind == ArgumentKind::body || kind == ArgumentKind::point)
    for (const Body& body : mechanism.bodies)
      all.push_back({argument_text(body.name), kind == ArgumentKind::body ? "body" : "its mass centre"});
  if (kind == ArgumentKind::point)
    for (const NamedPoint& point : mechanism.points)
      all.push_back({"ground@" + argument_text(point.name), "the point on the ground; or of a body@"});
}

std::vector<Completion> all_names(const Mechanism& mechanism) {
  std::vector<Completion> all;
  const auto with_unit = [](const std::string& number, const std::string& unit) {
    return unit.empty() ? number : number + " " + unit;
  };
  for (const NamedParameter& parameter : mechanism.parameters)
    all.push_back({parameter.name, with_unit(short_text(parameter.value), parameter.unit)});
  for (const NamedMeasure& measure : mechanism.measures)
    all.push_back({measure.name, "=" + measure.text});
  for (const NamedPoint& point : mechanism.points)
    for (int i = 0; i < 3; ++i)
      all.push_back({point.name + "." + "xyz"[i], with_unit(short_text(point.at[i]), "m")});
  for (const ResultFunction& function : result_functions())
    all.push_back({std::string(function.name) + "(", std::string(function.example)});
  for (const ExpressionFunction& function : expression_functions())
    all.push_back({std::string(function.name) + "(",
                   std::string(function.name) + (function.arguments == 2 ? "(a, b)" : "(a)")});
  all.push_back({"pi", "3.14159…"});
  return all;
}

// What a coordinate's name could become where no function asks for it.
void add_results(const Mechanism& mechanism, std::string_view word, std::vector<Completion>& found) {
  std::vector<Completion> named;
  add_arguments(mechanism, ArgumentKind::coordinate, named);
  for (const Completion& each : named) {
    const std::string_view name = each.text;
    if (word.empty() || !begins_with(name.substr(name.find_first_not_of("'\"")), word)) continue;
    found.push_back({"coordinate(" + each.text + ")", "where it is"});
    found.push_back({"rate(" + each.text + ")", "how fast it moves"});
  }
}

} // namespace

Completions completions_at(const Mechanism& mechanism, std::string_view text, std::size_t cursor) {
  Completions found;
  found.to = found.from = std::min(cursor, text.size());
  while (found.from > 0 && is_of_word(text[found.from - 1]))
    --found.from;
  const std::string_view before = text.substr(0, found.from),
                         word = text.substr(found.from, found.to - found.from);
  if (!word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '.')) return found;
  // Behind a number stands its unit, behind a name or a bracket an operator.
  const std::size_t last = before.find_last_not_of(' ');
  if (last != std::string_view::npos && (is_of_word(before[last]) || before[last] == ')')) return found;
  std::vector<Completion> all;
  const ResultFunction* function = function_around(before);
  if (function) add_arguments(mechanism, function->kind, all);
  for (Completion& each : all_names(mechanism))
    all.push_back(std::move(each));
  for (Completion& each : all)
    if (begins_with(each.text, word)) found.list.push_back(std::move(each));
  if (!function) add_results(mechanism, word, found.list);
  std::stable_partition(found.list.begin(), found.list.end(),
                        [&](const Completion& each) { return each.text == word; });
  return found;
}

} // namespace flyball
