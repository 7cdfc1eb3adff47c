#include "engine/continuation/branches.hpp"

#include <algorithm>
#include <limits>

namespace flyball {
namespace {

using Complex = std::complex<double>;

// The column given to each row so that the sum of costs is least: shortest augmenting paths (Jonker and
// Volgenant 1987). `cost(i, j)` for n rows and m >= n columns.
template <class Cost>
std::vector<std::size_t> assign(std::size_t n, std::size_t m, Cost cost) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<double> row_price(n, 0), column_price(m + 1, 0);
  std::vector<std::size_t> row_of(m + 1, none), from(m + 1, m);
  for (std::size_t i = 0; i < n; ++i) {
    row_of[m] = i; // a column outside stands for the row to be placed
    std::vector<double> least(m, std::numeric_limits<double>::infinity());
    std::vector<bool> used(m + 1, false);
    std::size_t at = m;
    do {
      used[at] = true;
      const std::size_t row = row_of[at];
      double delta = std::numeric_limits<double>::infinity();
      std::size_t next = m;
      for (std::size_t j = 0; j < m; ++j) {
        if (used[j]) continue;
        const double reduced = cost(row, j) - row_price[row] - column_price[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          from[j] = at;
        }
        if (least[j] < delta) {
          delta = least[j];
          next = j;
        }
      }
      for (std::size_t j = 0; j <= m; ++j) {
        if (used[j]) {
          row_price[row_of[j]] += delta;
          column_price[j] -= delta;
        } else if (j < m) {
          least[j] -= delta;
        }
      }
      at = next;
    } while (row_of[at] != none);
    for (; at != m; at = from[at])
      row_of[at] = row_of[from[at]];
  }
  std::vector<std::size_t> column(n, none);
  for (std::size_t j = 0; j < m; ++j)
    if (row_of[j] != none) column[row_of[j]] = j;
  return column;
}

bool known(Complex s) {
  return std::isfinite(s.real()) && std::isfinite(s.imag());
}

// What two known points foretell at a third; the last known where there is one only.
std::vector<Complex> foretold(const std::vector<Complex>& before, const std::vector<Complex>& last,
                              double step_before, double step) {
  std::vector<Complex> out = last;
  if (before.size() != last.size() || !(step_before > 0)) return out;
  const double ratio = std::min(2., step / step_before);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (known(before[i]) && known(last[i])) out[i] += ratio * (last[i] - before[i]);
  return out;
}

// How far apart two points of a branch are, by what moves: only ratios count.
double distance(const ResponsePoint& a, const ResponsePoint& b, double parameter_range) {
  double sum = std::pow((b.parameter - a.parameter) / parameter_range, 2);
  for (std::size_t i = 0; i < a.coordinates.size() && i < b.coordinates.size(); ++i)
    sum += std::pow(b.coordinates[i].value - a.coordinates[i].value, 2);
  return std::sqrt(sum);
}

} // namespace

std::vector<std::vector<Complex>> track_eigenvalues(const std::vector<ResponsePoint>& points) {
  std::vector<std::vector<Complex>> lines;
  std::size_t width = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ResponsePoint& p : points) {
    width = std::max(width, p.eigenvalues.size());
    low = std::min(low, p.parameter);
    high = std::max(high, p.parameter);
  }
  const double range = high > low ? high - low : 1;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::vector<Complex>& found = points[i].eigenvalues;
    std::vector<Complex> row(width, {nan, nan});
    if (i == 0) {
      std::ranges::copy(found, row.begin());
      lines.push_back(std::move(row));
      continue;
    }
    const std::vector<Complex> expected =
        i < 2 ? lines[i - 1]
              : foretold(lines[i - 2], lines[i - 1], distance(points[i - 2], points[i - 1], range),
                         distance(points[i - 1], points[i], range));
    double far = 1;
    for (const Complex s : found)
      far = std::max(far, 4 * std::abs(s));
    const std::vector<std::size_t> line = assign(found.size(), width, [&](std::size_t k, std::size_t j) {
      return known(expected[j]) ? std::abs(found[k] - expected[j]) : far;
    });
    for (std::size_t k = 0; k < found.size(); ++k)
      row[line[k]] = found[k];
    lines.push_back(std::move(row));
  }
  return lines;
}

} // namespace flyball
