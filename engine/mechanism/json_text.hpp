// JSON text to a tree and back, stricter than JSON: no key twice in an object, no number beyond a double, no
// absurd depth; and the path to a part of the tree, for messages.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace flyball {

using Json = nlohmann::ordered_json;

// Throws SceneError; for text that is not JSON its `where` is the line and column.
Json parse_json(std::string_view text);

// Text on two-space indents, where what fits stays on one line. Throws SceneError for a number that is not
// finite and for text that is not UTF-8.
std::string print_json(const Json& json);

// `path.key`, or `key` at the top.
std::string key_path(const std::string& path, std::string_view key);
// `path.name` for an element of a list that has a usable name, otherwise `path[i]`.
std::string element_path(const std::string& path, std::size_t i, const Json& element);

} // namespace flyball
