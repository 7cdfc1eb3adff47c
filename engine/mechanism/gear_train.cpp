#include "engine/mechanism/gear_train.hpp"

#include "engine/mechanism/gear_ratio.hpp"

#include <algorithm>
#include <array>

namespace flyball {

std::vector<GearedCoordinate> gear_train(const Mechanism& mechanism, CoordinateReference coordinate,
                                         const Joint* without) {
  std::vector<GearedCoordinate> train{{coordinate, 1}};
  const auto is_known = [&](CoordinateReference c) {
    return std::ranges::find(train, c, &GearedCoordinate::at) != train.end();
  };
  for (std::size_t i = 0; i < train.size(); ++i) {
    const GearedCoordinate from = train[i];
    for (const Joint& gear : mechanism.joints) {
      if (gear.type != JointType::gear || &gear == without) continue;
      const std::array ends{find_coordinate(mechanism, gear.joints[0]),
                            find_coordinate(mechanism, gear.joints[1])};
      const double ratio = gear_ratio(gear);
      for (const std::size_t end : {0u, 1u})
        if (ends[end] == from.at && !is_known(ends[1 - end]))
          train.push_back({ends[1 - end], from.ratio * (end == 0 ? ratio : 1 / ratio)});
    }
  }
  return train;
}

} // namespace flyball
