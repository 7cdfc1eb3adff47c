// How fast numbers of a mechanism change with something: a direction in the space of all of them, of which
// most stand still.
#pragma once

#include "engine/mechanism/dual_matrix.hpp"
#include "engine/mechanism/mechanism.hpp"

#include <optional>
#include <unordered_map>

namespace flyball {

// What a number is known by: where it is kept, or would be were it given. (An optional keeps what it holds
// where it begins, so that its number is known by one place, given or not.)
inline const void* place_of(const double& number) {
  return &number;
}
inline const void* place_of(const std::optional<double>& number) {
  return &number;
}
inline const void* place_of(const std::optional<Vec3>& vector, int i) {
  return reinterpret_cast<const double*>(&vector) + i;
}

class NumberRates {
 public:
  void clear() { rates_.clear(); }
  void set(const void* place, double rate) { rates_[place] = rate; }
  std::optional<double> find(const void* place) const {
    const auto found = rates_.find(place);
    return found == rates_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::unordered_map<const void*, double> rates_;
};

// Reads a mechanism's numbers as N: by themselves, or with their rates.
template <class N>
class NumberReader;

template <>
class NumberReader<double> {
 public:
  double operator()(const double& number) const { return number; }
  double operator()(const std::optional<double>& number, double stands_for) const {
    return number.value_or(stands_for);
  }
  const Vec3& operator()(const Vec3& vector) const { return vector; }
  Vec3 operator()(const std::optional<Vec3>& vector, const Vec3& stands_for) const {
    return vector.value_or(stands_for);
  }
  const Quat& operator()(const Quat& rotation) const { return rotation; }
};

template <>
class NumberReader<Dual> {
 public:
  using Vector = Eigen::Matrix<Dual, 3, 1>;

  explicit NumberReader(const NumberRates& rates) : rates_(rates) {}
  Dual operator()(const double& number) const { return {number, rates_.find(place_of(number)).value_or(0)}; }
  Dual operator()(const std::optional<double>& number, Dual stands_for) const {
    return with_rate(number ? Dual(*number) : stands_for, place_of(number));
  }
  Vector operator()(const Vec3& v) const { return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])}; }
  Vector operator()(const std::optional<Vec3>& vector, const Vector& stands_for) const {
    Vector all = vector ? Vector(vector->cast<Dual>()) : stands_for;
    for (int i = 0; i < 3; ++i)
      all[i] = with_rate(all[i], place_of(vector, i));
    return all;
  }
  Eigen::Quaternion<Dual> operator()(const Quat& rotation) const {
    const auto& c = rotation.coeffs();
    return {(*this)(c[3]), (*this)(c[0]), (*this)(c[1]), (*this)(c[2])};
  }

 private:
  Dual with_rate(Dual number, const void* place) const {
    const std::optional<double> rate = rates_.find(place);
    return rate ? Dual(number.value, *rate) : number;
  }

  const NumberRates& rates_;
};

} // namespace flyball
