// Writes samples of a motion into a run.
#pragma once

#include "engine/dynamics/equations.hpp"
#include "engine/dynamics/friction_modes.hpp"
#include "engine/report/measures.hpp"
#include "engine/system/point_motion.hpp"

#include <unordered_map>

namespace flyball {

class Recorder {
 public:
  // `reactions`, `points` and `measures` as in SimulationOptions.
  Recorder(Run& run, bool reactions, std::vector<BodyPoint> points, bool measures)
      : run_(run), reactions_(reactions), measured_(measures), points_(std::move(points)) {}

  // What the next samples are of; tracks are laid out at first. Throws SceneError for points of no body.
  void use(std::shared_ptr<const MotionModel> model, Equations& equations);

  // The same model with friction sticking or slipping otherwise.
  void follow(std::shared_ptr<const MotionModel> model, Equations& equations);

  // The evaluated state at t, with the integrated energies. `shift`: how far it was put back on the manifold.
  void record(double t, const Eigen::Vector3d& energies, double shift);

  // After a change of numbers, at the evaluated last sample: what it added to the stored energy is no error.
  void go_on();

  // Energy (J) that a jump of the forces brought, which is no error either.
  void absorb(double energy) { base_ += energy; }

  // The last sample's integrated energies.
  Eigen::Vector3d energies() const;

  void name(const StopElement& stop, StopEvent& event) const;
  void name(const FrictionElement& friction, FrictionEvent& event) const;

 private:
  void lay_out();
  void record_coordinates(double t);
  double go_on_from(const CoordinateTrack& track, double value, double rate) const;
  void record_energies(double t, const Eigen::Vector3d& energies);
  void record_reactions(const TransmittedForces& forces);
  void record_elements(const TransmittedForces& forces);
  void find_springs();
  void record_springs();
  void record_measures(TransmittedForces& forces);
  void record_points();
  double jacobi(double t);
  bool has_jacobi();

  Run& run_;
  bool reactions_, measured_;
  std::vector<BodyPoint> points_;
  std::vector<TrackedPoint> tracked_;
  MeasureSet measures_;
  // Of each of Run::springs: in System::reported, and in cut_dampers where it closes a loop; or in springs.
  struct SpringPlace {
    int coordinate = -1, cut_damper = -1, spring = -1;
  };
  std::vector<SpringPlace> sprung_;
  std::vector<double> values_, rates_;                       // of the coordinates at a sample
  std::vector<double> torques_;                              // of the drives that give these, likewise
  std::unordered_map<std::string, std::size_t> tree_joints_; // for reactions, by name
  std::shared_ptr<const MotionModel> model_;
  Equations* equations_ = nullptr;
  double base_ = 0; // J, stored energy that counts as none
  bool jacobi_ = false;
  Kinematics<double> standing_;
};

} // namespace flyball
