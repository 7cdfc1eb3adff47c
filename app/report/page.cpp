#include "app/report/page.hpp"

#include "app/report/base64.hpp"
#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "app/report/style.hpp"
#include "app/session/parameter_list.hpp"
#include "engine/mechanism/address.hpp"

namespace flyball {
namespace {

constexpr OptionalSection (*all_sections[])(const ReportContents&) = {
    steady_state_section,  periodic_section,    stability_section, cycle_section,   friction_section,
    loads_section,         bodies_section,      sliders_section,   laws_section,    curves_section,
    sensitivities_section, assumptions_section, warnings_section,  numbers_section, versions_section};

Html image(const std::string& png, const char* which, const ReportPicture& picture, const std::string& alt) {
  return void_element("img", {{"class", which},
                              {"src", "data:image/png;base64," + base64(png)},
                              {"width", std::to_string(picture.width)},
                              {"height", std::to_string(picture.height)},
                              {"alt", alt}});
}

Html picture_of(const ReportContents& contents) {
  const ReportPicture& p = contents.picture;
  if (p.light.empty() || p.dark.empty())
    return p.problem.empty() ? Html()
                             : element("p", "There is no picture: " + p.problem, {{"class", "note"}});
  const bool found = contents.solution.status == Status::converged;
  const std::string words =
      found ? "In its steady state; a dashed outline is the pose it is drawn in." : "As it is drawn.";
  const std::string alt = contents.mechanism->name + ": " + words;
  return element("figure", image(p.light, "light", p, alt) + image(p.dark, "dark", p, alt) +
                               element("figcaption", words)) +
         "\n";
}

// Whoever solves the file finds something else.
Html explored_line(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  Html numbers;
  for (const ExploredNumber& each : contents.explored) {
    const std::string unit = parameter_unit(m, each.address);
    numbers += Html(numbers.empty() ? "" : "; ") + parameter_phrase(each.address) + " " +
               quantity(get_parameter(m, each.address), unit, 9) + " (in the file " +
               quantity(each.in_file, unit, 9) + ")";
  }
  if (numbers.empty()) return {};
  return element("p", Html("Explored, other than in the file: ") + numbers + ".", {{"class", "note"}});
}

Html header(const ReportContents& contents) {
  const Mechanism& m = *contents.mechanism;
  const Solution& s = contents.solution;
  Html kicker = "Steady-state report";
  if (!contents.scene.empty()) kicker += Html(" · ") + contents.scene;
  if (!contents.date.empty()) kicker += Html(" · ") + element("time", contents.date);
  Html out = element("p", kicker, {{"class", "kicker"}}) + element("h1", m.name);
  if (!m.description.empty()) out += element("p", m.description, {{"class", "description"}});
  out += explored_line(contents);
  const ReportVerdict v = verdict(s);
  Html words = element("span", v.word, {{"class", v.color}});
  if (s.status == Status::converged) words += element("span", Html("solved in ") + duration(s.run_time_s));
  return element("header", out + element("p", words, {{"class", "verdict"}})) + "\n";
}

} // namespace

std::string report_page(const ReportContents& contents) {
  Html entries, body;
  for (const auto& make : all_sections) {
    const OptionalSection section = make(contents);
    if (!section) continue;
    entries += element("li", element("a", section->title, {{"href", "#" + section->id}}));
    body += element("section", element("h2", section->title) + "\n" + section->body, {{"id", section->id}}) +
            "\n";
  }
  const Html head =
      void_element("meta", {{"charset", "utf-8"}}) +
      void_element("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
      void_element("meta", {{"name", "color-scheme"}, {"content", "light dark"}}) +
      element("title", contents.mechanism->name + " – steady-state report") +
      element("style", Html::markup(std::string(report_style())));
  const Html contents_list =
      element("nav", element("h2", "Contents") + element("ol", entries), {{"aria-label", "Contents"}});
  const Html page = element("html",
                            element("head", head) + "\n" +
                                element("body", "\n" + header(contents) + picture_of(contents) +
                                                    contents_list + "\n" + element("main", "\n" + body)),
                            {{"lang", "en"}});
  return "<!DOCTYPE html>\n" + page.text() + "\n";
}

} // namespace flyball
