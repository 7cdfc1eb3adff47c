// The matrix of implicit steps of a tree, M + gamma C + gamma^2 K N (motion_solver.hpp), factored and solved
// with in time proportional to the bodies: elimination from the tips to the root.
//
// Derivation. Let a body have the velocity V and the acceleration A (twists in world axes about one fixed
// point), and ask for the wrench F = I A + V x* I V. A change of the coordinates moves it by X. With the axes
// S of coordinates j on the way to it, whose rates are S' and S'' where they are carried along with it,
//   X = sum S dq,  Y = X' = sum (S' dq + S ds),  Z = X'' = sum (S'' dq + T ds + S da),
// S' = V x S, S'' = A x S + V x S', T = (V + V_p) x S with V_p of the parent (2 S' of a single axis). Then
// dV = Y + X x V and dA = Z + Y x V + X x A, and what the body asks for changes by
//   dF = X x* F + B Y + I Z,   B x = -I (V x x) + x x* I V + V x* I x
// (the terms of engine/system/linearization.hpp; Echeandia and Wensing, 2021). Weight is in A. A force that
// keeps its direction in the world adds K X, one of the air D Y and in a wind K X, as in body_stiffness.hpp.
// So a body feels 18 numbers xi = gamma (X, Y, Z) of its own motion, where bodies at rest in a turning frame
// (tree_kkt.hpp) feel 6, and all of them are handed on from body to body as they are. With
// dq = gamma N x + b_q and gamma da = x - b_s for the unknown x = ds
//   xi = xi_p + sigma x + tau,  sigma = gamma^2 P N + gamma W + E,  tau = gamma P b_q - E b_s,
//   P = (S; S'; S''),  W = (0; S; T),  E = (0; 0; S).
// With F the wrench of a link and all beyond it, let its change be gamma X x* F + H xi + g once everything
// beyond is eliminated. The joint, of stiffness k and damping c, asks for
//   S^T (H xi + g + L (gamma N x + b_q) gamma) + gamma k (gamma N x + b_q) + gamma c x = 0,  L = S x* F,
// which gives, with u = H sigma + gamma^2 L N, the pivot D = S^T u + gamma^2 k N + gamma c, r = S^T H and
// h = g + H tau + gamma L b_q,
//   x = -D^-1 (S^T h + gamma k b_q + r xi_p),
// and the parent feels (H - u D^-1 r) xi_p + h - u D^-1 (S^T h + gamma k b_q).
// Pivots are not exchanged: beside M, which is positive definite, the rest is small with gamma.
#pragma once

#include "engine/dynamics/body_wrenches.hpp"
#include "engine/dynamics/tree_joints.hpp"

namespace flyball {

class NewtonElimination {
 public:
  // Of a released system without loops; its first `free` coordinates are solved for.
  NewtonElimination(const System& released, int free);

  // Takes in the derivatives at a point whose kinematics have its accelerations. False where they are not
  // finite.
  bool linearise(const MotionPoint& point);
  // `turns`: N by ball joint. False where a pivot vanishes.
  bool factor(double gamma, const std::vector<Mat3>& turns);
  // ds in the place of b_s.
  void solve(const Eigen::VectorXd& b_q, Eigen::VectorXd& s);

 private:
  using Vec18 = Eigen::Matrix<double, 18, 1>;
  using Mat618 = Eigen::Matrix<double, 6, 18>;

  // Of a joint of N coordinates.
  template <int N>
  struct Joint {
    using Square = Eigen::Matrix<double, N, N>;
    Eigen::Matrix<double, 6, N> s, load;      // S, L
    Eigen::Matrix<double, 18, N> place, rate; // P, W
    Square stiffness, damping;
    // Of the last factor().
    Eigen::Matrix<double, 18, N> sigma;
    Eigen::Matrix<double, 6, N> u, by_place, by_rate; // of h: with b_q, and with -b_s
    Eigen::Matrix<double, N, 18> row;                 // D^-1 r
    Square inverse;
    Eigen::Matrix<double, N, 1> e; // what the coordinates would do were the parent held
  };
  struct Node {
    int parent = -1;
    Vec3 arm;      // m, from the parent's origin
    Mat618 own, h; // of the body alone, and with what is beyond
    Vec6 g;
    Vec18 motion; // xi
  };

  void set_body(const MotionPoint& point, std::size_t link);
  template <int N>
  void set_joint(const MotionPoint& point, std::size_t link, int v, Joint<N>& joint);
  template <int N>
  bool eliminate(Node& n, const Eigen::Matrix<double, N, N>& turn, Joint<N>& joint);

  const System& system_;    // released
  std::vector<Node> nodes_; // by link
  TreeJoints<Joint> joints_;
  std::vector<Vec6> loads_; // F, by link
  double gamma_ = 0;
};

} // namespace flyball
