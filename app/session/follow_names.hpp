// What a person has chosen by the names of parts and numbers, and is no part of the document: tolerances,
// numbers that are held, told points, what studies are over. It goes along when these are renamed, and when
// that is undone.
#pragma once

#include "app/document/part.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace flyball {

struct Session;

// After an edit of `before`, whose names all that is chosen has.
void follow_names(Session& session, const Mechanism& before);
// What the part is called in `after`; as before where it is not known by another name.
Part renamed_part(Part part, const Mechanism& before, const Mechanism& after);

} // namespace flyball
