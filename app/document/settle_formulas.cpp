#include "app/document/settle_formulas.hpp"

#include "app/document/formula_change.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/numbers.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace flyball {
namespace {

bool near(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * (1 + std::abs(b));
}
constexpr double rounding = 1e-12;
// What is left of a residual by Newton's method is far below a hand's accuracy.
constexpr double solved = 1e-9;

double evaluated(const Mechanism& mechanism, const GivenNumber& given) {
  return evaluate_expression(mechanism, given.text, given.unit, given.address);
}

// Dependent parameters and points first.
void evaluate_names(Mechanism& mechanism) {
  Mechanism named;
  named.parameters = std::move(mechanism.parameters);
  named.points = std::move(mechanism.points);
  evaluate_formulas(named);
  mechanism.parameters = std::move(named.parameters);
  mechanism.points = std::move(named.points);
}

[[noreturn]] void refuse(const Mechanism& mechanism, const GivenNumber& given) {
  std::string sources;
  for (const std::string& source : sources_of(mechanism, given.text))
    sources += (sources.empty() ? "; it rests on " : ", ") + source;
  throw SceneError(given.address, "given by \"=" + given.text + "\", which this would not be" + sources);
}

bool contains(const std::vector<std::string>& all, const std::string& one) {
  return std::ranges::find(all, one) != all.end();
}

// The numbers that the moved ones rest on, found by Newton's method so that these have their values and the
// others of their parts keep theirs.
void solve_for_sources(Mechanism& next, std::vector<GivenNumber> wanted,
                       const std::vector<GivenNumber>& others) {
  const GivenNumber first = wanted.front();
  std::vector<std::string> sources;
  for (const GivenNumber& given : wanted)
    for (const std::string& source : sources_of(next, given.text))
      if (!contains(sources, source)) sources.push_back(source);
  if (sources.empty()) refuse(next, first);
  for (const GivenNumber& given : others) {
    const std::vector<std::string> its = sources_of(next, given.text);
    if (std::ranges::any_of(its, [&](const std::string& source) { return contains(sources, source); }))
      wanted.push_back(given);
  }
  const auto rows = static_cast<Eigen::Index>(wanted.size()),
             columns = static_cast<Eigen::Index>(sources.size());
  Eigen::MatrixXd jacobian(rows, columns);
  Eigen::VectorXd rest(rows);
  Mechanism named;
  named.parameters = next.parameters;
  named.points = next.points;
  for (int iteration = 0; iteration < 30; ++iteration) {
    bool done = true;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const GivenNumber& given = wanted[static_cast<std::size_t>(i)];
      const double value = evaluated(named, given);
      rest[i] = given.value - value;
      done = done && near(value, given.value, rounding);
      const std::vector<double> gradient = expression_gradient(named, given.text, sources);
      jacobian.row(i) = Eigen::Map<const Eigen::RowVectorXd>(gradient.data(), columns);
    }
    if (!jacobian.allFinite()) refuse(next, first);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
    if (qr.rank() < columns) refuse(next, first); // several ways to do it
    const Eigen::VectorXd step = qr.solve(rest);
    if (done || step.norm() == 0) break;
    for (Eigen::Index k = 0; k < columns; ++k) {
      const std::string& source = sources[static_cast<std::size_t>(k)];
      set_parameter(named, source, get_parameter(named, source) + step[k]);
    }
  }
  for (const GivenNumber& given : wanted)
    if (!near(evaluated(named, given), given.value, solved)) refuse(next, first);
  next.parameters = std::move(named.parameters);
  next.points = std::move(named.points);
}

// Of a parameter or point.
bool is_named(const GivenNumber& given) {
  return given.part.starts_with("parameters.") || given.part.starts_with("points.");
}

template <class Parts>
void add_names(const std::string& list, const Parts& parts, std::unordered_set<std::string>& to) {
  for (const auto& part : parts)
    to.insert(list + "." + part.name);
}

// "bodies.arm" of "bodies.arm.shapes.0".
std::string owner(const std::string& part) {
  const std::size_t dot = part.find('.');
  return dot == std::string::npos ? part : part.substr(0, part.find('.', dot + 1));
}

// `next` with the sources of what the edit has moved.
Mechanism settle(const Mechanism& before, const Mechanism& next) {
  Mechanism settled = next;
  drop_lost_formulas(settled);
  evaluate_names(settled);
  std::unordered_set<std::string> former;
  add_names("bodies", before.bodies, former);
  add_names("joints", before.joints, former);
  add_names("forces", before.forces, former);
  std::unordered_map<std::string, GivenNumber> given_before;
  for (GivenNumber& given : given_numbers(before))
    given_before.emplace(given.address, given);

  std::unordered_set<std::string> moved_parts, moved_numbers;
  std::vector<GivenNumber> moved, others;
  // Whether the edit has set it, and not what its expression says.
  const auto is_moved = [&](const GivenNumber& given) {
    const auto earlier = given_before.find(given.address);
    return earlier != given_before.end() && earlier->second.text == given.text &&
           earlier->second.value != given.value && !near(evaluated(settled, given), given.value, rounding);
  };
  for (const GivenNumber& given : given_numbers(next))
    if (is_named(given) && is_moved(given)) moved.push_back(given);
  const std::vector<GivenNumber> all = given_numbers(settled);
  for (const GivenNumber& given : all) {
    if (is_named(given) || is_of_state(next, given.text)) continue;
    const std::string part = owner(given.part);
    const bool is_part =
        part.find('.') != std::string::npos && !part.starts_with("gravity") && !part.starts_with("air.");
    if (is_part && !former.contains(part)) {
      bool same = false;
      try {
        same = near(evaluated(settled, given), given.value, solved);
      } catch (const SceneError&) { // of names that are not here
      }
      if (same) continue;
      put_expression(settled, given.address, "");
      // One number of a rotation alone says nothing.
      if (given.address.starts_with(given.part + ".rotation."))
        for (const int i : {0, 1, 2, 3})
          put_expression(settled, given.part + ".rotation." + std::to_string(i), "");
      continue;
    }
    if (!is_moved(given)) continue;
    moved_parts.insert(given.part);
    moved_numbers.insert(given.address);
    moved.push_back(given);
  }
  if (!moved.empty()) {
    for (const GivenNumber& given : all)
      if (moved_parts.contains(given.part) && !moved_numbers.contains(given.address)) others.push_back(given);
    solve_for_sources(settled, std::move(moved), others);
  }
  evaluate_formulas(settled);
  return settled;
}

} // namespace

void settle_formulas(const Mechanism& before, Mechanism& next) {
  if (used_of_version_2(next).empty()) return;
  try {
    next = settle(before, next);
  } catch (const SceneError&) {
    drop_lost_formulas(next);
    if (!take_with_mistakes(before, next)) throw;
  }
}

} // namespace flyball
