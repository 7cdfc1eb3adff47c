#include "app/render/imgui_renderer.hpp"

#include "app/render/imgui_compat.hpp"

#include <array>
#include <cstddef>

namespace flyball {

namespace {

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

void point_attributes(std::size_t first_vertex) {
  const std::size_t base = first_vertex * sizeof(ImDrawVert);
  constexpr auto stride = static_cast<GLsizei>(sizeof(ImDrawVert));
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, byte_offset(base + offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, byte_offset(base + offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                        byte_offset(base + offsetof(ImDrawVert, col)));
}

} // namespace

ImTextureID imgui_texture(GLuint texture) {
  return imgui_compat::texture_id(texture);
}

ImGuiRenderer::ImGuiRenderer()
    : shader_("imgui.vert", "imgui.frag"), vertex_array_(make_vertex_array()), vertices_(make_buffer()),
      indices_(make_buffer()) {
  ImGuiIO& io = ImGui::GetIO();
  io.BackendRendererName = "flyball";
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  glBindVertexArray(vertex_array_.get());
  for (GLuint i = 0; i < 3; ++i)
    glEnableVertexAttribArray(i);
  glBindVertexArray(0);
}

void ImGuiRenderer::upload_fonts() {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.GetTexDataAsAlpha8(&pixels, &width, &height);
  fonts_ = make_texture();
  glBindTexture(GL_TEXTURE_2D, fonts_.get());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // White, as opaque as the glyphs: a quarter of the memory that four channels take.
  constexpr std::array<GLint, 4> white{GL_ONE, GL_ONE, GL_ONE, GL_RED};
  glTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_RGBA, white.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, pixels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  check_gl("sending the fonts");
  atlas.SetTexID(imgui_texture(fonts_.get()));
}

void ImGuiRenderer::draw(const ImDrawData& data) {
  const float width = data.DisplaySize.x * data.FramebufferScale.x;
  const float height = data.DisplaySize.y * data.FramebufferScale.y;
  if (width <= 0 || height <= 0) return;

  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
  shader_.use();
  shader_.set("picture", 0);
  shader_.set("origin", data.DisplayPos.x, data.DisplayPos.y);
  shader_.set("size", data.DisplaySize.x, data.DisplaySize.y);
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(vertex_array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());

  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                 GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback) {
        if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
        continue;
      }
      const float left = (command.ClipRect.x - data.DisplayPos.x) * data.FramebufferScale.x;
      const float top = (command.ClipRect.y - data.DisplayPos.y) * data.FramebufferScale.y;
      const float right = (command.ClipRect.z - data.DisplayPos.x) * data.FramebufferScale.x;
      const float bottom = (command.ClipRect.w - data.DisplayPos.y) * data.FramebufferScale.y;
      if (right <= left || bottom <= top) continue;
      glScissor(static_cast<GLint>(left), static_cast<GLint>(height - bottom),
                static_cast<GLsizei>(right - left), static_cast<GLsizei>(bottom - top));
      glBindTexture(GL_TEXTURE_2D, imgui_compat::texture_name(command.GetTexID()));
      point_attributes(command.VtxOffset);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                     sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                     byte_offset(command.IdxOffset * sizeof(ImDrawIdx)));
    }
  }
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
  check_gl("drawing the interface");
}

} // namespace flyball
