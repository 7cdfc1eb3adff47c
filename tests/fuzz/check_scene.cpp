#include "tests/fuzz/check_scene.hpp"

#include "tests/fuzz/not_finite.hpp"
#include "tests/fuzz/watch.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"

namespace flyball::fuzz {
namespace {

constexpr std::size_t most_bodies = 10, most_parts = 14;
constexpr int most_coordinates = 20;

} // namespace

bool small_enough(const Mechanism& m) {
  int coordinates = 0;
  for (const Joint& joint : m.joints)
    coordinates += coordinate_count(joint.type);
  return m.bodies.size() <= most_bodies && m.joints.size() <= most_parts && m.forces.size() <= most_parts &&
         m.sliders.size() <= most_parts && coordinates <= most_coordinates;
}

namespace {

std::optional<std::string> check_saving(const Mechanism& m) {
  const std::string text = write_scene(m);
  try {
    const Mechanism again = parse_scene(text);
    if (!(again == m)) return "saved and loaded it is another mechanism:\n" + text;
    if (write_scene(again) != text) return "saved twice it is another text:\n" + text;
  } catch (const SceneError& error) {
    return std::string("what was saved does not load: ") + error.what();
  }
  return std::nullopt;
}

std::optional<std::string> check_solving(const Mechanism& m, std::chrono::milliseconds limit) {
  std::optional<Analysis> analysis;
  try {
    analysis.emplace(m);
  } catch (const SceneError& error) {
    if (error.expected().empty()) return "refused without a reason";
    return std::nullopt;
  }
  const Watch watch(limit);
  for (const bool nearest : {false, true}) {
    SolveOptions options;
    options.nearest = nearest;
    options.cancel = watch.expired();
    const Solution solution = analysis->solve(options);
    if (const auto field = not_finite(solution)) return "a number that is none: " + *field;
    if (solution.message.empty()) return "no message";
    if (solution.status == Status::converged && solution.poses.size() != m.bodies.size())
      return "converged without a pose for every body";
  }
  for (const Pose& pose : analysis->poses_at(0.3))
    if (!finite(pose)) return "a number that is none: pose at 0.3 s";
  return std::nullopt;
}

} // namespace

std::optional<std::string> check_scene(std::string_view bytes, std::chrono::milliseconds limit) {
  Mechanism m;
  try {
    m = parse_scene(bytes);
  } catch (const SceneError& error) {
    if (error.expected().empty()) return "refused without a reason";
    return std::nullopt;
  }
  if (auto complaint = check_saving(m)) return complaint;
  const std::vector<SceneError> mistakes = find_mistakes(m);
  for (const SceneError& mistake : mistakes)
    if (mistake.expected().empty()) return "a mistake without words";
  if (!mistakes.empty() || !small_enough(m)) return std::nullopt;
  return check_solving(m, limit);
}

} // namespace flyball::fuzz
