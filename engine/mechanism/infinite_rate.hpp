// A number that changes at no finite rate with another that it is made of, such as a square root at zero.
#pragma once

#include "engine/mechanism/error.hpp"

namespace flyball {

class InfiniteRate : public SceneError {
 public:
  using SceneError::SceneError;
};

} // namespace flyball
