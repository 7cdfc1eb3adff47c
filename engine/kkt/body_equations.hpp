// The linearised balance of any mechanism as the sparse equations of its bodies: for nets and meshes of
// springs and loops, where every body feels its neighbours alone.
//
// The unknowns are the bodies' small motions X and multipliers: of the directions that tree joints leave
// fixed, and of the cut joints. With the terms of tree_kkt.hpp and, between two bodies, those of
// pair_blocks.hpp the balance of all bodies reads
//   sum over bodies of K_b X_b + what joints transmit = wrenches of the coordinates' forces
//   N_l^T (X_l - X_p) = 0 for every tree joint, dq_l = D_l^T (X_l - X_p), N^T S = 0, D^T S = I
//   J_a X_a + J_b X_b = closing for every row of a cut joint,
// which is what the coordinates' own equations say and has as many entries as there are bodies and joints,
// while coordinates meet all others on their way to the root. Units of energy in every equation.
#pragma once

#include "engine/kkt/body_entries.hpp"
#include "engine/kkt/body_nodes.hpp"
#include "engine/kkt/pair_blocks.hpp"

namespace flyball {

// What the matrix of a motion's equations is a sum of: M, C + G and K.
struct MotionWeights {
  double mass = 0, velocity = 0, stiffness = 1;
};

class BodyEquations {
 public:
  // The balance at z, of a system with no_drive_rides(). Kinematics, residual and magnitudes must be at z;
  // the residual's wrenches of the links are used, not its sums with multipliers.
  void assemble(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                const Residual<double>& residual, const Magnitudes& magnitudes, Lines lines);

  // The same of a motion's equations of second order: in the place of K the sum by `weights`, K and C those
  // of bodies that stand still in their drive's frame. Residual and kinematics are those of the motion, with
  // its accelerations where K is asked for; without, residual and magnitudes are not looked at.
  void assemble_motion(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
                       const Residual<double>& residual, const Magnitudes& magnitudes,
                       const MotionWeights& weights);

  // The constraints, with the metric alone as a stiffness.
  void assemble_metric(const Problem& problem, const Kinematics<double>& kinematics,
                       BodyEntries::Zeros zeros);

  const BodyNodes& nodes() const { return nodes_; }
  bool symmetric() const { return pattern().symmetric; }
  bool compressed() const; // a line under compression, of the last assemble()
  int coordinates() const { return coordinates_; }
  int rows() const { return rows_; } // of cut joints
  int multipliers() const { return unknowns_ - 6 * nodes_.size(); }
  double mass() const { return mass_; } // kg, of what moves

  // By unknown: motions without stiffness and constraint, left out of what follows.
  const std::vector<bool>& unconstrained() const { return entries_.unconstrained(); }

  // The matrix, and its values with multiples of stiffness and metric (1/s^2). Valid until the next call.
  const SparsePattern& pattern() const { return entries_.pattern(); }
  const std::vector<double>& sum(double stiffness, double metric) { return entries_.sum(stiffness, metric); }

  // The right-hand side, on the reduced unknowns, of scaled forces of the coordinates and the rows' closing.
  void assemble_rhs(const Eigen::VectorXd& force, const Eigen::VectorXd& closing, Eigen::VectorXd& reduced);

  // Of a solution on the reduced unknowns the scaled coordinates, and the rows' multipliers; zero for what is
  // left out.
  void extract_solution(const Eigen::Ref<const Eigen::VectorXd>& reduced, Eigen::Ref<Eigen::VectorXd> x);
  void extract_solution(const Eigen::Ref<const Eigen::VectorXd>& reduced, Eigen::Ref<Eigen::VectorXd> x,
                        Eigen::VectorXd& lambda);

 private:
  void lay_out(const Problem& problem, bool symmetric, BodyEntries::Zeros zeros);
  void add_all(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics,
               const Residual<double>& residual, Lines lines);
  // Of the bodies of one part, and of its elements; of the elements between parts.
  void add_bodies(const Problem& problem, const Kinematics<double>& kinematics, std::size_t part, bool stiff);
  void add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& kinematics, Lines lines,
                 const SystemPart& part, std::size_t list);
  void add_body_forces(const Problem& problem, const Kinematics<double>& kinematics);
  void add_dampers(const Problem& problem, const Kinematics<double>& kinematics, std::size_t list);
  void add_pair(std::size_t list, int a, int b, const PairBlocks& blocks);
  void add_damping(std::size_t list, const PairEnds& ends, const PairDamping& damping);
  void sum_up_load(int node, const Residual<double>& residual);
  void add_joint(const Problem& problem, const Kinematics<double>& kinematics, std::size_t list, int node,
                 const Eigen::VectorXd* q);
  void add_rows(const Problem& problem, const Kinematics<double>& kinematics, const SystemPart& part,
                std::size_t list);
  void add_coordinate(std::size_t list, int row, int coordinate, double gradient);
  double noise_of(const Problem& problem, const BodyNode& node, const Magnitudes& magnitudes) const;

  // Of a body and all that meets it.
  struct Sums {
    Vec6 load;      // N m, N, about the link's origin; of all beyond it
    Mat6 stiffness; // of motions in rad and m; scaled in the end
    Mat6 metric;    // scaled
  };

  MotionWeights weights_;
  std::size_t between_ = 0;      // the list of entries of what is between parts; of one part alone its own
  std::vector<char> compressed_; // by list of entries: some line is
  int coordinates_ = 0, rows_ = 0, first_row_ = 0, unknowns_ = 0;
  double mass_ = 0;
  BodyNodes nodes_;
  std::vector<Sums> sums_;    // by node
  BodyEntries entries_;       // a list for each part of the system, and one for what is between them
  std::vector<double> noise_; // by node: stiffness that rounding makes
  Eigen::VectorXd work_;
};

} // namespace flyball
