#include "app/session/fuzzy_match.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace flyball {

namespace {

constexpr int whole = 60, at_front = 100, at_word = 80, within = 40, spread = 4; // in the name
constexpr int one_word = 30; // to its end: what is typed may have been typed out
constexpr int of_word_start = 4, more_at_word = 12, more_within = 6;

char lower_letter(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}
bool same_letter(char a, char b) {
  return lower_letter(a) == lower_letter(b);
}
bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || (static_cast<unsigned char>(c) & 0x80) != 0;
}
// "ball1" has one beginning, "speed of spin" three.
bool begins_word(std::string_view text, std::size_t at) {
  return at == 0 || !is_word_part(text[at - 1]);
}

bool ends_word(std::string_view text, std::size_t end) {
  return end == text.size() || !is_word_part(text[end]);
}

// What stands between blanks.
std::vector<std::string_view> typed_words(std::string_view typed) {
  std::vector<std::string_view> words;
  for (std::size_t from = 0; from < typed.size();) {
    const std::size_t end = std::min(typed.find(' ', from), typed.size());
    if (end > from) words.push_back(typed.substr(from, end - from));
    from = end + 1;
  }
  return words;
}

// Where the word stands together: rather as one of the text's words, else at one's beginning.
std::optional<std::size_t> find_together(std::string_view word, std::string_view text) {
  std::optional<std::size_t> found;
  for (auto from = text.begin();; ++from) {
    from = std::search(from, text.end(), word.begin(), word.end(), same_letter);
    if (from == text.end()) return found;
    const auto at = static_cast<std::size_t>(from - text.begin());
    const bool begins = begins_word(text, at);
    if (begins && ends_word(text, at + word.size())) return at;
    if (!found || (begins && !begins_word(text, *found))) found = at;
  }
}

// Its letters in their order from a word's beginning on, rather at other words' beginnings.
std::optional<FuzzyMatch> find_spread(std::string_view word, std::string_view text, std::size_t from) {
  FuzzyMatch match{.score = spread, .marks = {}};
  std::size_t at = from;
  for (const char letter : word) {
    std::optional<std::size_t> next;
    for (std::size_t i = at; i < text.size(); ++i) {
      if (!same_letter(letter, text[i])) continue;
      if (!next) next = i;
      if (begins_word(text, i)) {
        next = i;
        break;
      }
      if (i == at) break; // goes on where the last one ended
    }
    if (!next) return std::nullopt;
    if (begins_word(text, *next)) match.score += of_word_start;
    match.score -= static_cast<int>(*next - at) / 4;
    match.marks.push_back(*next);
    at = *next + 1;
  }
  match.score = std::max(match.score, 1);
  return match;
}

FuzzyMatch match_word(std::string_view word, std::string_view name, std::string_view more) {
  FuzzyMatch best;
  if (const auto at = find_together(word, name)) {
    const bool begins = begins_word(name, *at);
    best.score = *at == 0 ? at_front : begins ? at_word : within;
    if (begins && ends_word(name, *at + word.size())) best.score += one_word;
    for (std::size_t i = 0; i < word.size(); ++i)
      best.marks.push_back(*at + i);
    return best;
  }
  for (std::size_t from = 0; from < name.size(); ++from)
    if (begins_word(name, from) && same_letter(name[from], word[0]))
      if (auto match = find_spread(word, name, from); match && match->score > best.score)
        best = std::move(*match);
  if (const auto at = find_together(word, more)) {
    const int score = begins_word(more, *at) ? more_at_word : more_within;
    if (score > best.score) best = {.score = score, .marks = {}};
  }
  return best;
}

} // namespace

FuzzyMatch fuzzy_match(std::string_view typed, std::string_view name, std::string_view more) {
  FuzzyMatch all{.score = 0, .marks = {}};
  for (const std::string_view word : typed_words(typed)) {
    const FuzzyMatch match = match_word(word, name, more);
    if (!match) return {};
    all.score += match.score;
    all.marks.insert(all.marks.end(), match.marks.begin(), match.marks.end());
  }
  if (!typed.empty() && std::ranges::equal(typed, name, same_letter)) all.score += whole;
  std::ranges::sort(all.marks);
  all.marks.erase(std::unique(all.marks.begin(), all.marks.end()), all.marks.end());
  return all;
}

bool words_begin(std::string_view typed, std::string_view text) {
  return std::ranges::all_of(typed_words(typed), [&](std::string_view word) {
    const auto at = find_together(word, text);
    return at && begins_word(text, *at);
  });
}

} // namespace flyball
