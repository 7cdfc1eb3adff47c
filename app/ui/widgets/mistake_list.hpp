// What is missing before the mechanism can be solved, in words that lead to the part.
#pragma once

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"

#include <imgui.h>

#include <string>

namespace flyball {

// The part a mistake is about; an empty one for the scene as a whole.
Part part_of(const Mechanism& mechanism, const SceneError& mistake);
// "ball2 is not connected", "spin, axis: expected a direction, not zero".
std::string words_for(const SceneError& mistake);
// What can be done about it, where there is more to say; else empty.
std::string advice_for(const SceneError& mistake);

// The mistake in words; selects its part when it is clicked. Named `name`/`index`.
void mistake_row(Session& session, Ui& ui, const std::string& name, std::size_t index, const ImVec4& color);
// Rows, each of which selects its part when it is clicked; named `name`/0, `name`/1, ... At most `most`, then
// how many more there are.
void mistake_rows(Session& session, Ui& ui, const std::string& name, std::size_t first, std::size_t most);

// The same for warnings, from the first on.
void warning_rows(Session& session, Ui& ui, const std::string& name, std::size_t most);

} // namespace flyball
