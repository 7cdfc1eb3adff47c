#include "engine/mechanism/expression.hpp"

#include "engine/mechanism/decimal.hpp"
#include "engine/mechanism/expression_functions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/unset_duals.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

namespace flyball {
namespace {

bool begins_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool continues_name(char c) {
  return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_figure(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

[[noreturn]] void fail_sum(std::string_view doing, const ValueDimension& a, const ValueDimension& b) {
  throw ExpressionError(std::string(doing) + " " + dimension_text(a.dimension) + " and " +
                        dimension_text(b.dimension));
}

// The measure of what takes both as the same.
ValueDimension common(std::string_view doing, const ValueDimension& a, const ValueDimension& b) {
  if (a.plain) return b;
  if (!b.plain && !(a.dimension == b.dimension)) fail_sum(doing, a, b);
  return a;
}

} // namespace

// Recursive descent.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, bool results, Expression& to)
      : text_(text), results_(results), to_(to) {}

  void run() {
    sum();
    skip_blanks();
    if (at_ < text_.size())
      fail("expected an operator, found \"" + std::string(text_.substr(at_, 20)) + "\"");
  }

 private:
  using Operation = Expression::Operation;
  static constexpr int deepest = 100;

  [[noreturn]] void fail(const std::string& what) const {
    throw ExpressionError("column " + std::to_string(at_ + 1) + ": " + what);
  }
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ')
      ++at_;
  }
  // Whether the next sign is one of these; it is taken.
  char take(std::string_view signs) {
    skip_blanks();
    if (at_ == text_.size() || signs.find(text_[at_]) == std::string_view::npos) return 0;
    return text_[at_++];
  }
  void put(Expression::Step step, int taken) {
    values_ += 1 - taken;
    if (values_ > static_cast<int>(Expression::most_values)) fail("expected a simpler expression");
    to_.steps_.push_back(step);
  }
  void put(Operation operation, int taken) { put({.operation = operation}, taken); }

  void sum() {
    if (++depth_ > deepest) fail("expected fewer parentheses");
    product();
    while (const char sign = take("+-")) {
      product();
      put(sign == '+' ? Operation::add : Operation::subtract, 2);
    }
    --depth_;
  }
  void product() {
    factor();
    while (const char sign = take("*/")) {
      factor();
      put(sign == '*' ? Operation::multiply : Operation::divide, 2);
    }
  }
  void factor() {
    bool negative = false;
    while (const char sign = take("+-"))
      negative = negative != (sign == '-');
    primary();
    if (take("^")) {
      if (++depth_ > deepest) fail("expected fewer powers");
      factor();
      --depth_;
      put(Operation::power, 2);
    }
    if (negative) put(Operation::negate, 1);
  }
  void primary() {
    skip_blanks();
    if (at_ == text_.size()) fail("expected a number, a name or (, found the end");
    const char c = text_[at_];
    if (is_figure(c) || c == '.') return number();
    if (begins_name(c)) return name();
    if (!take("(")) fail("expected a number, a name or (, found \"" + std::string(1, c) + "\"");
    sum();
    if (!take(")")) fail("expected )");
  }
  void number() {
    double value = 0;
    const auto [end, error] = read_decimal(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range)
      fail("expected a number of a size between 1e-307 and 1e308, found \"" +
           std::string(text_.substr(at_, static_cast<std::size_t>(end - text_.data()) - at_)) + "\"");
    if (error != std::errc() || !std::isfinite(value)) fail("expected a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    Expression::Step step{.operation = Operation::number, .value = value, .dimension = {{}, true}};
    const std::size_t before = at_;
    skip_blanks();
    if (const auto read = read_unit(text_.substr(at_))) {
      step.value = times_unit(step.value, read->unit.factor);
      step.dimension = {read->unit.dimension.without_angle(), false};
      at_ += read->length;
    } else if (at_ < text_.size() && begins_name(text_[at_])) {
      fail("expected an operator or a unit, found \"" + std::string(word()) + "\"");
    } else {
      at_ = before;
    }
    put(step, 0);
  }
  std::string_view word() const {
    std::size_t end = at_;
    while (end < text_.size() && continues_name(text_[end]))
      ++end;
    return text_.substr(at_, end - at_);
  }
  void name() {
    const std::size_t begin = at_;
    const std::string_view found = word();
    at_ += found.size();
    if (take("(")) return call(found, begin);
    if (found == "pi")
      return put({.operation = Operation::number, .value = std::numbers::pi, .dimension = {{}, true}}, 0);
    std::string full(found);
    if (at_ + 1 < text_.size() && text_[at_] == '.' && begins_name(text_[at_ + 1])) {
      ++at_;
      const std::string_view coordinate = word();
      at_ += coordinate.size();
      full += "." + std::string(coordinate);
    }
    const auto place = std::ranges::find(to_.names_, full);
    const auto index = static_cast<std::size_t>(place - to_.names_.begin());
    if (place == to_.names_.end()) to_.names_.push_back(full);
    if (index > 1000) fail("expected fewer names");
    to_.mentions_.push_back({index, begin});
    put({.operation = Operation::name, .index = static_cast<std::uint16_t>(index)}, 0);
  }
  void call(std::string_view name, std::size_t begin) {
    if (name == "table") return table();
    const std::span functions = expression_functions();
    const auto function = std::ranges::find(functions, name, &ExpressionFunction::name);
    const auto result = std::ranges::find(result_functions(), name, &ResultFunction::name);
    if (function == functions.end() && result != result_functions().end()) {
      if (results_) return result_call(*result, begin);
      at_ = begin;
      fail("only measures and laws of drives can use results, as " + std::string(name) + "() is");
    }
    if (function == functions.end()) {
      std::vector<std::string_view> names;
      if (results_)
        for (const ResultFunction& each : result_functions())
          names.push_back(each.name);
      for (const ExpressionFunction& each : functions)
        names.push_back(each.name);
      at_ = begin;
      fail("there is no function \"" + std::string(name) + "\"" + did_you_mean(name, names) + "; expected " +
           word_list(names));
    }
    sum();
    for (int i = 1; i < function->arguments; ++i) {
      if (!take(",")) fail("expected , and another argument of " + std::string(name));
      sum();
    }
    if (!take(")")) fail("expected ) after the argument" + std::string(function->arguments > 1 ? "s" : ""));
    put({.operation = Operation::call, .index = static_cast<std::uint16_t>(function - functions.begin())},
        function->arguments);
  }

  // table(x, [x1, y1], [x2, y2], ...)
  void table() {
    sum();
    std::vector<ValueTable::Point> points;
    ValueDimension of{{}, true}, dimension{{}, true};
    while (take(",")) {
      const auto [x, x_dimension] = table_opened();
      if (!take(",")) fail("expected , and what stands there");
      const auto [y, y_dimension] = constant();
      if (!take("]")) fail("expected ] after a point of the table");
      of = common("a table has", of, x_dimension);
      dimension = common("a table has", dimension, y_dimension);
      if (!points.empty() && !(x > points.back().x)) fail("expected points in ascending order");
      if (std::max(std::abs(x), std::abs(y)) > 1e100) fail("expected numbers below 1e100");
      points.push_back({x, y});
    }
    if (!take(")")) fail("expected , or ) after a point of the table");
    if (points.size() < 2) fail("expected two points or more, as in table(rate(spin), [0, 10], [5, 8])");
    if (to_.tables_.size() > 1000) fail("expected fewer tables");
    put({.operation = Operation::table, .index = static_cast<std::uint16_t>(to_.tables_.size())}, 1);
    to_.tables_.push_back({ValueTable(std::move(points)), of, dimension});
  }
  std::pair<double, ValueDimension> table_opened() {
    if (!take("[")) fail("expected a point of the table, as in [5, 8]");
    return constant();
  }
  // A number with its sign and unit.
  std::pair<double, ValueDimension> constant() {
    const double sign = take("+-") == '-' ? -1 : 1;
    skip_blanks();
    if (at_ == text_.size() || (!is_figure(text_[at_]) && text_[at_] != '.')) fail("expected a number");
    number();
    const Expression::Step step = to_.steps_.back();
    to_.steps_.pop_back();
    --values_;
    return {sign * step.value, step.dimension};
  }

  void result_call(const ResultFunction& function, std::size_t begin) {
    const std::string name(function.name);
    ResultCall call{.result = function.result, .arguments = {}, .begin = begin};
    const auto expected = [&] {
      const std::string count = std::to_string(function.most);
      return (function.fewest == function.most ? count : std::to_string(function.fewest) + " or " + count) +
             " argument" + (function.most > 1 ? "s" : "") + " of " + name + ", as in " +
             std::string(function.example);
    };
    if (!take(")")) {
      do {
        call.arguments.push_back(argument());
      } while (take(","));
      if (!take(")")) fail("expected , or ) after a part's name" + quotes_hint(call.arguments.back().begin));
    }
    const auto count = static_cast<int>(call.arguments.size());
    if (count < function.fewest || count > function.most)
      fail("expected " + expected() + ", found " + std::to_string(count));
    const ArgumentKind kind = argument_kind(function, call.arguments.size());
    for (const ResultCall::Argument& each : call.arguments) {
      const bool point = !each.point.empty() && kind != ArgumentKind::point;
      if (!point && (each.index < 0 || kind == ArgumentKind::coordinate)) continue;
      at_ = each.begin;
      fail("expected " + std::string(noun(kind)) + ", found a " + (point ? "point" : "coordinate"));
    }
    if (to_.results_.size() > 1000) fail("expected fewer results");
    put({.operation = Operation::result, .index = static_cast<std::uint16_t>(to_.results_.size())}, 0);
    to_.results_.push_back(std::move(call));
  }
  // Where more words follow one at `begin` they may be of its name: "; a name that is no word stands in
  // quotes, as 'sun shaft'".
  std::string quotes_hint(std::size_t begin) const {
    const std::size_t end = std::min(text_.find_first_of(",()'\"", begin), text_.size());
    if (at_ == text_.size() || !begins_name(text_[at_]) || end <= at_) return {};
    std::string_view words = text_.substr(begin, end - begin);
    words.remove_suffix(words.size() - 1 - words.find_last_not_of(' '));
    return "; a name that is no word stands in quotes, as '" + std::string(words) + "'";
  }

  // "slide", "ball.1", "ball@A"; names that are no words in quotes of either kind.
  ResultCall::Argument argument() {
    skip_blanks();
    ResultCall::Argument argument;
    argument.begin = at_;
    if (const char quote = take("\"'")) {
      const std::size_t end = text_.find(quote, at_);
      if (end == std::string_view::npos) fail("expected the end of a name in quotes");
      argument.name = text_.substr(at_, end - at_);
      at_ = end + 1;
    } else {
      if (at_ == text_.size() || !begins_name(text_[at_]))
        fail("expected the name of a part, in quotes where it is no word");
      argument.name = word();
      at_ += argument.name.size();
    }
    argument.length = at_ - argument.begin;
    if (take("@")) {
      skip_blanks();
      argument.point_begin = at_;
      argument.point = word();
      if (argument.point.empty()) fail("expected the name of a point after @");
      at_ += argument.point.size();
    } else if (at_ + 1 < text_.size() && text_[at_] == '.') {
      const auto [end, error] =
          std::from_chars(text_.data() + at_ + 1, text_.data() + text_.size(), argument.index);
      if (error != std::errc() || argument.index < 0)
        fail("expected the number of a coordinate after the ." +
             (text_.substr(at_).starts_with(implicit_joint) ? "; " + std::string(implicit_joint_hint)
                                                            : std::string()));
      at_ = static_cast<std::size_t>(end - text_.data());
    }
    return argument;
  }

  std::string_view text_;
  bool results_;
  Expression& to_;
  std::size_t at_ = 0;
  int depth_ = 0, values_ = 0;
};

Expression::Expression(std::string_view text, Results results) {
  if (find_invalid_utf8(text) != std::string::npos) throw ExpressionError("expected UTF-8 text");
  ExpressionParser(text, results == Results::allowed, *this).run();
}

Dual Expression::evaluate(std::span<const Dual> values, std::span<const std::size_t> places,
                          std::span<const Dual> results, std::span<const std::size_t> result_places) const {
  UnsetDuals<most_values> stack;
  const std::span functions = expression_functions();
  std::size_t top = 0; // the first free place
  for (const Step& step : steps_) {
    switch (step.operation) {
    case Operation::number: stack[top++] = {step.value, 0}; continue;
    case Operation::name: stack[top++] = values[places.empty() ? step.index : places[step.index]]; continue;
    case Operation::result: stack[top++] = results[result_places[step.index]]; continue;
    case Operation::negate: stack[top - 1] = -stack[top - 1]; continue;
    case Operation::table: stack[top - 1] = tables_[step.index].values(stack[top - 1]); continue;
    case Operation::call: {
      const ExpressionFunction& function = functions[step.index];
      const Dual second = function.arguments == 2 ? stack[--top] : Dual();
      stack[top - 1] = function.evaluate(stack[top - 1], second);
      continue;
    }
    default: break;
    }
    const Dual b = stack[--top];
    Dual& a = stack[top - 1];
    switch (step.operation) {
    case Operation::add: a = a + b; break;
    case Operation::subtract: a = a - b; break;
    case Operation::multiply: a = a * b; break;
    case Operation::divide: a = a / b; break;
    default: a = power(a, b); break;
    }
  }
  return stack[0];
}

ValueDimension Expression::dimension(std::span<const ValueDimension> names,
                                     std::span<const ValueDimension> results) const {
  const std::span functions = expression_functions();
  struct Entry {
    ValueDimension dimension;
    std::optional<double> number; // where it is one by itself: an exponent
  };
  std::vector<Entry> stack;
  const auto pop = [&] {
    const Entry entry = stack.back();
    stack.pop_back();
    return entry;
  };
  const auto expect_number = [](const ValueDimension& m, const std::string& of) {
    if (!m.plain && !(m.dimension == Dimension{}))
      throw ExpressionError("expected a number or an angle as " + of + ", found " +
                            dimension_text(m.dimension));
  };
  for (const Step& step : steps_) {
    switch (step.operation) {
    case Operation::number:
      stack.push_back({step.dimension, step.dimension.plain ? std::optional(step.value) : std::nullopt});
      continue;
    case Operation::name: stack.push_back({names[step.index], {}}); continue;
    case Operation::result: stack.push_back({results[step.index], {}}); continue;
    case Operation::negate:
      if (stack.back().number) stack.back().number = -*stack.back().number;
      continue;
    case Operation::table:
      common("cannot look up in a table", pop().dimension, tables_[step.index].of);
      stack.push_back({tables_[step.index].dimension, {}});
      continue;
    default: break;
    }
    if (step.operation == Operation::call) {
      const ExpressionFunction& function = functions[step.index];
      const ValueDimension last = pop().dimension;
      const std::string name(function.name);
      switch (function.rule) {
      case DimensionRule::number:
        expect_number(last, "the argument of " + name);
        stack.push_back({{{}, last.plain}, {}});
        break;
      case DimensionRule::root: stack.push_back({{last.dimension * 0.5, last.plain}, {}}); break;
      case DimensionRule::same:
      case DimensionRule::ratio: {
        const ValueDimension both =
            function.arguments == 2 ? common(name + " of", pop().dimension, last) : last;
        stack.push_back({function.rule == DimensionRule::ratio ? ValueDimension{{}, both.plain} : both, {}});
        break;
      }
      }
      continue;
    }
    const Entry b = pop(), a = pop();
    ValueDimension result;
    std::optional<double> number;
    switch (step.operation) {
    case Operation::add: result = common("cannot add", a.dimension, b.dimension); break;
    case Operation::subtract: result = common("cannot subtract", a.dimension, b.dimension); break;
    case Operation::multiply:
    case Operation::divide: {
      const double sign = step.operation == Operation::multiply ? 1 : -1;
      result = {a.dimension.dimension + b.dimension.dimension * sign, a.dimension.plain && b.dimension.plain};
      if (a.number && b.number) number = sign > 0 ? *a.number * *b.number : *a.number / *b.number;
      break;
    }
    default:
      expect_number(b.dimension, "an exponent");
      if (a.dimension.plain || a.dimension.dimension == Dimension{})
        result = {{}, a.dimension.plain && b.dimension.plain};
      else if (b.number)
        result = {a.dimension.dimension * *b.number, false};
      else
        throw ExpressionError("expected a number as the exponent of " +
                              dimension_text(a.dimension.dimension));
      break;
    }
    stack.push_back({result, number});
  }
  return stack.back().dimension;
}

bool is_expression_name(std::string_view name) {
  return !name.empty() && begins_name(name.front()) && std::ranges::all_of(name, continues_name) &&
         find_invalid_utf8(name) == std::string::npos && name != "pi" &&
         std::ranges::find(expression_functions(), name, &ExpressionFunction::name) ==
             expression_functions().end();
}

namespace {

// A part of a text, and what stands there instead.
struct Replacement {
  std::size_t begin, length;
  std::string text;
};

std::string replaced(std::string_view text, std::vector<Replacement> all) {
  std::ranges::sort(all, {}, &Replacement::begin);
  std::string out;
  std::size_t copied = 0;
  for (const Replacement& each : all) {
    out += std::string(text.substr(copied, each.begin - copied)) + each.text;
    copied = each.begin + each.length;
  }
  return out + std::string(text.substr(copied));
}

} // namespace

std::string renamed_in(std::string_view text, std::string_view from, std::string_view to) {
  try {
    const Expression expression(text, Expression::Results::allowed);
    std::vector<Replacement> all;
    for (const Expression::Mention& mention : expression.mentions()) {
      const std::string_view name = expression.names()[mention.name];
      if (name.substr(0, name.find('.')) == from)
        all.push_back({mention.begin, from.size(), std::string(to)});
    }
    for (const ResultCall& call : expression.results())
      for (const ResultCall::Argument& argument : call.arguments)
        if (argument.point == from) all.push_back({argument.point_begin, from.size(), std::string(to)});
    return replaced(text, std::move(all));
  } catch (const ExpressionError&) {
    return std::string(text);
  }
}

std::string part_renamed_in(std::string_view text, ResultPart part, std::string_view from,
                            std::string_view to) {
  return parts_renamed_in(text, part,
                          [&](const std::string& name) { return name == from ? std::string(to) : name; });
}

std::string parts_renamed_in(std::string_view text, ResultPart part,
                             const std::function<std::string(const std::string&)>& renamed) {
  try {
    const Expression expression(text, Expression::Results::allowed);
    std::vector<Replacement> all;
    for (const ResultCall& call : expression.results())
      if (part_of(argument_kind(result_function(call.result), call.arguments.size())) == part)
        for (const ResultCall::Argument& argument : call.arguments)
          if (std::string to = renamed(argument.name); to != argument.name)
            all.push_back({argument.begin, argument.length, argument_text(to)});
    return replaced(text, std::move(all));
  } catch (const ExpressionError&) {
    return std::string(text);
  }
}

ResultPart part_of(ArgumentKind kind) {
  switch (kind) {
  case ArgumentKind::coordinate:
  case ArgumentKind::joint: return ResultPart::joint;
  case ArgumentKind::force: return ResultPart::force;
  case ArgumentKind::body:
  case ArgumentKind::point: break;
  }
  return ResultPart::body;
}

} // namespace flyball
