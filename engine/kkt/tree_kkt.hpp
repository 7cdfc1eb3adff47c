// The linearised balance of a tree, solved in time proportional to its bodies by eliminating coordinate after
// coordinate from the tips to the root, as the articulated-body algorithm does (Featherstone, Rigid Body
// Dynamics Algorithms, 2008, chapter 7) with stiffness in the place of inertia.
//
// Derivation. Where no drive rides on a free coordinate, the parts beyond a drive stand still in its frame,
// and the wrench F_b that a body's inertia and loads ask for depends on the body's pose alone. A small motion
// X_b (a twist) turns the wrench along and changes it by a 6 x 6 stiffness: dF_b = X_b x* F_b + K_b X_b. With
// F_l the sum over the subtree of link l, f_l = S_l^T F_l and dS_l = X_p x S_l for the parent's motion X_p,
//   df_l = S_l^T (G_l - X_p x* F_l) + k_l dq_l,  G_l = dF_l = sum of (X_b x* F_b + K_b X_b),  X_l = X_p + S_l
//   dq_l.
// Let G_l - X_l x* F_l = H_l X_l + g_l once everything beyond l is eliminated. Then with u = H_l S_l + S_l x*
// F_l, r = S_l^T H_l and the pivot D = S_l^T u + k_l,
//   D dq_l = b_l - S_l^T g_l - r X_p,   H_p = K_p + sum over children of (H_l - u D^-1 r),
//   g_p = sum of (g_l + u D^-1 (b_l - S_l^T g_l)).
// X x* F is antisymmetric in X. Where there is a potential, H plus half of it is symmetric, r = u^T, and the
// symmetric part is carried alone. The pivots are those of L D L^T, so their signs are those of the Hessian's
// eigenvalues (Sylvester).
//
// The metric adds to the inertia of the bodies what it takes to turn each as if it were as large as the
// mechanism: what bends is then measured, too.
#pragma once

#include "engine/kkt/body_stiffness.hpp"
#include "engine/kkt/kkt_system.hpp"

namespace flyball {

// Of a subtree, about a point: norms of the blocks of its stiffness before elimination, and of its inertia.
struct SubtreeSizes {
  double m = 0, mf = 0, f = 0, heavy_m = 0, heavy_mf = 0, heavy_f = 0;
  static SubtreeSizes Zero() { return {}; }
  SubtreeSizes operator+(const SubtreeSizes& o) const {
    return {m + o.m, mf + o.mf, f + o.f, heavy_m + o.heavy_m, heavy_mf + o.heavy_mf, heavy_f + o.heavy_f};
  }
};

class TreeKkt final : public KktSystem {
 public:
  // Of a system with is_plain_tree(). Speeds that are found are left out, zero in what it gives: the tree at
  // given speeds, its shafts held (speeds_kkt.hpp).
  void linearize(const Problem& problem, const Unknowns& z, const Evaluation& evaluation) override;
  // Takes in K + rate^2 M, or with velocities K + rate (C + G) + rate^2 M, in the place of K (rate in 1/s).
  void linearize_motion(const Problem& problem, const Unknowns& z, const Evaluation& evaluation, double rate,
                        bool with_velocities);
  void factor(double shift = 0) override;
  bool limit_turns(double most, Eigen::VectorXd& x) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  double metric_of_solution(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  const std::vector<NullDirection>& null_directions() override { return directions_; }
  void direction_of(const NullDirection& direction, Eigen::VectorXd& x) override;

 private:
  void solve_to(double enough, const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
                Eigen::VectorXd& lambda) override;
  // What a rotation of three coordinates has in the place of a node's one. Scaled.
  struct Ball {
    Eigen::Matrix<double, 6, 3> s, u, r; // r transposed
    Mat3 joint, inverse;
    Vec3 metric, noise, e;
  };

  // What sweeps read together lies together: caches end before large trees do.
  struct Node : BodyInertia {
    Mat6 own;           // K_b
    Vec3 force, moment; // F_l about the link's origin
    int link = -1, parent = -1, v = -1;
    int ball = -1;     // in balls_
    int branches = -1; // in the sweeps' stores: where children add up that are not the next node
    int last = -1;     // of these children
    bool angular = false;
    Vec3 axis;      // of the one coordinate, scaled
    double joint;   // stiffness of the coordinate
    double metric;  // of the coordinate itself
    double noise;   // below it a pivot is rounding
    double inverse; // of the pivot
    double e;       // see outwards()
    Vec3 arm;       // m, from the parent's origin
    Vec6 u, motion;
    bool one() const { return v >= 0 && ball < 0; }
    int at() const { return angular ? 0 : 3; } // of the axis in a twist
  };

  template <class Sum, class Visit>
  void inwards(std::vector<Sum>& branches, Visit visit);
  void place(int i, const Link& link);
  void add_motion(const Problem& problem, const Kinematics<double>& k);
  void set_joint(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                 const Magnitudes& magnitudes, const SubtreeSizes& sizes, double least, Node& n);
  void eliminate_one(Node& n, double shift, Mat6& h);
  void eliminate_three(Node& n, double shift, Mat6& h);
  void outwards(double most, Eigen::VectorXd& x);
  void clear_left_out(Eigen::VectorXd& x) const;

  bool symmetric_ = true;
  double rate_ = 0; // see linearize_motion()
  bool with_velocities_ = false;
  std::vector<Node> nodes_;       // of mobile links, parents before children
  std::vector<int> node_of_link_; // -1: immobile
  std::vector<int> left_out_;     // places of speeds that are found, in q_R
  std::vector<Ball> balls_;
  std::vector<Vec6> rows_; // r of a node's one coordinate, where that is not u
  std::vector<Mat6> stiffness_branches_;
  std::vector<Vec6> wrench_branches_;
  std::vector<SubtreeSizes> size_branches_;
  int branching_ = 0; // nodes with children that are not the next node
  std::vector<NullDirection> directions_;
};

} // namespace flyball
