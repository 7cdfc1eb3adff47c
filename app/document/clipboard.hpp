// Parts as text, to be pasted into another document or a mail.
#pragma once

#include "app/document/part.hpp"

#include <string>
#include <string_view>

namespace flyball {

// A scene file (see scene.hpp) with the selected bodies, what holds them to one another or to ground, and the
// joints and forces selected; gears with both their joints; the gravity, so that it can stand alone, and no
// sliders. Parts may refer to bodies that are not in it: they are looked for by name where it is pasted.
std::string copy_text(const Mechanism& mechanism, const Selection& selection);

// Adds the text's bodies, joints and forces; names that are taken or unusable are replaced by the next unused
// ones, in references too; a joint or force whose body, or a gear whose joint, is in neither document is left
// out. Returns what was added. Throws SceneError, and adds nothing, where the text is no scene.
Selection paste_text(Mechanism& mechanism, std::string_view text);

} // namespace flyball
