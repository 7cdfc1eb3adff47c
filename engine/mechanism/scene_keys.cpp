#include "engine/mechanism/scene_keys.hpp"

namespace flyball::scene_keys {
namespace {

constexpr std::string_view per_coordinate =
    "one value, or an array with null where nothing acts if the joint has several coordinates";

// The fields of an object as they are visited.
class KeyList {
 public:
  template <class Part>
  static std::vector<Field> of(const Part& part) {
    KeyList list;
    visit_fields(list, part);
    return std::move(list.all_);
  }

  void describe(const std::string&) {}
  void version(const Field& field) { all_.push_back(field); }
  void type(const Field& field, const auto&) { all_.push_back(field); }
  void expression(const Field& field, const std::string&) { all_.push_back(field); }
  void pair(const Field& field, const auto&, const auto&) { all_.push_back(field); }
  void field(const Field& field, const auto&) { all_.push_back(field); }
  template <class Value>
  void field(const Field& field, const Value&, const Standard<Value>&) {
    all_.push_back(field);
  }
  void coordinates(const Joint&) {
    const Keys keys = scene_keys::of(Coordinate());
    for (Field field : keys) {
      field.expected = per_coordinate;
      all_.push_back(field);
    }
  }

 private:
  std::vector<Field> all_;
};

template <class Part>
Keys of_only_type() {
  static const std::vector<Field> all = KeyList::of(Part());
  return all;
}

// By type.
template <class Part>
std::span<const Keys> of_each_type() {
  static const auto lists = [] {
    std::vector<std::vector<Field>> all(words_of(Part().type).size());
    Part part;
    for (std::size_t i = 0; i < all.size(); ++i) {
      part.type = static_cast<decltype(part.type)>(i);
      all[i] = KeyList::of(part);
    }
    return all;
  }();
  static const std::vector<Keys> all(lists.begin(), lists.end());
  return all;
}

template <class Part>
Keys of_its_type(const Part& part) {
  return of_each_type<Part>()[static_cast<std::size_t>(part.type)];
}

// The names of all N values of an enumeration.
template <class Type, std::size_t N>
std::span<const std::string_view> words() {
  static const std::array<std::string_view, N> names = [] {
    std::array<std::string_view, N> all{};
    for (std::size_t i = 0; i < N; ++i)
      all[i] = type_name(static_cast<Type>(i));
    return all;
  }();
  return names;
}

} // namespace

Keys of(const Mechanism&) {
  return of_only_type<Mechanism>();
}
Keys of(const NamedParameter&) {
  return of_only_type<NamedParameter>();
}
Keys of(const NamedMeasure&) {
  return of_only_type<NamedMeasure>();
}
Keys of(const Body&) {
  return of_only_type<Body>();
}
Keys of(const Coordinate&) {
  return of_only_type<Coordinate>();
}
Keys of(const CoordinateSpring&) {
  return of_only_type<CoordinateSpring>();
}
Keys of(const Stop&) {
  return of_only_type<Stop>();
}
Keys of(const Friction&) {
  return of_only_type<Friction>();
}
Keys of(const Drive&) {
  return of_only_type<Drive>();
}
Keys of(const Air&) {
  return of_only_type<Air>();
}
Keys of(const Slider&) {
  return of_only_type<Slider>();
}
Keys of(const Simulation&) {
  return of_only_type<Simulation>();
}
Keys of(const View&) {
  return of_only_type<View>();
}
Keys of(const Camera&) {
  return of_only_type<Camera>();
}
Keys of(const Shape& shape) {
  return of_its_type(shape);
}
Keys of(const Joint& joint) {
  if (joint.type != JointType::gear) return of_its_type(joint);
  static const auto of_each_kind = [] {
    std::array<std::vector<Field>, 4> all;
    Joint gear;
    gear.type = JointType::gear;
    for (std::size_t i = 0; i < all.size(); ++i) {
      gear.kind = static_cast<GearKind>(i);
      all[i] = KeyList::of(gear);
    }
    return all;
  }();
  return of_each_kind[static_cast<std::size_t>(joint.kind)];
}
Keys of(const Force& force) {
  return of_its_type(force);
}

std::span<const Keys> of_all_types(const Shape&) {
  return of_each_type<Shape>();
}
std::span<const Keys> of_all_types(const Joint&) {
  static const std::vector<Keys> all = [] {
    const std::span<const Keys> types = of_each_type<Joint>();
    std::vector<Keys> with_kinds(types.begin(), types.end());
    Joint gear;
    gear.type = JointType::gear;
    for (std::size_t i = 0; i < words_of(gear.kind).size(); ++i) {
      gear.kind = static_cast<GearKind>(i);
      with_kinds.push_back(of(gear));
    }
    return with_kinds;
  }();
  return all;
}
std::span<const Keys> of_all_types(const Force&) {
  return of_each_type<Force>();
}

std::span<const std::string_view> words_of(JointType) {
  return words<JointType, 10>();
}
std::span<const std::string_view> words_of(GearKind) {
  return words<GearKind, 4>();
}
std::span<const std::string_view> words_of(ForceType) {
  return words<ForceType, 6>();
}
std::span<const std::string_view> words_of(ShapeType) {
  return words<ShapeType, 4>();
}
std::span<const std::string_view> words_of(ForceFrame) {
  return words<ForceFrame, 2>();
}
std::span<const std::string_view> words_of(DriveKeeps) {
  return words<DriveKeeps, 2>();
}
std::span<const std::string_view> words_of(SliderScale) {
  return words<SliderScale, 2>();
}

} // namespace flyball::scene_keys
