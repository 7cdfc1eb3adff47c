// Reading values out of JSON with messages that name the place, what was expected and what was found.
#pragma once

#include "engine/mechanism/json_text.hpp"
#include "engine/mechanism/scene_keys.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// Where the expressions of a part go as they are read.
struct FormulaSink {
  Formulas* formulas = nullptr;
  std::size_t path = 0; // length of the part's own path, which keys do not repeat
};

// One value and its place.
class ValueReader {
 public:
  ValueReader(const Json& json, std::string path, std::string_view expected, FormulaSink sink = {})
      : json_(json), path_(std::move(path)), expected_(expected), sink_(sink) {}

  const Json& json() const { return json_; }
  const std::string& path() const { return path_; }
  const FormulaSink& sink() const { return sink_; }
  // The same where no expression may stand.
  ValueReader plain() const { return {json_, path_, expected_}; }

  bool boolean() const;
  // Zero of an expression, which goes to the sink.
  double number() const;
  const std::string& text() const;
  // An array of `smallest` to `largest` elements.
  std::vector<ValueReader> elements(std::size_t smallest, std::size_t largest,
                                    std::string_view expected) const;
  std::vector<ValueReader> elements() const;
  template <std::size_t N>
  std::array<double, N> numbers() const {
    std::array<double, N> all{};
    const std::vector<ValueReader> each = elements(N, N, "a number");
    for (std::size_t i = 0; i < N; ++i)
      all[i] = each[i].number();
    return all;
  }
  // Zero of a named point.
  Vec3 vec3() const;
  std::array<Vec3, 2> two_vec3() const;
  std::array<std::string, 2> two_texts() const;
  // Index of the word in the list.
  std::size_t word(std::span<const std::string_view> words) const;

  // Throws SceneError that says what was expected and what is there instead.
  [[noreturn]] void fail() const;
  [[noreturn]] void fail(std::string_view expected) const;

 private:
  const Json& json_;
  std::string path_;
  std::string_view expected_;
  FormulaSink sink_;

  // The place in its part as an address has it: "spring.1.stiffness".
  std::string key() const;
};

// One object, of which every key is known and none is missing.
class ObjectReader {
 public:
  // `noun` is what messages call the object, as in "a revolute joint"; `relatives` are the keys of objects it
  // may be mistaken for, such as joints of other types; `sink` takes the expressions.
  ObjectReader(const ValueReader& value, FormulaSink sink, scene_keys::Keys keys, std::string_view noun,
               std::span<const scene_keys::Keys> relatives);

  bool has(std::string_view key) const { return json_.contains(key); }
  // Of a field that is there.
  ValueReader value(const Field& field) const;
  std::string description() const;

 private:
  const Json& json_;
  const std::string& path_;
  FormulaSink sink_;
};

// The word under `key` in an object whose other keys depend on it.
std::size_t read_type(const ValueReader& value, std::span<const std::string_view> words,
                      std::string_view noun);

} // namespace flyball
