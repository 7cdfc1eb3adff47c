#include "engine/mechanism/object_reader.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr std::string_view description_key = "description";

std::string found_text(const Json& json) {
  switch (json.type()) {
  case Json::value_t::object: return "an object";
  case Json::value_t::array:
    return json.size() == 1 ? "an array of 1 element"
                            : "an array of " + std::to_string(json.size()) + " elements";
  case Json::value_t::string: {
    constexpr std::size_t longest = 40;
    const std::string& text = json.get_ref<const std::string&>();
    if (text.size() > longest) return "a text";
    return json.dump();
  }
  default: return json.dump();
  }
}

bool contains(scene_keys::Keys keys, std::string_view name) {
  return std::any_of(keys.begin(), keys.end(), [&](const Field& field) { return field.key == name; });
}

[[noreturn]] void fail_unknown(const std::string& path, std::string_view key, scene_keys::Keys keys,
                               std::string_view noun, std::span<const scene_keys::Keys> relatives) {
  std::vector<std::string_view> names;
  for (const Field& known : keys)
    names.push_back(known.key);
  names.push_back(description_key);
  const std::string its_keys = "; its keys are " + word_list(names, "and");
  const bool elsewhere = std::any_of(relatives.begin(), relatives.end(),
                                     [&](scene_keys::Keys other) { return contains(other, key); });
  if (elsewhere)
    throw SceneError(key_path(path, key), "this key does not belong to " + std::string(noun) + its_keys);
  const std::string hint = did_you_mean(key, names);
  throw SceneError(key_path(path, key),
                   "unknown key of " + std::string(noun) + (hint.empty() ? its_keys : hint));
}

} // namespace

void ValueReader::fail(std::string_view expected) const {
  throw SceneError(path_, "expected " + std::string(expected) + ", found " + found_text(json_));
}

void ValueReader::fail() const {
  fail(expected_);
}

bool ValueReader::boolean() const {
  if (!json_.is_boolean()) fail();
  return json_.get<bool>();
}

double ValueReader::number() const {
  if (sink_.formulas && json_.is_string() && json_.get_ref<const std::string&>().starts_with('=')) {
    sink_.formulas->push_back({key(), json_.get<std::string>().substr(1)});
    return 0;
  }
  if (!json_.is_number()) fail();
  return json_.get<double>();
}

Vec3 ValueReader::vec3() const {
  if (sink_.formulas && json_.is_string()) {
    const std::string point = json_.get<std::string>();
    if (!is_expression_name(point)) fail("the name of a point or " + std::string(expected_));
    const std::string its_key = key();
    for (const int i : {0, 1, 2})
      sink_.formulas->push_back({its_key + "." + std::to_string(i), point_coordinate(point, i)});
    return Vec3::Zero();
  }
  return Vec3(numbers<3>().data());
}

// "spring[1].stiffness" of "joints.x.spring[1].stiffness", with dots for brackets.
std::string ValueReader::key() const {
  std::string key;
  for (std::size_t i = sink_.path; i < path_.size(); ++i) {
    const char c = path_[i];
    if (c == ']' || ((c == '.' || c == '[') && key.empty())) continue;
    key += c == '[' ? '.' : c;
  }
  return key;
}

const std::string& ValueReader::text() const {
  if (!json_.is_string()) fail();
  return json_.get_ref<const std::string&>();
}

std::vector<ValueReader> ValueReader::elements(std::size_t smallest, std::size_t largest,
                                               std::string_view expected) const {
  if (!json_.is_array() || json_.size() < smallest || json_.size() > largest) fail();
  std::vector<ValueReader> all;
  all.reserve(json_.size());
  for (std::size_t i = 0; i < json_.size(); ++i)
    all.emplace_back(json_[i], element_path(path_, i, json_[i]), expected, sink_);
  return all;
}

std::vector<ValueReader> ValueReader::elements() const {
  return elements(0, std::string_view::npos, "an object");
}

std::array<Vec3, 2> ValueReader::two_vec3() const {
  const std::vector<ValueReader> both = elements(2, 2, "three numbers [x, y, z]");
  return {both[0].vec3(), both[1].vec3()};
}

std::array<std::string, 2> ValueReader::two_texts() const {
  const std::vector<ValueReader> both = elements(2, 2, "a name");
  return {both[0].text(), both[1].text()};
}

std::size_t ValueReader::word(std::span<const std::string_view> words) const {
  const std::string expected = word_list(words);
  if (!json_.is_string()) fail(expected);
  const std::string& found = json_.get_ref<const std::string&>();
  const auto place = std::find(words.begin(), words.end(), found);
  if (place == words.end())
    throw SceneError(path_,
                     "expected " + expected + ", found " + found_text(json_) + did_you_mean(found, words));
  return static_cast<std::size_t>(place - words.begin());
}

ObjectReader::ObjectReader(const ValueReader& value, FormulaSink sink, scene_keys::Keys keys,
                           std::string_view noun, std::span<const scene_keys::Keys> relatives)
    : json_(value.json()), path_(value.path()), sink_(sink) {
  if (!json_.is_object()) value.fail("an object");
  for (const auto& [key, ignored] : json_.items())
    if (key != description_key && !contains(keys, key)) fail_unknown(path_, key, keys, noun, relatives);
  for (const Field& field : keys)
    if (field.required && !has(field.key))
      throw SceneError(key_path(path_, field.key),
                       "missing; " + std::string(noun) + " needs it: " + std::string(field.expected));
}

ValueReader ObjectReader::value(const Field& field) const {
  return {json_.at(field.key), key_path(path_, field.key), field.expected, sink_};
}

std::string ObjectReader::description() const {
  if (!has(description_key)) return {};
  return ValueReader(json_.at(description_key), key_path(path_, description_key), "a text").text();
}

std::size_t read_type(const ValueReader& value, std::span<const std::string_view> words,
                      std::string_view noun) {
  constexpr std::string_view key = "type";
  if (!value.json().is_object()) value.fail("an object");
  if (!value.json().contains(key))
    throw SceneError(key_path(value.path(), key),
                     "missing; " + std::string(noun) + " needs it: " + word_list(words));
  return ValueReader(value.json().at(key), key_path(value.path(), key), "").word(words);
}

} // namespace flyball
