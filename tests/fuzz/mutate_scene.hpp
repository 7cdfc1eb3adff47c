// Changes to a scene that leave it JSON, so that most of them get past the parser.
#pragma once

#include <nlohmann/json.hpp>

#include <random>

namespace flyball::fuzz {

using Json = nlohmann::ordered_json;

// Changes one thing somewhere: a number to an extreme one, a name or type to another, a part to another kind
// of value; an element or key is doubled, dropped, moved or copied from elsewhere.
void mutate(Json& scene, std::mt19937& random);

// Puts a part of `other` where `scene` has one under the same key.
void cross(Json& scene, Json other, std::mt19937& random);

} // namespace flyball::fuzz
