#include "app/ui/tools/tools.hpp"

#include "app/ui/commands.hpp"
#include "app/ui/tools/named_points.hpp"
#include "app/ui/tools/tools_hand.hpp"
#include "app/ui/tools/typed_size.hpp"

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

void take_key_while_holding(App& app, const KeyPress& key) {
  if (key.key == keys::escape) {
    step_back(app);
  } else if (key.key == keys::enter) {
    if (!let_go_hand(app, true)) let_go(app, true);
    app.tool.spent = true;
  } else if (app.tool.grab) {
    take_typed_key(app.tool.grab->typed, key);
  }
}

// Whether a number that is typed now is the size of what is being placed.
bool takes_size(const App& app) {
  const ToolState& tool = app.tool;
  if (app.mode != Mode::build) return false;
  switch (tool.tool) {
  case Tool::rod:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return tool.first.has_value();
  case Tool::ball:
  case Tool::block:
  case Tool::plate: return tool.first || !app.keyboard.focus.in_panel;
  default: return false;
  }
}

bool take_size_key(App& app, const KeyPress& key) {
  ToolState& tool = app.tool;
  if (!tool.typed.empty() && key.key == keys::escape) {
    tool.typed.clear();
    return true;
  }
  if (key.key == keys::enter && (!tool.typed.empty() || tool.first)) return tool.place_now = true;
  return take_typed_key(tool.typed, key);
}

bool take_key(App& app, const KeyPress& key) {
  // What is held is not to be deleted or turned into something else by a shortcut.
  if (app.tool.grab || app.tool.assembly || app.tool.pull || app.tool.reach) {
    take_key_while_holding(app, key);
    return true;
  }
  if (takes_size(app) && take_size_key(app, key)) return true;
  if (key.ctrl || key.shift) return false;
  if (key.key == keys::escape) {
    if (!step_back(app)) return false;
    app.keyboard.focus = {};
    return true;
  }
  if (key.key == keys::enter && app.tool.joint) return make_joint(app);
  return false;
}

bool drags(Tool tool) {
  switch (tool) {
  case Tool::box:
  case Tool::ball:
  case Tool::block:
  case Tool::rod:
  case Tool::plate:
  case Tool::distance:
  case Tool::spring:
  case Tool::damper: return true;
  default: return false;
  }
}

} // namespace

bool places(Tool tool) {
  return tool != Tool::select && tool != Tool::rotate && tool != Tool::pull && tool != Tool::box;
}

void keep_tool_state(App& app) {
  ToolState& tool = app.tool;
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsMouseReleased(ImGuiMouseButton_Left))
    tool.spent = false;
  const bool other = tool.begun != tool.tool || (places(tool.tool) && app.mode != Mode::build);
  if (tool.grab && (other || app.mode != Mode::build)) let_go(app, true);
  if (other) drop_begun(tool);
  tool.begun = tool.tool;
  if (!selected_point(app)) tool.point.clear();
  if (tool.first && !has_body(app, tool.first->body)) drop_begun(tool);
  if (tool.joint && !(has_body(app, tool.joint->bodies[0]) && has_body(app, tool.joint->bodies[1])))
    tool.joint.reset();
}

bool takes_left_drag(const App& app, const ViewInput& input) {
  const ToolState& tool = app.tool;
  if (tool.grab || tool.assembly || tool.pull || tool.reach || tool.frame || tool.spent) return true;
  return drags(tool.tool) || ((input.ctrl || frames_with_left(app.navigation)) && !places(tool.tool));
}

bool step_back(App& app) {
  ToolState& tool = app.tool;
  if (let_go_hand(app, false)) {
    // It was the hand's.
  } else if (tool.grab) {
    let_go(app, false);
  } else if (tool.frame || tool.first) {
    drop_begun(tool);
  } else if (tool.joint && tool.joint->picking_axis) {
    tool.joint->picking_axis = false;
    tool.joint->axis_from.reset();
    return true;
  } else if (tool.joint) {
    select(app, tool.joint->before);
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

void take_tool_keys(App& app) {
  if (ImGui::GetIO().WantTextInput || app.dialog.showing || app.commands.palette_showing) return;
  std::erase_if(app.keys, [&](const KeyPress& key) { return take_key(app, key); });
}

void end_tool(App& app, const ViewInput& input) {
  drop_begun(app.tool);
  if (!input.shift) app.tool.tool = Tool::select;
}

namespace {

// Of what a click or the end of a drag would leave at a named point; empty: nothing.
std::string standing_hint(const App& app) {
  const ToolState& tool = app.tool;
  const std::string& name = tool.grab ? tool.grab->stands : tool.caches.aim.named;
  const bool takes = tool.grab || (places(tool.tool) && tool.tool != Tool::point && !tool.joint);
  return takes && !name.empty() ? "It stands at " + name + " then, and moves with it. " : "";
}

// "arm" of "joints.arm.at".
std::string owner_of(const std::string& address) {
  const std::string path = address.substr(address.find('.') + 1);
  return path.substr(0, path.find('.'));
}

std::string hint_of_tool(const App& app) {
  const ToolState& tool = app.tool;
  if (tool.grab)
    return std::string(tool.snap ? "Ctrl drags freely." : "Ctrl snaps.") +
           (outer_joints(*tool.grab->before, tool.grab->selection).empty() ? ""
            : app.inspector.leave_joints                                   ? " Shift takes joints along."
                                                                           : " Shift leaves joints behind.") +
           " A number can be typed. Esc takes it back.";
  if (const std::string hint = hand_hint(app); !hint.empty()) return hint;
  if (!tool.typed.empty()) return "Enter or a click places it so. Esc drops the number.";
  if (tool.cursor && !tool.joint)
    return std::string(tool.first ? "The other end, or its length, in figures: arrows" : "Arrows") +
           " move the cursor, Page Down goes to the next point, Enter places. Esc ends.";
  switch (tool.tool) {
  case Tool::select: return "";
  case Tool::rotate:
    return app.selection().empty() ? "Select what is to be turned." : "Drag a ring. Esc ends.";
  case Tool::pull:
    return app.mode == Mode::build
               ? "Drag a body: it moves along its joints. Esc ends."
               : "Drag a body: a spring pulls it; with Shift sliders bring it there. Esc ends.";
  case Tool::box: return "Drag a frame round the parts; Shift adds. Esc ends.";
  case Tool::ball:
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

std::string tool_hint(const App& app) {
  return standing_hint(app) + hint_of_tool(app);
}

const std::vector<SnapPoint>& cached_snap_points(App& app) {
  ToolCaches& cache = app.tool.caches;
  if (cache.snap_revision != app.document.revision()) {
    cache.snap_points = snap_points(app.mechanism());
    cache.snap_revision = app.document.revision();
  }
  return cache.snap_points;
}

const SceneList& cached_scene(App& app) {
  if (app.mode == Mode::build) return shown_scene(app)->solid;
  ToolCaches& cache = app.tool.caches;
  // Marks of cut joints come with the answer.
  if (cache.scene_revision != app.document.revision() || cache.scene_ticket != app.answer.ticket) {
    ViewFrame frame = view_frame(app);
    frame.mechanism = &app.mechanism();
    frame.poses = {};
    cache.scene = scene_of(frame);
    cache.scene_revision = app.document.revision();
    cache.scene_ticket = app.answer.ticket;
  }
  return cache.scene;
}

namespace {

void look_at_selection(App& app) {
  ToolCaches& cache = app.tool.caches;
  if (cache.selected_revision == app.document.revision() && cache.selected == app.selection()) return;
  cache.selected_revision = app.document.revision();
  cache.selected = app.selection();
  cache.centre = centre_of(app.mechanism(), app.selection());
  cache.ends.clear();
  if (app.selection().parts.size() != 1) return;
  for (const int end : {0, 1})
    if (const auto point = point_position(app.mechanism(), {app.selection().parts[0], end}))
      cache.ends.push_back(*point);
  // What has one point only is moved by its middle.
  if (cache.ends.size() == 1) cache.ends.clear();
}

} // namespace

std::optional<Vec3> cached_centre(App& app) {
  look_at_selection(app);
  return app.tool.caches.centre;
}

const std::vector<Vec3>& cached_ends(App& app) {
  look_at_selection(app);
  return app.tool.caches.ends;
}

} // namespace flyball
