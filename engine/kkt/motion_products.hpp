// M x, (C + G) x and K x of the linearised motion M q'' + (C + G) q' + K q = 0, J x and J^T lambda, without
// any of these matrices: one pass from the root outwards for the bodies' motions and one back for the
// wrenches, at a cost that grows with the bodies.
//
// Derivation. Beyond a drive that rides on no free coordinate everything stands still in the drive's frame,
// which turns with w. There a body's small motion X (a twist) asks for the wrench M_b X'' + D_b X' + K_b X +
// X x* F_b: M_b its inertia, D_b of Coriolis forces and those of the air, K_b and F_b those of tree_kkt.hpp.
// The coordinates feel what is summed up beyond them, as derived there; K x is needed beside elimination to
// tell how good a solution is.
#pragma once

#include "engine/kkt/pair_blocks.hpp"

#include <array>

namespace flyball {

// In scaled units (see Scaling). Of a system with no_drive_rides().
class MotionProducts {
 public:
  // At z, where kinematics and residual must be; the residual's wrenches of the links are used.
  void linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                 const Residual<double>& residual);

  // The same for velocity() and inertia() alone, and stiffness() where it is asked for, at a part of the
  // cost.
  void linearize_forces(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                        const Residual<double>& residual, bool with_stiffness);

  int coordinates() const { return coordinates_; }

  // The bodies' momenta, each divided by the root of its inertia: L x with L^T L = M, without entries that no
  // motion has. L^T of such.
  int momenta() const { return momentum_count_; }
  void momentum(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  void momentum_transposed(const Eigen::VectorXd& p, Eigen::VectorXd& out);

  void mass(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  // The same without momenta.
  void inertia(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  void velocity(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  void stiffness(const Eigen::VectorXd& x, Eigen::VectorXd& out);
  // 2-norm of what K x is made of, in the motions of the bodies: by each coordinate's own stiffness, the
  // load that it bears, and what acts between two bodies.
  double stiffness_terms(const Eigen::VectorXd& x);
  void constraint(const Eigen::VectorXd& x, Eigen::VectorXd& out) const; // J x
  void constraint_transposed(const Eigen::VectorXd& lambda, Eigen::VectorXd& out) const;

  // C + G is more than rounding: there are dampers or drag, or Coriolis forces along the coordinates.
  bool velocity_matters() const { return velocity_matters_; }

 private:
  void take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
               const Residual<double>& residual);

  struct Node {
    BodyInertia body;
    int link = -1, parent = -1, v = -1;
    int columns = 0; // of its coordinates: 0, 1 or 3
    bool angular = false;
    Mat3 axes;          // of the coordinates, scaled; a single one is in the first column
    Mat3 joint, damper; // of the coordinates themselves, scaled
    Vec3 arm;           // m, from the parent's origin
    std::array<int, 6> momentum{-1, -1, -1, -1, -1, -1}; // its entries there; -1: none
    bool heavy = false;
    double root_of_mass = 0;
    Vec3 centre;          // m, of mass, from the origin
    Mat3 root_of_inertia; // about the mass centre
    bool stiff = false, damped = false;
    Mat6 stiffness, damping; // K_b and D_b, where these say so
    Vec6 load;               // of the subtree, about the origin
    Vec6 motion, wrench;
  };
  // What acts between two bodies; nodes, -1: stands still.
  struct Pair {
    int a = -1, b = -1;
    PairBlocks blocks;
  };
  struct Damper {
    int a = -1, b = -1;
    PairDamping pair;
  };
  struct Gradient {
    int row = 0, v = 0;
    double value = 0;
  };

  void add_links(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                 const Residual<double>& residual);
  void set_body(const Problem& problem, const Kinematics<double>& k, Node& n);
  void set_joint(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k, Node& n);
  void add_body_forces(const Problem& problem, const Kinematics<double>& k);
  void add_pair(const PairEnds& ends, const PairBlocks& blocks);
  void add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& k);
  void add_damper(const PairEnds& ends, const PairDamping& damping);
  void add_dampers(const Problem& problem, const Kinematics<double>& k);
  void set_rows(const Problem& problem, const Kinematics<double>& k);
  bool coriolis_matters();
  void number_momenta();
  static Vec6 momentum_of(const Node& n);

  int node_at(int link) const { return link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(link)]; }
  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  Vec6 motion_of(int i) { return i < 0 ? Vec6(Vec6::Zero()) : node(i).motion; }
  void outwards(const Eigen::VectorXd& x);
  template <class Own>
  void inwards(Eigen::VectorXd& out, Own own);

  int coordinates_ = 0, rows_ = 0, momentum_count_ = 0;
  bool velocity_matters_ = false, has_dampers_ = false;
  bool with_momenta_ = true, with_stiffness_ = true;
  std::vector<Node> nodes_; // of mobile links, parents before children
  std::vector<int> node_of_link_;
  std::vector<Pair> pairs_;
  std::vector<Damper> dampers_;
  std::vector<Gradient> gradients_; // of the constraints, scaled
  Eigen::VectorXd momenta_;
};

} // namespace flyball
