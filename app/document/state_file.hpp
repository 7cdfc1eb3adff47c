// Small JSON files in the folder of a person's state: conveniences, of which none that cannot be read or
// written is a reason to disturb anybody.
#pragma once

#include "app/document/body_hues.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace flyball {

// Null where there is no such file, or it is none that can be read; nothing but a regular file is opened.
nlohmann::json read_state(const std::filesystem::path& file);
// Atomically, its folder too where there is none. Texts that are not UTF-8 are kept with marks in the place
// of what is not.
void write_state(const std::filesystem::path& file, const nlohmann::json& state);
// The colours in an object that may have some.
NamedHues read_hues(const nlohmann::json& entry);
void write_hues(nlohmann::json& entry, const NamedHues& hues);

} // namespace flyball
