// How a body looks: its shapes, their sizes and colours.
#include "app/render/icons.hpp"
#include "app/ui/inspector/inspector_parts.hpp"
#include "app/ui/inspector/inspector_rows.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "app/viewport/scene_list.hpp"
#include "engine/mechanism/mass_properties.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flyball {

namespace {

using Change = std::function<void(Body&, Shape&)>;

// Mass or density as before, whichever was typed last; the density where none was.
void take_again(const InspectorState& inspector, Body& body, double density) {
  const auto given = inspector.given_masses.find(body.name);
  const bool typed = given != inspector.given_masses.end();
  if (typed && given->second.mass) {
    take_uniform_mass(body, body.mass);
    return;
  }
  const bool same = typed && std::abs(given->second.density - density) <= 1e-13 * density;
  take_mass_properties(body, same ? given->second.density : density);
}

// The mass follows a shape that an expression gives, unless expressions give what would follow.
void mass_follows(const InspectorState& inspector, const std::string& name, const Mechanism& before,
                  Mechanism& next) {
  const int from = body_index(before, name), to = body_index(next, name);
  if (from < 0 || to < 0) return;
  const Body& earlier = before.bodies[static_cast<std::size_t>(from)];
  const bool given = std::ranges::any_of(earlier.formulas, [](const Formula& formula) {
    return formula.key == "mass" || formula.key.starts_with("position") || formula.key.starts_with("inertia");
  });
  const std::optional<double> density = density_of(earlier);
  if (!earlier.density && !given && density && follows_shapes(inspector, earlier))
    take_again(inspector, next.bodies[static_cast<std::size_t>(to)], *density);
}

// Edits one shape, of several bodies that of each; the mass follows where it did before.
void edit_shape(Session& session, Ui& ui, const InspectorState& inspector, const std::string& body,
                std::size_t index, const char* what, const Change& change) {
  const std::vector<std::string> names = edited_with(ui, {PartKind::body, body});
  later(ui, [=, &session, &inspector] {
    const std::string step = std::string(what) + " " + body + and_more(names.size() - 1);
    edit(session, step, [&](Mechanism& mechanism, Selection&) {
      for (Body& same : mechanism.bodies) {
        if (std::ranges::count(names, same.name) == 0 || index >= same.shapes.size()) continue;
        const bool follows = follows_shapes(inspector, same);
        const std::optional<double> density = density_of(same);
        change(same, same.shapes[index]);
        if (follows && density) take_again(inspector, same, *density);
      }
    });
  });
}

struct ShapeRows {
  Session& session;
  Ui& ui;
  InspectorState& inspector;
  const Body& body;
  std::size_t index;
  std::string name; // of the widgets

  const Shape& shape() const { return body.shapes[index]; }
  Vec3 centre() const { return shape().at.value_or(body.position); }
  std::string expression(const std::string& key) const {
    return "bodies." + body.name + ".shapes." + std::to_string(index) + "." + key;
  }
  auto follow() const {
    return [&inspector = inspector,
            bodies = edited_with(ui, {PartKind::body, body.name})](const Mechanism& before, Mechanism& next) {
      for (const std::string& each : bodies)
        mass_follows(inspector, each, before, next);
    };
  }

  void length(const std::string& label, const std::string& widget, const std::string& key, double value,
              const char* help, const std::function<void(Shape&, double)>& set) const {
    number_row(session, ui, label,
               {.name = name + "/" + widget,
                .value = value,
                .unit = "m",
                .help = help,
                .least = Least::above_zero,
                .expression = expression(key),
                .set =
                    [&session = session, &ui = ui, &inspector = inspector, body = body.name, index = index,
                     set](double typed) {
                      edit_shape(session, ui, inspector, body, index, "Size",
                                 [set, typed](Body&, Shape& s) { set(s, typed); });
                    },
                .follow = follow()});
  }

  void point(const std::string& label, const std::string& key, const Vec3& value, const char* help,
             const std::function<Vec3&(Body&, Shape&)>& place, bool standard = false) const {
    if (is_of_several(ui)) return; // each has its own
    vector_rows(session, ui, label,
                {.name = name + "/" + key,
                 .value = value,
                 .unit = "m",
                 .help = help,
                 .expression = expression(key),
                 .set =
                     [&session = session, &ui = ui, &inspector = inspector, body = body.name, index = index,
                      place](int axis, double typed) {
                       edit_shape(session, ui, inspector, body, index, "Shape",
                                  [=](Body& b, Shape& s) { place(b, s)[axis] = typed; });
                     },
                 .standard = standard,
                 .follow = follow()});
  }

  // Of a cylinder or capsule: about its middle, along its centre line.
  void length_and_axis() const {
    const Vec3 line = shape().to - shape().from;
    number_row(session, ui, "Length",
               {.name = name + "/length",
                .value = line.norm(),
                .unit = "m",
                .help = "Length of the centre line; its middle stays where it is.",
                .least = Least::above_zero,
                .set = [&session = session, &ui = ui, &inspector = inspector, body = body.name,
                        index = index](double typed) {
                  edit_shape(session, ui, inspector, body, index, "Size", [typed](Body&, Shape& s) {
                    lay_along(s, (s.to - s.from).stableNormalized(), typed);
                  });
                }});
    row_label(ui, "Axis");
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (i > 0) ImGui::SameLine(0, 3 * ui.scale);
      const bool along = line.norm() > 0 && line == Vec3(line[i] * Vec3::Unit(i));
      if (text_button(ui, name + "/along/" + axis_letters[at], axis_letters[at], along))
        edit_shape(session, ui, inspector, body.name, index, "Shape",
                   [i](Body&, Shape& s) { lay_along(s, Vec3::Unit(i), (s.to - s.from).norm()); });
      help_on_hover((std::string("Along the world's ") + axis_letters[at] + " axis, as drawn.").c_str());
    }
  }

  // About the middle of its centre line; one without length along x.
  static void lay_along(Shape& s, const Vec3& direction, double length) {
    const Vec3 middle = (s.from + s.to) / 2,
               half = length / 2 * (direction.norm() > 0 ? direction : Vec3(Vec3::UnitX()));
    s.from = middle - half;
    s.to = middle + half;
  }

  void sizes() const {
    if (shape().type == ShapeType::box) {
      constexpr std::array helps{"Edge along the body's x axis.", "Edge along the body's y axis.",
                                 "Edge along the body's z axis."};
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        length(std::string("Edge ") + axis_letters[at], std::string("size/") + axis_letters[at],
               "size." + std::to_string(i), shape().size[i], helps[at],
               [i](Shape& s, double value) { s.size[i] = value; });
      }
    } else {
      length("Radius", "radius", "radius", shape().radius, "Radius of the shape.",
             [](Shape& s, double value) { s.radius = value; });
    }
    if (shape().type == ShapeType::sphere || shape().type == ShapeType::box) {
      point(
          "Centre", "at", centre(), "Centre of the shape in the world, as drawn.",
          [](Body& b, Shape& s) -> Vec3& {
            if (!s.at) s.at = b.position;
            return *s.at;
          },
          !shape().at);
    } else {
      length_and_axis();
      point("From", "from", shape().from, "One end of the centre line in the world, as drawn.",
            [](Body&, Shape& s) -> Vec3& { return s.from; });
      point("To", "to", shape().to, "The other end of the centre line in the world, as drawn.",
            [](Body&, Shape& s) -> Vec3& { return s.to; });
    }
  }

  void swatch(int i, const std::optional<Color>& color, float side) const {
    const bool on = color ? shape().color && *shape().color == numbers(*color) : !shape().color;
    const std::string widget = name + "/color/" + (color ? std::to_string(i) : "default");
    const ImVec2 from = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton(widget.c_str(), {side, side})) {
      std::optional<std::array<double, 3>> wanted;
      if (color) wanted = numbers(*color);
      edit_shape(session, ui, inspector, body.name, index, "Colour",
                 [wanted](Body&, Shape& s) { s.color = wanted; });
    }
    note_widget(ui.widgets, widget);
    help_on_hover(color ? "Colour of the shape." : "The colour the program chooses for the body.");
    const UiColors& colors = colors_of(ui);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 to(from.x + side, from.y + side), middle((from.x + to.x) / 2, (from.y + to.y) / 2);
    if (color)
      list.AddCircleFilled(middle, 0.42f * side, packed(to_imgui(*color)));
    else
      list.AddCircle(middle, 0.38f * side, packed(colors.dim), 0, 1.5f * ui.scale);
    if (on) list.AddCircle(middle, 0.5f * side, packed(colors.accent), 0, 2 * ui.scale);
  }

  void colours() const {
    constexpr std::array palette{okabe_ito::orange, okabe_ito::sky_blue, okabe_ito::green,
                                 okabe_ito::yellow, okabe_ito::blue,     okabe_ito::vermillion,
                                 okabe_ito::purple, rgb(0x9AA3AD)};
    const float width = row_label(ui, "Colour", "How the shape is coloured; it means nothing else.");
    const float side = ImGui::GetFrameHeight() - 4 * ui.scale, gap = 3 * ui.scale;
    const int a_row = std::max(1, static_cast<int>((width + margin_width(ui) + gap) / (side + gap)));
    ImGui::BeginGroup();
    for (int i = 0; i <= static_cast<int>(palette.size()); ++i) {
      if (i % a_row != 0) ImGui::SameLine(0, gap);
      swatch(i - 1, i == 0 ? std::nullopt : std::optional(palette[static_cast<std::size_t>(i - 1)]), side);
    }
    ImGui::EndGroup();
  }

  static std::array<double, 3> numbers(const Color& color) {
    // Through bytes, so that a file has the colour as it is on screen.
    const auto part = [](float x) { return std::round(static_cast<double>(x) * 255) / 255; };
    return {part(color.r), part(color.g), part(color.b)};
  }

  void type() const {
    constexpr std::array<std::string_view, 4> types{"sphere", "box", "cylinder", "capsule"};
    const auto chosen = choice_row(ui, name + "/type", "Shape", types, static_cast<std::size_t>(shape().type),
                                   "What the body looks like.");
    if (chosen)
      edit_shape(session, ui, inspector, body.name, index, "Shape",
                 [type = static_cast<ShapeType>(*chosen)](Body& b, Shape& s) { s = shape_as(s, type, b); });
    ImGui::SameLine(0, 0);
    if (margin_button(ui, name + "/remove", icon::close, "Take this shape away; the mass stays."))
      edit_body(session, ui, "Remove a shape of " + body.name, body.name, [index = index](Body& same) {
        if (index < same.shapes.size())
          same.shapes.erase(same.shapes.begin() + static_cast<std::ptrdiff_t>(index));
      });
  }
};

void add_shape(Session& session, Ui& ui, const Body& body) {
  Shape shape;
  shape.radius = body.shapes.empty() ? 2 * scene_scale(session.mechanism()).unit : body.shapes.back().radius;
  if (!(shape.radius > 0)) shape.radius = body.shapes.back().size.maxCoeff() / 2;
  edit_body(session, ui, "Add a shape to " + body.name, body.name,
            [shape](Body& same) { same.shapes.push_back(shape); });
}

} // namespace

Shape shape_as(const Shape& shape, ShapeType type, const Body& body) {
  Shape other = shape;
  other.type = type;
  const auto is_rod = [](ShapeType t) { return t == ShapeType::cylinder || t == ShapeType::capsule; };
  if (is_rod(shape.type) && is_rod(type)) return other;
  const Quat turn = body.rotation.normalized();
  // Half the edges of a box around it, along the body's axes.
  Vec3 centre = shape.at.value_or(body.position), half = Vec3::Constant(shape.radius);
  if (shape.type == ShapeType::box) half = shape.size / 2;
  if (is_rod(shape.type)) {
    centre = (shape.from + shape.to) / 2;
    half = ((turn.conjugate() * (shape.to - shape.from)).cwiseAbs() / 2).cwiseMax(shape.radius);
  }
  int longest = 0;
  half.maxCoeff(&longest);
  if (is_rod(type)) {
    const Vec3 along = turn * (half[longest] * Vec3::Unit(longest));
    other.from = centre - along;
    other.to = centre + along;
    other.at.reset();
    other.radius = half.minCoeff();
    return other;
  }
  if (is_rod(shape.type)) other.at = centre;
  other.from = other.to = Vec3::Zero();
  other.size = type == ShapeType::box ? Vec3(2 * half) : Vec3(Vec3::Zero());
  other.radius = type == ShapeType::box ? 0 : half.minCoeff();
  return other;
}

void shapes_section(Session& session, Ui& ui, InspectorState& inspector, const Body& body) {
  const std::vector<const Body*> others = others_edited(session, ui, body);
  const auto as_this = [&](const Body* each) {
    return std::ranges::equal(each->shapes, body.shapes, {}, &Shape::type, &Shape::type);
  };
  if (!std::ranges::all_of(others, as_this)) return; // none is that of another
  if (!inspector_section(session, ui, "inspector/shapes section", "Shapes", true)) return;
  if (body.shapes.empty()) paragraph("Drawn from what is joined to it.", colors_of(ui).dim);
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    if (i > 0) ImGui::Dummy({0, 3 * ui.scale});
    const ShapeRows rows{session, ui, inspector, body, i, "inspector/shapes/" + std::to_string(i)};
    rows.type();
    rows.sizes();
    rows.colours();
  }
  if (text_button(ui, "inspector/shapes/add", "Add a shape")) add_shape(session, ui, body);
  help_on_hover("Another solid that the body looks like; its mass stays until a density is typed.");
}

} // namespace flyball
