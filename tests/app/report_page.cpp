// The report's page: well-formed, complete and safe whatever the scene's texts hold.
#include "app/report/base64.hpp"
#include "app/report/numbers.hpp"
#include "app/report/page.hpp"
#include "engine/mechanism/scene.hpp"
#include "tests/catch.hpp"
#include "tests/engine/friction_scenes.hpp"

#include <algorithm>
#include <set>

using namespace flyball;

namespace {

const std::string evil = "<script>alert(1)</script> & \"x\"";

ReportContents contents_of(const std::string& scene) {
  const std::string file = std::string(FLYBALL_ASSETS) + "/scenes/" + scene + ".json";
  return report_contents(std::make_shared<const Mechanism>(load_scene(file)), {});
}

// Everything between < and >, without what stands in <style>.
struct Tags {
  std::vector<std::string> open;
  std::set<std::string> ids;
  std::vector<std::string> links;
  std::string problem;
};

// The values of an attribute in a tag.
std::string attribute(const std::string& tag, const std::string& name) {
  const std::string key = " " + name + "=\"";
  const std::size_t at = tag.find(key);
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size();
  return tag.substr(from, tag.find('"', from) - from);
}

Tags read_tags(const std::string& page) {
  Tags out;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) {
      out.problem = "a tag that does not end";
      return out;
    }
    const std::string tag = page.substr(at + 1, end - at - 1);
    at = end;
    if (tag.starts_with("!")) continue;
    const std::string name =
        tag.substr(tag.starts_with("/"), tag.find_first_of(" /", 1) - tag.starts_with("/"));
    if (tag.starts_with("/")) {
      if (out.open.empty() || out.open.back() != tag.substr(1)) {
        out.problem = "</" + tag.substr(1) + "> closes " + (out.open.empty() ? "nothing" : out.open.back());
        return out;
      }
      out.open.pop_back();
      continue;
    }
    if (const std::string id = attribute(tag, "id"); !id.empty() && !out.ids.insert(id).second)
      out.problem = "twice the id " + id;
    if (const std::string link = attribute(tag, "href"); !link.empty()) out.links.push_back(link);
    if (!tag.ends_with("/")) out.open.push_back(name);
  }
  if (!out.open.empty()) out.problem = "not closed: " + out.open.back();
  return out;
}

void check_page(const std::string& page) {
  CHECK(page.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
  const Tags tags = read_tags(page);
  CHECK(tags.problem == "");
  CHECK(tags.links.size() >= 5);
  for (const std::string& link : tags.links) {
    INFO(link);
    CHECK(link.starts_with("#"));
    CHECK(tags.ids.contains(link.substr(1)));
  }
  for (const char* word : {"nan", "NaN", "inf ", "-inf", "<script", "javascript:", "http://localhost",
                           "https://", "src=\"http", "@import"}) {
    INFO(word);
    CHECK(page.find(word) == std::string::npos);
  }
  // The only address is the name of the language that SVG is.
  for (std::size_t at = page.find("://"); at != std::string::npos; at = page.find("://", at + 1))
    CHECK(page.substr(at - 4, 30).starts_with("http://www.w3.org/2000/svg"));
}

// The numbers of the section `id`.
std::string section(const std::string& page, const std::string& id) {
  const std::size_t from = page.find("<section id=\"" + id + "\"");
  return from == std::string::npos ? "" : page.substr(from, page.find("</section>", from) - from);
}

} // namespace

TEST_CASE("a report tells how far its curves are, all together") {
  std::vector<double> parts;
  bool solved = false, after = false;
  ReportOptions options;
  options.progress = [&](const Progress& now) {
    const bool curves = std::string_view(now.phase) == "response curves";
    if (curves)
      parts.push_back(now.part);
    else
      (parts.empty() ? solved : after) = true;
  };
  const ReportContents contents =
      report_contents(std::make_shared<const Mechanism>(test::shipped("governor")), options);
  REQUIRE(contents.curves.size() == 2);
  CHECK(solved);
  CHECK_FALSE(after);
  REQUIRE(parts.size() > 10);
  CHECK(parts.front() == 0);
  CHECK(std::ranges::is_sorted(parts));
  CHECK(std::ranges::count(parts, 0.5) > 0); // where the second begins
  CHECK(parts.back() > 0.9);
  CHECK(parts.back() <= 1);
}

TEST_CASE("a report tells all of a steady state") {
  ReportContents contents = contents_of("governor");
  contents.picture = {"light PNG", "dark PNG", 16, 9, ""};
  contents.scene = "governor.json";
  contents.date = "2026-11-24 12:00";
  const std::string page = report_page(contents);
  check_page(page);
  CHECK(page.find("data:image/png;base64," + base64("light PNG")) != std::string::npos);
  CHECK(section(page, "steady-state").find("0.785615681488 rad") == std::string::npos); // no plain space
  CHECK(section(page, "steady-state").find("0.78561568") != std::string::npos);
  CHECK(section(page, "steady-state").find("Estimated error") != std::string::npos);
  CHECK(section(page, "stability").find("Hz") != std::string::npos);
  CHECK(section(page, "loads").find("N\u00a0m") != std::string::npos);
  CHECK(section(page, "loads").find("spring on a joint") != std::string::npos);
  CHECK(section(page, "parameters").find("joints.spin.drive.speed") != std::string::npos);
  CHECK(section(page, "assumptions").find("9.80665") != std::string::npos);
  CHECK(section(page, "warnings").find("None") != std::string::npos);
  CHECK(section(page, "versions").find("Eigen") != std::string::npos);
  CHECK(section(page, "numbers").find("bodies.ball1.mass") != std::string::npos);
  // Two sliders, an angle and a length, on light and dark ground.
  const std::string curves = section(page, "response");
  std::size_t drawings = 0;
  for (std::size_t at = curves.find("<svg"); at != std::string::npos; at = curves.find("<svg", at + 1))
    ++drawings;
  CHECK(drawings == 8);
}

TEST_CASE("a report of an engine with its governor tells the law, the droop and the rates of the speed") {
  const ReportContents contents = contents_of("governor_engine");
  const std::string page = report_page(contents);
  check_page(page);
  CHECK(section(page, "laws").find("gain * (coordinate(slide) - 0.15 m)") != std::string::npos);
  REQUIRE(contents.curves.size() == 3);
  REQUIRE(contents.curves[0].over.parameter == "joints.spin.drive.load");
  REQUIRE(contents.curves[0].plots.size() == 3);
  const Plot& droop = contents.curves[0].plots[0];
  CHECK(droop.y.unit == "rad/s");
  for (const auto& [load, speed] : {std::pair(-25., 11.74560), std::pair(25., 10.29396)}) { // Haug's
    double nearest = 1;
    for (const PlotCurve& line : droop.curves)
      for (const auto& p : line.points)
        if (std::abs(p[0] - load) < 1e-9) nearest = std::min(nearest, std::abs(p[1] - speed));
    CAPTURE(load);
    CHECK(nearest < 1e-5);
  }
  const std::string rates = section(page, "sensitivities");
  CHECK(rates.find("speed of spin") != std::string::npos);
  CHECK(rates.find("(rad/s)/(N") != std::string::npos);
  // A mode that does not swing has no frequency of any kind.
  const std::string modes = section(page, "stability");
  const std::size_t still = modes.find("no oscillation");
  REQUIRE(still != std::string::npos);
  CHECK(modes.substr(still, modes.find("</tr>", still) - still).find("Hz") == std::string::npos);
}

TEST_CASE("a report's curves pass through its state") {
  const ReportContents contents = contents_of("governor");
  REQUIRE(contents.curves.size() == 2);
  for (const ReportCurve& curve : contents.curves)
    for (const Plot& plot : curve.plots) {
      REQUIRE(plot.marker);
      double nearest = 1;
      for (const PlotCurve& line : plot.curves)
        for (const auto& p : line.points)
          nearest = std::min(nearest, std::hypot((p[0] - plot.marker->x) / (curve.over.to - curve.over.from),
                                                 p[1] - plot.marker->y));
      CHECK(nearest < 0.02);
    }
}

TEST_CASE(
    "a report of what moves periodically tells its ranges and multipliers, and its motions over a slider") {
  Mechanism m = load_scene(std::string(FLYBALL_ASSETS) + "/scenes/horizontal_rotor.json");
  m.sliders.resize(1);
  m.sliders[0].from = 60;
  ReportOptions options;
  options.plotted = {"whirl", "up"};
  const ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), options);
  REQUIRE(moves(contents));
  REQUIRE(contents.curves.size() == 1);
  REQUIRE(contents.curves[0].plots.size() == 2);
  const Plot& whirl = contents.curves[0].plots[0];
  CHECK(whirl.y.label == "whirl");
  CHECK_FALSE(whirl.marker); // it turns at 30 rad/s
  REQUIRE(whirl.bands.size() == 1);
  REQUIRE(whirl.curves.size() == 1);
  CHECK(whirl.curves[0].points.size() >= 25);
  const std::string page = report_page(contents);
  check_page(page);
  CHECK(section(page, "response").find("least to most") != std::string::npos);
  CHECK(section(page, "response").find("Periodic motions as one number moves") != std::string::npos);
  CHECK(contents.periodic->stable == true);
  const std::string told = section(page, "periodic-motion");
  CHECK(told.find("across") != std::string::npos);
  CHECK(told.find("bearing") != std::string::npos);
  CHECK(told.find("Floquet multipliers") != std::string::npos);
  CHECK(told.find("across, damper") != std::string::npos);
  CHECK_FALSE(contents_of("pendulum").periodic);
}

TEST_CASE("without sliders a report has the curves of what drives are given, and of named parameters") {
  Mechanism m = load_scene(std::string(FLYBALL_ASSETS) + "/scenes/governor_engine.json");
  m.sliders.clear();
  const ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), {});
  std::vector<std::string> over;
  for (const ReportCurve& curve : contents.curves) {
    over.push_back(curve.over.parameter);
    CHECK_FALSE(curve.plots.empty());
  }
  REQUIRE_FALSE(over.empty());
  CHECK(over.front() == "joints.spin.drive.load");
  CHECK(std::ranges::find(over, "parameters.gain") != over.end());
}

TEST_CASE(
    "a report of a steady state that hunts tells its limit cycle, and its curves are of steady states") {
  Mechanism m = load_scene(std::string(FLYBALL_ASSETS) + "/scenes/governor_engine.json");
  for (Joint& joint : m.joints)
    if (joint.name == "slide") joint.coordinates[0].damping = 15; // below 21.54 N s/m it hunts
  m.sliders.resize(std::min<std::size_t>(m.sliders.size(), 1));
  const ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), {});
  REQUIRE(contents.solution.stable == false);
  CHECK_FALSE(moves(contents));
  REQUIRE(contents.cycle);
  REQUIRE(contents.cycle->status == PeriodicStatus::found);
  CHECK(contents.cycle->period == Approx(1.7448408).epsilon(1e-6));
  const std::string page = report_page(contents);
  check_page(page);
  const std::string told = section(page, "limit-cycle");
  for (const char* words : {"Period", "Mean", "Least", "Most", "slide", "Floquet multipliers", "Run time"}) {
    CAPTURE(words);
    CHECK(told.find(words) != std::string::npos);
  }
  CHECK(section(page, "response").find("Steady states as one number moves") != std::string::npos);
  CHECK_FALSE(contents_of("governor_engine").cycle); // it is stable
}

TEST_CASE("curves of a report show what friction holds and what slips") {
  Mechanism m = test::clutch_and_brake(R"("friction": {"limit": 0.5})", R"("damping": 0.05)");
  m.sliders.push_back({.parameter = "joints.brake.damping", .from = 0.01, .to = 0.1, .description = ""});
  const ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), {});
  REQUIRE(contents.curves.size() == 1);
  REQUIRE(contents.curves[0].plots.size() == 1);
  const Plot& plot = contents.curves[0].plots[0];
  CHECK(plot.y.label == "speed of clutch");
  std::set<std::string> names;
  for (const PlotCurve& curve : plot.curves)
    names.insert(curve.name);
  CHECK(names == std::set<std::string>{"held as drawn", "slips on friction"});
  check_page(report_page(contents));

  const ReportContents governor = contents_of("governor_friction");
  REQUIRE_FALSE(governor.curves.empty());
  CHECK(std::ranges::any_of(governor.curves, [](const ReportCurve& curve) {
    return std::ranges::any_of(curve.plots, [](const Plot& shown) { return !shown.bands.empty(); });
  }));
}

TEST_CASE("springs in a report balance what they hold") {
  const ReportContents contents = contents_of("governor");
  REQUIRE(contents.springs.size() == 1);
  const SpringLoad& s = contents.springs.front();
  CHECK(s.name == "slide");
  CHECK(s.force == Approx(-1000 * s.deflection));
  CHECK(s.energy == Approx(500 * s.deflection * s.deflection));
}

TEST_CASE("a scene's texts are texts in a report") {
  Mechanism m = load_scene(std::string(FLYBALL_ASSETS) + "/scenes/governor.json");
  const auto rename = [](std::string& name, std::string_view from) {
    if (name == from) name = evil;
  };
  m.name = m.description = evil;
  for (Slider& s : m.sliders)
    s.description = evil;
  for (Body& b : m.bodies)
    rename(b.name, "ball1");
  for (Joint& j : m.joints) {
    rename(j.bodies[0], "ball1");
    rename(j.bodies[1], "ball1");
    rename(j.name, "arm1");
  }
  ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), {.plotted = {evil}});
  contents.scene = evil + "\xff\x1b[31m\u202e.json";
  contents.warnings.emplace_back(evil, evil);
  contents.picture.problem = evil;
  const std::string page = report_page(contents);
  check_page(page);
  CHECK(page.find(evil) == std::string::npos);
  CHECK(page.find("<title>&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;x&quot;") != std::string::npos);
  CHECK(page.find('\x1b') == std::string::npos);
  CHECK(page.find("\u202e") == std::string::npos);
  CHECK(page.find('\xff') == std::string::npos);
}

TEST_CASE("a report without a steady state says why") {
  Mechanism m = load_scene(std::string(FLYBALL_ASSETS) + "/scenes/pendulum.json");
  m.gravity = {3, -9, 2};
  m.sliders.resize(1); // over each of which a second of motions is followed
  const ReportContents contents = report_contents(std::make_shared<const Mechanism>(m), {});
  REQUIRE(contents.solution.status != Status::converged);
  const std::string page = report_page(contents);
  check_page(page);
  CHECK(page.find("<h2>No steady state</h2>") != std::string::npos);
  CHECK(page.find(Html(contents.solution.message).text()) != std::string::npos);
  CHECK(section(page, "loads").empty());
  CHECK(section(page, "stability").empty());
}

TEST_CASE("a report tells of dry friction where there is some") {
  const std::string page = report_page(contents_of("governor_friction"));
  check_page(page);
  const std::string friction = section(page, "friction");
  CHECK(friction.find("Insensitivity") != std::string::npos);
  CHECK(friction.find("First to slip") != std::string::npos);
  CHECK(friction.find("lift") != std::string::npos);
  CHECK(section(report_page(contents_of("governor")), "friction").empty());
  // What nothing bounds has no number.
  const Mechanism held = read_scene(R"({"flyball": 1, "name": "Pendulum", "gravity": [0, -10, 0],
    "bodies": [{"name": "bob", "mass": 2, "position": [0, -0.5, 0]}],
    "joints": [{"name": "hinge", "type": "revolute", "bodies": ["ground", "bob"], "at": [0, 0, 0],
      "axis": [0, 0, 1], "friction": {"limit": 12}}]})");
  const std::string everywhere =
      section(report_page(report_contents(std::make_shared<const Mechanism>(held), {})), "friction");
  CHECK(everywhere.find("no bound") != std::string::npos);
  CHECK(everywhere.find("can go round") != std::string::npos);
  CHECK(everywhere.find("Margin") != std::string::npos);
}

TEST_CASE("numbers in a report are set as in print") {
  CHECK(written_number("-1.2e-07").text() == "−1.2\u202f×\u202f10<sup>−7</sup>");
  CHECK(quantity(-2.5, "m/s^2").text() == "−2.5\u00a0m/s²");
  CHECK(quantity(90, "°").text() == "90\u202f°");
  CHECK(quantity(1. / 0., "m").text().find("inf") == std::string::npos);
  CHECK(vector_quantity({1, 0, -2}, "N m").text() == "(1,\u20020,\u2002−2)\u00a0N\u00a0m");
}

TEST_CASE("base64 as in RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}
