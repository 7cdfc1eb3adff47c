// All of it without a mouse: what follows are key events only.
#include "robot.hpp"

#include "app/document/create.hpp"
#include "app/session/parameter_list.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/keyboard/focus_order.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/load_view.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/widgets/ui_style.hpp"
#include "engine/mechanism/address.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* spin_speed = "joints.spin.drive.speed";

struct Typist : Robot {
  explicit Typist(PixelSize wanted = {1280, 900}) : Robot(wanted) {}
  ~Typist() { CHECK_FALSE(ImGui::IsMousePosValid()); } // no mouse was ever there

  const std::string& at() const { return app.ui.keyboard.at; }
  // F6 until the keyboard is in the region.
  void go_to(const std::string& region) {
    for (int i = 0; i < 12 && app.ui.keyboard.region != region; ++i)
      key(keys::f6);
    INFO("region " << region << ", but in " << app.ui.keyboard.region);
    REQUIRE(app.ui.keyboard.region == region);
  }
  // Tab until it is at the widget.
  void tab_to(const std::string& name, bool back = false) {
    for (int i = 0; i < 80 && at() != name; ++i)
      key(keys::tab, false, back);
    INFO("widget " << name << ", but at " << at());
    REQUIRE(at() == name);
  }
  // Page Down until the tool's cursor is on the point.
  void cursor_to(const Vec3& point) {
    const ImVec2 wanted = pixel(point);
    const WidgetRect view = widget("view");
    const auto there = [&] {
      if (!app.tool.cursor) return false;
      const Vec2 off(app.tool.cursor->x() - static_cast<double>(wanted.x - view.from.x),
                     app.tool.cursor->y() - static_cast<double>(wanted.y - view.from.y));
      return off.norm() < 2;
    };
    for (int i = 0; i < 12 && !there(); ++i)
      key(keys::page_down);
    REQUIRE(there());
  }
};

} // namespace

TEST_CASE("by the keyboard the joint tool starts where no joint is yet, rather than on one") {
  Typist hand;
  App& app = hand.app;
  open_document(app.session, Document(shipped("governor")));
  set_mode(app.session, Mode::build);
  select(app.session, {});
  hand.frames(3);
  const auto nearest_joint = [&] {
    const WidgetRect view = hand.widget("view");
    double least = 1e9;
    for (const Joint& joint : app.session.mechanism().joints)
      for (const Vec3& point : joint.type == JointType::distance
                                   ? std::vector<Vec3>{joint.points[0], joint.points[1]}
                                   : std::vector<Vec3>{joint.at}) {
        const ImVec2 at = hand.pixel(point);
        const Vec2 off(app.tool.cursor->x() - static_cast<double>(at.x - view.from.x),
                       app.tool.cursor->y() - static_cast<double>(at.y - view.from.y));
        least = std::min(least, off.norm());
      }
    return least;
  };
  hand.key('J');
  REQUIRE(app.tool.tool == Tool::joint);
  REQUIRE(app.tool.cursor);
  CHECK(nearest_joint() > 4);
  // Of two bodies that a joint does not join yet it is where they meet, be there another's.
  hand.key(keys::escape);
  edit(app.session, "Take the arm off", [](Mechanism& next, Selection&) {
    std::erase_if(next.joints, [](const Joint& joint) { return joint.name == "arm2"; });
  });
  Selection both;
  both.parts = {{PartKind::body, "spindle"}, {PartKind::body, "ball2"}};
  select(app.session, both);
  hand.frames(2);
  hand.key('J');
  REQUIRE(app.tool.cursor);
  const WidgetRect view = hand.widget("view");
  const ImVec2 hub = hand.pixel(Vec3(0, 0.2, 0));
  CHECK(app.tool.cursor->x() == Approx(hub.x - view.from.x).margin(3));
  CHECK(app.tool.cursor->y() == Approx(hub.y - view.from.y).margin(3));
}

TEST_CASE("a pendulum is built, solved, explored and exported without one event of the mouse") {
  Typist hand;
  App& app = hand.app;
  hand.key('N', true);
  hand.key('1');
  hand.key('R', false, true);
  REQUIRE(app.tool.tool == Tool::rod);
  hand.cursor_to(Vec3::Zero());
  hand.key(keys::enter);
  REQUIRE(app.tool.first);
  hand.strike("0.5");
  hand.key(keys::enter);
  REQUIRE(app.session.mechanism().bodies.size() == 1);
  CHECK(hand.at() == "inspector/name");
  const std::string rod = app.session.mechanism().bodies[0].name;

  hand.key('B', false, true);
  hand.cursor_to(Vec3(0.5, 0, 0));
  for (int i = 0; i < 6; ++i)
    hand.key(keys::down);
  hand.strike("0.03");
  hand.key(keys::enter);
  REQUIRE(app.session.mechanism().bodies.size() == 2);
  const Body& ball = app.session.mechanism().bodies[1];
  CHECK(ball.position.x() == Approx(0.5).margin(0.02));
  CHECK(ball.position.y() < -0.05);

  hand.key('A', true);
  hand.key('J');
  hand.cursor_to(Vec3(0.5, 0, 0));
  hand.key(keys::enter);
  REQUIRE(app.tool.joint);
  CHECK(hand.at() == "tools/join");
  hand.key(keys::enter);
  REQUIRE(app.session.mechanism().joints.size() == 1);

  hand.key('J');
  hand.cursor_to(Vec3::Zero());
  hand.key(keys::enter);
  REQUIRE(app.tool.joint);
  CHECK(app.tool.joint->bodies == std::array<std::string, 2>{std::string(ground_name), rod});
  hand.tab_to("tools/axis/y", true);
  hand.key(' ');
  hand.tab_to("tools/join");
  hand.key(keys::enter);
  REQUIRE(app.session.mechanism().joints.size() == 2);
  const Joint& hub = app.session.mechanism().joints[1];
  CHECK(hub.axis.normalized().isApprox(Vec3::UnitY()));
  const std::string speed = "joints." + hub.name + ".drive.speed";
  CHECK(hand.at() == "inspector/name");
  hand.tab_to("inspector/drive");
  hand.key(' ');
  REQUIRE_NOTHROW(get_parameter(app.session.mechanism(), speed));
  for (const SceneError& mistake : app.session.mistakes)
    FAIL_CHECK(mistake.what());
  REQUIRE(app.session.mistakes.empty());

  hand.key(keys::escape);
  CHECK(hand.at().empty());
  hand.key(keys::tab);
  REQUIRE(app.session.mode == Mode::explore);
  hand.frames(2);
  REQUIRE(converged(app.session));
  const double drawn_speed = get_parameter(app.session.mechanism(), speed);
  const std::uint64_t answer = app.session.answer.ticket;
  hand.go_to("parameters");
  hand.tab_to("parameters/" + speed);
  hand.key(keys::right);
  hand.key(keys::right, true);
  CHECK(get_parameter(app.session.mechanism(), speed) > drawn_speed);
  hand.frames(2);
  CHECK(app.session.answer.ticket > answer);
  CHECK(converged(app.session));

  hand.key('C');
  hand.frames(3);
  REQUIRE(app.session.study.open == StudyKind::response);
  CHECK(app.session.study.response.curve.found);

  hand.key('E', true);
  hand.frames(2);
  REQUIRE(app.dialog.showing);
  hand.tab_to("export/save");
  hand.key(keys::enter);
  hand.frames(2);
  CHECK(app.export_request);
  CHECK_FALSE(app.dialog.showing);
}

TEST_CASE("points that lie behind one another in the picture are gone to one by one") {
  Typist hand;
  App& app = hand.app;
  hand.key('N', true);
  edit(app.session, "Add rod", [](Mechanism& next, Selection& selection) {
    add_body(next, {.form = BodyForm::rod, .radius = 0.01, .from = {-0.2, 0, 0}, .to = {0.4, 0, 0}});
    selection.set({});
  });
  hand.frames(2);
  hand.key('2'); // along the rod
  hand.frames(60);
  hand.key('J');
  std::set<double> met;
  for (int i = 0; i < 8; ++i) {
    hand.key(keys::page_down);
    hand.frames(1);
    met.insert(std::round(1000 * app.tool.caches.aim.point.x()));
  }
  CHECK(met == std::set<double>{-200, 0, 100, 400}); // both ends, the centre and the origin
  for (int i = 0; i < 8 && app.tool.caches.aim.point.x() > -0.199; ++i) {
    hand.key(keys::page_up);
    hand.frames(1);
  }
  hand.key(keys::enter);
  REQUIRE(app.tool.joint);
  CHECK(app.tool.joint->at == Vec3(-0.2, 0, 0));
}

TEST_CASE("Tab reaches every field and button of the inspector, in reading order and in sight") {
  Typist hand({1280, 700});
  App& app = hand.app;
  const Part part = GENERATE(Part{PartKind::body, "ball1"}, Part{PartKind::joint, "slide"});
  set_mode(app.session, Mode::build);
  select(app.session, {{part}});
  hand.frames(3);
  std::vector<std::string> wanted;
  for (const KeyStop& stop : app.ui.widgets.stops)
    if (region_of(stop) == "inspector" && stop.use != KeyUse::aside) wanted.push_back(stop.name);
  REQUIRE(wanted.size() > 8);
  hand.go_to("inspector");
  hand.key(keys::tab);
  const auto first = std::ranges::find(wanted, hand.at());
  REQUIRE(first != wanted.end());
  std::rotate(wanted.begin(), first, wanted.end());
  for (const std::string& name : wanted) {
    CHECK(hand.at() == name);
    const auto seen = app.ui.widgets.find(name);
    INFO(name);
    REQUIRE(seen != app.ui.widgets.end());
    CHECK(seen->second.to.y - seen->second.from.y > 8);
    const KeyStop* stop = stop_named(app.ui.widgets.stops, name);
    REQUIRE(stop);
    CHECK(ImGui::GetIO().WantTextInput == (stop->use == KeyUse::type));
    hand.key(keys::tab);
  }
  CHECK(hand.at() == wanted.front()); // and round again
  hand.key(keys::tab, false, true);
  CHECK(hand.at() == wanted.back());
}

TEST_CASE("what is typed goes into the field that Tab reaches, from the first character on") {
  Typist hand;
  App& app = hand.app;
  set_mode(app.session, Mode::build);
  select(app.session, {{{PartKind::body, "ball1"}}});
  hand.frames(3);
  hand.go_to("inspector");
  hand.tab_to("inspector/mass");
  hand.strike("2");
  hand.key(keys::tab);
  hand.frames(2);
  CHECK(app.session.mechanism().bodies[1].mass == 2);
  CHECK(hand.at() != "inspector/mass");
  // With Enter the field keeps the keys, and digits begin to type in it again.
  hand.tab_to("inspector/mass", true);
  hand.strike("3");
  hand.key(keys::enter);
  hand.frames(2);
  CHECK(app.session.mechanism().bodies[1].mass == 3);
  CHECK(hand.at() == "inspector/mass");
  hand.strike("45");
  hand.key(keys::enter);
  hand.frames(2);
  CHECK(app.session.mechanism().bodies[1].mass == 45);
  hand.key('L', true);
  hand.frames(2);
  CHECK(std::ranges::any_of(app.session.mechanism().sliders,
                            [](const Slider& slider) { return slider.parameter == "bodies.ball1.mass"; }));
}

TEST_CASE("Alt opens the menus, arrows go through them, and Escape gives the keys back") {
  Typist hand;
  App& app = hand.app;
  hand.go_to("parameters");
  const std::string before = hand.at();
  REQUIRE_FALSE(before.empty());
  hand.alt();
  REQUIRE(app.ui.widgets.contains("menu/file.new"));
  CHECK(hand.at() == "menu/file.new");
  hand.key(keys::down);
  CHECK(hand.at() == "menu/file.open");
  hand.key(keys::right);
  hand.frames(2);
  REQUIRE(app.ui.widgets.contains("menu/edit.all"));
  CHECK_FALSE(app.ui.widgets.contains("menu/file.new"));
  hand.key(keys::left);
  hand.key(keys::left);
  hand.frames(2);
  REQUIRE(app.ui.widgets.contains("menu/help.palette"));
  hand.key(keys::escape);
  hand.frames(2);
  CHECK_FALSE(app.ui.widgets.contains("menu/help.palette"));
  CHECK(hand.at() == before);

  hand.alt('S');
  hand.frames(2);
  for (int i = 0; i < 9 && hand.at() != "menu/study.response"; ++i)
    hand.key(keys::down);
  hand.key(keys::enter);
  hand.frames(3);
  CHECK(app.session.study.open == StudyKind::response);
  CHECK_FALSE(app.ui.widgets.contains("menu/study.response"));
  hand.alt();
  REQUIRE(app.ui.widgets.contains("menu/file.new"));
  hand.alt();
  hand.frames(2);
  CHECK_FALSE(app.ui.widgets.contains("menu/file.new"));
}

TEST_CASE("a slider by keys: steps, fine, coarse, its ends, and a typed number") {
  Typist hand;
  App& app = hand.app;
  hand.go_to("parameters");
  hand.tab_to(std::string("parameters/") + spin_speed);
  const auto value = [&] { return get_parameter(app.session.mechanism(), spin_speed); };
  const double stored = value();
  hand.key(keys::right);
  const double one = value();
  CHECK(one > stored);
  hand.key(keys::right, false, true);
  CHECK(value() - one == Approx((one - stored) / 10).epsilon(0.6));
  CHECK(value() > one);
  const double before = value();
  hand.key(keys::right, true);
  CHECK(value() - before > 5 * (one - stored));
  hand.key(keys::left);
  CHECK(value() < before + 11 * (one - stored));
  CHECK(app.session.document.position() == 1); // all of it was one movement
  hand.key(keys::home);
  CHECK(value() == 0);
  hand.key(keys::end);
  CHECK(value() == 30);
  hand.strike("15");
  hand.frames(2);
  REQUIRE(app.ui.fields.typing.name == std::string("parameters/") + spin_speed + "/value");
  hand.key(keys::enter);
  hand.frames(2);
  CHECK(value() == 15);
  CHECK(app.session.mode == Mode::explore);
}

TEST_CASE("after a drag of a slider with the mouse Tab is the mode again") {
  Robot hand({1280, 900});
  App& app = hand.app;
  const double stored = get_parameter(app.session.mechanism(), spin_speed);
  hand.drag(std::string("parameters/") + spin_speed, {0.4f, 0.5f}, {0.6f, 0.5f});
  hand.frames(2);
  REQUIRE(get_parameter(app.session.mechanism(), spin_speed) != stored);
  hand.point(hand.widget("view").center());
  hand.key(keys::tab);
  CHECK(app.session.mode == Mode::build);
}

TEST_CASE("when the panel's contents change under the keys they come to no button") {
  Robot robot({1280, 900});
  App& app = robot.app;
  set_mode(app.session, Mode::build);
  robot.frames(3);
  const auto field = std::ranges::find_if(app.ui.widgets.stops, [](const KeyStop& stop) {
    return stop.use == KeyUse::type && stop.name.starts_with("inspector/");
  });
  REQUIRE(field != app.ui.widgets.stops.end());
  focus_widget(app.ui, field->name);
  robot.frames(6);
  REQUIRE(app.ui.keyboard.ring);
  app.commands.run("edit.all"); // the inspector is of all parts now, and begins with what deletes them
  robot.frames(20);
  const std::size_t bodies = app.session.mechanism().bodies.size();
  robot.key(' ');
  robot.key(key_enter);
  robot.frames(3);
  CHECK(app.session.mechanism().bodies.size() == bodies);
}

TEST_CASE("a plot's dot goes along its curve by arrows, and plus zooms about it") {
  Typist hand;
  App& app = hand.app;
  hand.key('C');
  hand.frames(4);
  REQUIRE(app.session.study.response.curve.found);
  hand.go_to("study");
  hand.tab_to("plot/response/area");
  const double before = get_parameter(app.session.mechanism(), spin_speed);
  hand.key(keys::right);
  hand.key(keys::right);
  hand.frames(2);
  CHECK(get_parameter(app.session.mechanism(), spin_speed) > before);
  CHECK(converged(app.session));
  hand.key('=');
  CHECK(app.panels->studies.shown().response.view.look.range[0]);
  hand.key(keys::home);
  CHECK_FALSE(app.panels->studies.shown().response.view.look.range[0]);
  // The context menu, and back.
  hand.key(keys::f10, false, true);
  hand.frames(2);
  REQUIRE(app.ui.widgets.contains("plot/response/menu/csv"));
  hand.key(keys::escape);
  hand.frames(2);
  CHECK_FALSE(app.ui.widgets.contains("plot/response/menu/csv"));
  CHECK(hand.at() == "plot/response/area");
}

TEST_CASE("the outline is gone through by arrows, which choose the parts") {
  Typist hand;
  App& app = hand.app;
  set_mode(app.session, Mode::build);
  hand.frames(3);
  hand.go_to("outline");
  hand.tab_to("outline/bodies/spindle");
  hand.key(keys::down);
  hand.frames(2);
  CHECK(app.session.selection().parts ==
        std::vector{Part{PartKind::body, app.session.mechanism().bodies[1].name}});
  hand.key(keys::f2); // rename, a command of the part
  hand.frames(2);
  CHECK_FALSE(app.ui.fields.typing.name.empty());
}

TEST_CASE("F6 goes round all regions, and Tab in the view goes on switching Build and Explore") {
  Typist hand;
  App& app = hand.app;
  std::set<std::string> seen;
  for (int i = 0; i < 12; ++i) {
    hand.key(keys::f6);
    seen.insert(app.ui.keyboard.region);
  }
  for (const char* region : {"toolbar", "parameters", "view", "results"})
    CHECK(seen.contains(region));
  hand.go_to("view");
  hand.key(keys::tab);
  CHECK(app.session.mode == Mode::build);
  hand.key(keys::tab);
  CHECK(app.session.mode == Mode::explore);
  const double azimuth = app.view.camera.azimuth, distance = app.view.camera.distance;
  hand.key(keys::right);
  CHECK(app.view.camera.azimuth != azimuth);
  hand.key('+');
  CHECK(app.view.camera.distance < distance);
}

TEST_CASE("free-body diagrams are gone through by Page Down and Page Up in the view") {
  Typist hand;
  App& app = hand.app;
  const std::vector<Body>& bodies = app.session.mechanism().bodies;
  const auto chosen = [&] {
    const std::vector<Part>& parts = app.session.selection().parts;
    return parts.size() == 1 && parts.front().kind == PartKind::body ? parts.front().name : std::string();
  };
  hand.key('A');
  for (const Body& body : bodies) {
    hand.key(keys::page_down);
    hand.frames(2);
    CHECK(chosen() == body.name);
    CHECK(shows_diagram(app.view));
  }
  hand.key(keys::page_down);
  CHECK(chosen() == bodies.front().name); // round
  hand.key(keys::page_up);
  CHECK(chosen() == bodies.back().name);
  hand.key(key_escape);
  hand.frames(2);
  CHECK(app.session.selection().parts.empty());
  CHECK_FALSE(shows_diagram(app.view));
}

TEST_CASE("the tabs of the studies are one stop, the open one, and arrows go along them") {
  Typist hand;
  App& app = hand.app;
  hand.key('C');
  hand.frames(3);
  REQUIRE(app.session.study.open == StudyKind::response);
  hand.go_to("study");
  CHECK(hand.at() == "study/response");
  hand.key(keys::tab);
  CHECK_FALSE(hand.at() == "study/states");
  hand.key(keys::tab, false, true);
  CHECK(hand.at() == "study/response");
  hand.key(keys::right);
  CHECK(hand.at() == "study/states");
  hand.key(keys::right);
  CHECK(hand.at() == "study/modes");
  CHECK(app.session.study.open == StudyKind::response); // Enter opens
  hand.key(key_enter);
  hand.frames(2);
  CHECK(app.session.study.open == StudyKind::modes);
  CHECK(hand.at() == "study/modes");
}

TEST_CASE("a dialog keeps the keys to itself and gives them back") {
  Typist hand;
  App& app = hand.app;
  hand.go_to("parameters");
  const std::string before = hand.at();
  hand.key('E', true);
  hand.frames(3);
  REQUIRE(app.dialog.showing);
  std::set<std::string> seen;
  for (int i = 0; i < 20; ++i) {
    hand.key(keys::tab);
    seen.insert(hand.at());
  }
  for (const std::string& name : seen) {
    INFO(name);
    CHECK(name.starts_with("export/"));
  }
  for (const char* name : {"export/save", "export/cancel", "export/panels", "export/width"})
    CHECK(seen.contains(name));
  hand.tab_to("export/cancel");
  hand.key(keys::enter);
  hand.frames(3);
  CHECK_FALSE(app.dialog.showing);
  CHECK_FALSE(app.export_request);
  CHECK(hand.at() == before);
}

TEST_CASE("the ring is seen in every theme, and a click takes it away") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.ui.theme = GENERATE(Theme::light, Theme::dark, Theme::high_contrast);
  apply_style(app.ui.theme, app.ui.scale);
  focus_widget(app.ui, "parameters/restart");
  robot.frames(3);
  const auto count = [&] {
    const ImVec4 wanted = ui_colors(app.ui.theme).focus;
    const Image image = robot.picture();
    int pixels = 0;
    const auto near = [](std::uint8_t byte, float part) {
      return std::abs(static_cast<float>(byte) - 255 * part) < 3;
    };
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.at(x, y);
        if (near(p[0], wanted.x) && near(p[1], wanted.y) && near(p[2], wanted.z)) ++pixels;
      }
    return pixels;
  };
  const WidgetRect rect = robot.widget("parameters/restart");
  const int ring = count();
  CHECK(static_cast<float>(ring) > 2 * (rect.to.x - rect.from.x)); // two lines along it, and its sides
  robot.click(ImVec2{robot.widget("view").from.x + 60, robot.widget("view").center().y});
  robot.frames(2);
  CHECK(count() < ring / 10);
}

TEST_CASE("every command is in a menu of the bar") {
  for (const Command& command : commands()) {
    const std::string id = command.id;
    const auto titles = menu_titles();
    INFO(id);
    CHECK(std::ranges::any_of(titles, [&](std::string_view title) {
      return std::ranges::equal(id.substr(0, id.find('.')), title, [](char a, char b) {
        return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
      });
    }));
  }
}
