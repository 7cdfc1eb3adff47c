// The editor in its main states, brought about by mouse and keys.
#include "building.hpp"
#include "stored_picture.hpp"

#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/session/motion.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "app/ui/tools/tools.hpp"
#include "tests/catch.hpp"

#include <algorithm>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr PixelSize window{1200, 760};

// A robot whose pictures come out the same everywhere.
class Hand : public Robot {
 public:
  explicit Hand(const char* scene = nullptr) : Robot(window, steady_options().numbers) {
    if (scene)
      open_scene(app.session, std::filesystem::path(FLYBALL_ASSETS "/scenes") / scene);
    else
      open_document(app.session, Document());
    set_mode(app.session, Mode::build);
    frames(3);
  }
  void choose(PartKind kind, const char* name) {
    Selection selection;
    selection.set({kind, name});
    select(app.session, selection);
    frames(3);
  }
  void check(const std::string& name) {
    point({-1000, -1000}); // away from whatever would light up
    frames(11);            // shades behind dialogs fade in
    const ImageComparison comparison = compare_with_stored(name, picture());
    INFO(name << ": " << comparison.message);
    CHECK(comparison.same);
  }
};

} // namespace

TEST_CASE("an empty document says what to do first") {
  Hand hand;
  hand.check("editor-empty");
}

TEST_CASE("a joint is being placed", "[egl]") {
  Hand hand("governor.json");
  hand.key('1');
  hand.key('J');
  hand.click_at({0, 0.1256, 0});
  REQUIRE(hand.app.tool.joint);
  hand.check("editor-placing-joint");
}

TEST_CASE("a named point is picked for a joint") {
  Hand hand("governor_parametric.json");
  hand.key('1');
  hand.choose(PartKind::joint, "slide");
  set_tool(hand.app.session, hand.app.ui, hand.app.tool, Tool::point);
  hand.app.tool.standing = "joints.slide.at";
  hand.frames(3);
  hand.check("editor-picking-point");
}

TEST_CASE("each kind of part has its inspector") {
  SECTION("body") {
    Hand hand("governor.json");
    hand.choose(PartKind::body, "ball1");
    hand.check("inspector-body");
  }
  SECTION("joint") {
    Hand hand("governor.json");
    hand.choose(PartKind::joint, "slide");
    hand.check("inspector-joint");
  }
  SECTION("distance joint") {
    Hand hand("governor.json");
    hand.choose(PartKind::joint, "link1");
    hand.check("inspector-distance");
  }
  SECTION("spring") {
    Hand hand("pendulum.json");
    hand.key('1');
    hand.key('S');
    hand.click_at({1, 0, 0});
    hand.click_at({1, -1, 0});
    REQUIRE(hand.app.session.mechanism().forces.size() == 1);
    hand.check("inspector-spring");
  }
  SECTION("scene") {
    Hand hand("conical_pendulum.json");
    hand.check("inspector-scene");
  }
  SECTION("parameters and points") {
    Hand hand("governor_parametric.json");
    hand.check("inspector-parameters");
  }
  SECTION("numbers that expressions give") {
    Hand hand("governor_parametric.json");
    hand.choose(PartKind::joint, "slide");
    hand.check("inspector-expressions");
  }
  SECTION("a body that expressions give") {
    Hand hand("governor_parametric.json");
    edit(hand.app.session, "Turn", [](Mechanism& next, Selection&) {
      set_expression(next, "bodies.ball1.turn.2", "20 deg");
      name_number(next, "bodies.ball1.shapes.1.radius", "rod");
    });
    hand.app.sizes.inspector_share = 0.9f;
    hand.app.ui.sections.open["inspector/mass section"] = false;
    hand.choose(PartKind::body, "ball1");
    hand.check("inspector-shapes");
  }
  SECTION("several parts") {
    Hand hand("governor.json");
    hand.key('A', true);
    hand.check("inspector-several");
  }
}

TEST_CASE("a collar is dragged to where it should settle, and the sliders follow") {
  Hand hand("governor_parametric.json");
  // Its read-outs would fill the panel, whose rows are a pixel higher with some versions of ImGui than with
  // others.
  edit(hand.app.session, "Clear", [](Mechanism& next, Selection&) { next.measures.clear(); });
  set_mode(hand.app.session, Mode::explore);
  hand.frames(4);
  const auto collar = static_cast<std::size_t>(body_index(hand.app.session.mechanism(), "collar"));
  const Vec3 from = hand.app.session.poses.at(collar).position;
  hand.hold(false, true, true);
  hand.point(hand.pixel(from));
  hand.press();
  hand.frames(2);
  hand.point(hand.pixel(from + Vec3(0, 0.01, 0)));
  hand.point(hand.pixel(from + Vec3(0, 0.05, 0))); // farther than the arms let it
  hand.frames(14);
  REQUIRE(hand.app.tool.reach);
  const ImageComparison comparison = compare_with_stored("hand-with-sliders", hand.picture());
  INFO(comparison.message);
  CHECK(comparison.same);
  hand.release();
}

TEST_CASE("an unfinished mechanism says what is missing") {
  Hand hand("governor.json");
  hand.choose(PartKind::joint, "spin");
  hand.key(keys::del);
  REQUIRE_FALSE(hand.app.session.mistakes.empty());
  hand.check("editor-unfinished");
}

TEST_CASE("the command palette finds commands by words") {
  Hand hand("governor.json");
  hand.key('P', true);
  hand.frames(2);
  hand.type("copy");
  hand.check("command-palette");
}

TEST_CASE("the sheet of shortcuts lists every key") {
  Hand hand("governor.json");
  hand.key('?');
  hand.check("shortcut-sheet");
}

TEST_CASE("the examples have pictures") {
  Hand hand;
  hand.app.commands.run("file.examples");
  hand.frames(30);
  hand.check("gallery");
}

TEST_CASE("parts are turned with rings") {
  Hand hand("governor.json");
  hand.choose(PartKind::body, "ball2");
  hand.key('R');
  hand.check("editor-rotating");
}

TEST_CASE("the motion stands beside the steady state, with its plots", "[egl]") {
  Hand hand("governor.json");
  set_mode(hand.app.session, Mode::explore);
  open_study(hand.app.session, StudyKind::motion);
  hand.frames(2);
  hand.app.session.playback.playing = false;
  seek_motion(hand.app.session, 0.55);
  SECTION("in amber") {
    hand.check("study-motion");
  }
  SECTION("in a view of its own") {
    hand.app.session.motion.beside = true;
    hand.check("study-motion-beside");
  }
}

TEST_CASE("the landscape is drawn below the view") {
  Hand hand("conical_pendulum.json");
  set_mode(hand.app.session, Mode::explore);
  SECTION("response") {
    open_study(hand.app.session, StudyKind::response);
    hand.check("study-response");
  }
  SECTION("states") {
    open_study(hand.app.session, StudyKind::states);
    hand.check("study-states");
  }
  SECTION("modes") {
    open_study(hand.app.session, StudyKind::modes);
    hand.check("study-modes");
  }
  SECTION("map") {
    open_study(hand.app.session, StudyKind::map);
    hand.check("study-map");
  }
}

TEST_CASE("periodic motions are drawn over a number where the balance turns") {
  Hand hand("horizontal_rotor.json");
  set_mode(hand.app.session, Mode::explore);
  open_study(hand.app.session, StudyKind::response);
  hand.app.session.study.response.choice.quantity = "value up";
  hand.check("study-resonance");
}

TEST_CASE("the limit cycle is told beside the steady state that hunts") {
  Hand hand("governor_engine.json");
  set_mode(hand.app.session, Mode::explore);
  change_parameter(hand.app.session, "joints.slide.damping", 15);
  find_cycle(hand.app.session, true);
  hand.check("limit-cycle");
}

TEST_CASE("the boundary of hunting is drawn in the map: Vyshnegradsky's diagram") {
  Hand hand("governor_engine.json");
  set_mode(hand.app.session, Mode::explore);
  open_study(hand.app.session, StudyKind::map);
  hand.frames(2);
  MapChoice& choice = hand.app.session.study.map.choice;
  choice.hunting = true;
  choice.axes = {MapAxis{"joints.slide.damping", 5, 60, 23}, MapAxis{"parameters.gain", 1000, 20000, 23}};
  choice.shown = "spin.speed";
  hand.check("study-hunting");
}

TEST_CASE("how the governor scatters is drawn below the view, and around its response") {
  Hand hand("governor_parametric.json");
  set_mode(hand.app.session, Mode::explore);
  hand.app.session.study.spread.begun = true;
  hand.app.session.study.spread.choice.tolerances = {{"parameters.w", Distribution::normal, 2},
                                                     {"parameters.L", Distribution::uniform, 0.003, false},
                                                     {"parameters.m", Distribution::triangular, 20},
                                                     {"parameters.k", Distribution::normal, 3}};
  SECTION("histogram") {
    open_study(hand.app.session, StudyKind::spread);
    hand.check("study-spread");
  }
  SECTION("band") {
    open_study(hand.app.session, StudyKind::response);
    hand.app.session.study.band.wanted = true;
    hand.check("study-band");
  }
}

TEST_CASE("what friction holds is told, and drawn around the response") {
  Hand hand("governor_friction.json");
  set_mode(hand.app.session, Mode::explore);
  open_study(hand.app.session, StudyKind::response);
  hand.frames(2);
  choose_response_end(hand.app.session, &ResponseChoice::from, 14);
  choose_response_end(hand.app.session, &ResponseChoice::to, 20);
  hand.app.session.study.response.choice.quantity = "value lift";
  hand.check("study-friction");
}

TEST_CASE("the tutorial's pictures are what its steps lead to") {
  Robot robot(building_size, steady_options().numbers);
  robot.app.view.samples = 4;
  build_governor(robot, [&](const std::string& step) {
    for (const char* shown : {"empty", "bodies", "joining hinge1", "one arm", "mirror", "explored"}) {
      if (step != shown) continue;
      const ImVec2 hand = ImGui::GetIO().MousePos;
      robot.point({-1000, -1000});
      robot.frames(11);
      std::string name = "tutorial-" + step;
      std::ranges::replace(name, ' ', '-');
      const ImageComparison comparison = compare_with_stored(name, robot.picture());
      INFO(name << ": " << comparison.message);
      CHECK(comparison.same);
      robot.point(hand);
    }
  });
}

TEST_CASE("what acts on the governor is drawn, and on one ball of it") {
  Hand hand("governor.json");
  set_mode(hand.app.session, Mode::explore);
  hand.frames(2);
  hand.key('A');
  hand.check("governor-loads");
  hand.choose(PartKind::body, "ball1");
  hand.check("governor-free-body");
}

TEST_CASE("the context menu of a body") {
  Hand hand("governor.json");
  hand.choose(PartKind::body, "ball1");
  hand.app.commands.run("view.menu");
  hand.frames(2);
  hand.check("context-menu");
}

TEST_CASE("the governor's transfer function is drawn below the view") {
  Hand hand("governor.json");
  set_mode(hand.app.session, Mode::explore);
  hand.app.session.study.transfer.choice = {"torque(slide)", "slide"};
  open_study(hand.app.session, StudyKind::transfer);
  hand.check("study-transfer");
}
