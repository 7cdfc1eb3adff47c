#include "app/cli/solution_json.hpp"

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

Json to_json(const Mechanism& mechanism, const Solution& s) {
  const bool converged = s.status == Status::converged;
  Json out;
  out["status"] = word(s.status);
  out["message"] = s.message;
  for (const char* key : {"coordinates", "multipliers"})
    out[key] = converged ? Json::object() : Json(nullptr);
  out["residual"] = number_json(s.residual);
  out["error_estimate"] = converged ? Json::object() : Json(nullptr);
  out["iterations"] = s.iterations;
  out["history"] = Json::array();
  for (double h : s.history)
    out["history"].push_back(number_json(h));
  out["net"] = s.fallback ? Json(word(*s.fallback)) : Json(nullptr);
  out["run_time_s"] = s.run_time_s;
  out["stable"] = s.stable ? Json(*s.stable) : Json(nullptr);
  out["stability_reason"] = s.stability_reason ? Json(word(*s.stability_reason)) : Json(nullptr);
  for (const char* key :
       {"potential", "eigenvalues", "floquet", "at_constant_speed", "speeds", "speed_errors", "neutral",
        "drive_torques", "drive_torque_ranges", "reactions", "bearings", "poses", "points", "measures",
        "sensitivities", "measure_sensitivities", "condition"})
    out[key] = nullptr;
  out["unheld"] = Json::array();
  for (const UnheldCoordinate& c : s.unheld)
    out["unheld"].push_back(c.count == 1 ? c.joint : c.joint + "." + std::to_string(c.index));
  if (!converged) return out;

  if (s.potential) out["potential"] = number_json(*s.potential);
  out["coordinates"] = coordinates_json(s.coordinates);
  for (const CoordinateSolution& c : s.coordinates) {
    if (c.driven) continue;
    put(out["error_estimate"], c.joint, c.index, c.count, number_json(c.error));
  }
  for (const JointMultipliers& m : s.multipliers) {
    out["multipliers"][m.joint] = Json::array();
    for (double value : m.values)
      out["multipliers"][m.joint].push_back(number_json(value));
  }
  if (s.eigenvalues) out["eigenvalues"] = eigenvalues_json(*s.eigenvalues);
  if (s.floquet) out["floquet"] = floquet_json(*s.floquet);
  if (const auto& at = s.at_constant_speed) {
    out["at_constant_speed"] = {
        {"stable", at->stable ? Json(*at->stable) : Json(nullptr)},
        {"stability_reason", at->stability_reason ? Json(word(*at->stability_reason)) : Json(nullptr)},
        {"eigenvalues", at->eigenvalues ? eigenvalues_json(*at->eigenvalues) : Json(nullptr)}};
  }
  out["speeds"] = speeds_json(s.coordinates);
  out["speed_errors"] = Json::object();
  for (const CoordinateSolution& c : s.coordinates)
    if (c.speed) put(out["speed_errors"], c.joint, c.index, c.count, number_json(c.speed_error));
  out["neutral"] = s.neutral;
  out["drive_torques"] = Json::object();
  for (const DriveTorque& d : s.drive_torques)
    put(out["drive_torques"], d.joint, d.index, d.count, number_json(d.value));
  for (const DriveTorque& d : s.drive_torques)
    if (d.given)
      put(out["drives_by_torque"], d.joint, d.index, d.count,
          {{"torque", number_json(d.given->torque)}, {"load", number_json(d.given->load)}});
  if (!s.frictions.empty()) out["rests_on_friction"] = frictions_json(s.frictions);
  out["drive_torque_ranges"] = Json::object();
  for (const DriveTorque& d : s.drive_torques)
    if (d.varying) {
      Json range = {{"mean", nullptr}, {"min", nullptr}, {"max", nullptr}};
      if (d.range)
        range = {{"mean", number_json(d.range->mean)},
                 {"min", number_json(d.range->least)},
                 {"max", number_json(d.range->most)}};
      put(out["drive_torque_ranges"], d.joint, d.index, d.count, std::move(range));
    }
  out["reactions"] = Json::object();
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
    out["reactions"][r.joint] = std::move(entry);
  }
  for (const GearReaction& g : s.gears) {
    Json entry = {{"force", array(g.force)},
                  {"torque", array(g.torque)},
                  {"a", number_json(g.a)},
                  {"b", number_json(g.b)}};
    if (g.varying) entry["varying"] = true;
    if (g.nonunique) entry["nonunique"] = true;
    out["reactions"][g.joint] = std::move(entry);
  }
  out["bearings"] = Json::object();
  for (const BearingForce& b : s.bearings) {
    Json entry = {{"force", array(b.force)}, {"torque", array(b.torque)}};
    if (b.varying) entry["varying"] = true;
    out["bearings"][b.bearing] = std::move(entry);
  }
  out["poses"] = Json::object();
  for (std::size_t b = 0; b < s.poses.size(); ++b) {
    const Quat& q = s.poses[b].rotation;
    out["poses"][mechanism.bodies[b].name] = {
        {"position", array(s.poses[b].position)},
        {"rotation", {number_json(q.w()), number_json(q.x()), number_json(q.y()), number_json(q.z())}}};
  }
  out["points"] = Json::object();
  for (const PointSolution& p : s.points)
    out["points"][point_label(p.point)] = to_json(p.motion);
  out["measures"] = measures_json(s.measures);
  out["measure_sensitivities"] = Json::object();
  for (const Sensitivity& x : s.sensitivities) {
    if (x.measures.empty()) continue;
    Json& rates = out["measure_sensitivities"][x.address] = Json::object();
    for (std::size_t i = 0; i < x.measures.size(); ++i)
      rates[s.measures[i].name] = number_json(x.measures[i]);
  }
  out["sensitivities"] = Json::object();
  for (const Sensitivity& x : s.sensitivities) {
    out["sensitivities"][x.address] = Json::object();
    for (const Sensitivity::Rate& r : x.rates)
      put(out["sensitivities"][x.address], r.speed ? r.joint + ".speed" : r.joint, r.index, r.count,
          number_json(r.value));
  }
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
