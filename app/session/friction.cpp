#include "app/session/friction.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/study/ribbon_bends.hpp"
#include "engine/study/ribbon_tips.hpp"

#include <cmath>

namespace flyball {
namespace {

FrictionReport find_friction(const FrictionRequest& request, const TaskContext<FrictionReport>& context) {
  return report_friction(*request.mechanism, request.state, request.parts, &context.cancel);
}

FoundRibbon find_ribbon(const RibbonRequest& request, const TaskContext<FoundRibbon>& context) {
  const ResponseRequest& of = request.curve->of;
  FoundRibbon found;
  const auto add = [&](const std::vector<RibbonPoint>& points) {
    found.stretches.push_back({found.points.size(), points.size()});
    found.points.insert(found.points.end(), points.begin(), points.end());
  };
  for (const BandRun& run : band_runs(*request.curve, BandOf::any)) {
    std::vector<RibbonPlace> places;
    for (const ResponsePoint* state : run.states)
      places.push_back({state->parameter, start_values(state->coordinates)});
    add(friction_ribbon_at_bends(*of.mechanism, of.address, places, run.apart, &context.cancel));
  }
  for (const std::vector<RibbonPoint>& tip :
       ribbon_tips(*of.mechanism, of.address, of.from, of.to, request.curve->result.diagram, &context.cancel))
    add(tip);
  return found;
}

std::optional<FrictionRequest> request_of(const Session& session) {
  const LiveAnswer& answer = session.answer;
  if (!answer.mechanism || answer.error || !has_friction(*answer.mechanism)) return std::nullopt;
  FrictionRequest request{{answer.mechanism}, {}, parts_of(*answer.mechanism, answer.solution.frictions)};
  if (answer.solution.status == Status::converged) request.state = start_values(answer.solution.coordinates);
  return request;
}

void update_ribbon(Session& session) {
  auto& ribbon = session.study.friction.ribbon;
  const auto& curve = session.study.response.curve.found;
  if (!session.study.friction.ribbon_wanted || session.study.open != StudyKind::response || !curve ||
      !has_friction(*curve->of.mechanism)) {
    if (ribbon.asked) ribbon = {};
    return;
  }
  ribbon.take("Making the band of friction was stopped.");
  if (session.study.response.curve.running()) return;
  RibbonRequest wanted{curve};
  if (ribbon.asked == wanted) return;
  ribbon.ask(session.options, std::move(wanted), find_ribbon, BackgroundWorker::Running::finished);
  ribbon.take();
}

} // namespace

void update_friction(Session& session) {
  update_ribbon(session);
  auto& report = session.study.friction.report;
  const auto wanted = request_of(session);
  if (!wanted) {
    if (report.asked) report = {};
    return;
  }
  report.take();
  if (report.asked == *wanted) return;
  report.ask(session.options, *wanted, find_friction, BackgroundWorker::Running::finished);
  report.take();
}

const FrictionReport* friction_report(const Session& session) {
  const auto& report = session.study.friction.report;
  const auto wanted = request_of(session);
  return wanted && report.is_of(*wanted) ? &report.found->result : nullptr;
}

std::optional<std::string> banded_quantity(const Session& session) {
  const std::string& key = session.study.response.choice.quantity;
  if (!key.starts_with("value ") && !key.starts_with("measure ")) return std::nullopt;
  return key.substr(key.find(' ') + 1);
}

std::shared_ptr<const Study<RibbonRequest, FoundRibbon>::Found> shown_ribbon(const Session& session) {
  const FrictionState& state = session.study.friction;
  if (!state.ribbon_wanted || !state.ribbon.found) return nullptr;
  const bool fits =
      state.ribbon.found->of.curve == session.study.response.curve.found || state.ribbon.running();
  return fits ? state.ribbon.found : nullptr;
}

std::vector<RibbonGap> ribbon_gaps(const Session& session) {
  std::vector<RibbonGap> gaps;
  const auto ribbon = shown_ribbon(session);
  const std::optional<std::string> name = banded_quantity(session);
  if (!ribbon || !name) return gaps;
  const std::vector<RibbonPoint>& points = ribbon->result.points;
  for (const BandStretch& stretch : ribbon->result.stretches) {
    bool goes_on = false;
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
      const BandExtent* extent = find_extent(points[i], *name);
      if ((extent && std::isfinite(extent->low) && std::isfinite(extent->high)) ||
          points[i].message.empty()) {
        goes_on = false;
      } else if (goes_on && gaps.back().why == points[i].message) {
        gaps.back().to = points[i].number;
      } else {
        gaps.push_back({points[i].number, points[i].number, points[i].message});
        goes_on = true;
      }
    }
  }
  return gaps;
}

} // namespace flyball
