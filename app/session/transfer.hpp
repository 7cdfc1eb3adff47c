// The linear model of the state that is shown, of one input and one output: transfer function, poles and
// zeros. It follows the numbers as they move. Nothing of it is made before a person asks.
#pragma once

#include "app/session/shared_mechanism.hpp"
#include "app/session/study.hpp"
#include "engine/study/frequency_response.hpp"

#include <string>
#include <utility>
#include <vector>

namespace flyball {

struct Session;

// As read_signals() has them; empty: not chosen yet.
struct TransferChoice {
  std::string input, output;
  bool operator==(const TransferChoice&) const = default;
};

struct TransferRequest {
  SharedMechanism mechanism;
  TransferChoice choice;
  std::vector<std::pair<std::string, double>> start; // the state that is shown
  bool operator==(const TransferRequest&) const = default;
};

struct FoundTransfer {
  LinearModel model;
  std::vector<BodePoint> response;
  std::vector<std::complex<double>> zeros; // 1/s
  bool has_zeros = false;                  // they are known
};

struct TransferState {
  TransferChoice choice;
  Study<TransferRequest, FoundTransfer> found;
};

// Takes the model; makes it anew after every change of what it is about.
void update_transfer(Session& session);
// Everything goes but what was chosen.
void close_transfer(Session& session);

// Whether there is a model of what is shown.
bool has_transfer(const Session& session);

// Why there is no model of it, with the input in words; empty where nothing is wrong.
std::string transfer_problem(const Session& session);

// An input or output in words: "speed of spin" of a number's address; others as they are written.
std::string signal_phrase(const Session& session, const std::string& signal);

// What may be chosen: numbers, and torques and forces that are added; coordinates, rates, measures and what
// drives give.
std::vector<std::string> transfer_inputs(const Session& session);
std::vector<std::string> transfer_outputs(const Session& session);

} // namespace flyball
