#include "engine/study/model_coordinates.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/input_effect.hpp"

#include <algorithm>

namespace flyball {

std::vector<bool> turning_entries(const System& steady) {
  std::vector<bool> out(static_cast<std::size_t>(steady.nv), false);
  for (const DriveTorqueElement& torque : steady.torques)
    out[static_cast<std::size_t>(steady.links[static_cast<std::size_t>(torque.link)].v)] = true;
  return out;
}

ModelCoordinates choose_coordinates(const System& steady, const Eigen::MatrixXd& basis, bool turning_last) {
  ModelCoordinates out;
  const std::vector<bool> driven = turning_entries(steady);
  const Eigen::Index k = basis.cols();
  Eigen::MatrixXd rest = basis.transpose();
  const auto take_turning = [&] {
    for (int v = 0; v < steady.nv; ++v) {
      if (!driven[static_cast<std::size_t>(v)]) continue;
      Eigen::VectorXd along = rest.col(v);
      const double size = along.norm();
      if (!(size > 1e-9 * basis.row(v).norm())) continue; // geared to those before
      along /= size;
      out.entries.push_back(v);
      rest -= along * (along.transpose() * rest);
    }
  };
  const auto take_others = [&] {
    Eigen::MatrixXd others = rest;
    for (int v = 0; v < steady.nv && turning_last; ++v)
      if (driven[static_cast<std::size_t>(v)]) others.col(v).setZero();
    PivotedQr qr;
    if (!qr.compute(others)) throw Refusal{"The loops' equations overflow."};
    const Eigen::Index left =
        turning_last ? qr.rank(1e-6) : k - static_cast<Eigen::Index>(out.entries.size());
    for (Eigen::Index i = 0; i < left; ++i)
      out.entries.push_back(static_cast<int>(qr.permutation()[i]));
    const Eigen::MatrixXd taken = qr.q().leftCols(left);
    rest -= taken * (taken.transpose() * rest);
  };
  if (turning_last) take_others();
  take_turning();
  if (!turning_last && k > static_cast<Eigen::Index>(out.entries.size())) take_others();
  std::ranges::sort(out.entries);
  out.phase.assign(out.entries.size(), false);
  return out;
}

LinearModel::State name_state(const MotionModel& model, int v, bool rate) {
  for (const CoordinateInfo& c : model.system.coordinates) {
    const Link& link = model.system.links[static_cast<std::size_t>(c.link)];
    const bool ball = link.type == LinkType::spherical;
    if (link.v < 0 || (ball ? link.v + c.index - link.coordinate : link.v) != v) continue;
    LinearModel::State out;
    const TreeJoint& joint = model.system.tree_joints[static_cast<std::size_t>(c.tree_joint)];
    out.name =
        ball ? joint.name + ".turn." + "xyz"[c.index - link.coordinate] : coordinate_label(joint, c.index);
    out.unit = c.angle ? "rad" : "m";
    if (rate) {
      out.name += ".rate";
      out.unit += "/s";
    }
    return out;
  }
  return {};
}

} // namespace flyball
