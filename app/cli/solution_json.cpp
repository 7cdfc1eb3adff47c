#include "app/cli/solution_json.hpp"

#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json array(const Vec3& v) {
  return {number_json(v.x()), number_json(v.y()), number_json(v.z())};
}

// Of x, y, z.
Json unique_components(const OpenDirections& open) {
  return {!open.component(0), !open.component(1), !open.component(2)};
}

// Puts a value at its joint: the value itself where the joint has one coordinate, else into an array with
// null where nothing was said.
void put(Json& object, const std::string& joint, int index, int count, Json value) {
  if (count == 1) {
    object[joint] = std::move(value);
    return;
  }
  if (!object.contains(joint)) object[joint] = Json::array_t(static_cast<std::size_t>(count));
  object[joint][static_cast<std::size_t>(index)] = std::move(value);
}

Json eigenvalues_json(const std::vector<std::complex<double>>& eigenvalues) {
  Json out = Json::array();
  for (const auto& e : eigenvalues)
    out.push_back({number_json(e.real()), number_json(e.imag())});
  return out;
}

} // namespace

Json number_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json with_warnings(Json answer, const Mechanism& mechanism) {
  answer["warnings"] = warnings_json(find_warnings(mechanism));
  return answer;
}

Json floquet_json(const Floquet& f) {
  Json out = {{"period_s", number_json(f.period)}, {"error", number_json(f.error)}};
  out["multipliers"] = Json::array();
  for (const auto& mu : f.multipliers)
    out["multipliers"].push_back({number_json(mu.real()), number_json(mu.imag())});
  out["growth_rates"] = Json::array();
  for (const double growth : f.growth)
    out["growth_rates"].push_back(number_json(growth));
  return out;
}

Json to_json(const PointMotion& motion) {
  return {{"position", array(motion.position)},
          {"velocity", array(motion.velocity)},
          {"acceleration", array(motion.acceleration)}};
}

Json warnings_json(const std::vector<SceneError>& warnings) {
  Json out = Json::array();
  for (const SceneError& warning : warnings)
    out.push_back({{"where", warning.where()}, {"message", warning.expected()}});
  return out;
}

namespace {

Json flag_json(std::optional<bool> value) {
  return value ? Json(*value) : Json(nullptr);
}

Json reason_json(std::optional<StabilityReason> value) {
  return value ? Json(word(*value)) : Json(nullptr);
}

Json errors_json(const std::vector<CoordinateSolution>& coordinates) {
  Json out = Json::object();
  for (const CoordinateSolution& c : coordinates)
    if (!c.driven) put(out, c.joint, c.index, c.count, number_json(c.error));
  return out;
}

Json speed_errors_json(const std::vector<CoordinateSolution>& coordinates) {
  Json out = Json::object();
  for (const CoordinateSolution& c : coordinates)
    if (c.speed) put(out, c.joint, c.index, c.count, number_json(c.speed_error));
  return out;
}

Json multipliers_json(const std::vector<JointMultipliers>& multipliers) {
  Json out = Json::object();
  for (const JointMultipliers& m : multipliers) {
    out[m.joint] = Json::array();
    for (double value : m.values)
      out[m.joint].push_back(number_json(value));
  }
  return out;
}

Json at_constant_speed_json(const AtConstantSpeed& at) {
  return {{"stable", flag_json(at.stable)},
          {"stability_reason", reason_json(at.stability_reason)},
          {"eigenvalues", at.eigenvalues ? eigenvalues_json(*at.eigenvalues) : Json(nullptr)}};
}

Json torque_range_json(const std::optional<PhaseRange>& range) {
  if (!range) return {{"mean", nullptr}, {"min", nullptr}, {"max", nullptr}};
  return {{"mean", number_json(range->mean)},
          {"min", number_json(range->least)},
          {"max", number_json(range->most)}};
}

void add_drives(const std::vector<DriveTorque>& drives, Json& out) {
  out["drive_torques"] = out["drive_torque_ranges"] = Json::object();
  for (const DriveTorque& d : drives) {
    put(out["drive_torques"], d.joint, d.index, d.count, number_json(d.value));
    if (d.varying) put(out["drive_torque_ranges"], d.joint, d.index, d.count, torque_range_json(d.range));
    if (d.given)
      put(out["drives_by_torque"], d.joint, d.index, d.count,
          {{"torque", number_json(d.given->torque)}, {"load", number_json(d.given->load)}});
  }
}

Json reactions_json(const Solution& s) {
  Json out = Json::object();
  for (const Reaction& r : s.reactions) {
    Json entry = {{"force", array(r.force)}, {"torque", array(r.torque)}};
    if (r.varying) entry["varying"] = true;
    if (r.nonunique()) {
      entry["nonunique"] = true;
      entry["unique"] = {{"force", unique_components(r.open.force)},
                         {"torque", unique_components(r.open.torque)}};
      entry["unique_part"] = {{"force", array(r.open.force.unique_part(r.force))},
                              {"torque", array(r.open.torque.unique_part(r.torque))}};
    }
    out[r.joint] = std::move(entry);
  }
  for (const GearReaction& g : s.gears) {
    Json entry = {{"force", array(g.force)},
                  {"torque", array(g.torque)},
                  {"a", number_json(g.a)},
                  {"b", number_json(g.b)}};
    if (g.varying) entry["varying"] = true;
    if (g.nonunique) entry["nonunique"] = true;
    out[g.joint] = std::move(entry);
  }
  return out;
}

Json bearings_json(const std::vector<BearingForce>& bearings) {
  Json out = Json::object();
  for (const BearingForce& b : bearings) {
    Json entry = {{"force", array(b.force)}, {"torque", array(b.torque)}};
    if (b.varying) entry["varying"] = true;
    out[b.bearing] = std::move(entry);
  }
  return out;
}

Json poses_json(const Mechanism& mechanism, const std::vector<Pose>& poses) {
  Json out = Json::object();
  for (std::size_t b = 0; b < poses.size(); ++b) {
    const Quat& q = poses[b].rotation;
    out[mechanism.bodies[b].name] = {
        {"position", array(poses[b].position)},
        {"rotation", {number_json(q.w()), number_json(q.x()), number_json(q.y()), number_json(q.z())}}};
  }
  return out;
}

Json points_json(const std::vector<PointSolution>& points) {
  Json out = Json::object();
  for (const PointSolution& p : points)
    out[point_label(p.point)] = to_json(p.motion);
  return out;
}

void add_sensitivities(const Solution& s, Json& out) {
  out["measure_sensitivities"] = out["sensitivities"] = Json::object();
  for (const Sensitivity& x : s.sensitivities) {
    Json& rates = out["sensitivities"][x.address] = Json::object();
    for (const Sensitivity::Rate& r : x.rates)
      put(rates, r.speed ? r.joint + ".speed" : r.joint, r.index, r.count, number_json(r.value));
    if (x.measures.empty()) continue;
    Json& of_measures = out["measure_sensitivities"][x.address] = Json::object();
    for (std::size_t i = 0; i < x.measures.size(); ++i)
      of_measures[s.measures[i].name] = number_json(x.measures[i]);
  }
}

} // namespace

Json to_json(const Mechanism& mechanism, const Solution& s) {
  const bool converged = s.status == Status::converged;
  Json out;
  out["status"] = word(s.status);
  out["message"] = s.message;
  for (const char* key : {"coordinates", "multipliers"})
    out[key] = nullptr;
  out["residual"] = number_json(s.residual);
  out["error_estimate"] = nullptr;
  out["iterations"] = s.iterations;
  out["history"] = Json::array();
  for (double h : s.history)
    out["history"].push_back(number_json(h));
  out["net"] = s.fallback ? Json(word(*s.fallback)) : Json(nullptr);
  out["run_time_s"] = s.run_time_s;
  out["stable"] = flag_json(s.stable);
  out["stability_reason"] = reason_json(s.stability_reason);
  for (const char* key :
       {"potential", "eigenvalues", "floquet", "at_constant_speed", "speeds", "speed_errors", "neutral",
        "drive_torques", "drive_torque_ranges", "reactions", "bearings", "poses", "points", "measures",
        "sensitivities", "measure_sensitivities", "condition"})
    out[key] = nullptr;
  out["unheld"] = Json::array();
  for (const UnheldCoordinate& c : s.unheld)
    out["unheld"].push_back(coordinate_label(c));
  if (!converged) return out;

  if (s.potential) out["potential"] = number_json(*s.potential);
  out["coordinates"] = coordinates_json(s.coordinates);
  out["error_estimate"] = errors_json(s.coordinates);
  out["multipliers"] = multipliers_json(s.multipliers);
  if (s.eigenvalues) out["eigenvalues"] = eigenvalues_json(*s.eigenvalues);
  if (s.floquet) out["floquet"] = floquet_json(*s.floquet);
  if (s.at_constant_speed) out["at_constant_speed"] = at_constant_speed_json(*s.at_constant_speed);
  out["speeds"] = speeds_json(s.coordinates);
  out["speed_errors"] = speed_errors_json(s.coordinates);
  out["neutral"] = s.neutral;
  add_drives(s.drive_torques, out);
  if (!s.frictions.empty()) out["rests_on_friction"] = frictions_json(s.frictions);
  out["reactions"] = reactions_json(s);
  out["bearings"] = bearings_json(s.bearings);
  out["poses"] = poses_json(mechanism, s.poses);
  out["points"] = points_json(s.points);
  out["measures"] = measures_json(s.measures);
  add_sensitivities(s, out);
  if (s.condition) out["condition"] = number_json(*s.condition);
  return out;
}

Json to_json(const Mechanism& mechanism, const AllSolutions& all) {
  Json out;
  out["equilibria"] = Json::array();
  for (const Solution& s : all.equilibria)
    out["equilibria"].push_back(to_json(mechanism, s));
  Json bounds = Json::object();
  for (const AllSolutions::Bound& b : all.bounds)
    put(bounds, b.speed ? b.joint + ".speed" : b.joint, b.index, b.count, {b.lower, b.upper});
  out["search"] = {{"bounds", std::move(bounds)}, {"starts", all.starts},
                   {"complete", false},           {"message", all.message},
                   {"end", word(all.end)},        {"expected_missing", number_json(all.unseen)},
                   {"not_steady", all.passing}};
  return out;
}

Json measures_json(const std::vector<MeasureSolution>& measures) {
  Json out = Json::object();
  for (const MeasureSolution& m : measures) {
    Json& entry = out[m.name] = {{"value", m.value ? number_json(*m.value) : Json(nullptr)},
                                 {"unit", m.unit},
                                 {"error_estimate", m.error ? number_json(*m.error) : Json(nullptr)}};
    if (!m.value) entry["reason"] = m.reason;
    if (m.nonunique) entry["nonunique"] = true;
  }
  return out;
}

Json frictions_json(const std::vector<FrictionForce>& frictions) {
  Json out = Json::object();
  for (const FrictionForce& f : frictions)
    put(out, f.joint, f.index, f.count,
        {{"force", f.value ? number_json(*f.value) : Json(nullptr)},
         {"limit", number_json(f.limit)},
         {"slips", f.slips}});
  return out;
}

Json speeds_json(const std::vector<CoordinateSolution>& coordinates) {
  Json out = Json::object();
  for (const CoordinateSolution& c : coordinates)
    if (c.speed) put(out, c.joint, c.index, c.count, number_json(*c.speed));
  return out;
}

Json coordinates_json(const std::vector<CoordinateSolution>& coordinates) {
  Json out = Json::object();
  for (const CoordinateSolution& c : coordinates)
    if (!c.driven) put(out, c.joint, c.index, c.count, number_json(c.value));
  return out;
}

} // namespace flyball::cli
