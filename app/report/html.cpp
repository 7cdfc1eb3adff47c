#include "app/report/html.hpp"

#include "engine/mechanism/safe_text.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr std::size_t most_rows = 400; // of a table

std::string start_tag(std::string_view name, HtmlAttributes attributes) {
  std::string out = "<" + std::string(name);
  for (const auto& [key, value] : attributes)
    out += " " + std::string(key) + "=\"" + Html(value).text() + "\"";
  return out;
}

} // namespace

Html::Html(std::string_view plain) {
  for (const char c : printable_lines(plain)) {
    switch (c) {
    case '&': text_ += "&amp;"; break;
    case '<': text_ += "&lt;"; break;
    case '>': text_ += "&gt;"; break;
    case '"': text_ += "&quot;"; break;
    case '\'': text_ += "&#39;"; break;
    default: text_ += c;
    }
  }
}

Html Html::markup(std::string text) {
  Html out;
  out.text_ = std::move(text);
  return out;
}

Html& Html::operator+=(const Html& more) {
  text_ += more.text_;
  return *this;
}

Html element(std::string_view name, const Html& inner, HtmlAttributes attributes) {
  return Html::markup(start_tag(name, attributes) + ">" + inner.text() + "</" + std::string(name) + ">");
}

Html void_element(std::string_view name, HtmlAttributes attributes) {
  return Html::markup(start_tag(name, attributes) + "/>");
}

Html paragraph_of(const Html& words) {
  return element("p", words) + "\n";
}

Html heading_of(std::string_view words) {
  return element("h3", words) + "\n";
}

Html list_of(const std::vector<std::string>& items) {
  Html inner;
  for (const std::string& item : items)
    inner += element("li", item);
  return element("ul", inner) + "\n";
}

void HtmlTable::row(const std::vector<Html>& cells) {
  if (++rows_ <= most_rows) shown_.push_back(cells);
}

Html HtmlTable::html() const {
  const auto used = [&](std::size_t column) {
    return std::ranges::any_of(shown_, [&](const auto& cells) { return !cells[column].empty(); });
  };
  Html head;
  std::vector<Html> rows(shown_.size());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (!used(c)) continue;
    const char* const kind = columns_[c].number ? "number" : "words";
    head += element("th", columns_[c].title, {{"scope", "col"}, {"class", kind}});
    for (std::size_t r = 0; r < rows.size(); ++r) // the first cell names what the row is about
      rows[r] += c == 0 ? element("th", shown_[r][c], {{"scope", "row"}})
                        : element("td", shown_[r][c], {{"class", kind}});
  }
  Html body = "\n";
  for (const Html& row : rows)
    body += element("tr", row) + "\n";
  // As wide as it needs to be, without making the page so.
  Html out = element("div", element("table", element("thead", element("tr", head)) + element("tbody", body)),
                     {{"class", "wide"}}) +
             "\n";
  if (rows_ > most_rows)
    out += paragraph_of("The other " + std::to_string(rows_ - most_rows) + " rows are left out.");
  return out;
}

void HtmlTerms::term(const Html& word, const Html& meaning) {
  body_ += element("dt", word) + element("dd", meaning) + "\n";
}

} // namespace flyball
