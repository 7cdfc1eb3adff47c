// Draws Dear ImGui's output with the program's own OpenGL, in a window and off-screen alike.
#pragma once

#include "app/render/gl.hpp"
#include "app/render/shader.hpp"

#include <imgui.h>

namespace flyball {

// Texture for ImGui::Image; a Framebuffer's picture needs uv0 (0, 1) and uv1 (1, 0).
ImTextureID imgui_texture(GLuint texture);

class ImGuiRenderer {
 public:
  ImGuiRenderer();

  // Sends the current context's font atlas to OpenGL; again after fonts were changed.
  void upload_fonts();
  // Draws over what the bound framebuffer holds.
  void draw(const ImDrawData& data);

 private:
  ShaderProgram shader_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_, indices_;
  GlTexture fonts_;
};

} // namespace flyball
