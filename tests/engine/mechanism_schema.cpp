// The schema in assets holds the same scenes as the reader: what the reader finds malformed the schema
// refuses, and what the schema refuses the reader, which also knows the meaning, refuses.
#include "tests/catch.hpp"

#if !__has_include(<valijson/validator.hpp>)

TEST_CASE("The schema agrees with the reader") {
  WARN("skipped: valijson is not installed");
}

#else

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"

#include "tests/engine/mechanism_everything.hpp"
#include "tests/engine/mechanism_random.hpp"
#include "tests/support/scenes.hpp"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

using namespace flyball;
using namespace flyball::test;
using Json = nlohmann::json;

namespace {

class SceneSchema {
 public:
  SceneSchema() {
    const Json text = Json::parse(read_bytes(FLYBALL_ASSETS "/scene.schema.json"));
    const valijson::adapters::NlohmannJsonAdapter adapter(text);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, schema_);
  }
  bool accepts(const Json& scene) const {
    valijson::Validator validator;
    return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(scene), nullptr);
  }

 private:
  valijson::Schema schema_;
};

template <class Read>
bool accepted(Read&& read, const std::string& text) {
  try {
    read(text);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

// Every place in a tree, as a JSON pointer.
void collect_places(const Json& json, const Json::json_pointer& place, std::vector<Json::json_pointer>& all) {
  all.push_back(place);
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      collect_places(value, place / key, all);
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i)
      collect_places(json[i], place / i, all);
}

// The tree with one part changed in each of many ways.
std::vector<Json> mutations(const Json& scene, const Json::json_pointer& place) {
  std::vector<Json> all;
  const auto change = [&](auto&& edit) {
    Json copy = scene;
    edit(copy[place]);
    all.push_back(std::move(copy));
  };
  for (const Json& other : {Json(nullptr), Json(true), Json(3), Json("text"), Json::array(), Json::object()})
    change([&](Json& part) { part = other; });
  if (scene[place].is_object()) {
    change([](Json& part) { part["unknown"] = 1; });
    change([](Json& part) { part["description"] = "told"; });
    change([](Json& part) { part["description"] = 1; });
    change([](Json& part) { part["cut"] = true; });
    change([](Json& part) { part["damping"] = 1; });
    for (const auto& item : scene[place].items())
      change([&](Json& part) { part.erase(item.key()); });
  }
  if (scene[place].is_array() && !scene[place].empty()) {
    change([](Json& part) { part.push_back(part.back()); });
    change([](Json& part) { part.erase(part.size() - 1); });
  }
  return all;
}

void check_agreement(const SceneSchema& schema, const Json& scene) {
  std::vector<Json::json_pointer> places;
  collect_places(scene, Json::json_pointer(), places);
  for (const Json::json_pointer& place : places)
    for (const Json& mutation : mutations(scene, place)) {
      const std::string text = mutation.dump();
      const bool by_schema = schema.accepts(mutation);
      if (by_schema ? accepted(parse_scene, text) : !accepted(read_scene, text)) continue;
      INFO(place.to_string() << "\n" << Json::diff(scene, mutation).dump());
      CHECK(by_schema == accepted(parse_scene, text));
    }
  SUCCEED();
}

} // namespace

TEST_CASE("The schema takes every shipped scene") {
  const SceneSchema schema;
  for (const std::string& file : shipped_files()) {
    INFO(file);
    CHECK(schema.accepts(Json::parse(read_bytes(file))));
  }
  CHECK(schema.accepts(Json::parse(everything)));
}

TEST_CASE("The schema refuses every mistake of form") {
  const SceneSchema schema;
  for (const Mistake& mistake : mistakes_of_form) {
    INFO(mistake.find << "  ->  " << mistake.replace);
    CHECK_FALSE(schema.accepts(Json::parse(edited(mistake.find, mistake.replace))));
  }
}

TEST_CASE("The schema agrees with the reader on changed scenes") {
  const SceneSchema schema;
  check_agreement(schema, Json::parse(everything));
  for (const char* name : {"governor", "pendulum"})
    check_agreement(schema, Json::parse(read_bytes(shipped_file(name))));
}

#endif
