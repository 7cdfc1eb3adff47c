// Arrows of what acts, in the view: shown and taken away by a key, read with the mouse, exported.
#include "app/document/document.hpp"
#include "app/document/formula_edits.hpp"
#include "app/session/motion.hpp"
#include "app/session/periodic.hpp"
#include "app/ui/camera_glide.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/load_view.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/panels/legend.hpp"
#include "app/ui/shown_scene.hpp"
#include "app/ui/snapshot.hpp"
#include "app/ui/view_frame.hpp"
#include "engine/mechanism/scene.hpp"
#include "robot.hpp"
#include "slider_crank.hpp"
#include "temporary_folder.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

// How many pixels of the view differ.
int differing(const Robot& robot, const Image& a, const Image& b) {
  const WidgetRect view = robot.app.ui.widgets.at("view");
  int count = 0;
  for (int y = static_cast<int>(view.from.y); y < static_cast<int>(view.to.y); ++y)
    for (int x = static_cast<int>(view.from.x); x < static_cast<int>(view.to.x); ++x)
      if (!std::equal(a.at(x, y), a.at(x, y) + 4, b.at(x, y))) ++count;
  return count;
}

bool has_row(App& app, const std::string& words) {
  return std::ranges::any_of(legend_rows(app.context()), [&](const LegendRow& row) {
    return row.words.find(words) != std::string::npos;
  });
}

} // namespace

TEST_CASE("a key shows what acts, and takes it away again") {
  Robot robot;
  App& app = robot.app;
  robot.point({1, 1});
  const Image before = robot.picture();
  CHECK_FALSE(has_row(app, "reactions"));
  robot.key('A');
  CHECK(app.view.loads);
  const Image with = robot.picture();
  CHECK(differing(robot, before, with) > 1500);
  CHECK(has_row(app, "reactions, up to 1991 N"));
  CHECK(has_row(app, "inertial loads, up to"));
  // Beside the shaft's weight hardly anything could be seen in proportion.
  CHECK(has_row(app, "eight times as much"));
  CHECK_FALSE(has_row(app, "not drawn"));
  // So it stays while a slider is held.
  const auto lengths = [&] { return view_frame(app.session, app.ui, app.tool, app.view).load_lengths; };
  CHECK_FALSE(lengths());
  app.ui.slider_press.dragging = true;
  CHECK(lengths() == LoadLengths::by_cube_root);
  app.ui.slider_press.dragging = false;
  const std::vector<LegendRow> rows = legend_rows(app.context());
  const auto row = std::ranges::find_if(rows, [](const LegendRow& each) { return each.chooses.has_value(); });
  REQUIRE(row != rows.end());
  robot.click("legend/" + std::to_string(row - rows.begin()));
  robot.point({1, 1});
  robot.frames(2);
  CHECK(app.view.load_lengths == LoadLengths::in_proportion);
  CHECK(has_row(app, "N not drawn"));
  CHECK(differing(robot, with, robot.picture()) > 1000);
  app.commands.run("view.loads_by_root");
  robot.frames(2);
  CHECK(has_row(app, "eight times as much"));
  robot.key('A');
  CHECK(differing(robot, before, robot.picture()) == 0);
  CHECK_FALSE(has_row(app, "reactions"));
  robot.key(' ', true); // no other key does
  CHECK_FALSE(app.view.loads);
}

TEST_CASE("with a body selected the arrows are its free-body diagram, with values beside them") {
  Robot robot({1280, 900});
  App& app = robot.app;
  robot.key('A');
  select(app.session, {{Part{PartKind::body, "ball1"}}});
  robot.frames(2);
  CHECK(has_row(app, "Free body: ball1"));
  CHECK_FALSE(app.commands.enabled(command("view.loads_by_root"))); // always in proportion
  const ViewScene& scene = *shown_scene(app.context());
  CHECK(std::ranges::count(scene.loads, LoadKind::weight, &Load::kind) == 1);
  for (const Instance& instance : scene.free_body)
    CHECK(instance.part == find_part(app.session.mechanism(), {PartKind::body, "ball1"}));
  CHECK(!scene.free_body.empty());
  CHECK(scene.others.size() > scene.free_body.size());
  CHECK(scene.drawn.empty());
  std::vector<WidgetRect> labels;
  for (const auto& [name, rect] : app.ui.widgets)
    if (name.starts_with("load/")) labels.push_back(rect);
  CHECK(labels.size() >= 4); // weight, inertial load, hinge, link
  CHECK(app.ui.widgets.count("load/weight/force") == 1);
  CHECK(app.ui.widgets.count("load/arm1/force") == 1);
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const bool apart = labels[i].to.x <= labels[k].from.x || labels[k].to.x <= labels[i].from.x ||
                         labels[i].to.y <= labels[k].from.y || labels[k].to.y <= labels[i].from.y;
      CHECK(apart);
    }
  // A faded body can be picked: its diagram takes the place of the first.
  robot.click_at(
      app.session.poses[static_cast<std::size_t>(body_index(app.session.mechanism(), "ball2"))].position);
  CHECK(has_row(app, "Free body: ball2"));
}

TEST_CASE("the legend goes where it hides fewer arrows, and does not jump while the view is turned") {
  Robot robot;
  App& app = robot.app;
  const auto middle = [&](const char* widget) {
    const WidgetRect at = app.ui.widgets.at(widget);
    return (at.from.y + at.to.y) / 2;
  };
  CHECK(middle("legend") > middle("view")); // a ball of the drawn pose stands in the upper corner
  robot.key('A');
  robot.frames(2);
  app.view.camera.target.x() -= 0.12; // what the shaft's bearing gives stands in the corner then
  robot.frames(2);
  CHECK(middle("legend") > middle("view"));
  const WidgetRect view = app.ui.widgets.at("view");
  robot.point({view.from.x + 20, view.from.y + 120});
  robot.press();
  look_from(app.view, 0, 1.57);
  robot.frames(2);
  app.view.camera.target -= Vec3(0.2, 0, 0.3); // the mechanism into the lower corner
  robot.frames(2);
  CHECK(middle("legend") > middle("view"));
  robot.release();
  robot.frames(2);
  CHECK(middle("legend") < middle("view"));
  robot.key('A');
  robot.frames(2);
  CHECK(middle("legend") < middle("view"));
}

TEST_CASE("what is explored, the legend and a notice stand clear of each other, and of the view cube") {
  const PixelSize window = GENERATE(PixelSize{900, 600}, PixelSize{1280, 800}, PixelSize{640, 480});
  Robot robot(window);
  App& app = robot.app;
  robot.key('A');
  change_parameter(app.session, "joints.slide.damping", 14.2857142857);
  robot.frames(2);
  app.session.notice = "Undone: Delete the joint slide";
  robot.frames(2);
  const std::map<std::string, WidgetRect, std::less<>>& all = app.ui.widgets;
  const std::array names{"explored", "legend frame", "notice", "status"};
  for (const char* one : names)
    for (const char* other : names) {
      if (std::string_view(one) >= other || !all.contains(one) || !all.contains(other)) continue;
      INFO(one << " and " << other);
      const WidgetRect &a = all.at(one), &b = all.at(other);
      CHECK((a.to.x <= b.from.x || b.to.x <= a.from.x || a.to.y <= b.from.y || b.to.y <= a.from.y));
    }
  REQUIRE(all.contains("explored"));
  CHECK(all.at("explored").from.x >= all.at("view").from.x + 90);
}

TEST_CASE("arrows that come are taken into the view, unless a part is looked at") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.view.ghost = false; // which takes room of its own
  robot.key('F');
  robot.frames(30, 0.04);
  app.view.camera.distance *= 0.85; // as near as all bodies are still in view
  const double drawn_from = app.view.camera.distance;
  const auto all_seen = [&] {
    return std::ranges::all_of(shown_scene(app.context())->arrows.arrows, [&](const LoadArrow& arrow) {
      const auto at = app.view.camera.project(arrow.to, app.view.size);
      return at && at->x() > 0 && at->y() > 0 && at->x() < app.view.size.width &&
             at->y() < app.view.size.height;
    });
  };
  robot.key('A');
  robot.frames(30, 0.04);
  REQUIRE(shown_scene(app.context())->arrows.arrows.size() > 4);
  CHECK(all_seen());
  CHECK(app.view.camera.distance > drawn_from);
  robot.key('A');
  robot.frames(30, 0.04);
  CHECK(app.view.camera.distance == drawn_from);
  app.view.camera.distance /= 4; // near to it
  const ViewCamera before = app.view.camera;
  robot.key('A');
  robot.frames(30, 0.04);
  CHECK(app.view.camera.distance == before.distance);
}

TEST_CASE("arrows of a body that is selected later are taken into the view, too") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.view.ghost = false;
  open_document(app.session, Document(shipped("governor_watt")));
  robot.frames(3);
  robot.key('F');
  robot.frames(30, 0.04);
  app.view.camera.distance *= 0.9;
  const double drawn_from = app.view.camera.distance;
  const auto out_of_view = [&] {
    return std::ranges::count_if(shown_scene(app.context())->arrows.arrows, [&](const LoadArrow& arrow) {
      const auto at = app.view.camera.project(arrow.to, app.view.size);
      return !at || at->x() < 0 || at->y() < 0 || at->x() > app.view.size.width ||
             at->y() > app.view.size.height;
    });
  };
  robot.key('A');
  robot.frames(30, 0.04);
  for (const char* body : {"ball1", "ball2", "sleeve"}) {
    CAPTURE(body);
    REQUIRE(body_index(app.session.mechanism(), body) >= 0);
    select(app.session, {{{PartKind::body, body}}});
    robot.frames(30, 0.04);
    CHECK(out_of_view() == 0);
  }
  CHECK(app.view.camera.distance > drawn_from);
  select(app.session, {});
  robot.frames(30, 0.04);
  robot.key('A');
  robot.frames(30, 0.04);
  CHECK(app.view.camera.distance == Approx(drawn_from));
}

TEST_CASE("an arrow that is pointed at tells what it is") {
  Robot robot({1280, 900});
  App& app = robot.app;
  robot.key('A');
  const ViewScene& scene = *shown_scene(app.context());
  const auto arrow = std::ranges::find_if(scene.arrows.arrows, [&](const LoadArrow& each) {
    return scene.loads[each.load].kind == LoadKind::inertia && !scene.loads[each.load].moment;
  });
  REQUIRE(arrow != scene.arrows.arrows.end());
  robot.point_at(0.2 * arrow->from + 0.8 * arrow->to);
  robot.frames(2);
  CHECK(app.ui.widgets.count("load/pointed") == 1);
  robot.key('A');
  CHECK(app.ui.widgets.count("load/pointed") == 0);
}

TEST_CASE("a reaction that is one of many says so when it is pointed at") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_scene(app.session, FLYBALL_CASES "/reactions_nonunique_by_joint.json");
  robot.frames(3);
  REQUIRE(app.session.answer.solution.reactions_nonunique);
  robot.key('A');
  const ViewScene& scene = *shown_scene(app.context());
  int told = 0;
  for (const LoadArrow& arrow : scene.arrows.arrows) {
    robot.point_at(0.2 * arrow.from + 0.8 * arrow.to);
    robot.frames(2);
    told += static_cast<int>(app.ui.widgets.count("load/nonunique"));
  }
  CHECK(told > 0);
  CHECK(told < static_cast<int>(scene.arrows.arrows.size())); // the other joint's is the only one
}

TEST_CASE("forces in the plane of a linkage are the only ones possible, and their arrows say nothing else") {
  Robot robot({1280, 900});
  App& app = robot.app;
  open_scene(app.session, shipped_file("fourbar_turntable"));
  robot.frames(3);
  REQUIRE(app.session.answer.solution.reactions_nonunique);
  robot.key('A');
  int pointed = 0;
  for (const LoadArrow& arrow : shown_scene(app.context())->arrows.arrows) {
    robot.point_at(0.2 * arrow.from + 0.8 * arrow.to);
    robot.frames(2);
    pointed += static_cast<int>(app.ui.widgets.count("load/pointed"));
    CHECK(app.ui.widgets.count("load/nonunique") == 0);
  }
  CHECK(pointed > 4);
}

TEST_CASE("arrows turn along where that is exact, and the legend says where they cannot") {
  Robot robot;
  App& app = robot.app;
  robot.key('A');
  const auto reaction = [&] {
    for (const Load& load : shown_scene(app.context())->loads)
      if (load.kind == LoadKind::inertia && !load.moment && load.vector.norm() > 1) return load.vector;
    return Vec3(Vec3::Zero());
  };
  const Vec3 at_first = reaction();
  REQUIRE(at_first.norm() > 1);
  robot.key(' ');
  robot.frames(10, 0.03);
  CHECK(app.session.playback.time > 0.1);
  CHECK(reaction().norm() == Approx(at_first.norm()));
  CHECK((reaction() - at_first).norm() > 0.2 * at_first.norm());
  CHECK(loads_missing(app.session, app.tool, app.view).empty());
  robot.key(' ');
  open_scene(app.session, shipped_file("rate_gyro"));
  robot.frames(3);
  CHECK(!shown_scene(app.context())->loads.empty());
  robot.key(' ');
  robot.frames(5, 0.03);
  CHECK(shown_scene(app.context())->loads.empty());
  CHECK(has_row(app, "at the drawn phase only"));
  robot.key(' ');
  rewind(app.session);
  robot.frames(2);
  CHECK(!shown_scene(app.context())->loads.empty());
  robot.key(258); // Tab: building
  CHECK(has_row(app, "while exploring"));
}

TEST_CASE("a picture with forces is fitted to the arrows, and the window's view stays") {
  Robot robot({1280, 900});
  App& app = robot.app;
  app.view.ghost = app.view.grid = app.view.shadow = false;
  robot.key('F');
  robot.frames(30, 0.04);
  app.view.camera.distance *= 0.85; // as near as all bodies are still in view
  const ViewCamera before = app.view.camera;
  app.view.loads = true;
  const Image image = view_picture(app, {640, 480}, 1);
  CHECK(app.view.camera == before);
  for (int x = 0; x < image.width; ++x) // the bearing's arrow ends below
    for (int channel = 0; channel < 3; ++channel)
      CHECK(std::abs(image.at(x, 0)[channel] - image.at(0, 0)[channel]) <= 2);
}

TEST_CASE("an exported picture has the arrows where that is ticked") {
  const TemporaryFolder folder;
  Robot robot;
  App& app = robot.app;
  const auto exported = [&](const std::string& name, bool loads) {
    const std::filesystem::path file = folder.path() / name;
    app.export_request = ExportRequest{file, 640, 480, false, loads};
    export_picture(app, robot.size);
    return read_png(file);
  };
  CHECK_FALSE(exported("without.png", false) == exported("with.png", true));
  CHECK_FALSE(app.view.loads);
  CHECK_FALSE(app.view.alone);
  robot.key('E', true);
  robot.frames(2);
  CHECK_FALSE(app.panels->picture.loads());
  robot.click("export/loads");
  CHECK(app.panels->picture.loads());
}

TEST_CASE(
    "arrows of a periodic motion are those of the moment that is shown, to one scale through all of it") {
  Robot robot({1280, 900});
  App& app = robot.app;
  Mechanism crank = Document::empty_mechanism();
  add_driven_slider_crank(crank, 10);
  open_document(app.session, Document(crank));
  robot.frames(3);
  const PeriodicState* motion = periodic_motion(app.session);
  REQUIRE(motion);
  robot.key('A');
  CHECK(loads_missing(app.session, app.tool, app.view).empty());
  CHECK(has_row(app, "Of this moment"));
  CHECK_FALSE(shows_diagram(app.view));
  select(app.session, {{{PartKind::body, "rod1"}}});
  robot.frames(2);
  CHECK(shows_diagram(app.view));
  CHECK(has_row(app, "Free body: rod1, adds up to zero"));
  CHECK(has_row(app, "inertial loads"));
  CHECK_FALSE(has_row(app, "without inertial loads"));
  select(app.session, {});
  robot.frames(2);
  const Run& run = *motion->motion;
  const auto check = [&](std::size_t sample) {
    app.session.playback.time = run.time[sample];
    robot.frames(2);
    const ViewScene& scene = *shown_scene(app.context());
    std::size_t found = 0;
    for (const ReactionTrack& track : run.reactions)
      for (const Load& load : scene.loads) {
        if (load.kind != LoadKind::reaction || load.moment ||
            part_of(app.session.mechanism(), load.part).name != track.joint)
          continue;
        ++found;
        CHECK((load.vector - track.force[sample]).norm() < 1e-6 * track.force[sample].norm());
        double largest = 0;
        for (const Vec3& force : track.force)
          largest = std::max(largest, force.norm());
        CHECK(scene.arrows.scales.largest(LoadKind::reaction, false) >= largest);
      }
    CHECK(found >= 3);
    return scene.arrows.scales.length(false, 1);
  };
  const double at_first = check(0);
  CHECK(check(run.time.size() / 3) == at_first);
}

TEST_CASE("in a motion, too, arrows of a drive by torque are what it gives and the load against it") {
  constexpr double given = 60, resistance = 3; // N m, N m s
  Robot robot({1280, 900});
  App& app = robot.app;
  // A block that a turning spring pulls to and fro, and a wheel by itself, loaded by what the block does.
  Mechanism m = parse_scene(R"({"flyball": 2, "name": "Beside", "gravity": [0, 0, 0],
    "bodies": [{"name": "crank", "mass": 1, "position": [0.05, 0, 0], "inertia": [0.01, 0.01, 0.01]},
      {"name": "block", "mass": 1, "position": [0, 0, 0]},
      {"name": "wheel", "mass": 1, "position": [-0.3, 0, 0], "inertia": [0.01, 0.01, 0.01]}],
    "joints": [
      {"name": "spin", "type": "revolute", "bodies": ["ground", "crank"], "at": [0, 0, 0], "axis": [0, 0, 1],
       "drive": {"speed": 10}},
      {"name": "slide", "type": "prismatic", "bodies": ["ground", "block"], "at": [0, 0, 0],
       "axis": [1, 0, 0], "spring": {"stiffness": 50}, "damping": 5},
      {"name": "turn", "type": "revolute", "bodies": ["ground", "wheel"], "at": [-0.3, 0, 0],
       "axis": [0, 0, 1], "drive": {"speed": 20, "torque": 60}}],
    "forces": [{"name": "coil", "type": "spring", "bodies": ["crank", "block"],
      "points": [[0.1, 0.02, 0], [0, 0, 0]], "stiffness": 100, "free_length": 0.05}]})");
  set_expression(m, "joints.turn.drive.load", "3 N m s*rate(turn) + 2 N s*rate(slide)");
  open_document(app.session, Document(m));
  set_mode(app.session, Mode::explore);
  robot.frames(3);
  const PeriodicState* motion = periodic_motion(app.session);
  REQUIRE((motion && motion->motion));
  const Run& run = *motion->motion;
  const auto rate = [&](const std::string& joint, std::size_t sample) {
    const auto track = std::ranges::find(run.coordinates, joint, &CoordinateTrack::joint);
    REQUIRE(track != run.coordinates.end());
    return track->rate[sample];
  };
  robot.key('A');
  const auto along = [&](LoadKind kind) {
    double sum = 0;
    for (const Load& load : shown_scene(app.context())->loads)
      if (load.kind == kind && load.moment && part_of(app.session.mechanism(), load.part).name == "turn")
        sum += load.vector.z();
    return sum;
  };
  for (const std::size_t sample : {std::size_t(0), run.time.size() / 3}) {
    app.session.playback.time = run.time[sample];
    const double load = resistance * rate("turn", sample) + 2 * rate("slide", sample);
    for (const bool alone : {false, true}) { // all of it, and the wheel's free-body diagram
      select(app.session, {});
      if (alone) select(app.session, {{{PartKind::body, "wheel"}}});
      robot.frames(2);
      CAPTURE(sample, alone);
      CHECK(along(LoadKind::drive) == Approx(given).epsilon(1e-6));
      CHECK(along(LoadKind::applied) == Approx(-load).epsilon(1e-6));
    }
    CHECK(has_row(app, "Free body: wheel, adds up to zero"));
  }
}

TEST_CASE(
    "a limit cycle in a view of its own has the arrows of its moment, as long as those beside it would be") {
  Robot robot({1280, 1400});
  App& app = robot.app;
  open_scene(app.session, shipped_file("governor_engine"));
  robot.frames(2);
  change_parameter(app.session, "joints.slide.damping", 15); // it hunts
  robot.frames(3);
  robot.click("results/cycle");
  robot.frames(3);
  robot.click("results/cycle/motion");
  robot.frames(3);
  play(app.session, false);
  robot.click("motion/beside");
  robot.key('A');
  REQUIRE(converged(app.session));
  const Run& run = *shown_motion(app.session)->run;
  const auto force = [&](const ViewScene& scene) { // of the collar's spring
    for (const Load& load : scene.loads)
      if (load.kind == LoadKind::spring && part_of(app.session.mechanism(), load.part).name == "slide")
        return load.vector.norm();
    return -1.;
  };
  const SpringTrack& spring = *std::ranges::find(run.springs, "slide", &SpringTrack::joint);
  double steady = -1;
  for (const std::size_t sample : {run.time.size() / 8, run.time.size() / 3}) {
    seek_motion(app.session, run.time[sample]);
    robot.frames(3);
    REQUIRE(app.view.scene_beside.scene);
    const ViewScene &shown = *app.view.scene.scene, &cycle = *app.view.scene_beside.scene;
    CAPTURE(sample);
    CHECK(force(cycle) == Approx(std::abs(spring.spring[sample])).epsilon(1e-6));
    CHECK(cycle.arrows.scales.length(false, 10) == shown.arrows.scales.length(false, 10));
    if (steady >= 0) CHECK(force(shown) == Approx(steady));
    steady = force(shown); // that of the steady state, which stays
  }
  robot.key('A');
  robot.frames(2);
  CHECK(app.view.scene_beside.scene->loads.empty());
}

TEST_CASE("a motion in the place of a steady state that there is not has the arrows of its moment") {
  Robot robot({1280, 1400});
  App& app = robot.app;
  Mechanism m = Document::empty_mechanism();
  add_slider_crank_by_torque(m);
  open_document(app.session, Document(m));
  set_mode(app.session, Mode::explore);
  robot.frames(3);
  REQUIRE(app.session.answer.solution.status == Status::not_converged);
  robot.key('A');
  CHECK(has_row(app, "Forces: no steady state"));
  app.session.motion.duration = 1;
  robot.key('M');
  robot.frames(3);
  play(app.session, false);
  const Run& run = *shown_motion(app.session)->run;
  const DriveTrack& drive = run.drives.front();
  for (const std::size_t sample : {run.time.size() / 4, run.time.size() / 2}) {
    seek_motion(app.session, run.time[sample]);
    robot.frames(3);
    CHECK_FALSE(has_row(app, "Forces: no steady state"));
    CHECK(has_row(app, "Of this moment"));
    double given = 0;
    for (const Load& load : app.view.scene.scene->loads)
      if (load.kind == LoadKind::drive) given += load.vector.norm();
    CHECK(given == Approx(std::abs(drive.torque[sample] + drive.load[sample])).epsilon(1e-6));
  }
}
