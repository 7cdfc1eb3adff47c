// Numbers that are only tried stand beside the document's mechanism.
#include "app/document/document.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/rename.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <limits>

using namespace flyball;
using namespace flyball::test;

namespace {

constexpr const char* speed = "joints.spin.drive.speed";
constexpr const char* mass = "bodies.collar.mass";

Document governor() {
  return Document(shipped("governor"));
}

double shown(const Document& document, const char* address) {
  return get_parameter(document.mechanism(), address);
}

double stored(const Document& document, const char* address) {
  return get_parameter(document.stored(), address);
}

} // namespace

TEST_CASE("exploring makes no document unsaved") {
  Document document = governor();
  const std::uint64_t revision = document.revision(), before = document.stored_revision();
  document.explore("Set speed", {{speed, 15}}, 1);
  CHECK(shown(document, speed) == 15);
  CHECK(stored(document, speed) == 11.0174);
  CHECK_FALSE(document.unsaved());
  CHECK(document.revision() > revision);
  CHECK(document.stored_revision() == before);
  // A drag is one step, and back where it was none.
  document.explore("Set speed", {{speed, 16}}, 1);
  CHECK(document.steps().size() == 2);
  document.explore("Set speed", {{speed, 11.0174}}, 1);
  CHECK(document.steps().size() == 1);
  CHECK(document.explored().empty());
  CHECK(document.mechanism() == document.stored());
}

TEST_CASE("explored values are kept or left, and both are undone") {
  Document document = governor();
  document.explore("Set speed", {{speed, 15}});
  document.explore("Set mass", {{mass, 2}});
  REQUIRE(document.explored().size() == 2);
  SECTION("kept") {
    document.keep_explored();
    CHECK(document.explored().empty());
    CHECK(stored(document, speed) == 15);
    CHECK(stored(document, mass) == 2);
    CHECK(document.unsaved());
    document.undo();
    CHECK_FALSE(document.unsaved());
    CHECK(document.explored().size() == 2);
    CHECK(shown(document, mass) == 2);
    CHECK(stored(document, mass) == 1);
  }
  SECTION("left") {
    document.drop_explored();
    CHECK(document.mechanism() == document.saved());
    CHECK_FALSE(document.unsaved());
    document.undo();
    CHECK(shown(document, speed) == 15);
  }
  SECTION("put aside while building") {
    const std::uint64_t revision = document.revision();
    CHECK(document.put_explored_aside(true));
    CHECK(document.mechanism() == document.saved());
    CHECK(document.revision() > revision);
    CHECK_FALSE(document.put_explored_aside(true));
    CHECK(document.put_explored_aside(false));
    CHECK(shown(document, speed) == 15);
  }
  SECTION("saving writes neither") {
    document.mark_saved("there.json");
    CHECK(get_parameter(document.saved(), speed) == 11.0174);
    CHECK(document.explored().size() == 2);
  }
}

TEST_CASE("an edit leaves beside it what is explored of other numbers") {
  Document document = governor();
  document.explore("Set speed", {{speed, 15}});
  document.explore("Set mass", {{mass, 2}});
  SECTION("of another number") {
    document.edit_number("Set stiffness", "joints.slide.spring.stiffness", 900);
    CHECK(shown(document, "joints.slide.spring.stiffness") == 900);
    CHECK(shown(document, speed) == 15);
    CHECK(stored(document, speed) == 11.0174);
    CHECK(document.unsaved());
  }
  SECTION("of the same number") {
    document.edit_number("Set mass", mass, 3);
    CHECK(shown(document, mass) == 3);
    CHECK(document.explored() == Explored{{speed, 15}});
  }
  SECTION("back to what is stored of the same number") {
    document.edit_number("Set mass", mass, 1);
    CHECK(shown(document, mass) == 1);
    CHECK_FALSE(document.unsaved());
    CHECK(document.explored().size() == 1);
  }
  SECTION("by another mechanism") {
    Mechanism next = document.stored();
    set_parameter(next, mass, 5);
    document.edit("Reload", next, {});
    CHECK(shown(document, mass) == 5); // what the edit has set counts
    CHECK(shown(document, speed) == 15);
  }
  SECTION("of a part that is renamed") {
    Mechanism next = document.stored();
    rename_part(next, {PartKind::body, "collar"}, "sleeve");
    document.edit("Rename", next, {});
    CHECK(shown(document, "bodies.sleeve.mass") == 2);
    CHECK(get_parameter(document.stored(), "bodies.sleeve.mass") == 1);
    CHECK(document.explored().size() == 2);
  }
  SECTION("of a part that is gone") {
    Mechanism next = document.stored();
    std::erase_if(next.bodies, [](const Body& body) { return body.name == "collar"; });
    document.edit("Delete", next, {});
    CHECK(document.explored() == Explored{{speed, 15}});
    document.undo();
    CHECK(shown(document, mass) == 2);
  }
}

TEST_CASE("what is explored of a number that is named is explored of the parameter") {
  Document document = governor();
  document.explore("Set speed", {{speed, 15}});
  Mechanism named = document.stored();
  name_number(named, speed, "n");
  document.edit("Name", named, {});
  CHECK(shown(document, speed) == 15);
  CHECK(stored(document, speed) == 11.0174);
  CHECK(document.explored() == Explored{{"parameters.n", 15}});
  document.keep_explored();
  CHECK(stored(document, "parameters.n") == 15);
  CHECK(stored(document, speed) == 15);
}

TEST_CASE("a number that an expression gives is not explored") {
  Document document = governor();
  Mechanism given = document.stored();
  given.bodies[static_cast<std::size_t>(body_index(given, "collar"))].formulas = {{"mass", "1 kg"}};
  document.edit("Give the mass", given, {});
  document.explore("Set mass", {{mass, 2}});
  CHECK(document.explored().empty());
  CHECK(document.steps().size() == 2);
}

TEST_CASE("what cannot be explored is not") {
  Document document = governor();
  document.explore("Nothing", {{"joints.none.drive.speed", 3}});
  document.explore("Nothing", {{speed, std::numeric_limits<double>::quiet_NaN()}});
  CHECK(document.steps().size() == 1);
  CHECK_THROWS_AS(document.edit_number("Nothing", "bodies.none.mass", 1), SceneError);
  CHECK(document.steps().size() == 1);
}
