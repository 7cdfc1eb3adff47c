#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/edit_commands.hpp"

#include <array>

namespace flyball::menus {

namespace {

template <GearKind kind>
void gear(App& app) {
  gear_selected(app.session, kind);
}
template <GearKind kind>
bool can_gear(const App& app) {
  return can_gear_selected(app.session, kind);
}

const std::array insert_commands{
    Command{.id = "insert.ball",
            .title = "Ball",
            .help = "A solid ball: click where its centre is.",
            .key = shift('B'),
            .run = choose_tool<Tool::ball>,
            .checked = tool_chosen<Tool::ball>},
    Command{.id = "insert.block",
            .title = "Block",
            .help = "A solid block: click where its centre is.",
            .key = shift('K'),
            .run = choose_tool<Tool::block>,
            .checked = tool_chosen<Tool::block>},
    Command{.id = "insert.rod",
            .title = "Rod",
            .help = "A solid rod: click its two ends.",
            .key = shift('R'),
            .run = choose_tool<Tool::rod>,
            .checked = tool_chosen<Tool::rod>},
    Command{.id = "insert.plate",
            .title = "Plate",
            .help = "A thin block: click where its centre is.",
            .key = shift('P'),
            .run = choose_tool<Tool::plate>,
            .checked = tool_chosen<Tool::plate>},
    Command{.id = "insert.disc",
            .title = "Disc",
            .help =
                "A solid disc, across the view: click where its centre is, or drag from there to its rim.",
            .key = shift('D'),
            .run = choose_tool<Tool::disc>,
            .checked = tool_chosen<Tool::disc>,
            .words = "flywheel wheel drum rotor cylinder"},
    Command{.id = "insert.joint",
            .title = "Joint",
            .help = "Join two bodies, or a body and the ground: click the point where they meet.",
            .key = plain('J'),
            .run = choose_tool<Tool::joint>,
            .checked = tool_chosen<Tool::joint>,
            .separated = true},
    Command{.id = "insert.distance",
            .title = "Link",
            .help = "A massless link of constant length between two points (a distance joint).",
            .key = plain('L'),
            .run = choose_tool<Tool::distance>,
            .checked = tool_chosen<Tool::distance>},
    Command{.id = "insert.gear",
            .title = "Join by a gear",
            .help = "Couple the selected joints: each turns as the one chosen before it does.",
            .run = gear<GearKind::gear>,
            .enabled = can_gear<GearKind::gear>,
            .separated = true,
            .words = "wheel planetary ratio coupling",
            .lacks = "select two joints that turn, with Ctrl: the second will turn as the first does."},
    Command{.id = "insert.belt",
            .title = "Join by a belt",
            .help =
                "A belt or chain over wheels on the selected joints, from one to the next in the order of "
                "their choice.",
            .run = gear<GearKind::belt>,
            .enabled = can_gear<GearKind::belt>,
            .words = "chain pulley",
            .lacks = "select two or more joints that turn, with Ctrl, in the belt's order."},
    Command{.id = "insert.rack",
            .title = "Join by a rack",
            .help = "A pinion on the selected joint that turns moves a rack along the one that slides.",
            .run = gear<GearKind::rack>,
            .enabled = can_gear<GearKind::rack>,
            .words = "pinion",
            .lacks = "select a joint that turns and one that slides, with Ctrl."},
    Command{.id = "insert.screw",
            .title = "Join by a screw",
            .help = "A thread: the selected joint that slides moves by the lead as the other makes a turn.",
            .run = gear<GearKind::screw>,
            .enabled = can_gear<GearKind::screw>,
            .words = "thread spindle lead",
            .lacks = "select a joint that turns and one that slides with Ctrl, or a cylindrical one."},
    Command{.id = "insert.spring",
            .title = "Spring",
            .help = "A spring between two points.",
            .key = plain('S'),
            .run = choose_tool<Tool::spring>,
            .checked = tool_chosen<Tool::spring>,
            .separated = true},
    Command{.id = "insert.damper",
            .title = "Damper",
            .help = "A damper between two points.",
            .key = plain('D'),
            .run = choose_tool<Tool::damper>,
            .checked = tool_chosen<Tool::damper>},
    Command{.id = "insert.bearing",
            .title = "Bearing",
            .help = "An elastic bearing: stiffness and damping across the axis of what turns in it.",
            .key = shift('J'),
            .run = choose_tool<Tool::bearing>,
            .checked = tool_chosen<Tool::bearing>},
    Command{.id = "insert.force",
            .title = "Force",
            .help = "A constant force at a point of a body.",
            .key = shift('F'),
            .run = choose_tool<Tool::force>,
            .checked = tool_chosen<Tool::force>},
    Command{.id = "insert.torque",
            .title = "Torque",
            .help = "A constant torque on a body.",
            .key = shift('T'),
            .run = choose_tool<Tool::torque>,
            .checked = tool_chosen<Tool::torque>},
    Command{.id = "insert.drag",
            .title = "Air drag",
            .help = "The drag of the air, at a point of a body.",
            .key = shift('A'),
            .run = choose_tool<Tool::drag>,
            .checked = tool_chosen<Tool::drag>},
    Command{.id = "insert.vane",
            .title = "Vane",
            .help = "A plate or blade in the air: drag and lift by the direction of the flow.",
            .key = shift('V'),
            .run = choose_tool<Tool::vane>,
            .checked = tool_chosen<Tool::vane>},
};

} // namespace

std::span<const Command> insert() {
  return insert_commands;
}

} // namespace flyball::menus
