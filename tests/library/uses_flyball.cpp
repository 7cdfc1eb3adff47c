// The steady state of a scene, its stability, and where branches of it begin or end.
#include <flyball/flyball.hpp>

#include <iostream>

int main(int, char** arguments) try {
  flyball::Mechanism mechanism = flyball::load_scene(arguments[1]);
  flyball::Analysis analysis(mechanism);
  const flyball::Solution s = analysis.solve();
  std::cout.precision(15);
  std::cout << s.message << (s.stable == true ? " stable" : " not stable") << '\n';
  for (const flyball::CoordinateSolution& c : s.coordinates)
    std::cout << c.joint << ' ' << c.value << " +- " << c.error << (c.angle ? " rad" : " m") << '\n';
  const auto d = flyball::follow_branches(mechanism, arguments[2], 0, 20);
  std::cout << d.branches.size() << " branches, " << d.special.size() << " special points\n";
  return s.status == flyball::Status::converged ? 0 : 1;
} catch (const flyball::SceneError& e) {
  std::cerr << e.what() << '\n';
  return 2;
}
