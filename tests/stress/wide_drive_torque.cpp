// The torques of drives once more, for further numbers: see wide_kinematics.cpp.
#include "engine/system/drive_torque.cpp"

#include "tests/stress/other_extended.hpp"
#include "tests/stress/wide.hpp"

namespace flyball {

// Laws are evaluated in double precision: in wider numbers they go on from there by their slopes, which the
// judge's Newton-Raphson needs.
template <>
void add_drive_torques<stress::Dual>(const System& system, const Parameters& p,
                                     const Configuration<stress::Dual>& q, const Kinematics<stress::Dual>&,
                                     Configuration<stress::Dual>& f) {
  Eigen::VectorXd rounded(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i)
    rounded[i] = static_cast<double>(q[i].v);
  Kinematics<double> k;
  forward<double>(system, p, rounded, 0, k);
  const LawState<double> laws{system, p, rounded, k};
  for (std::size_t i = 0; i < system.torques.size(); ++i) {
    const auto l = static_cast<std::size_t>(system.torques[i].link);
    const Link& link = system.links[l];
    if (finds_speed(link)) f[link.v] += p.links[l].force[0].resistance(q[link.q]);
    f[link.v] -= stress::Dual(laws.value(i).value);
  }
  for (const bool rates : {false, true})
    laws.add_derivatives(rates, [&](int row, int column, double slope) {
      const auto link = std::ranges::find(system.links, column, &Link::v);
      if (link == system.links.end() || link->type == LinkType::spherical) return;
      if (rates != finds_speed(*link)) return; // what else has a rate is at rest
      f[row] += stress::Dual(slope) * (q[link->q] - stress::Dual(rounded[link->q]));
    });
}

template void add_drive_torques<stress::OtherExtended>(const System&, const Parameters&,
                                                       const Configuration<stress::OtherExtended>&,
                                                       const Kinematics<stress::OtherExtended>&,
                                                       Configuration<stress::OtherExtended>&);

} // namespace flyball
