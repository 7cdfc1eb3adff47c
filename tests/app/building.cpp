#include "building.hpp"

#include "app/ui/commands.hpp"
#include "app/ui/layout.hpp"
#include "tests/catch.hpp"

namespace flyball::test {

namespace {

class Builder {
 public:
  Builder(Robot& robot, const OnStep& on_step) : robot_(robot), on_step_(on_step) {}

  // An empty document, from the front, with about `height` (m) of it in view.
  void begin(double height) {
    robot_.key('N', true);
    robot_.key('1');
    step("empty");
    robot_.key('R', false, true); // the first steps make room
    for (int i = 0; i < 60 && view_height() > height; ++i)
      robot_.wheel("view", 1);
    for (int i = 0; i < 60 && view_height() < 0.9 * height; ++i)
      robot_.wheel("view", -1);
  }

  void step(const std::string& name) {
    if (on_step_) on_step_(name);
  }

  void click_at(const Vec3& world) { robot_.click_at(world); }
  void click(const std::string& name) {
    reveal(name);
    robot_.click(name);
  }
  // The hand is at work in the view again, where letters are commands.
  void key(int code, bool ctrl = false, bool shift = false) {
    robot_.point(robot_.widget("view").center());
    robot_.key(code, ctrl, shift);
  }

  // Types into a field of the inspector.
  void fill(const std::string& field, const std::string& text) {
    click("inspector/" + field);
    robot_.key('A', true);
    robot_.type(text);
    robot_.key(key_enter);
  }
  void tick(const std::string& box) { click("inspector/" + box); }
  void mass_and_inertia(const std::string& mass, const std::string& xx, const std::string& yy,
                        const std::string& zz) {
    fill("mass", mass);
    fill("inertia/xx", xx);
    fill("inertia/yy", yy);
    fill("inertia/zz", zz);
  }

  void rod(const Vec3& from, const Vec3& to, const std::string& name) {
    key('R', false, true);
    click_at(from);
    click_at(to);
    fill("name", name);
  }
  void ball(const Vec3& at, const std::string& name) {
    key('B', false, true);
    click_at(at);
    fill("name", name);
  }
  void choose(const std::string& combo, const std::string& item) {
    click(combo);
    robot_.click(combo + "/" + item);
  }
  // At a point where both bodies are.
  void joint(const Vec3& at, const std::string& parent, const std::string& child, const std::string& type,
             const std::string& axis, const std::string& name) {
    key('J');
    click_at(at);
    REQUIRE(robot_.app.tool.joint);
    if (robot_.app.tool.joint->bodies[0] != parent) choose("tools/parent", parent);
    if (robot_.app.tool.joint->bodies[1] != child) choose("tools/child", child);
    click("tools/type/" + type);
    if (!axis.empty()) click("tools/axis/" + axis);
    step("joining " + name);
    click("tools/join");
    fill("name", name);
  }

 private:
  double view_height() {
    const ViewCamera& camera = robot_.app.view.camera;
    return 2 * camera.distance * std::tan(camera.field_of_view / 2);
  }

  // Scrolls the inspector until the field can be seen as a whole.
  void reveal(const std::string& name) {
    if (!name.starts_with("inspector/")) return;
    const PanelRect panel =
        layout_of(robot_.app, static_cast<float>(robot_.size.width), static_cast<float>(robot_.size.height))
            .inspector;
    const auto seen = [&] {
      const auto found = robot_.app.ui.widgets.find(name); // what of it can be seen
      return found != robot_.app.ui.widgets.end() && found->second.to.y - found->second.from.y >= 16;
    };
    for (const float notches : {20.f, -1.f})
      for (int i = 0; i < 40 && !seen(); ++i) {
        robot_.point({panel.x + panel.width - 12, panel.y + panel.height / 2});
        ImGui::GetIO().MouseWheel = notches;
        robot_.frames(2);
      }
  }

  Robot& robot_;
  const OnStep& on_step_;
};

} // namespace

void build_pendulum(Robot& robot, const OnStep& on_step) {
  Builder b(robot, on_step);
  b.begin(5.8);
  b.click("inspector/gravity/none");

  b.rod({0, 0, 0}, {1, 0, 0}, "crank");
  b.mass_and_inertia("1", "0", "0.1", "0.1");
  b.rod({1, 0, 0}, {2.4, 0, 0}, "arm");
  b.mass_and_inertia("0", "0", "0", "0");
  b.ball({2.1, 0, 0}, "weight");
  b.mass_and_inertia("1", "0", "0", "0");

  b.joint({0, 0, 0}, "ground", "crank", "revolute", "z", "spin");
  b.tick("drive");
  b.fill("drive/speed", "20 rad/s");
  b.joint({1, 0, 0}, "crank", "arm", "revolute", "z", "theta");
  b.tick("spring");
  b.fill("spring/stiffness", "300");
  b.fill("spring/free", "1.0472 rad");
  b.tick("damper");
  b.fill("damping", "10");
  b.joint({2.1, 0, 0}, "arm", "weight", "prismatic", "x", "d");
  b.fill("coordinate", "1.1");
  b.tick("spring");
  b.fill("spring/stiffness", "50 kN/m");
  b.fill("spring/free", "1");
  b.tick("damper");
  b.fill("damping", "100");
  b.key(keys::tab);
  b.step("explored");
}

void build_governor(Robot& robot, const OnStep& on_step) {
  Builder b(robot, on_step);
  b.begin(0.5);

  b.rod({0, -0.06, 0}, {0, 0.22, 0}, "spindle");
  b.rod({0, 0.2, 0}, {-0.16, 0.2, 0}, "arm1");
  b.mass_and_inertia("0", "0", "0", "0");
  b.ball({-0.16, 0.2, 0}, "ball1");
  b.fill("mass", "1");
  b.step("bodies");
  b.key('K', false, true);
  b.click_at({0, 0.1, 0});
  b.fill("name", "collar");
  b.fill("position/y", "0.1256");
  b.fill("mass", "1");

  b.joint({0, 0, 0}, "ground", "spindle", "revolute", "y", "spin");
  b.tick("drive");
  b.fill("drive/speed", "11.0174");
  b.step("drive");
  b.joint({0, 0.2, 0}, "spindle", "arm1", "revolute", "z", "hinge1");
  b.joint({-0.16, 0.2, 0}, "arm1", "ball1", "fixed", "", "weld1");
  b.joint({0, 0.1256, 0}, "spindle", "collar", "prismatic", "y", "slide");
  b.fill("axis/y", "-1");
  b.fill("coordinate", "0.2 - 0.1256");
  b.tick("spring");
  b.fill("spring/stiffness", "1000");
  b.fill("spring/free", "150 mm");
  b.tick("damper");
  b.fill("damping", "30");
  b.key('L');
  b.click_at({-0.08, 0.2, 0});
  b.click_at({0, 0.1256, 0});
  b.fill("name", "link1");
  b.fill("length", "0.10922");
  b.step("one arm");

  b.click("outline/bodies/arm1");
  robot.hold(true, false);
  b.click("outline/bodies/ball1");
  robot.hold(false, false);
  b.key('M', true);
  robot.frames(3);
  b.step("mirror");
  b.click("mirror/ok");
  b.step("mirrored");
  b.key(keys::escape);
  b.key(keys::tab);
  b.step("explored");
}

} // namespace flyball::test
