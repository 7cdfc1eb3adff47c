// What the palette's entries do.
#pragma once

namespace flyball {

struct App;
struct PaletteEntry;

// Runs the command, selects the part and brings it into view, goes to the number's slider or field, or sets
// it.
void use_palette_entry(App& app, const PaletteEntry& entry);

} // namespace flyball
