// Markup as a type of its own: plain text becomes part of it in one way only, escaped.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flyball {

class Html {
 public:
  Html() = default;
  // Plain text, from wherever: what means something in markup is escaped, what steers a line or its direction
  // is written out (see printable_lines()).
  Html(std::string_view plain);
  Html(const std::string& plain) : Html(std::string_view(plain)) {}
  Html(const char* plain) : Html(std::string_view(plain)) {}
  // What is markup already.
  static Html markup(std::string text);

  Html& operator+=(const Html& more);
  friend Html operator+(Html a, const Html& b) { return a += b; }
  const std::string& text() const { return text_; }
  bool empty() const { return text_.empty(); }

 private:
  std::string text_;
};

using HtmlAttributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

// <name a="b">inner</name>; values of attributes are plain text.
Html element(std::string_view name, const Html& inner, HtmlAttributes attributes = {});
// <name a="b"/>: one that has nothing inside.
Html void_element(std::string_view name, HtmlAttributes attributes);

Html paragraph_of(const Html& words);
Html heading_of(std::string_view words); // within a section
Html list_of(const std::vector<std::string>& items);

// A table in which columns of numbers are flush right. Columns without anything in them are left out; of very
// many rows the last are, which it says.
class HtmlTable {
 public:
  struct Column {
    std::string title;
    bool number = true;
  };
  explicit HtmlTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  void row(const std::vector<Html>& cells); // as many as columns
  bool empty() const { return rows_ == 0; }
  Html html() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<Html>> shown_;
  std::size_t rows_ = 0;
};

// Words and what belongs to each, below each other.
class HtmlTerms {
 public:
  void term(const Html& word, const Html& meaning);
  Html html() const { return element("dl", body_); }

 private:
  Html body_;
};

} // namespace flyball
