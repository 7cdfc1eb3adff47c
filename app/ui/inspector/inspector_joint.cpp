#include "app/render/icons.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>
#include <unordered_map>

namespace flyball {

namespace {

std::string address_of(const Joint& joint, const std::string& key) {
  return "joints." + joint.name + "." + key;
}

void type_row(Session& session, Ui& ui, const Joint& joint) {
  constexpr std::array types{JointType::revolute,  JointType::prismatic, JointType::cylindrical,
                             JointType::universal, JointType::spherical, JointType::planar,
                             JointType::free,      JointType::fixed,     JointType::distance};
  std::array<std::string_view, types.size()> words;
  std::ranges::transform(types, words.begin(), [](JointType type) { return type_name(type); });
  const auto present = static_cast<std::size_t>(std::ranges::find(types, joint.type) - types.begin());
  const auto chosen =
      choice_row(ui, "inspector/type", "Type", words, present,
                 "What the joint leaves free; drives, springs and stops stay where they fit.");
  if (!chosen) return;
  const std::size_t others = others_edited(session, ui, joint).size();
  edit_later(session, ui, "Make " + joint.name + " " + std::string(words[*chosen]) + and_more(others),
             [names = edited_with(ui, {PartKind::joint, joint.name}),
              type = types[*chosen]](Mechanism& mechanism, Selection&) {
               for (const std::string& name : names)
                 change_joint_type(mechanism, name, type);
             });
}

// Buttons that lay the axis along one of the world's.
void direction_buttons(Session& session, Ui& ui, const Joint& joint, Vec3 Joint::*axis,
                       const std::string& widget) {
  row_label(ui, "");
  const std::vector<const Joint*> others = others_edited(session, ui, joint);
  const float gap = 3 * ui.scale;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i > 0) ImGui::SameLine(0, gap);
    const auto lies_along = [axis, i](const Joint* each) { return each->*axis == Vec3(Vec3::Unit(i)); };
    const bool along = lies_along(&joint) && std::ranges::all_of(others, lies_along);
    if (text_button(ui, widget + "/along/" + axis_letters[at], axis_letters[at], along))
      edit_joint(session, ui, "Turn axis of " + joint.name, joint.name,
                 [axis, i](Joint& same) { same.*axis = Vec3::Unit(i); });
    help_on_hover((std::string("Along the world's ") + axis_letters[at] + " axis.").c_str());
  }
  ImGui::SameLine(0, gap);
  if (text_button(ui, widget + "/flip", icon::swap))
    edit_joint(session, ui, "Flip axis of " + joint.name, joint.name,
               [axis](Joint& same) { same.*axis = Vec3(-(same.*axis)) + Vec3::Zero(); });
  help_on_hover("The other way round: positive becomes negative.");
}

void axis_rows(Session& session, Ui& ui, const Joint& joint) {
  const bool universal = joint.type == JointType::universal;
  vector_rows(session, ui, "Axis",
              {.name = "inspector/axis",
               .value = joint.axis,
               .help = joint.type == JointType::planar ? "Normal of the plane, as drawn; of any length."
                       : universal ? "First axis, fixed in the parent, as drawn; of any length."
                                   : "Direction of the axis, as drawn; of any length.",
               .address = address_of(joint, universal ? "axes.0" : "axis")});
  direction_buttons(session, ui, joint, &Joint::axis, "inspector/axis");
  if (!has_axis2(joint.type)) return;
  vector_rows(session, ui, universal ? "Axis 2" : "x axis",
              {.name = "inspector/axis2",
               .value = joint.axis2,
               .help = universal ? "Second axis, fixed in the child, as drawn; of any length."
                                 : "Direction in the plane in which x is counted; of any length.",
               .address = address_of(joint, universal ? "axes.1" : "x_axis")});
  direction_buttons(session, ui, joint, &Joint::axis2, "inspector/axis2");
}

// Whether some joint leads back to where others lead already. Of the drawing alone, so that the row below
// does not come and go with answers.
bool has_loops(const Mechanism& mechanism) {
  std::unordered_map<std::string_view, std::size_t> index{{ground_name, 0}};
  for (const Body& body : mechanism.bodies)
    index.emplace(body.name, index.size());
  std::vector<std::size_t> leads_to(index.size()); // union-find
  std::iota(leads_to.begin(), leads_to.end(), std::size_t{0});
  const auto group = [&](std::size_t i) {
    while (leads_to[i] != i)
      i = leads_to[i] = leads_to[leads_to[i]];
    return i;
  };
  for (const Joint& joint : mechanism.joints) {
    const auto a = index.find(joint.bodies[0]), b = index.find(joint.bodies[1]);
    if (joint.type == JointType::gear || a == index.end() || b == index.end()) continue;
    const std::size_t from = group(a->second), to = group(b->second);
    if (from == to) return true;
    leads_to[from] = to;
  }
  return false;
}

// Only where there are loops is there anything to cut.
void cut_row(Session& session, Ui& ui, const Joint& joint) {
  const SystemSummary& summary = session.answer.summary;
  if (is_of_several(ui)) return;
  const bool can = joint.type != JointType::free && joint.type != JointType::distance;
  if (!can || (!joint.cut && !has_loops(session.mechanism()))) return;
  constexpr std::array<std::string_view, 3> options{"automatic", "cut here", "not cut here"};
  const std::size_t present = !joint.cut ? 0 : *joint.cut ? 1 : 2;
  const bool cut_now = std::ranges::find(summary.cut_joints, joint.name) != summary.cut_joints.end();
  const auto chosen =
      choice_row(ui, "inspector/cut", "Loop", options, present,
                 cut_now ? "Where a loop is cut open for solving; the program cuts this joint."
                         : "Where a loop is cut open for solving; the program does not cut this joint.");
  if (!chosen) return;
  edit_joint(session, ui, "Cut of " + joint.name, joint.name, [choice = *chosen](Joint& same) {
    same.cut = choice == 0 ? std::nullopt : std::optional(choice == 1);
  });
}

} // namespace

namespace {

void note_row(Session& session, Ui& ui, const Joint& joint) {
  if (is_of_several(ui)) return;
  text_row(
      session, ui, "inspector/description", "Note", joint.description, "A note for whoever reads the scene.",
      [&session, &ui, name = joint.name](const std::string& text) {
        edit_joint(session, ui, "Describe " + name, name, [text](Joint& same) { same.description = text; });
      });
}

} // namespace

void joint_inspector(Session& session, Ui& ui, const Joint& joint) {
  const Part part{PartKind::joint, joint.name};
  if (!is_of_several(ui)) name_row(session, ui, part);
  if (joint.type == JointType::gear) {
    note_row(session, ui, joint);
    return gear_rows(session, ui, joint);
  }
  type_row(session, ui, joint);
  if (joint.type == JointType::distance) {
    note_row(session, ui, joint);
    return distance_rows(session, ui, joint);
  }
  // What acts comes first: that is what one needs of every joint, in sight in a low window, too.
  coordinate_sections(session, ui, joint);
  if (!inspector_section(session, ui, "inspector/place section", "Place", true)) return;
  body_end_row(session, ui, part, joint.bodies, 0, "Parent");
  body_end_row(session, ui, part, joint.bodies, 1, "Child");
  vector_rows(session, ui, "Point",
              {.name = "inspector/at",
               .value = joint.at,
               .unit = "m",
               .help = "Where the joint is in the world, as drawn; fixed in both bodies.",
               .address = address_of(joint, "at")});
  if (has_axis(joint.type)) axis_rows(session, ui, joint);
  cut_row(session, ui, joint);
  note_row(session, ui, joint);
}

void distance_rows(Session& session, Ui& ui, const Joint& joint) {
  const Part part{PartKind::joint, joint.name};
  for (std::size_t end = 0; end < 2; ++end) {
    body_end_row(session, ui, part, joint.bodies, end, end == 0 ? "From" : "To");
    end_point_rows(session, ui, part, joint.points, end);
  }
  std::function<void()> reset;
  if (joint.length)
    reset = [&session, &ui, name = joint.name] {
      edit_joint(session, ui, "Length of " + name + " as drawn", name,
                 [](Joint& same) { same.length.reset(); });
    };
  number_row(session, ui, "Length",
             {.name = "inspector/length",
              .value = joint.length.value_or(drawn_distance(joint.points)),
              .unit = "m",
              .help = "The distance that is kept between the two points.",
              .least = Least::above_zero,
              .address = address_of(joint, "length"),
              .standard = !joint.length},
             reset);
}

} // namespace flyball
