#include "engine/mechanism/json_text.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace flyball {
namespace {

constexpr std::size_t deepest = 32; // a scene needs seven

std::string position_text(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  const std::size_t column = start == std::string_view::npos ? offset + 1 : offset - start;
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// Builds the tree and throws at the first part that is wrong, while the path to it is known.
class TreeBuilder final : public nlohmann::json_sax<Json> {
 public:
  explicit TreeBuilder(std::string_view text) : text_(text) {}
  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; } // JSON text has none
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    Level& level = levels_.back();
    if (!level.keys.insert(key).second)
      throw SceneError(key_path(path(), key), "this key stands twice in one object; expected it once");
    level.key = std::move(key);
    return true;
  }

  bool parse_error(std::size_t offset, const std::string& token,
                   const nlohmann::detail::exception& e) override {
    constexpr int out_of_range_number = 406;
    if (e.id == out_of_range_number)
      throw SceneError(path_of_next(), "expected a finite number; " + token + " is too large");
    // The offset counts the bytes read, the wrong one included.
    const std::string where = position_text(text_, std::min(offset > 0 ? offset - 1 : 0, text_.size()));
    const std::string_view what = e.what();
    constexpr std::string_view before_reason = ": ";
    const std::size_t reason = what.find(before_reason, what.find("column"));
    throw SceneError(where, "not JSON: " + std::string(reason == std::string_view::npos
                                                           ? what
                                                           : what.substr(reason + before_reason.size())));
  }

 private:
  struct Level {
    Json* value;
    std::set<std::string> keys;
    std::string key; // the key whose value comes next
  };

  // Path to the innermost open object or array.
  std::string path() const {
    std::string path;
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i)
      path = child_path(path, levels_[i], levels_[i + 1].value);
    return path;
  }

  std::string path_of_next() const {
    return levels_.empty() ? "" : child_path(path(), levels_.back(), nullptr);
  }

  static std::string child_path(const std::string& path, const Level& level, const Json* open_child) {
    if (level.value->is_object()) return key_path(path, level.key);
    const std::size_t count = level.value->size();
    return open_child == nullptr ? path + "[" + std::to_string(count) + "]"
                                 : element_path(path, count - 1, *open_child);
  }

  Json* put(Json value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.value->is_array()) {
      level.value->push_back(std::move(value));
      return &level.value->back();
    }
    // Not operator[], which would search all the keys again.
    auto& object = level.value->get_ref<Json::object_t&>();
    object.emplace_back(level.key, std::move(value));
    return &object.back().second;
  }

  bool add(Json value) {
    put(std::move(value));
    return true;
  }

  bool open(Json value) {
    if (levels_.size() == deepest)
      throw SceneError(path_of_next(), "expected at most " + std::to_string(deepest) +
                                           " levels of arrays and objects, one inside the other");
    levels_.push_back({put(std::move(value)), {}, {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  std::string_view text_;
  Json root_;
  std::vector<Level> levels_;
};

} // namespace

std::string key_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string element_path(const std::string& path, std::size_t i, const Json& element) {
  if (element.is_object()) {
    const auto name = element.find("name");
    if (name != element.end() && name->is_string()) {
      const std::string& text = name->get_ref<const std::string&>();
      if (is_usable_name(text)) return key_path(path, text);
    }
  }
  return path + "[" + std::to_string(i) + "]";
}

Json parse_json(std::string_view text) {
  if (const std::size_t bad = find_invalid_utf8(text); bad != std::string_view::npos)
    throw SceneError(position_text(text, bad), "expected UTF-8 text; this byte is no part of any");
  if (std::all_of(text.begin(), text.end(),
                  [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }))
    throw SceneError("", "empty; expected a JSON object that begins {\"flyball\": 1, \"name\": ...");
  TreeBuilder builder(text);
  Json::sax_parse(text, &builder);
  return builder.take();
}

} // namespace flyball
