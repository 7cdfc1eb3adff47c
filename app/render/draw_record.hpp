// What Dear ImGui last had to draw, byte by byte, to tell a frame that would only draw it again.
#pragma once

#include <imgui.h>

#include <string>

namespace flyball {

class DrawRecord {
 public:
  // Whether it differs from what was given last. What textures hold is not looked at.
  bool take(const ImDrawData& data);

 private:
  std::string last_, now_;
};

} // namespace flyball
