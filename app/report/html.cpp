#include "app/report/html.hpp"

#include "engine/mechanism/safe_text.hpp"

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
  if (++rows_ > most_rows) return;
  Html inner;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // The first names what the row is about.
    const char* const name = i == 0 ? "th" : "td";
    if (columns_[i].number)
      inner += element(name, cells[i], {{"class", "number"}});
    else
      inner += i == 0 ? element(name, cells[i], {{"scope", "row"}}) : element(name, cells[i]);
  }
  body_ += element("tr", inner) + "\n";
}

Html HtmlTable::html() const {
  Html head;
  for (const Column& column : columns_)
    head += column.number ? element("th", column.title, {{"scope", "col"}, {"class", "number"}})
                          : element("th", column.title, {{"scope", "col"}});
  // As wide as it needs to be, without making the page so.
  Html out =
      element("div", element("table", element("thead", element("tr", head)) + element("tbody", "\n" + body_)),
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
