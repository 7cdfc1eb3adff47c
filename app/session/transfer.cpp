#include "app/session/transfer.hpp"

#include "app/session/session.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/result_functions.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <utility>

namespace flyball {

namespace {

constexpr int frequencies = 400;

FoundTransfer find_transfer(const TransferRequest& request, const TaskContext<FoundTransfer>& context) {
  LinearModelOptions options;
  options.start = request.start;
  options.nearest = true;
  options.slipping = true; // the panel says so
  options.cancel = &context.cancel;
  const std::vector<std::string> input{request.choice.input}, output{request.choice.output};
  FoundTransfer found;
  found.model = linearize(*request.mechanism, input, output, options);
  if (!found.model.refusal.empty() && has_friction(*request.mechanism)) { // what only friction holds
    options.nearest = options.slipping = false;
    LinearModel held = linearize(*request.mechanism, input, output, options);
    if (held.refusal.empty()) found.model = std::move(held);
  }
  if (!found.model.refusal.empty()) throw std::runtime_error(found.model.refusal);
  const Interruptible scope(&context.cancel);
  context.progress({"frequency response", -1});
  found.response = frequency_response(found.model, telling_frequencies(found.model, frequencies)).front();
  if (found.model.explicit_form)
    if (auto z = zeros(*found.model.explicit_form, 0, 0)) {
      found.zeros = std::move(*z);
      found.has_zeros = true;
    }
  return found;
}

// "slide", "ball.1" of what a steady state finds; of drives too where `driven`.
std::vector<std::string> coordinates_of(const Session& session, bool driven) {
  std::vector<std::string> names;
  for (const CoordinateSolution& c : session.answer.solution.coordinates)
    if (!c.dependent && (driven || !c.driven)) names.push_back(coordinate_label(c));
  return names;
}

void choose_at_first(Session& session) {
  TransferChoice& choice = session.study.transfer.choice;
  const std::vector<std::string> inputs = transfer_inputs(session), outputs = transfer_outputs(session);
  if (std::ranges::find(inputs, choice.input) == inputs.end())
    choice.input = inputs.empty() ? "" : inputs.front();
  if (std::ranges::find(outputs, choice.output) != outputs.end()) return;
  // What the response shows, or else a length, as of a collar.
  choice.output = outputs.empty() ? "" : outputs.front();
  for (const CoordinateSolution& c : session.answer.solution.coordinates)
    if (!c.driven && !c.dependent && !c.angle) choice.output = coordinate_label(c);
  const std::string& key = session.study.response.choice.quantity;
  for (const std::string& output : outputs)
    if (key == "value " + output || key == "measure " + output) choice.output = output;
}

} // namespace

std::vector<std::string> transfer_inputs(const Session& session) {
  std::vector<std::string> all = variable_numbers(session, Dampers::without);
  for (const CoordinateSolution& c : session.answer.solution.coordinates)
    if (!c.dependent && is_found(c))
      all.push_back("torque(" + coordinate_argument(coordinate_label(c)) + ")");
  for (const std::string& address : parameter_addresses(session.mechanism()))
    if (address.find(".damping") != std::string::npos) all.push_back(address);
  for (const Body& body : session.mechanism().bodies)
    for (const char* axis : {"x", "y", "z"})
      all.push_back(std::string("force_") + axis + "(" + argument_text(body.name) + ")");
  return all;
}

std::vector<std::string> transfer_outputs(const Session& session) {
  std::vector<std::string> all = coordinates_of(session, false);
  for (const std::string& label : coordinates_of(session, false))
    all.push_back("rate(" + coordinate_argument(label) + ")");
  for (const CoordinateSolution& c : session.answer.solution.coordinates)
    if (c.speed) all.push_back("rate(" + coordinate_argument(coordinate_label(c)) + ")");
  for (const DriveTorque& drive : session.answer.solution.drive_torques)
    all.push_back("torque(" + coordinate_argument(coordinate_label(drive)) + ")");
  for (const NamedMeasure& measure : session.mechanism().measures)
    all.push_back(measure.name);
  return all;
}

void update_transfer(Session& session) {
  if (session.study.open != StudyKind::transfer) return;
  TransferState& state = session.study.transfer;
  const auto take = [&] {
    if (state.found.take("It was stopped.") && !state.found.problem.empty()) state.found.found.reset();
  };
  take();
  if (session.mode != Mode::explore || !session.mistakes.empty() || !converged(session) || solving(session))
    return;
  choose_at_first(session);
  if (state.choice.input.empty() || state.choice.output.empty()) return;
  TransferRequest now{
      {session.answer.mechanism}, state.choice, start_values(session.answer.solution.coordinates)};
  if (state.found.asked && *state.found.asked == now) return;
  // While a hand drags a slider every model that was begun is worth seeing; of another choice only its own.
  const bool same = state.found.asked && state.found.asked->choice == state.choice;
  if (same && state.found.running()) return;
  state.found.ask(session.options, std::move(now), find_transfer,
                  same ? BackgroundWorker::Running::finished : BackgroundWorker::Running::cancelled);
  take(); // in immediate mode it is there
}

bool has_transfer(const Session& session) {
  const auto& found = session.study.transfer.found;
  return found.found && found.problem.empty();
}

std::string transfer_problem(const Session& session) {
  const auto& found = session.study.transfer.found;
  return with_phrase(found.problem, found.asked ? found.asked->choice.input : std::string());
}

std::string signal_phrase(const Session& session, const std::string& signal) {
  return has_number(session.mechanism(), signal) ? parameter_phrase(signal) : signal;
}

void close_transfer(Session& session) {
  TransferState fresh;
  fresh.choice = session.study.transfer.choice;
  session.study.transfer = std::move(fresh);
}

} // namespace flyball
