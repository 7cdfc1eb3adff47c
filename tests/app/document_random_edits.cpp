// Whatever is done to a document: it saves and loads to itself, its past is exact, and checking and solving
// it never crash.
#include "app/document/clipboard.hpp"
#include "app/document/copies.hpp"
#include "app/document/create.hpp"
#include "app/document/document.hpp"
#include "app/document/finite.hpp"
#include "app/document/formula_edits.hpp"
#include "app/document/named_edits.hpp"
#include "app/document/remove.hpp"
#include "app/document/rename.hpp"
#include "app/document/settle_formulas.hpp"
#include "app/document/snap_points.hpp"
#include "app/document/transform.hpp"
#include "app/document/turns.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/mass_properties.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "tests/app/document_mechanisms.hpp"
#include "tests/engine/mechanism_everything.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/scenes.hpp"

#include <limits>

using namespace flyball;
using namespace flyball::test;

namespace {

// Takes out what the panel complains of, until it does so no more.
void mend(Mechanism& m) {
  for (;;) {
    const std::vector<SceneError> mistakes = find_mistakes(m);
    if (mistakes.empty()) return;
    const std::string where = mistakes[0].where();
    if (where.starts_with("sliders")) {
      m.sliders.clear();
      continue;
    }
    const std::size_t first = where.find('.');
    if (first == std::string::npos) return;
    const std::string list = where.substr(0, first),
                      name = where.substr(first + 1, where.find('.', first + 1) - first - 1);
    const PartKind kind = list == "bodies"   ? PartKind::body
                          : list == "joints" ? PartKind::joint
                                             : PartKind::force;
    const std::size_t before = everything_of(m).parts.size();
    remove_parts(m, {{{kind, name}}});
    if (everything_of(m).parts.size() == before) return;
  }
}

// A person who tries everything, also what makes no sense.
class Person {
 public:
  Person(std::uint32_t seed, Mechanism start) : dice_(seed), document_(std::move(start)) {
    past_.push_back(document_.mechanism());
  }

  Document& document() { return document_; }
  const std::vector<Mechanism>& past() const { return past_; }
  int edits() const { return edits_; }
  int refused() const { return refused_; }
  int named() const { return named_; }

  void act() {
    const int what = dice_.below(100);
    if (what < 6)
      undo();
    else if (what < 10)
      redo();
    else if (what < 12)
      jump();
    else if (what < 15)
      drag();
    else if (what < 20)
      document_.select(selection());
    else
      edit("Edit " + std::to_string(what), 0, [&](Mechanism& m) { change(m); });
    check();
  }

 private:
  void edit(const std::string& name, std::uint64_t gesture, const std::function<void(Mechanism&)>& change) {
    Mechanism next = document_.mechanism();
    change(next);
    ++edits_;
    try {
      document_.edit(name, next, selection(), gesture);
    } catch (const SceneError&) { // what expressions do not allow
      ++refused_;
      return;
    }
    // What the history ought to be.
    if (!is_finite(next)) return;
    settle_formulas(past_[at_], next);
    if (next == past_[at_]) return;
    const bool same = gesture != 0 && gesture == gesture_ && at_ > 0;
    past_.resize(at_ + 1);
    if (same) {
      past_.pop_back();
      --at_;
    }
    gesture_ = next == past_.back() ? 0 : gesture;
    if (next == past_.back()) return;
    past_.push_back(std::move(next));
    ++at_;
  }

  void undo() {
    CHECK(document_.undo() == (at_ > 0));
    if (at_ > 0) --at_;
    gesture_ = 0;
  }
  void redo() {
    CHECK(document_.redo() == (at_ + 1 < past_.size()));
    if (at_ + 1 < past_.size()) ++at_;
    gesture_ = 0;
  }
  void jump() {
    const auto back = std::min(at_, static_cast<std::size_t>(dice_.below(8)));
    at_ = std::min(at_ - back + static_cast<std::size_t>(dice_.below(8)), past_.size() - 1);
    document_.go_to(at_);
    gesture_ = 0;
  }
  // Several edits with one movement of the hand, sometimes back to where it began.
  void drag() {
    const Mechanism before = document_.mechanism();
    const Selection what = selection();
    const auto gesture = ++gestures_;
    const bool turn = dice_.chance(0.5);
    for (int i = dice_.below(5); i >= 0; --i) {
      const Vec3 by = dice_.box(0.3);
      edit("Drag", gesture, [&](Mechanism& m) {
        m = before;
        if (turn)
          rotate_parts(m, what, {0, 0, 0}, Quat(Eigen::AngleAxisd(by.x(), Vec3::UnitY())));
        else
          move_parts(m, what, by);
      });
    }
    if (dice_.chance(0.3)) edit("Drag", gesture, [&](Mechanism& m) { m = before; });
  }

  void check() {
    CHECK(document_.mechanism() == past_[at_]);
    Mechanism again = document_.mechanism();
    evaluate_formulas(again);
    CHECK(again == document_.mechanism());
    for (const Body& body : again.bodies)
      if (is_rotation_given(body)) CHECK(std::abs(body.rotation.norm() - 1) < 1e-9);
    CHECK(document_.position() == at_);
    CHECK(document_.steps().size() == past_.size());
    CHECK(existing(document_.selection(), document_.mechanism()) == document_.selection());
  }

  double number() {
    static const std::vector<double> odd{0,     -1,     1e-12, 1e9,
                                         1e300, -1e300, NAN,   std::numeric_limits<double>::infinity()};
    return dice_.chance(0.03) ? dice_.one_of(odd) : dice_.between(-1, 1);
  }
  double positive() { return dice_.chance(0.95) ? std::abs(number()) : number(); }
  Vec3 vector() {
    if (dice_.chance(0.4)) return static_cast<double>(dice_.below(3) - 1) * Vec3::Unit(dice_.below(3));
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  std::string name(PartKind kind) {
    static const std::vector<std::string> odd{"ground", "",    "nobody",  "a.b",
                                              "ball1",  "new", "Kugel ü", "rod7"};
    const Mechanism& m = document_.mechanism();
    std::vector<std::string> names;
    for (const Part& part : everything_of(m).parts)
      if (part.kind == kind) names.push_back(part.name);
    return names.empty() || dice_.chance(0.06) ? dice_.one_of(odd) : dice_.one_of(names);
  }
  std::array<std::string, 2> two_bodies() {
    std::array<std::string, 2> both{dice_.chance(0.5) ? "ground" : name(PartKind::body),
                                    name(PartKind::body)};
    if (dice_.chance(0.3)) std::swap(both[0], both[1]);
    return both;
  }
  Part part() {
    const auto kind = static_cast<PartKind>(dice_.chance(0.02) ? 0 : 1 + dice_.below(3));
    return {kind, name(kind)};
  }
  Selection selection() {
    Selection all;
    for (int i = dice_.below(4); i > 0; --i)
      all.add(part());
    return all;
  }
  std::string coordinate() {
    const std::string joint = name(PartKind::joint);
    return dice_.chance(0.6) ? joint : joint + "." + std::to_string(dice_.below(7));
  }

  void change(Mechanism& m) {
    if (m.bodies.size() > 8 || m.joints.size() > 16 || m.forces.size() > 8)
      return remove_parts(m, {{part(), part(), part()}});
    switch (dice_.below(28)) {
    case 0:
    case 1:
    case 2: new_body(m); return;
    case 3:
    case 4: new_joint(m, two_bodies()); return;
    case 5: add_distance(m, two_bodies(), {vector(), vector()}); return;
    case 6: add_gear(m, {coordinate(), coordinate()}, number()); return;
    case 7: add_spring(m, two_bodies(), {vector(), vector()}, positive(), positive()); return;
    case 8:
      add_force(m, static_cast<ForceType>(1 + dice_.below(3)), name(PartKind::body), vector(), vector());
      return;
    case 9: remove_parts(m, selection()); return;
    case 10: rename(m); return;
    case 11: move_parts(m, selection(), vector()); return;
    case 12: rotate_parts(m, selection(), vector(), rotation()); return;
    case 13: set_point(m, {part(), dice_.below(4) - 1}, vector()); return;
    case 14: duplicate_parts(m, selection(), vector()); return;
    case 15: mirror_parts(m, selection(), vector(), vector()); return;
    case 16: circular_copy(m, selection(), vector(), vector(), dice_.below(5)); return;
    case 17: paste(m); return;
    case 18: set_number(m); return;
    case 19: pin(m); return;
    case 20: act_on_coordinate(m); return;
    case 21: weigh(m); return;
    case 22: m.gravity = dice_.chance(0.7) ? Vec3(0, -9.80665, 0) : vector(); return;
    case 23: mend(m); return;
    case 24:
    case 25: name_something(m); return;
    case 26: express(m); return;
    case 27: rename_something(m); return;
    }
  }

  Quat rotation() {
    if (dice_.chance(0.5))
      return Quat(Eigen::AngleAxisd(M_PI / 2 * dice_.below(4), Vec3::Unit(dice_.below(3))));
    const Vec3 v = vector();
    return Quat(number(), v.x(), v.y(), v.z());
  }
  void new_body(Mechanism& m) {
    NewBody body;
    body.form = static_cast<BodyForm>(dice_.below(4));
    body.at = vector();
    body.radius = 0.1 * positive();
    body.size = 0.1 * vector().cwiseAbs();
    body.from = vector();
    body.to = vector();
    body.density = 1000 * positive();
    const std::string name_given = add_body(m, body);
    if (dice_.chance(0.8)) new_joint(m, {dice_.chance(0.5) ? "ground" : name(PartKind::body), name_given});
  }
  void new_joint(Mechanism& m, const std::array<std::string, 2>& bodies) {
    add_joint(m, static_cast<JointType>(dice_.below(8)), bodies, vector(), vector(), vector());
  }
  void rename(Mechanism& m) {
    const Mechanism before = m;
    try {
      rename_part(m, part(), name(dice_.chance(0.5) ? PartKind::none : PartKind::body));
    } catch (const SceneError&) {
      CHECK(m == before);
    }
  }
  void paste(Mechanism& m) {
    const Mechanism& from = dice_.chance(0.5) ? m : dice_.one_of(past_);
    const std::string text = copy_text(from, selection());
    const Mechanism before = m;
    const Selection added = paste_text(m, text);
    CHECK(existing(added, m) == added);
    CHECK(existing(added, before).empty());
  }
  void set_number(Mechanism& m) {
    try {
      set_parameter(m, dice_.one_of(parameter_addresses(m)), number());
    } catch (const SceneError&) { // a number that is none
    }
  }
  // Of parameters and points, or one that is none.
  std::string known_name(const Mechanism& m) {
    std::vector<std::string> names{"nobody"};
    for (const NamedParameter& each : m.parameters)
      names.push_back(each.name);
    for (const NamedPoint& each : m.points)
      names.push_back(each.name);
    return dice_.one_of(names);
  }
  // Of a number that takes an expression, also one without an address.
  std::string expressible(const Mechanism& m) {
    std::vector<std::string> all = parameter_addresses(m);
    for (const Body& body : m.bodies) {
      const std::string path = "bodies." + body.name;
      for (const char* axis : {"0", "1", "2"})
        all.push_back(path + ".turn." + axis);
      for (std::size_t i = 0; i < body.shapes.size(); ++i)
        for (const char* key : {".radius", ".size.1", ".at.0", ".from.2"})
          all.push_back(path + ".shapes." + std::to_string(i) + key);
    }
    return dice_.one_of(all);
  }
  void try_to(Mechanism& m, const std::function<void()>& act) {
    const Mechanism before = m;
    try {
      act();
      ++named_;
    } catch (const SceneError&) {
      CHECK(m == before);
    }
  }
  void name_something(Mechanism& m) {
    if (dice_.chance(0.3) && m.points.size() < 6)
      m.points.push_back({free_name(m, "Q"), vector(), {}});
    else if (dice_.chance(0.5) && !m.points.empty())
      try_to(m, [&] { stand_at_point(m, point_address(m, {part(), dice_.below(2)}), known_name(m)); });
    else if (m.parameters.size() < 8)
      try_to(m, [&] { name_number(m, expressible(m), free_name(m, "p")); });
  }
  void express(Mechanism& m) {
    static const std::vector<std::string> forms{"2*@", "@ + @", "-@", "sqrt(@*@ + @^2)", "@ + 1", "0.5",
                                                "@.x", "",      "2 *"};
    std::string text = dice_.one_of(forms);
    for (std::size_t at; (at = text.find('@')) != std::string::npos;)
      text.replace(at, 1, known_name(m));
    try_to(m, [&] { set_expression(m, expressible(m), text); });
  }
  void rename_something(Mechanism& m) {
    const std::string which = known_name(m), to = dice_.chance(0.2) ? known_name(m) : free_name(m, "n");
    const bool point = point_index(m, which) >= 0;
    try_to(m, [&] {
      if (dice_.chance(0.3))
        point ? remove_point(m, which) : remove_parameter(m, which);
      else
        point ? rename_point(m, which, to) : rename_parameter(m, which, to);
    });
  }
  void pin(Mechanism& m) {
    if (m.sliders.size() > 5) m.sliders.erase(m.sliders.begin());
    m.sliders.push_back({dice_.one_of(parameter_addresses(m)), number(), number(),
                         static_cast<SliderScale>(dice_.below(2)), ""});
  }
  void act_on_coordinate(Mechanism& m) {
    if (m.joints.empty()) return;
    Joint& joint = m.joints[static_cast<std::size_t>(dice_.below(static_cast<int>(m.joints.size())))];
    for (Coordinate& c : joint.coordinates) {
      c.drawn = number();
      if (dice_.chance(0.5)) c.spring = CoordinateSpring{100 * positive(), number()};
      if (dice_.chance(0.1)) c.spring.reset();
      if (dice_.chance(0.2)) c.stop = Stop{number(), {}, 100 * positive()};
      if (dice_.chance(0.2)) c.drive = Drive{number()};
      if (dice_.chance(0.5)) c.drive.reset();
      c.damping = positive();
    }
  }
  void weigh(Mechanism& m) {
    if (m.bodies.empty()) return;
    take_mass_properties(m.bodies[static_cast<std::size_t>(dice_.below(static_cast<int>(m.bodies.size())))],
                         1000 * positive());
  }
  Dice dice_;
  Document document_;
  std::vector<Mechanism> past_; // what every step ought to be
  std::size_t at_ = 0;
  std::uint64_t gestures_ = 0, gesture_ = 0;
  int edits_ = 0, refused_ = 0, named_ = 0;
};

// What only compiling finds is told as an error.
bool settles(const Mechanism& m, bool details) {
  try {
    SolveOptions options;
    options.details = details;
    return Analysis(m).solve(options).status == Status::converged;
  } catch (const SceneError&) {
    return false;
  }
}

} // namespace

TEST_CASE("thousands of random edits, undos, redos and jumps") {
  const std::vector<Mechanism> starts{Document::empty_mechanism(), shipped("governor_parametric"),
                                      read_scene(everything)};
  int edits = 0, named = 0, refused = 0, valid = 0, solved = 0, settled = 0;
  const std::uint32_t seeds = few_or_all(3u, 9u); // each start once, or three times
  const int every = few_or_all(32, 16);           // edits is solved what they left
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    const Mechanism& start = starts[seed % starts.size()];
    Person person(seed, start);
    Document& document = person.document();
    for (int i = 0; i < 900; ++i) {
      CAPTURE(seed, i);
      person.act();
      if (i % 4 != 0) continue;
      const Mechanism& m = document.mechanism();
      REQUIRE(parse_scene(write_scene(m)) == m);
      snap_points(m);
      centre_of(m, document.selection());
      if (i % every != 0) continue;
      const std::vector<SceneError> mistakes = find_mistakes(m);
      Mechanism mended = m;
      mend(mended);
      if (!find_mistakes(mended).empty() || mended.bodies.empty() || mended.bodies.size() > 5) continue;
      valid += mistakes.empty();
      ++solved;
      settled += settles(mended, i % 3 == 0);
    }
    edits += person.edits();
    named += person.named();
    refused += person.refused();

    const Mechanism end = document.mechanism();
    const std::size_t position = document.position();
    REQUIRE(document.steps().size() < Document::most_steps); // nothing of the past was dropped
    while (document.undo())
      CHECK(document.mechanism() == person.past()[document.position()]);
    CHECK(document.mechanism() == start);
    CHECK_FALSE(document.unsaved());
    while (document.position() < position)
      REQUIRE(document.redo());
    CHECK(document.mechanism() == end);
    while (document.redo())
      CHECK(document.mechanism() == person.past()[document.position()]);
    CHECK(document.mechanism() == person.past().back());
  }
  CAPTURE(edits, named, refused, valid, solved, settled);
  const auto times = static_cast<int>(seeds);
  CHECK(named > 22 * times);
  CHECK(refused > 2 * times);
  CHECK(refused < 220 * times);
  CHECK(edits > 750 * times);
  CHECK(valid > 32 / every * times);
  CHECK(solved > 320 / every * times);
  CHECK(settled > 128 / every * times);
}
