#include "engine/mechanism/body_point.hpp"

#include "engine/mechanism/text.hpp"

namespace flyball {

std::string point_label(const BodyPoint& point) {
  std::string label = point.body;
  if (point.at)
    for (int i = 0; i < 3; ++i)
      label += (i ? "," : ":") + number_text((*point.at)[i]);
  return label;
}

} // namespace flyball
