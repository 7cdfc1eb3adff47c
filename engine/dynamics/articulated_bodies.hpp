// Accelerations of a tree in time proportional to its bodies, by the articulated-body algorithm
// (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 7).
//
// A body and all that hangs on it, with joints that give way, answers a motion A of its own with the wrench
// I A + g: I is its articulated-body inertia. With the axes S of the joint that holds it (6 x 1, or 6 x 3 of
// a ball joint), u = I S and the pivot D = S^T u, the joint's equation S^T (I A + g) = -f gives, for the
// parent's motion A_p, in world axes and about one point,
//   a = D^-1 (-f - S^T g - u^T A_p),   A = A_p + S a,
// and the parent feels (I - u D^-1 u^T) A_p + g + u D^-1 (-f - S^T g) of it. Driven joints give way by
// nothing: their bodies are one with the parent's.
#pragma once

#include "engine/dynamics/tree_joints.hpp"
#include "engine/kkt/body_stiffness.hpp"

namespace flyball {

class ArticulatedBodies {
 public:
  // Of a released system without loops; its first `free` coordinates give way.
  ArticulatedBodies(const System& released, int free);

  // Takes in the bodies' inertias and eliminates. False where a pivot is not positive.
  bool factor(const Parameters& parameters, const Kinematics<double>& kinematics);
  // Whether every free coordinate moves mass, of the last factor(): no pivot is near rounding beside the body
  // that it is of, had the joints next beyond not given way. (Hinges of an even chain of n links have about
  // 1/n^3 of that.)
  bool carry_all() const { return lightest_ > no_mass; }
  bool overflowed() const { return overflowed_; }

  // Solves M a + f + (what the wrenches are along the coordinates) = 0 for the first entries of a, which are
  // the free ones. Wrenches are by link about its origin (moment, force), and end up as those that the links
  // ask for with everything beyond them, g above.
  void solve(std::vector<Vec6>& wrenches, const Eigen::VectorXd& force, Eigen::VectorXd& a);
  // Of that solution: the wrench that the parent exerts on a link, about its origin.
  Vec6 transmitted(std::size_t link, const std::vector<Vec6>& wrenches) const;

 private:
  static constexpr double no_mass = 1e-11; // rounding leaves up to 1e-13

  // Of a joint of N coordinates.
  template <int N>
  struct Joint {
    Eigen::Matrix<double, 6, N> s, u;
    Eigen::Matrix<double, N, N> inverse;
    Eigen::Matrix<double, N, 1> e; // what the coordinates would do were the parent held
  };
  struct Node {
    int parent = -1;
    int holder = -1; // the nearest with a joint that gives way towards the root
    Vec3 arm, reach; // m, from the parent's origin, and from the holder's
    Mat6 inertia;
    double turned = 0, shifted = 0; // traces of what joints next beyond have taken off it, kg m^2 and kg
    Vec6 motion;
  };

  template <int N>
  bool eliminate(const Node& n, Joint<N>& joint, Mat6& left);

  std::vector<Node> nodes_; // by link
  TreeJoints<Joint> joints_;
  double lightest_ = 0; // pivot over that
  bool overflowed_ = false;
};

} // namespace flyball
