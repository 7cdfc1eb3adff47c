// Tables in expressions: through their points, monotone where these are, with a slope that does not jump.
#include "engine/mechanism/expression.hpp"
#include "engine/mechanism/value_table.hpp"
#include "tests/catch.hpp"

#include <cmath>
#include <random>

using namespace flyball;

namespace {

Dual at(const ValueTable& table, double x) {
  return table(Dual{x, 1});
}

std::string mistake(std::string_view text) {
  try {
    const Expression expression(text);
    const std::vector<ValueDimension> names(expression.names().size(), ValueDimension{{.length = 1}, false});
    expression.dimension(names);
  } catch (const ExpressionError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a table of two points is a line, and goes on straight") {
  const ValueTable line({{1, 10}, {3, 4}});
  for (const double x : {-5., 1., 1.7, 3., 8.}) {
    CHECK(at(line, x).value == Approx(13 - 3 * x));
    CHECK(at(line, x).rate == Approx(-3));
  }
}

TEST_CASE("a table's slopes are those of Fritsch and Butland") {
  // Evenly spaced: the harmonic mean of the slopes on either side; none at a top.
  const ValueTable table({{0, 0}, {1, 2}, {2, 3}, {3, 1}});
  CHECK(at(table, 1).rate == Approx(2 * 2. * 1. / 3.));
  CHECK(at(table, 2).rate == Approx(0).margin(1e-15));
  CHECK(at(table, 0).rate == Approx((3 * 2. - 1.) / 2)); // of the parabola through the first three
  CHECK(at(table, -1).value == Approx(-2.5));
}

TEST_CASE("random tables: through their points, monotone between them, smooth at them") {
  std::mt19937 random(3);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  for (int n = 0; n < 50; ++n) {
    std::vector<ValueTable::Point> points{{uniform(-2, 2), uniform(-3, 3)}};
    for (int i = 0; i < 2 + n % 7; ++i)
      points.push_back({points.back().x + uniform(0.1, 2), uniform(-3, 3)});
    const ValueTable table(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK(std::abs(at(table, points[i].x).value - points[i].y) < 1e-12);
      const double h = 1e-7;
      CHECK(std::abs(at(table, points[i].x - h).rate - at(table, points[i].x + h).rate) <
            1e-4 * (1 + std::abs(at(table, points[i].x).rate)) * 10);
      if (i + 1 == points.size()) continue;
      double last = points[i].y;
      const double sign = points[i + 1].y > points[i].y ? 1 : -1;
      for (int k = 1; k <= 40; ++k) {
        const double x = points[i].x + (points[i + 1].x - points[i].x) * k / 40;
        const Dual here = at(table, x);
        CHECK(sign * (here.value - last) > -1e-12);
        last = here.value;
        const double step = 1e-6;
        if (k < 40)
          CHECK(std::abs(here.rate - (at(table, x + step).value - at(table, x - step).value) / (2 * step)) <
                1e-6 * (1 + std::abs(here.rate)));
      }
    }
  }
}

TEST_CASE("tables in expressions have units, and what is wrong with one is told") {
  const Expression expression("2 * table(x - 0.5 m, [-200 mm, 10 N], [2 m, -5 N], [3 m, 0]) + 1 N");
  REQUIRE(expression.names().size() == 1);
  const std::vector<ValueDimension> length{ValueDimension{{.length = 1}, false}};
  CHECK(expression.dimension(length).dimension == Dimension{.length = 1, .mass = 1, .time = -2});
  const std::vector<Dual> x{Dual{0.3, 1}};
  CHECK(expression.evaluate(x).value == Approx(21));
  CHECK(mistake("table(x, [0, 1], [1 m, 2])").empty());
  CHECK(mistake("table(x, [0, 1], [1, 2])").empty()); // plain numbers count as what they are compared with
  CHECK_THAT(mistake("table(x, [0, 1], [1 s, 2])"), ContainsSubstring("look up"));
  CHECK_THAT(mistake("table(x, [0, 1 N], [1, 2 m])"), ContainsSubstring("a table has"));
  CHECK_THAT(mistake("table(x, [0, 1])"), ContainsSubstring("two points"));
  CHECK_THAT(mistake("table(x, [1, 1], [1, 2])"), ContainsSubstring("ascending"));
  CHECK_THAT(mistake("table(x, [0, 1], 3)"), ContainsSubstring("expected a point"));
  CHECK_THAT(mistake("table(x, [0, x], [1, 2])"), ContainsSubstring("expected a number"));
  CHECK_THAT(mistake("table(x, [0, 1], [1, 2)"), ContainsSubstring("expected ]"));
  CHECK(is_expression_name("table")); // a name for a parameter as ever
  CHECK(Expression("table + 1").names().front() == "table");
}
