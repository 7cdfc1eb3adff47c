#include "app/document/document.hpp"
#include "tests/catch.hpp"

#include <limits>

using namespace flyball;

namespace {

Mechanism with_gravity(double down) {
  Mechanism m = Document::empty_mechanism();
  m.gravity.y() = -down;
  return m;
}

Mechanism with_bodies(std::initializer_list<const char*> names) {
  Mechanism m = Document::empty_mechanism();
  for (const char* name : names) {
    m.bodies.emplace_back();
    m.bodies.back().name = name;
  }
  return m;
}

Selection body(const char* name) {
  return {{{PartKind::body, name}}};
}

} // namespace

TEST_CASE("an edit is a step, and nothing is none") {
  Document document;
  document.edit("Change gravity", with_gravity(1), {});
  document.edit("Change gravity", with_gravity(1), {});
  REQUIRE(document.steps().size() == 2);
  CHECK(document.unsaved());
  CHECK(document.undo());
  CHECK_FALSE(document.undo());
  CHECK(document.mechanism() == Document::empty_mechanism());
  CHECK_FALSE(document.unsaved());
  CHECK(document.redo());
  CHECK_FALSE(document.redo());
  CHECK(document.mechanism() == with_gravity(1));
}

TEST_CASE("a drag is one step, and none once it is back where it began") {
  Document document;
  for (const double down : {1, 2, 3})
    document.edit("Drag", with_gravity(down), {}, 7);
  CHECK(document.steps().size() == 2);
  document.edit("Drag", Document::empty_mechanism(), {}, 7);
  CHECK(document.steps().size() == 1);
  CHECK_FALSE(document.can_undo());
  document.edit("Drag", with_gravity(4), {}, 7);
  document.edit("Drag", with_gravity(5), {}, 8);
  CHECK(document.steps().size() == 3);
  CHECK(document.undo());
  CHECK(document.mechanism() == with_gravity(4));
}

TEST_CASE("an untitled document is named in all its steps at once") {
  Document document;
  document.edit("Change gravity", with_gravity(1), {});
  document.explore("Try gravity", {{"gravity.1", -2}});
  document.edit("Change gravity again", with_gravity(3), {});
  document.undo();
  document.name_untitled("Arm");
  document.name_untitled("Leg"); // it has a name
  CHECK(document.position() == 2);
  CHECK(document.steps().size() == 4);
  for (std::size_t i = 0; i < document.steps().size(); ++i) {
    CHECK(document.steps()[i].mechanism->name == "Arm");
    CHECK(document.steps()[i].tried->name == "Arm");
  }
  CHECK(document.steps()[1].mechanism == document.steps()[2].mechanism); // one object still
  CHECK(document.stored().gravity.y() == -1);
  CHECK(document.mechanism().gravity.y() == -2);
}

TEST_CASE("what could not be saved is no edit") {
  Document document;
  document.edit("Change gravity", with_gravity(std::numeric_limits<double>::infinity()), {});
  Mechanism sized = Document::empty_mechanism();
  sized.bodies.resize(1);
  sized.bodies[0].shapes.resize(1);
  sized.bodies[0].shapes[0].at = Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0);
  document.edit("Size", sized, {});
  CHECK(document.steps().size() == 1);
}

TEST_CASE("the oldest steps are dropped, the rest stays exact") {
  Document document;
  for (int i = 1; i <= 1500; ++i)
    document.edit("Change gravity", with_gravity(i), {});
  REQUIRE(document.steps().size() == Document::most_steps);
  document.go_to(0);
  CHECK(document.mechanism() == with_gravity(501));
  document.go_to(5000);
  CHECK(document.mechanism() == with_gravity(1500));
}

TEST_CASE("of a large mechanism fewer steps are kept") {
  Mechanism large = with_gravity(0);
  large.bodies.resize(10'000);
  for (std::size_t i = 0; i < large.bodies.size(); ++i)
    large.bodies[i].name = std::to_string(i);
  Document document(large);
  constexpr int edits = 150;
  for (int i = 1; i <= edits; ++i) {
    large.gravity.y() = -i;
    document.edit("Change gravity", large, {});
  }
  const std::size_t kept = document.steps().size();
  CHECK(kept >= Document::least_steps);
  CHECK(kept * large.bodies.size() * sizeof(Body) < Document::most_bytes);
  CHECK(document.mechanism().gravity.y() == -edits);
  document.go_to(0);
  CHECK(document.mechanism().gravity.y() == -(edits + 1. - static_cast<double>(kept)));
}

TEST_CASE("undoing keeps what is selected as far as it exists") {
  Document document(with_bodies({"a", "b"}));
  document.select(body("a"));
  Mechanism heavy = document.stored();
  heavy.bodies[0].mass = 2;
  document.edit("Set mass", heavy, document.selection());
  SECTION("though the step before knew of no selection") {
    document.undo();
    CHECK(document.selection() == body("a"));
    document.redo();
    CHECK(document.selection() == body("a"));
  }
  SECTION("also where another part was selected since") {
    document.select(body("b"));
    document.undo();
    CHECK(document.selection() == body("b"));
    document.redo();
    CHECK(document.selection() == body("b"));
  }
  SECTION("and nothing stays nothing") {
    document.select({});
    document.undo();
    CHECK(document.selection().empty());
    document.redo();
    CHECK(document.selection().empty());
  }
}

TEST_CASE(
    "undoing selects what it brings back, and what was selected before where all that is selected goes") {
  Document document(with_bodies({"a", "b"}));
  document.select(body("b"));
  document.edit("Delete b", with_bodies({"a"}), {});
  CHECK(document.selection().empty());
  SECTION("what comes back") {
    document.undo();
    CHECK(document.selection() == body("b"));
    document.redo();
    CHECK(document.selection().empty());
  }
  SECTION("not over what was selected meanwhile") {
    document.select(body("a"));
    document.undo();
    CHECK(document.selection() == body("a"));
  }
  SECTION("what goes") {
    document.select(body("a"));
    document.edit("Add c", with_bodies({"a", "c"}), body("c"));
    document.undo();
    CHECK(document.selection() == body("a"));
    document.redo();
    CHECK(document.selection() == body("c"));
  }
  SECTION("of several those that are left") {
    document.edit("Add c", with_bodies({"a", "c"}), {});
    document.select({{{PartKind::body, "c"}, {PartKind::body, "a"}}});
    document.undo();
    CHECK(document.selection() == body("a"));
  }
}

TEST_CASE("undoing and redoing everything selects what was selected") {
  Document document(with_bodies({}));
  document.edit("Add a", with_bodies({"a"}), body("a"));
  document.edit("Add b", with_bodies({"a", "b"}), body("b"));
  document.edit("Add c", with_bodies({"a", "b", "c"}), body("c"));
  document.select(body("b"));
  while (document.undo()) {
  }
  CHECK(document.selection().empty());
  SECTION("at once") {
    while (document.redo()) {
    }
    CHECK(document.selection() == body("b"));
  }
  SECTION("but for what was selected meanwhile") {
    document.redo();
    document.redo();
    CHECK(document.selection() == body("b"));
    document.select(body("a"));
    document.redo();
    CHECK(document.selection() == body("a"));
  }
}
