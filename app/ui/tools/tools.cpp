#include "app/ui/tools/tools.hpp"

#include "app/ui/commands.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/tools/typed_size.hpp"
#include "app/ui/view_context.hpp"
#include "app/ui/view_frame.hpp"

namespace flyball {

namespace {

bool has_body(const Session& session, const std::string& name) {
  return name == ground_name || body_index(session.mechanism(), name) >= 0;
}

void drop_begun(ToolState& tool) {
  tool.first.reset();
  tool.first_clicked = false;
  tool.typed.clear();
  tool.place_now = false;
  tool.frame.reset();
  tool.joint.reset();
  tool.hovered = Handle::none;
  tool.hovered_point.reset();
}

void take_key_while_holding(Session& session, ToolState& tool, const KeyPress& key) {
  if (key.key == keys::escape) {
    step_back(session, tool);
  } else if (key.key == keys::enter) {
    if (!let_go_hand(session, tool, true)) let_go(session, tool, true);
    tool.spent = true;
  } else if (tool.grab) {
    take_typed_key(tool.grab->typed, key);
  }
}

// Whether a number that is typed now is the size of what is being placed.
bool takes_size(const Session& session, const Ui& ui, const ToolState& tool) {

  if (session.mode != Mode::build) return false;
  switch (tool.tool) {
  case Tool::rod:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return tool.first.has_value();
  case Tool::ball:
  case Tool::block:
  case Tool::plate:
  case Tool::disc: return tool.first || !ui.keyboard.focus.in_panel;
  default: return false;
  }
}

bool take_size_key(ToolState& tool, const KeyPress& key) {

  if (!tool.typed.empty() && key.key == keys::escape) {
    tool.typed.clear();
    return true;
  }
  if (key.key == keys::enter && (!tool.typed.empty() || tool.first)) return tool.place_now = true;
  return take_typed_key(tool.typed, key);
}

bool take_key(Session& session, Ui& ui, ToolState& tool, const KeyPress& key) {
  // What is held is not to be deleted or turned into something else by a shortcut.
  if (tool.grab || tool.assembly || tool.pull || tool.reach) {
    take_key_while_holding(session, tool, key);
    return true;
  }
  if (takes_size(session, ui, tool) && take_size_key(tool, key)) return true;
  if (key.ctrl || key.shift) return false;
  if (key.key == keys::escape) {
    if (!step_back(session, tool)) return false;
    ui.keyboard.focus = {};
    return true;
  }
  if (key.key == keys::enter && tool.joint) return make_joint(session, ui, tool);
  return false;
}

bool drags(Tool tool) {
  switch (tool) {
  case Tool::box:
  case Tool::ball:
  case Tool::block:
  case Tool::rod:
  case Tool::plate:
  case Tool::disc:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return true;
  default: return false;
  }
}

} // namespace

void set_tool(Session& session, Ui& ui, ToolState& tool, Tool wanted) {
  ui.keyboard.at.clear();                 // the tool works in the view
  for (auto& behind : ui.keyboard.behind) // also if it was chosen in the menu of a field
    behind = {};
  if (wanted != Tool::select && wanted != Tool::box && wanted != Tool::pull) set_mode(session, Mode::build);
  tool.tool = wanted;
}

bool places(Tool tool) {
  return tool != Tool::select && tool != Tool::rotate && tool != Tool::pull && tool != Tool::box;
}

void keep_tool_state(Session& session, ToolState& tool) {

  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsMouseReleased(ImGuiMouseButton_Left))
    tool.spent = false;
  const bool other = tool.begun != tool.tool || (places(tool.tool) && session.mode != Mode::build);
  if (tool.grab && (other || session.mode != Mode::build)) let_go(session, tool, true);
  if (other) drop_begun(tool);
  tool.begun = tool.tool;
  if (!selected_point(session, tool)) tool.point.clear();
  if (tool.first && !has_body(session, tool.first->body)) drop_begun(tool);
  if (tool.joint && !(has_body(session, tool.joint->bodies[0]) && has_body(session, tool.joint->bodies[1])))
    tool.joint.reset();
}

bool takes_left_drag(const ToolState& tool, const ViewState& view, const ViewInput& input) {
  if (tool.grab || tool.assembly || tool.pull || tool.reach || tool.frame || tool.spent) return true;
  return drags(tool.tool) || ((input.ctrl || frames_with_left(view.navigation)) && !places(tool.tool));
}

bool step_back(Session& session, ToolState& tool) {

  if (let_go_hand(session, tool, false)) {
    // It was the hand's.
  } else if (tool.grab) {
    let_go(session, tool, false);
  } else if (tool.frame || tool.first) {
    drop_begun(tool);
  } else if (tool.joint && tool.joint->picking_axis) {
    tool.joint->picking_axis = false;
    tool.joint->axis_from.reset();
    return true;
  } else if (tool.joint) {
    select(session, tool.joint->before);
    tool.joint.reset();
    return true;
  } else if (tool.tool != Tool::select) {
    tool.tool = Tool::select;
    return true;
  } else if (!tool.point.empty()) {
    tool.point.clear();
    return true;
  } else {
    return false;
  }
  tool.spent = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  return true;
}

void take_tool_keys(Session& session, Ui& ui, ToolState& tool) {
  if (ImGui::GetIO().WantTextInput) return;
  std::erase_if(ui.keys, [&](const KeyPress& key) { return take_key(session, ui, tool, key); });
}

void end_tool(ToolState& tool, const ViewInput& input) {
  drop_begun(tool);
  if (!input.shift) tool.tool = Tool::select;
}

namespace {

// Of what a click or the end of a drag would leave at a named point; empty: nothing.
std::string standing_hint(const ToolState& tool) {

  const std::string& name = tool.grab ? tool.grab->stands : tool.caches.aim.named;
  const bool takes = tool.grab || (places(tool.tool) && tool.tool != Tool::point && !tool.joint);
  return takes && !name.empty() ? "It stands at " + name + " then, and moves with it. " : "";
}

// "arm" of "joints.arm.at".
std::string owner_of(const std::string& address) {
  const std::string path = address.substr(address.find('.') + 1);
  return path.substr(0, path.find('.'));
}

std::string hint_of_tool(const Session& session, const ToolState& tool) {

  if (tool.grab)
    return std::string(tool.snap ? "Ctrl drags freely." : "Ctrl snaps.") +
           (outer_joints(*tool.grab->before, tool.grab->selection).empty() ? ""
            : tool.leave_joints                                            ? " Shift takes joints along."
                                                                           : " Shift leaves joints behind.") +
           " A number can be typed. Esc takes it back.";
  if (const std::string hint = hand_hint(tool); !hint.empty()) return hint;
  if (!tool.typed.empty()) return "Enter or a click places it so. Esc drops the number.";
  if (tool.cursor && !tool.joint)
    return std::string(tool.first ? "The other end, or its length, in figures: arrows" : "Arrows") +
           " move the cursor, Page Down goes to the next point, Enter places. Esc ends.";
  switch (tool.tool) {
  case Tool::select: return "";
  case Tool::rotate:
    return session.selection().empty() ? "Select what is to be turned." : "Drag a ring. Esc ends.";
  case Tool::pull:
    return session.mode == Mode::build
               ? "Drag a body: it moves along its joints. Esc ends."
               : "Drag a body: a spring pulls it; with Shift sliders bring it there. Esc ends.";
  case Tool::box: return "Drag a frame round the parts; Shift adds. Esc ends.";
  case Tool::ball:
  case Tool::disc:
    return "Click where the centre is, or drag from there to the radius; it can be typed. Esc ends.";
  case Tool::block:
  case Tool::plate:
    return "Click where the centre is, or drag from there to a corner; an edge can be typed. Esc ends.";
  case Tool::rod:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper:
    return tool.first ? "Click the other end, or type the length. Esc drops the first."
                      : "Click one end, then the other. Esc ends.";
  case Tool::joint:
  case Tool::bearing: {
    const bool bearing = tool.tool == Tool::bearing;
    if (!tool.joint)
      return bearing ? "Click the point of a shaft where the bearing holds it. Esc ends."
                     : "Click the point where two bodies meet. Esc ends.";
    if (tool.joint->picking_axis)
      return tool.joint->axis_from ? "Click a second point on the axis." : "Click a point on the axis.";
    return std::string(bearing ? "Enter inserts it." : "Enter joins.") +
           " Click to move the point. Esc cancels.";
  }
  case Tool::force: return "Click a point of a body: a force of 1 N downwards. Esc ends.";
  case Tool::torque: return "Click a body: a torque of 1 N m about the line of sight. Esc ends.";
  case Tool::drag: return "Click a point of a body that the air holds back. Esc ends.";
  case Tool::vane: return "Click a point of a body to put a vane there, square to the view's axis. Esc ends.";
  case Tool::point:
    return "Click the named point where " + owner_of(tool.standing) + " shall stand. Esc ends.";
  }
  return "";
}

} // namespace

std::string tool_hint(const Session& session, const ToolState& tool) {
  return standing_hint(tool) + hint_of_tool(session, tool);
}

const std::vector<SnapPoint>& cached_snap_points(const Session& session, ToolState& tool) {
  ToolCaches& cache = tool.caches;
  if (cache.snap_revision != session.document.revision()) {
    cache.snap_points = snap_points(session.mechanism());
    cache.snap_revision = session.document.revision();
  }
  return cache.snap_points;
}

const SceneList& cached_scene(const ViewContext& context) {
  if (context.session.mode == Mode::build) return shown_scene(context)->solid;
  ToolCaches& cache = context.tool.caches;
  // Marks of cut joints come with the answer.
  if (cache.scene_revision != context.session.document.revision() ||
      cache.scene_ticket != context.session.answer.ticket) {
    ViewFrame frame = view_frame(context.session, context.ui, context.tool, context.view);
    frame.mechanism = &context.session.mechanism();
    frame.poses = {};
    cache.scene = scene_of(frame);
    cache.scene_revision = context.session.document.revision();
    cache.scene_ticket = context.session.answer.ticket;
  }
  return cache.scene;
}

namespace {

void look_at_selection(const Session& session, ToolState& tool) {
  ToolCaches& cache = tool.caches;
  if (cache.selected_revision == session.document.revision() && cache.selected == session.selection()) return;
  cache.selected_revision = session.document.revision();
  cache.selected = session.selection();
  cache.centre = centre_of(session.mechanism(), session.selection());
  cache.ends.clear();
  if (session.selection().parts.size() != 1) return;
  for (const int end : {0, 1})
    if (const auto point = point_position(session.mechanism(), {session.selection().parts[0], end}))
      cache.ends.push_back(*point);
  // What has one point only is moved by its middle.
  if (cache.ends.size() == 1) cache.ends.clear();
}

} // namespace

std::optional<Vec3> cached_centre(const Session& session, ToolState& tool) {
  look_at_selection(session, tool);
  return tool.caches.centre;
}

const std::vector<Vec3>& cached_ends(const Session& session, ToolState& tool) {
  look_at_selection(session, tool);
  return tool.caches.ends;
}

} // namespace flyball
