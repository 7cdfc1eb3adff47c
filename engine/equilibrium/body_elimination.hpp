// The linearised balance of any mechanism as the sparse equations of its bodies: for nets and meshes of
// springs and loops, where every body feels its neighbours alone.
//
// The unknowns are the bodies' small motions X and multipliers: of the directions that tree joints leave
// fixed, and of the cut joints. With the terms of tree_elimination.hpp and, between two bodies, those of
// pair_blocks.hpp the balance of all bodies reads
//   sum over bodies of K_b X_b + what joints transmit = wrenches of the coordinates' forces
//   N_l^T (X_l - X_p) = 0 for every tree joint, dq_l = D_l^T (X_l - X_p), N^T S = 0, D^T S = I
//   J_a X_a + J_b X_b = closing for every row of a cut joint,
// which is what the coordinates' own equations say and has as many entries as there are bodies and joints,
// while coordinates meet all others on their way to the root. Factored as L D L^T with pivoting; in a plane
// net of n bodies that takes about n log n of storage and n^1.5 of work (George, Nested dissection of a
// regular finite element mesh, 1973). The signs of its eigenvalues less those of the multipliers are those
// of the Hessian that the constraints leave (Nocedal and Wright, Numerical Optimization, 2006, theorem 16.3).
#pragma once

#include "engine/equilibrium/body_stiffness.hpp"
#include "engine/equilibrium/eliminator.hpp"
#include "engine/equilibrium/pair_blocks.hpp"
#include "engine/equilibrium/sparse_factorization.hpp"

namespace flyball {

class BodyElimination final : public Eliminator {
 public:
  // Of a system with no_drive_rides().
  void linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                 const Residual<double>& residual, const Magnitudes& magnitudes) override;
  bool linearize_convex(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                        const Residual<double>& residual, const Magnitudes& magnitudes) override;
  // Takes in the metric alone, as a stiffness: then a step is the shortest one that closes the loops, and
  // multipliers are those that balance a force best. Dependent rows have pivots of the size by which the
  // loops are open, told by `tolerance`.
  void linearize_metric(const Problem& problem, const Kinematics<double>& kinematics, double tolerance);

  void factor(double shift = 0) override;
  using Eliminator::solve;
  void solve(const Eigen::VectorXd& rhs, const Eigen::VectorXd& closing, Eigen::VectorXd& x,
             Eigen::VectorXd& lambda) override;
  double metric(const Eigen::VectorXd& x, Eigen::VectorXd& product) override;
  void direction_of(const Flat& flat, Eigen::VectorXd& x) override;

  // Constraint rows that others imply, of the last factor().
  int redundant() const { return redundant_; }

 private:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

  // A link with the massless ones of its tree joint before it. Motions and wrenches are scaled to the
  // mechanism's reach but where units are given.
  struct Node : BodyStiffness {
    int parent = -1; // node; -1: stands still
    int link = -1;
    int columns = 0;
    std::array<int, 6> v{}, stage{};    // coordinates, the root's first, and the link of each
    Vec3 arm;                           // m, from the parent's origin to this one's
    Vec6 load;                          // N m, N, about the link's origin; of all beyond it
    Columns s, d, n;                    // see above
    Mat6 shift;                         // of the parent's motion to this one's
    Eigen::Matrix<double, 6, 1> weight; // metric of the coordinates themselves
    int multipliers = 0;                // first of its own among the unknowns
    Mat6 stiffness, inertial;           // of the body and all that meets it
    Vec6 g, motion;
  };

  // What an entry is made of.
  struct Value {
    double stiffness = 0, metric = 0, fixed = 0;
  };

  void lay_out(const Problem& problem, const Kinematics<double>& kinematics);
  void set_columns(const Problem& problem, const Kinematics<double>& kinematics, Node& node) const;
  void add_bodies(const Problem& problem, const Kinematics<double>& kinematics);
  void add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                 Lines lines);
  void take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
               const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines);
  void add_joints(const Problem& problem, const Eigen::VectorXd* q);
  void add_rows(const Problem& problem, const Kinematics<double>& kinematics);
  void add_pair(int a, int b, const PairBlocks& blocks);
  void finish_nodes();
  void leave_out_what_is_loose(const Problem& problem, const Magnitudes& magnitudes);
  void number();
  void find_flat_directions();
  void solve_unknowns();
  void spread(const Eigen::Ref<const Eigen::VectorXd>& held);
  void emit(int row, int column, const Value& value);
  // Entries between two nodes, and of the second by the first.
  void emit_between(int a, int b, const Mat6& ab, const Mat6& ba, const Mat6& metric_ab);
  void emit_block(int a, int first_i, int b, int first_j, const Mat6& ab, const Mat6& ba,
                  const Mat6& metric_ab);
  void emit_row(int row, int node, const Vec6& gradient);
  void emit_coordinate(int row, int coordinate, double gradient);
  int node_at(int link) const { return link < 0 ? -1 : node_of_link_[static_cast<std::size_t>(link)]; }
  Node& node(int i) { return nodes_[static_cast<std::size_t>(i)]; }
  void sum_up(double stiffness, double metric);
  Mat6 scaled(const Mat6& m) const;

  bool symmetric_ = true, solved_ = false, metric_alone_ = false, compressed_ = false;
  int coordinates_ = 0, first_row_ = 0, unknowns_ = 0, redundant_ = 0;
  double length_ = 1, tolerance_ = zero;
  std::vector<Node> nodes_;       // parents before children
  std::vector<int> node_of_link_; // -1: stands still, or part of a later link's node
  std::vector<int> next_;         // by link: what it is part of a node with
  std::vector<int> children_;
  std::vector<std::pair<int, int>> place_; // of each coordinate: node, column
  SparsePattern pattern_;
  std::vector<Value> values_;
  std::vector<double> sum_, largest_;
  std::vector<bool> loose_;           // unknowns that nothing holds
  std::vector<int> place_of_unknown_; // in what is solved; -1: loose
  SparseFactorization factors_, constraints_;
  Eigen::VectorXd work_, held_;
};

} // namespace flyball
