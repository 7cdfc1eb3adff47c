// The page's sections, each from the contents. One that has nothing to tell is left out.
#pragma once

#include "app/report/contents.hpp"
#include "app/report/html.hpp"

namespace flyball {

struct ReportSection {
  std::string id, title;
  Html body;
};
using OptionalSection = std::optional<ReportSection>;

// Without a steady state, why there is none.
OptionalSection steady_state_section(const ReportContents& contents);
OptionalSection periodic_section(const ReportContents& contents); // where there is none
OptionalSection cycle_section(const ReportContents& contents);    // of a steady state that hunts
OptionalSection stability_section(const ReportContents& contents);
OptionalSection friction_section(const ReportContents& contents); // of scenes that have some
OptionalSection loads_section(const ReportContents& contents);
OptionalSection curves_section(const ReportContents& contents);
OptionalSection sliders_section(const ReportContents& contents);
OptionalSection laws_section(const ReportContents& contents);
OptionalSection sensitivities_section(const ReportContents& contents);
OptionalSection assumptions_section(const ReportContents& contents);
OptionalSection warnings_section(const ReportContents& contents);
OptionalSection bodies_section(const ReportContents& contents);
OptionalSection numbers_section(const ReportContents& contents); // of the scene, all of them
OptionalSection versions_section(const ReportContents& contents);

// "Stable: ...", and which of the page's colours goes with it: "good", "bad", "open".
struct ReportVerdict {
  std::string word, sentence;
  const char* color = "open";
};
ReportVerdict verdict(const Solution& solution);

} // namespace flyball
