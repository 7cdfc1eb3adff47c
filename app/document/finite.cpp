#include "app/document/finite.hpp"

#include "engine/mechanism/fields.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {
namespace {

template <class Part>
bool finite(const Part& part);

bool finite(double x) {
  return std::isfinite(x);
}
bool finite(const Vec3& v) {
  return v.allFinite();
}
bool finite(const Quat& q) {
  return q.coeffs().allFinite();
}
bool finite(const NamedPoint& point) {
  return finite(point.at);
}
bool finite(const std::string&) {
  return true;
}
template <class Value, std::size_t N>
bool finite(const std::array<Value, N>& values) {
  return std::ranges::all_of(values, [](const Value& value) { return finite(value); });
}
template <class Value>
bool finite(const std::vector<Value>& values) {
  return std::ranges::all_of(values, [](const Value& value) { return finite(value); });
}
template <class Value>
bool finite(const std::optional<Value>& value) {
  return !value || finite(*value);
}

// Whether all fields are finite that are visited.
struct FiniteFields {
  bool all = true;

  void describe(const std::string&) {}
  void version(const Field&) {}
  void expression(const Field&, const std::string&) {}
  void type(const Field&, const auto&) {}
  void field(const Field&, const auto& value) { all = all && finite(value); }
  template <class Value>
  void field(const Field&, const Value& value, const Standard<Value>&) {
    all = all && finite(value);
  }
  void pair(const Field&, const auto& a, const auto& b) { all = all && finite(a) && finite(b); }
  void coordinates(const Joint& joint) { all = all && finite(joint.coordinates); }
};

template <class Part>
bool finite(const Part& part) {
  if constexpr (std::is_enum_v<Part> || std::is_same_v<Part, bool>) {
    return true;
  } else {
    FiniteFields fields;
    visit_fields(fields, part);
    return fields.all;
  }
}

} // namespace

bool is_finite(const Mechanism& mechanism) {
  return finite(mechanism);
}

} // namespace flyball
