// Colours stay with their bodies.
#include "app/document/clipboard.hpp"
#include "app/document/copies.hpp"
#include "app/document/create.hpp"
#include "app/document/document.hpp"
#include "app/document/remove.hpp"
#include "app/document/rename.hpp"

#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/support/scenes.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

using namespace flyball;
using namespace flyball::test;

namespace {

using ByName = std::map<std::string, int>;

ByName hues_of(const Document& document) {
  ByName all;
  for (std::size_t i = 0; i < document.stored().bodies.size(); ++i)
    all[document.stored().bodies[i].name] = document.hues().at(i);
  return all;
}

void change(Document& document, const std::function<void(Mechanism&)>& edit) {
  Mechanism next = document.stored();
  edit(next);
  document.edit("Change", std::move(next), {});
}

Mechanism chain(int links) {
  Mechanism mechanism;
  for (int i = 0; i < links; ++i) {
    const double x = 0.1 * i;
    const std::string name = add_body(
        mechanism, {.form = BodyForm::rod, .radius = 0.01, .from = {x, 0, 0}, .to = {x + 0.1, 0, 0}});
    const std::string before = i == 0 ? "ground" : mechanism.bodies[static_cast<std::size_t>(i) - 1].name;
    add_joint(mechanism, JointType::revolute, {before, name}, {x, 0, 0}, {0, 0, 1});
  }
  return mechanism;
}

} // namespace

TEST_CASE("deleting, renaming, sorting and undoing recolour no body") {
  Document document(shipped("governor"));
  const ByName before = hues_of(document);
  std::set<int> different;
  for (const auto& [name, hue] : before)
    different.insert(hue % body_hue_count);
  CHECK(different.size() == before.size()); // few bodies have a hue each

  change(document, [](Mechanism& m) { remove_parts(m, {{{PartKind::body, "spindle"}}}); });
  for (const auto& [name, hue] : hues_of(document))
    CHECK(before.at(name) == hue);
  document.undo();
  CHECK(hues_of(document) == before);

  change(document, [](Mechanism& m) { rename_part(m, {PartKind::body, "ball1"}, "weight"); });
  CHECK(hues_of(document).at("weight") == before.at("ball1"));
  CHECK(hues_of(document).at("collar") == before.at("collar"));
  change(document, [](Mechanism& m) { std::ranges::reverse(m.bodies); });
  CHECK(hues_of(document).at("weight") == before.at("ball1"));
  CHECK(hues_of(document).at("spindle") == before.at("spindle"));
  change(document, [](Mechanism& m) {
    duplicate_parts(m, {{{PartKind::body, "collar"}}}, {1, 0, 0});
    std::rotate(m.bodies.begin(), m.bodies.end() - 1, m.bodies.end());
  });
  CHECK(hues_of(document).at("spindle") == before.at("spindle"));
  CHECK(hues_of(document).at("weight") == before.at("ball1"));
  document.go_to(0);
  CHECK(hues_of(document) == before);
}

TEST_CASE("what was built has the same colours when it is read again") {
  Document document;
  for (int i = 0; i < body_hue_count; ++i)
    change(document, [&](Mechanism& m) {
      add_body(m, {.form = i % 2 ? BodyForm::rod : BodyForm::ball,
                   .at = Vec3(i, 0, 0),
                   .radius = 0.1,
                   .from = Vec3(i, 0, 0),
                   .to = Vec3(i, 1, 0)});
    });
  CHECK(choose_hues(document.stored()) == document.hues());
}

TEST_CASE("neighbours never share a hue") {
  for (const int links : {2, 7, 40}) {
    const BodyHues hues = choose_hues(chain(links));
    for (std::size_t i = 1; i < hues.size(); ++i)
      CHECK(hues[i] % body_hue_count != hues[i - 1] % body_hue_count);
  }
  // Built one after the other, before they are joined, too.
  Document document;
  const Mechanism whole = chain(6);
  for (std::size_t i = 1; i <= whole.bodies.size(); ++i)
    change(document, [&](Mechanism& m) {
      m.bodies.assign(whole.bodies.begin(), whole.bodies.begin() + static_cast<std::ptrdiff_t>(i));
    });
  for (std::size_t i = 1; i < document.hues().size(); ++i)
    CHECK(document.hues()[i] % body_hue_count != document.hues()[i - 1] % body_hue_count);
}

TEST_CASE("an answer that is a little older finds its bodies' colours") {
  Document document(shipped("governor"));
  const Mechanism older = document.stored();
  const BodyHues before = document.hues();
  change(document, [](Mechanism& m) { remove_parts(m, {{{PartKind::body, "ball1"}}}); });
  const BodyHues now = hues_for(older, document.colouring());
  for (std::size_t i = 0; i < older.bodies.size(); ++i)
    if (older.bodies[i].name != "ball1") CHECK(now[i] == before[i]);
  CHECK(hues_for(older, {}) == choose_hues(older));
}
