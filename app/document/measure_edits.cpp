#include "app/document/measure_edits.hpp"

#include "app/document/formula_edits.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/mistakes.hpp"

#include <algorithm>

namespace flyball {
namespace {

std::vector<SceneError> mistakes_of(const Mechanism& mechanism) {
  Mistakes mistakes;
  find_measure_mistakes(mechanism, mistakes);
  return mistakes.all();
}

void check_measure_name(const Mechanism& mechanism, const std::string& name) {
  if (!is_expression_name(name))
    throw SceneError("measures." + name, "expected a name of letters, figures and _ that is no function's");
  if (free_name(mechanism, name) != name)
    throw SceneError("measures." + name, "expected a name of its own; there is a \"" + name + "\" already");
}

// Whether a measure asks of a part that is not there, or uses a name that is none.
bool is_lost(const Mechanism& mechanism, const NamedMeasure& measure) {
  Mechanism alone = mechanism;
  std::erase_if(alone.measures, [&](const NamedMeasure& each) { return each.name == measure.name; });
  for (NamedMeasure& each : alone.measures) // whatever else is wrong with them
    each.text = "0";
  alone.measures.push_back(measure);
  return !mistakes_of(alone).empty();
}

// In measures and laws, where a measure is called by name.
void replace_in_uses(Mechanism& mechanism, const std::string& name, const std::string& text) {
  for (NamedMeasure& each : mechanism.measures)
    each.text = renamed_in(each.text, name, text);
  for (Joint& joint : mechanism.joints)
    for (Formula& formula : joint.formulas)
      if (formula.key.starts_with("drive.") && parameter_index(mechanism, name) < 0)
        formula.text = renamed_in(formula.text, name, text);
}

} // namespace

void set_measure(Mechanism& mechanism, const std::string& name, const NamedMeasure& measure) {
  Mechanism next = mechanism;
  const int index = measure_index(next, name);
  if (name != measure.name) check_measure_name(next, measure.name);
  if (index < 0) {
    next.measures.push_back(measure);
  } else {
    next.measures[static_cast<std::size_t>(index)] = measure;
    if (name != measure.name) replace_in_uses(next, name, measure.name);
  }
  // Only its own mistakes: others may be being mended.
  for (const SceneError& error : mistakes_of(next))
    if (error.where() == "measures." + measure.name || error.where() == "measures." + measure.name + ".unit")
      throw error;
  mechanism = std::move(next);
}

std::string measure_mistake(const Mechanism& mechanism, const std::string& name,
                            const NamedMeasure& measure) {
  try {
    Mechanism copy = mechanism;
    set_measure(copy, name, measure);
    return {};
  } catch (const SceneError& error) {
    return error.expected();
  }
}

void remove_measure(Mechanism& mechanism, const std::string& name) {
  const int index = measure_index(mechanism, name);
  if (index < 0) throw SceneError("measures." + name, "there is no such measure");
  replace_in_uses(mechanism, name, "(" + mechanism.measures[static_cast<std::size_t>(index)].text + ")");
  mechanism.measures.erase(mechanism.measures.begin() + index);
}

void follow_in_measures(Mechanism& mechanism, const Part& part, const std::string& name) {
  const ResultPart kind = part.kind == PartKind::joint   ? ResultPart::joint
                          : part.kind == PartKind::force ? ResultPart::force
                                                         : ResultPart::body;
  for (NamedMeasure& each : mechanism.measures)
    each.text = part_renamed_in(each.text, kind, part.name, name);
  for (Joint& joint : mechanism.joints)
    for (Formula& formula : joint.formulas)
      if (is_drive_law(mechanism, formula))
        formula.text = part_renamed_in(formula.text, kind, part.name, name);
}

void drop_lost_measures(Mechanism& mechanism) {
  for (bool dropped = !mechanism.measures.empty(); dropped;) {
    dropped = std::erase_if(mechanism.measures,
                            [all = mechanism](const NamedMeasure& each) { return is_lost(all, each); }) > 0;
  }
}

NamedMeasure new_measure(const Mechanism& mechanism) {
  if (mechanism.bodies.empty()) return {free_name(mechanism, "mass_of_all"), "", "mass()", "kg"};
  const std::string body = argument_text(mechanism.bodies.back().name);
  return {free_name(mechanism, "height"), "", "y(" + body + ")", "m"};
}

} // namespace flyball
