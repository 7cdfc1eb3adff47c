#include "app/document/coordinate_image.hpp"
#include "app/document/gear_kinds.hpp"
#include "app/document/references.hpp"

#include <algorithm>
#include <charconv>

namespace flyball {
namespace {

// The parts of "joints.NAME.KEY.INDEX" and what follows, where an address is of this form.
struct CoordinateAddress {
  std::string key;
  std::size_t index = 0;
  std::string rest; // ".stiffness", or empty
};

std::optional<CoordinateAddress> address_of(const std::string& address, const std::string& start) {
  if (!address.starts_with(start)) return {};
  const std::size_t dot = address.find('.', start.size());
  if (dot == std::string::npos) return {};
  CoordinateAddress found{address.substr(start.size(), dot - start.size()), 0, ""};
  const char *first = address.data() + dot + 1, *last = address.data() + address.size();
  const auto [end, error] = std::from_chars(first, last, found.index);
  if (error != std::errc{} || (end != last && *end != '.')) return {};
  found.rest = std::string(end, last);
  constexpr std::array<std::string_view, 7> keys{"coordinate", "spring",   "damping", "damping_force",
                                                 "stop",       "friction", "drive"};
  if (std::ranges::find(keys, found.key) == keys.end()) return {}; // such as "at.0"
  return found;
}

void turn_round(CoordinateAddress& address, Slider& slider) {
  if (address.key == "damping" || address.rest == ".stiffness") return;
  if (address.key == "friction" && address.rest != ".share") return;
  if (address.rest == ".lower" || address.rest == ".upper")
    address.rest = address.rest == ".lower" ? ".upper" : ".lower";
  const double from = slider.from;
  slider.from = 0.0 - slider.to;
  slider.to = 0.0 - from;
  slider.scale = SliderScale::linear; // there is no other below zero
}

} // namespace

void move_end(Joint& gear, std::size_t end, const Joint& joint, int coordinate,
              const CoordinateImage& image) {
  const bool stays = image.mixed;
  gear.joints[end] = coordinate_name(joint, stays ? coordinate : static_cast<int>(image.index));
  if (stays || image.sign > 0) return;
  reverse_ratio(gear);
  if (end == 1 && gear.offset) gear.offset = 0.0 - *gear.offset;
}

void follow_coordinates(Mechanism& mechanism, const Joint& joint,
                        const std::vector<CoordinateImage>& images) {
  for (Joint& gear : mechanism.joints) {
    if (gear.type != JointType::gear) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      if (joint_of_end(gear.joints[end]) != joint.name) continue;
      const int coordinate = find_coordinate(mechanism, gear.joints[end]).coordinate;
      if (static_cast<std::size_t>(coordinate) < images.size())
        move_end(gear, end, joint, coordinate, images[static_cast<std::size_t>(coordinate)]);
    }
  }
  const std::string start = "joints." + joint.name + ".";
  for (Slider& slider : mechanism.sliders) {
    std::optional<CoordinateAddress> address = address_of(slider.parameter, start);
    if (!address || address->index >= images.size()) continue;
    const CoordinateImage& image = images[address->index];
    if (image.mixed) continue;
    if (image.sign < 0) turn_round(*address, slider);
    slider.parameter = start + address->key + "." + std::to_string(image.index) + address->rest;
  }
}

} // namespace flyball
