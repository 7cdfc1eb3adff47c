#include "app/document/turns.hpp"

#include "engine/mechanism/formulas.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>
#include <vector>

namespace flyball {
namespace {

constexpr double degrees_in_radian = 180 / std::numbers::pi;
constexpr std::string_view rotation_key = "rotation.";

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' '))
    text.remove_prefix(1);
  while (text.ends_with(' '))
    text.remove_suffix(1);
  return text;
}

std::string without_blanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

bool is_word(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           static_cast<unsigned char>(c) >= 0x80;
  });
}

// The index behind the bracket that closes the one at the beginning; npos: none does.
std::size_t behind_bracket(std::string_view text) {
  int open = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++open;
    if (text[i] == ')' && --open == 0) return i + 1;
  }
  return std::string_view::npos;
}

bool turns_about(const Turns& turns, std::size_t axis) {
  return !turns.texts[axis].empty() || turns.angles[static_cast<Eigen::Index>(axis)] != 0;
}

std::string half_text(const Turns& turns, std::size_t axis) {
  const std::string& text = turns.texts[axis];
  if (text.empty()) return number_text(turns.angles[static_cast<Eigen::Index>(axis)] / 2) + " deg";
  return is_word(text) ? text + "/2" : "(" + text + ")/2";
}

// The inverse of half_text; false where the text is no such half.
bool take_half(std::string_view half, Turns& turns, std::size_t axis) {
  half = trimmed(half);
  if (half.ends_with("deg")) {
    const std::string number(trimmed(half.substr(0, half.size() - 3)));
    char* end = nullptr;
    turns.angles[static_cast<Eigen::Index>(axis)] = 2 * std::strtod(number.c_str(), &end);
    return !number.empty() && *end == 0;
  }
  if (!half.ends_with('2')) return false;
  half = trimmed(half.substr(0, half.size() - 1));
  if (!half.ends_with('/')) return false;
  half = trimmed(half.substr(0, half.size() - 1));
  if (half.starts_with('(') && behind_bracket(half) == half.size())
    half = half.substr(1, half.size() - 2);
  else if (!is_word(half))
    return false;
  turns.texts[axis] = half;
  return true;
}

// Of each axis the cosine, or of the axis `sine` the other one; empty where a factor is zero.
std::string product(const Turns& turns, int sine, bool swapped) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_sine = (static_cast<int>(axis) == sine) != swapped;
    if (!turns_about(turns, axis)) {
      if (is_sine) return {};
      continue;
    }
    text += (text.empty() ? "" : "*") + std::string(is_sine ? "sin(" : "cos(") + half_text(turns, axis) + ")";
  }
  return text;
}

// The quaternion's w, x, y and z of the turns, the product of three about one axis each; empty: zero.
std::array<std::string, 4> entries_of(const Turns& turns) {
  std::array<std::string, 4> entries;
  for (int i = 0; i < 4; ++i) {
    const bool minus = i == 1 || i == 3;
    const std::string first = product(turns, i - 1, false), second = product(turns, i - 1, true);
    std::string& entry = entries[static_cast<std::size_t>(i)] = first;
    if (!second.empty())
      entry += (minus ? (first.empty() ? "-" : " - ") : (first.empty() ? "" : " + ")) + second;
  }
  return entries;
}

// What the cosines that a text begins with are of.
std::vector<std::string_view> leading_cosines(std::string_view text) {
  constexpr std::string_view cosine = "cos";
  std::vector<std::string_view> of;
  for (text = trimmed(text); text.starts_with("cos(");) {
    const std::size_t end = behind_bracket(text);
    if (end == std::string_view::npos) break;
    of.push_back(text.substr(cosine.size() + 1, end - cosine.size() - 2));
    text = trimmed(text.substr(end));
    if (!text.starts_with('*')) break;
    text = trimmed(text.substr(1));
  }
  return of;
}

// Nothing for what is no quaternion of turns.
std::optional<Turns> read_turns(const std::array<std::string, 4>& entries) {
  const std::vector<std::string_view> halves = leading_cosines(entries[0]);
  for (unsigned axes = 1; axes < 8; ++axes) {
    if (static_cast<std::size_t>(std::popcount(axes)) != halves.size()) continue;
    Turns turns;
    std::size_t next = 0;
    bool good = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((axes >> axis & 1U) != 0) good = good && take_half(halves[next++], turns, axis);
    if (good && std::ranges::equal(entries_of(turns), entries, {}, without_blanks, without_blanks))
      return turns;
  }
  return std::nullopt;
}

} // namespace

// Rx, then Ry, then Rz.
Quat rotation_by(const Vec3& angles) {
  const Vec3 turns = angles / degrees_in_radian;
  return Quat(Eigen::AngleAxisd(turns.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(turns.y(), Vec3::UnitY()) *
              Eigen::AngleAxisd(turns.x(), Vec3::UnitX()));
}

Vec3 turns_of(const Quat& rotation) {
  const Mat3 r = rotation.normalized().toRotationMatrix();
  const double y = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  const bool locked = std::abs(r(2, 0)) > 1 - 1e-12; // x and z turn about the same axis then
  const double x = locked ? 0 : std::atan2(r(2, 1), r(2, 2));
  const double z = locked ? std::atan2(-r(0, 1), r(1, 1)) : std::atan2(r(1, 0), r(0, 0));
  Vec3 turns = Vec3(x, y, z) * degrees_in_radian;
  for (double& turn : turns)
    turn = std::round(turn * 1e9) / 1e9 + 0.0; // no negative zero
  return turns;
}

bool is_rotation_given(const Body& body) {
  return std::ranges::any_of(body.formulas, [](const Formula& f) { return f.key.starts_with(rotation_key); });
}

void forget_rotation(Formulas& formulas) {
  std::erase_if(formulas, [](const Formula& formula) { return formula.key.starts_with(rotation_key); });
}

std::optional<Turns> given_turns(const Mechanism& mechanism, const Body& body) {
  if (!is_rotation_given(body)) return std::nullopt;
  std::array<std::string, 4> entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto found =
        std::ranges::find(body.formulas, std::string(rotation_key) + std::to_string(i), &Formula::key);
    if (found != body.formulas.end()) entries[i] = found->text;
  }
  std::optional<Turns> turns = read_turns(entries);
  if (!turns) return std::nullopt;
  const Quat& q = body.rotation;
  const std::array<double, 4> values{q.w(), q.x(), q.y(), q.z()};
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (entries[i].empty() && values[i] != 0) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string& text = turns->texts[static_cast<std::size_t>(axis)];
    if (text.empty()) continue;
    turns->angles[axis] =
        evaluate_expression(mechanism, text, "rad", "bodies." + body.name + ".rotation") * degrees_in_radian;
  }
  return turns;
}

void set_turns(Body& body, const Turns& turns) {
  forget_rotation(body.formulas);
  body.rotation = rotation_by(turns.angles);
  if (std::ranges::all_of(turns.texts, &std::string::empty)) return;
  const std::array<std::string, 4> entries = entries_of(turns);
  const std::array<double*, 4> places{&body.rotation.w(), &body.rotation.x(), &body.rotation.y(),
                                      &body.rotation.z()};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].empty())
      *places[i] = 0;
    else
      body.formulas.push_back({std::string(rotation_key) + std::to_string(i), entries[i]});
  }
  std::ranges::sort(body.formulas, {}, &Formula::key); // as a file is read
}

} // namespace flyball
