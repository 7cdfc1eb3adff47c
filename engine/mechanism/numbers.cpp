#include "engine/mechanism/numbers.hpp"

#include "engine/mechanism/fields.hpp"
#include "engine/mechanism/number_rates.hpp"

#include <optional>
#include <utility>

namespace flyball {
namespace {

// The numbers among the fields that are visited; texts, choices and what is only seen have no address.
class Collector {
 public:
  explicit Collector(std::string prefix = {}, bool rotation = false, std::optional<Vec3> centre = {})
      : prefix_(std::move(prefix)), rotation_(rotation), centre_(std::move(centre)) {}

  void describe(const std::string&) {}
  void type(const Field&, const auto&) {}

  void field(const Field& field, double& place) { add(key(field), field, place); }
  void field(const Field& field, double& place, double) { add(key(field), field, place); }
  // An absent limit is no limit, which no number says.
  void field(const Field& field, std::optional<double>& place) {
    if (place) add(key(field), field, *place);
  }
  void field(const Field& field, std::optional<double>& place, double stands_for) {
    all_.push_back({key(field), std::string(field.unit), place.value_or(stands_for), place_of(place),
                    [&place](double v) { place = v; }});
  }
  void field(const Field& field, Vec3& place) { add(key(field), field, place); }
  void field(const Field& field, Vec3& place, const Vec3&) { add(key(field), field, place); }
  void field(const Field& field, std::optional<Vec3>& place) {
    if (centre_) return this->field(field, place, *centre_);
    if (place) add(key(field), field, *place);
  }
  void field(const Field& field, std::optional<Vec3>& place, const Vec3& stands_for) {
    for (int i = 0; i < 3; ++i)
      all_.push_back({key(field) + "." + std::to_string(i), std::string(field.unit),
                      place.value_or(stands_for)[i], place_of(place, i), [&place, stands_for, i](double v) {
                        if (!place) place = stands_for;
                        (*place)[i] = v;
                      }});
  }
  void field(const Field& field, std::array<Vec3, 2>& places) { pair(field, places[0], places[1]); }
  void field(const Field& field, std::array<double, 6>& places, const std::array<double, 6>&) {
    for (std::size_t i = 0; i < places.size(); ++i)
      add(key(field) + "." + std::to_string(i), field, places[i]);
  }
  void field(const Field& field, BearingMatrix& places, const BearingMatrix&) {
    const std::size_t size = places.size() > 4 ? 6 : 2;
    for (std::size_t i = 0; i < places.size(); ++i) {
      Field entry = field;
      entry.unit = fields::bearing_unit(field.unit, size, i / size, i % size);
      add(key(field) + "." + std::to_string(i / size) + "." + std::to_string(i % size), entry, places[i]);
    }
  }
  void pair(const Field& field, double& a, double& b) {
    add(key(field) + ".0", field, a);
    add(key(field) + ".1", field, b);
  }
  void pair(const Field& field, Vec3& a, Vec3& b) {
    add(key(field) + ".0", field, a);
    add(key(field) + ".1", field, b);
  }

  void field(const Field&, const std::string&) {}
  void field(const Field&, const std::array<std::string, 2>&) {}
  void field(const Field&, const std::optional<bool>&) {}
  void field(const Field&, bool, bool) {}
  void field(const Field&, ForceFrame, ForceFrame) {}
  void field(const Field&, GearKind, GearKind) {}
  void field(const Field&, DriveKeeps, DriveKeeps) {}
  void field(const Field&, const std::string&, const std::string&) {}
  void field(const Field&, const std::optional<std::array<double, 2>>&) {}
  void field(const Field&, const std::optional<std::array<double, 3>>&) {}
  // One of them by itself would leave no rotation.
  void field(const Field& field, Quat& rotation, const Quat&) {
    if (!rotation_) return;
    const std::array<double*, 4> places{&rotation.w(), &rotation.x(), &rotation.y(), &rotation.z()};
    for (std::size_t i = 0; i < places.size(); ++i)
      add(key(field) + "." + std::to_string(i), field, *places[i]);
  }
  void field(const Field&, const std::vector<Shape>&, const std::vector<Shape>&) {}

  void field(const Field& field, std::optional<CoordinateSpring>& spring) { inside(field, spring); }
  void field(const Field& field, std::optional<Stop>& stop) { inside(field, stop); }
  void field(const Field& field, std::optional<Friction>& friction) { inside(field, friction); }
  void field(const Field& field, std::optional<Drive>& drive) { inside(field, drive); }

  void coordinates(Joint& joint) {
    const auto count = static_cast<std::size_t>(coordinate_count(joint.type));
    if (joint.coordinates.size() != count) return;
    for (std::size_t i = 0; i < count; ++i) {
      index_ = count > 1 ? "." + std::to_string(i) : "";
      angle_ = is_angle(joint.type, static_cast<int>(i));
      visit_fields(*this, joint.coordinates[i], angle_);
    }
    index_.clear();
  }

  std::vector<Number> take() { return std::move(all_); }

 private:
  // "damping.1" of the second coordinate's, "spring.1.stiffness" of an object's.
  std::string key(const Field& field) const { return prefix_ + std::string(field.key) + index_; }
  void add(std::string key, const Field& field, double& place) {
    all_.push_back(
        {std::move(key), std::string(field.unit), place, place_of(place), [&place](double v) { place = v; }});
  }
  void add(const std::string& key, const Field& field, Vec3& place) {
    for (int i = 0; i < 3; ++i)
      add(key + "." + std::to_string(i), field, place[i]);
  }
  template <class Part>
  void inside(const Field& field, std::optional<Part>& part) {
    if (!part) return;
    const std::string index = std::exchange(index_, {});
    prefix_ = std::string(field.key) + index + ".";
    visit_fields(*this, *part, angle_);
    prefix_.clear();
    index_ = index;
  }

  std::string prefix_, index_;
  bool rotation_, angle_ = true;
  std::optional<Vec3> centre_; // m; where what has no place of its own is
  std::vector<Number> all_;
};

} // namespace

std::vector<Number> numbers_of(Body& body) {
  Collector all;
  visit_fields(all, body);
  return all.take();
}

std::vector<Number> all_numbers_of(Body& body) {
  Collector all({}, true);
  visit_fields(all, body);
  return all.take();
}

std::vector<Number> all_numbers_of(Shape& shape, const Body& body) {
  Collector all({}, false, body.position);
  visit_fields(all, shape);
  return all.take();
}

std::vector<Number> numbers_of(NamedParameter& parameter) {
  Collector all;
  visit_fields(all, parameter);
  return all.take();
}

std::vector<Number> numbers_of(NamedPoint& point) {
  std::vector<Number> all;
  for (int i = 0; i < 3; ++i) {
    double& place = point.at[i];
    all.push_back({std::to_string(i), "m", place, place_of(place), [&place](double v) { place = v; }});
  }
  return all;
}

std::vector<Number> numbers_of(const Mechanism& mechanism, Joint& joint) {
  Collector all;
  visit_fields(all, joint, &mechanism);
  return all.take();
}

std::vector<Number> numbers_of(const Mechanism& mechanism, Force& force) {
  Collector all;
  visit_fields(all, force, &mechanism);
  return all.take();
}

std::vector<Number> numbers_of_gravity(Vec3& gravity) {
  Collector all;
  all.field(fields::gravity, gravity);
  return all.take();
}

std::vector<Number> numbers_of(Air& air) {
  Collector all(std::string(fields::air.key) + ".");
  visit_fields(all, air);
  return all.take();
}

std::vector<Number> numbers_of(Simulation& simulation) {
  Collector all(std::string(fields::simulation.key) + ".");
  visit_fields(all, simulation);
  return all.take();
}

} // namespace flyball
