// Edits of measures. All throw SceneError, and leave the mechanism as it was, where they cannot be done.
#pragma once

#include "app/document/part.hpp"
#include "engine/mechanism/measure_plan.hpp"

#include <string>

namespace flyball {

// What `measure` would have wrong in the mechanism, in place of the one of this name (empty: beside all);
// empty where nothing is.
std::string measure_mistake(const Mechanism& mechanism, const std::string& name, const NamedMeasure& measure);
// The same measure with another expression. Where this is of another dimension its unit goes along: that of
// the first result, or the SI's.
NamedMeasure with_expression(const Mechanism& mechanism, NamedMeasure measure, const std::string& text);
// Puts it in that place; where its name changes, other measures follow.
void set_measure(Mechanism& mechanism, const std::string& name, const NamedMeasure& measure);
// Where others use it they have its expression instead.
void remove_measure(Mechanism& mechanism, const std::string& name);

// After a part got another name.
void follow_in_measures(Mechanism& mechanism, const Part& part, const std::string& name);
// Drops those that ask of parts that are not there, and what uses these.
void drop_lost_measures(Mechanism& mechanism);

// To begin with: how high the last body stands.
NamedMeasure new_measure(const Mechanism& mechanism);

} // namespace flyball
