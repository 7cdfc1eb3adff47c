#include "app/render/draw_record.hpp"

#include <utility>

namespace flyball {

namespace {

template <class T>
void add_bytes(std::string& bytes, const T* values, int count) {
  bytes.append(reinterpret_cast<const char*>(values), sizeof(T) * static_cast<std::size_t>(count));
}

template <class... Ts>
void add_values(std::string& bytes, const Ts&... values) {
  (add_bytes(bytes, &values, 1), ...);
}

} // namespace

bool DrawRecord::take(const ImDrawData& data) {
  now_.clear();
  add_values(now_, data.DisplayPos, data.DisplaySize, data.FramebufferScale, data.CmdListsCount);
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    add_values(now_, list.VtxBuffer.Size, list.IdxBuffer.Size, list.CmdBuffer.Size);
    add_bytes(now_, list.VtxBuffer.Data, list.VtxBuffer.Size);
    add_bytes(now_, list.IdxBuffer.Data, list.IdxBuffer.Size);
    for (const ImDrawCmd& command : list.CmdBuffer) // not as a whole: there are gaps in it
      add_values(now_, command.ClipRect, command.GetTexID(), command.VtxOffset, command.IdxOffset,
                 command.ElemCount, command.UserCallback, command.UserCallbackData);
  }
  if (now_ == last_) return false;
  std::swap(now_, last_);
  return true;
}

} // namespace flyball
