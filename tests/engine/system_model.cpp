#include "tests/engine/system_model.hpp"

#include <algorithm>
#include <cmath>

namespace flyball::testing {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

Mechanism written_out(Mechanism m, const System& system) {
  for (const TreeJoint& t : system.tree_joints) {
    if (t.joint >= 0) continue;
    Joint joint;
    joint.name = t.name;
    joint.type = JointType::free;
    joint.bodies = {t.parent_body < 0 ? std::string(ground_name) : m.bodies[at(t.parent_body)].name,
                    m.bodies[at(t.child_body)].name};
    joint.at = m.bodies[at(t.child_body)].position;
    joint.coordinates.resize(6);
    m.joints.push_back(joint);
  }
  return m;
}

} // namespace

Model::Model(const Mechanism& m, const CutChoice& choice) : mechanism(m), system(compile(m, choice)) {
  bind(system, m, parameters);
  drawn_configuration(system, parameters, drawn);
  mechanism = written_out(m, system);
  for (const CutJoint& cut : system.cuts)
    cuts.push_back(mechanism.joints[at(cut.joint)].name);
}

bool Model::has_twins() const {
  return std::ranges::any_of(system.tree_joints, &TreeJoint::closes_loop);
}

ReferenceState Model::state(const Eigen::VectorXd& q, double t) const {
  ReferenceState s;
  for (const CoordinateInfo& c : system.coordinates) {
    const TreeJoint& joint = system.tree_joints[at(c.tree_joint)];
    if (joint.closes_loop) continue;
    Real value = coordinate_value(system, parameters, q, c);
    if (system.links[at(c.link)].drive >= 0) value += Real(parameters.links[at(c.link)].speed) * Real(t);
    s.coordinates[joint.name].push_back(value);
  }
  return s;
}

MatrixR Model::tangents(const Eigen::VectorXd& q, const reference::Tree& tree) const {
  MatrixR map = MatrixR::Zero(static_cast<Eigen::Index>(tree.coordinates.size()), system.nv);
  for (const Link& link : system.links) {
    const TreeJoint& joint = system.tree_joints[at(link.tree_joint)];
    if (link.v < 0 || joint.closes_loop) continue;
    const int row = tree.first[at(joint_index(mechanism, joint.name))] + link.coordinate;
    if (link.type != LinkType::spherical) {
      map(row, link.v) = 1;
      continue;
    }
    // Reversed: the engine turns the joint's parent against its child.
    const Quat d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
    map.block<3, 3>(row, link.v) = link.reversed ? Mat3(-d.toRotationMatrix().transpose()).cast<Real>().eval()
                                                 : reference::Mat3R(reference::Mat3R::Identity());
  }
  return map;
}

Eigen::VectorXd Model::displaced(Dice& dice, double size) const {
  const auto clear = [&](const Eigen::VectorXd& q) {
    for (const Link& link : system.links) {
      if (link.v < 0) continue;
      const bool rotation = link.type == LinkType::spherical;
      const LinkParameters& p = parameters.links[static_cast<std::size_t>(&link - system.links.data())];
      const Vec3 r = rotation ? rotation_vector<double>(link, p, q) : Vec3(q[link.q], 0, 0);
      if (rotation && r.norm() > 3) return false;
      for (int i = 0; i < (rotation ? 3 : 1); ++i) {
        const CoordinateForce& f = p.force[at(i)];
        if (f.has_lower && std::abs(r[i] - f.lower) < 0.01) return false;
        if (f.has_upper && std::abs(r[i] - f.upper) < 0.01) return false;
      }
    }
    return true;
  };
  Eigen::VectorXd q = drawn;
  for (int tries = 0; tries < 100; ++tries) {
    q = drawn;
    Eigen::VectorXd step(system.nv);
    for (const Link& link : system.links) {
      const double reach = link.type == LinkType::prismatic ? size / 3 : size;
      for (int i = 0; link.v >= 0 && i < (link.type == LinkType::spherical ? 3 : 1); ++i)
        step[link.v + i] = dice.between(-reach, reach);
    }
    retract<double>(system, step, q);
    if (clear(q)) break;
  }
  return q;
}

bool Model::close(Eigen::VectorXd& q, double t) const {
  if (system.rows == 0) return true;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(system.rows);
  for (int i = 0; i < 60 && system.nv > 0; ++i) {
    const Point<double> point = evaluate_at<double>(*this, q, none, t);
    if (point.residual.phi.cwiseAbs().maxCoeff() < 3e-16) return true;
    Linearization l;
    linearize_constraints(system, parameters, point.kinematics, l);
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    decomposition.setThreshold(1e-9);
    decomposition.compute(l.constraint);
    const Eigen::VectorXd step = decomposition.solve(-point.residual.phi);
    retract<double>(system, step * std::min(1., 0.3 / step.norm()), q);
    if (step.norm() < 1e-15) break;
  }
  return evaluate_at<double>(*this, q, none, t).residual.phi.cwiseAbs().maxCoeff() < 1e-14;
}

template <class S>
Point<S> evaluate_at(const Model& model, const Configuration<S>& q, const Configuration<S>& lambda,
                     double t) {
  Point<S> p;
  forward<S>(model.system, model.parameters, q, t, p.kinematics);
  evaluate_residual<S>(model.system, model.parameters, q, lambda, p.kinematics, p.residual);
  return p;
}

Linearization linearize_at(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& lambda,
                           double t) {
  const Point<double> p = evaluate_at<double>(model, q, lambda, t);
  Linearization l;
  linearize(model.system, model.parameters, q, lambda, p.kinematics, p.residual, l);
  linearize_motion(model.system, model.parameters, q, p.kinematics, l);
  return l;
}

MatrixR null_space(const MatrixR& a) {
  if (a.rows() == 0 || a.cols() == 0) return MatrixR::Identity(a.cols(), a.cols());
  const Eigen::JacobiSVD<MatrixR> svd(a, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-8L)
    ++rank;
  return svd.matrixV().rightCols(a.cols() - rank);
}

double largest(const VectorR& v) {
  return v.size() == 0 ? 0 : static_cast<double>(v.cwiseAbs().maxCoeff());
}

double largest(const MatrixR& m) {
  return m.size() == 0 ? 0 : static_cast<double>(m.cwiseAbs().maxCoeff());
}

template Point<double> evaluate_at(const Model&, const Configuration<double>&, const Configuration<double>&,
                                   double);
template Point<Extended> evaluate_at(const Model&, const Configuration<Extended>&,
                                     const Configuration<Extended>&, double);

} // namespace flyball::testing
