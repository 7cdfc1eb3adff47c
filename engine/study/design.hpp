// Design mode: the value of a parameter at which a coordinate stands where it is wanted, or a measure has the
// value wanted. "At which speed is the collar at 0.12 m?"
//
// The branches over the parameter's range are followed, every crossing of the wanted value is bracketed on
// them, and each is solved by Newton-Raphson on the balance together with q = v, the parameter among the
// unknowns, with residuals in extended precision.
#pragma once

#include "engine/continuation/branches.hpp"

#include <array>
#include <functional>

namespace flyball {

struct DesignOptions {
  bool all = true;            // on disconnected branches, too
  double largest_step = 0.02; // of the branches, scaled
  const std::atomic<bool>* cancel = nullptr;
  ReportProgress progress; // as of following the branches
};

struct DesignSolution {
  double parameter = 0;       // in its unit
  double parameter_error = 0; // estimated, absolute
  double residual = 0;        // scaled, of the balance and of q = v, in extended precision
  int iterations = 0;         // of the Newton-Raphson run that ends here
  std::optional<double> rate; // d wanted / d parameter; none at a fold
  int branch = 0;             // in the diagram
  bool connected = true;      // ResponseBranch::connected
  ResponsePoint at;           // coordinates with errors, stability, eigenvalues, reactions, drive torques
};

// found: at least one solution. constant: all along a branch it has the value, which singles out no number.
enum class DesignEnd { found, never, constant, cancelled, no_branch };

struct DesignAnswer {
  Status status = Status::not_converged;      // converged: at least one solution; else `message` says why not
  std::string message;                        // a sentence or two; the range covered where v is never reached
  std::vector<DesignSolution> solutions;      // stable ones first, then connected ones, then by parameter
  std::string wanted, unit;                   // what is wanted, and in which unit
  double value = 0;                           // of it
  CoordinateSolution coordinate;              // name and kind of a coordinate wanted; of a measure empty
  double lowest = 0, highest = 0;             // what it covers on the branches followed
  std::vector<std::array<double, 2>> covered; // the same in parts, those that overlap as one
  DesignEnd end = DesignEnd::no_branch;
  double run_time_s = 0;
};

// `wanted` as of find_wanted(); `value` in its unit (angles without spring or stop modulo turns). Throws
// SceneError for an address or a coordinate that does not exist or is driven.
DesignAnswer design(const Mechanism& mechanism, const std::string& address, double from, double to,
                    const std::string& wanted, double value, const DesignOptions& options = {});

// What a message calls the wanted and the varied number, and how it shows them.
struct DesignWords {
  std::string wanted, wanted_unit;
  std::string varied, varied_unit;
  std::function<double(double)> shown, shown_varied; // from SI units; empty: in these
};
// What became of asking for it with the number between `from` and `to`, on `all` branches or on connected
// ones; as DesignAnswer::message in other words.
std::string design_message(const DesignAnswer& answer, double from, double to, bool all,
                           const DesignWords& words);

} // namespace flyball
