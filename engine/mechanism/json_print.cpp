#include "engine/mechanism/error.hpp"
#include "engine/mechanism/json_text.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>

namespace flyball {
namespace {

// Text on one line where it fits, else one element a line.
class Printer {
 public:
  std::string print(const Json& json) {
    break_open(json, 0, "");
    return std::move(text_) + "\n";
  }

 private:
  static constexpr std::size_t widest = 110;

  static std::string scalar(const Json& json, const std::string& path) {
    if (json.is_string() && find_invalid_utf8(json.get_ref<const std::string&>()) != std::string::npos)
      throw SceneError(path, "expected UTF-8 text");
    if (!json.is_number_float()) return json.dump();
    const double value = json.get<double>();
    if (!std::isfinite(value)) throw SceneError(path, "expected a finite number; JSON has no other");
    return number_text(value);
  }

  static std::string one_line(const Json& json, const std::string& path) {
    if (!json.is_structured()) return scalar(json, path);
    std::string text(1, json.is_object() ? '{' : '[');
    for (std::size_t i = 0; const auto& [key, value] : json.items()) {
      if (i > 0) text += ", ";
      if (json.is_object()) text += Json(key).dump() + ": ";
      text += one_line(value, child_path(json, path, key, i++, value));
    }
    return text + (json.is_object() ? '}' : ']');
  }

  static std::string child_path(const Json& parent, const std::string& path, const std::string& key,
                                std::size_t i, const Json& child) {
    return parent.is_object() ? key_path(path, key) : element_path(path, i, child);
  }

  void print(const Json& json, std::size_t indent, const std::string& path) {
    const std::size_t start = text_.rfind('\n') + 1;
    const std::string line = one_line(json, path);
    if (text_.size() - start + line.size() < widest || !json.is_structured() || json.empty())
      text_ += line;
    else
      break_open(json, indent, path);
  }

  void break_open(const Json& json, std::size_t indent, const std::string& path) {
    text_ += json.is_object() ? "{\n" : "[\n";
    for (std::size_t i = 0; const auto& [key, value] : json.items()) {
      text_.append(indent + 2, ' ');
      if (json.is_object()) text_ += Json(key).dump() + ": ";
      // The lists of the scene always have a line for each part, so that a change shows as one line.
      const bool list_of_scene =
          indent == 0 && value.is_array() && !value.empty() && value.front().is_object();
      const std::string child = child_path(json, path, key, i++, value);
      if (list_of_scene)
        break_open(value, indent + 2, child);
      else
        print(value, indent + 2, child);
      text_ += i < json.size() ? ",\n" : "\n";
    }
    text_.append(indent, ' ');
    text_ += json.is_object() ? '}' : ']';
  }

  std::string text_;
};

} // namespace

std::string print_json(const Json& json) {
  return Printer().print(json);
}

} // namespace flyball
