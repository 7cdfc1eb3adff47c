// A mechanism with one number of it free: what branches are followed in.
#pragma once

#include "engine/kkt/problem.hpp"
#include "engine/mechanism/varied_numbers.hpp"
#include "engine/search/phase_search.hpp"

#include <optional>
#include <string>

namespace flyball {

// Whether an address is of a number that expressions may make others of: of the mechanism's parameters and
// points. Both ends of a range of any other being possible, all between them is.
bool makes_others(const std::string& address);

class Family {
 public:
  // `scale`: the range of interest, in the parameter's unit.
  Family(const System& system, const Mechanism& mechanism, const std::string& address, double scale,
         KktForm form = KktForm::dense);
  Family(const Family&) = delete;
  Family& operator=(const Family&) = delete;

  void set(double value);
  // Throws SceneError where expressions make a number of this value's that no scene may have.
  void expect_possible() const;
  // Of states that stand turned (search/phase_search.hpp): with the angles of what turns among the unknowns.
  void tie(std::optional<AngleTies> ties);
  const std::optional<AngleTies>& ties() const { return ties_; }
  // To the angles of such a state, by link, at which it stays.
  void turn(const Eigen::VectorXd& starts);
  // How fast the mechanism's numbers change with it, here.
  const NumberRates& rates();
  double value() const { return value_; }
  double scale() const { return scale_; }
  const Mechanism& mechanism() const { return mechanism_; }
  Problem problem() const { return {system_, parameters_, scaling_, nullptr, form_}; }

 private:
  const System& system_;
  Mechanism mechanism_;
  VariedNumbers number_; // of mechanism_
  bool makes_others_;
  double scale_, value_ = 0;
  KktForm form_;
  Parameters parameters_;
  Scaling scaling_;
  NumberRates rates_;
  std::optional<AngleTies> ties_;
  Eigen::VectorXd starts_; // of turn()
};

} // namespace flyball
