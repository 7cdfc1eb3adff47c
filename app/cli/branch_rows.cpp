#include "app/cli/branch_rows.hpp"

#include "app/cli/hunting_told.hpp"
#include "app/cli/output.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/column_name.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array special_types{SpecialPointType::fold,       SpecialPointType::branch_point,
                                   SpecialPointType::hopf,       SpecialPointType::flutter,
                                   SpecialPointType::parametric, SpecialPointType::slip};

Json point_json(const ResponsePoint& p) {
  Json out = {{"parameter", p.parameter}, {"coordinates", coordinates_json(p.coordinates)}};
  if (std::ranges::any_of(p.coordinates, [](const CoordinateSolution& c) { return c.speed.has_value(); }))
    out["speeds"] = speeds_json(p.coordinates);
  if (!p.frictions.empty()) out["rests_on_friction"] = frictions_json(p.frictions);
  if (!p.measures.empty()) out["measures"] = measures_json(p.measures);
  out["stable"] = p.stable ? Json(*p.stable) : Json(nullptr);
  out["stability_reason"] = p.stability_reason ? Json(word(*p.stability_reason)) : Json(nullptr);
  out["eigenvalues"] = Json::array();
  for (const auto& e : p.eigenvalues)
    out["eigenvalues"].push_back({e.real(), e.imag()});
  if (p.floquet) out["floquet"] = floquet_json(*p.floquet);
  return out;
}

// From the number of the branch to what is special about the point.
std::string point_cells(std::span<const ValueColumn> values, int branch, const ResponsePoint& p,
                        std::string_view special) {
  std::string out = fmt::format("{},{}", branch, csv_number(p.parameter));
  for (const ValueColumn& value : values)
    out += "," + csv_number(value_at(p.coordinates, p.measures, value));
  return out + fmt::format(",{},{}", p.stable ? (*p.stable ? "true" : "false") : "", special);
}

// What a point has of friction: whether it rests on that, and the band, or nothing where there is none.
std::string friction_cells(std::span<const ValueColumn> values, const ResponsePoint& p,
                           const RibbonPoint& point) {
  std::string out = "," + std::string(friction_word(p.frictions));
  for (const ValueColumn& value : values) {
    const BandExtent* extent = find_extent(point, value.name);
    out += extent ? "," + csv_number(extent->low) + "," + csv_number(extent->high) : ",,";
  }
  return out;
}

// Why a branch begins or ends at this point of it.
std::string note(const ResponseBranch& branch, std::size_t point) {
  std::string out;
  if (point == 0 && !branch.begin.empty()) out = "begins: " + branch.begin;
  if (point + 1 == branch.points.size()) out += (out.empty() ? "ends: " : "; ends: ") + branch.end;
  return csv_field(printable(out));
}

Json band_json(const RibbonPoint& point) {
  Json out = Json::object();
  for (const BandExtent& extent : point.extents)
    out[extent.name] = {number_json(extent.low), number_json(extent.high)};
  return out;
}

// To the points of a branch, along each stretch of it.
void add_slow_changes(std::span<const RibbonPoint> ribbon, Json& points) {
  for (const auto& [begin, end] : slow_stretches(ribbon))
    for (const BandExtent& extent : ribbon[begin].extents)
      for (std::size_t i = begin;
           const HysteresisPoint& way : hysteresis(ribbon.subspan(begin, end - begin), extent.name))
        points[i++]["slow_change"][extent.name] = {{"forth", way.forth}, {"back", way.back}};
}

} // namespace

Json tips_json(const Ribbons& tips) {
  Json out = Json::array();
  for (const std::vector<RibbonPoint>& tip : tips) {
    Json& points = out.emplace_back(Json::array());
    for (const RibbonPoint& point : tip)
      points.push_back({{"parameter", point.number}, {"band", band_json(point)}});
  }
  return out;
}

Json diagram_json(const ResponseDiagram& d, const Ribbons& ribbons, const HopfPoints& hunting) {
  Json out = {{"status", word(d.status)},
              {"message", d.message},
              {"branches", Json::array()},
              {"special", Json::array()}};
  for (std::size_t k = 0; k < d.branches.size(); ++k) {
    const ResponseBranch& b = d.branches[k];
    Json points = Json::array();
    for (const ResponsePoint& p : b.points)
      points.push_back(point_json(p));
    for (std::size_t i = 0; k < ribbons.size() && i < ribbons[k].size(); ++i) {
      points[i]["band"] = band_json(ribbons[k][i]);
      if (ribbons[k][i].extents.empty() && !ribbons[k][i].message.empty())
        points[i]["band_message"] = ribbons[k][i].message;
    }
    if (k < ribbons.size()) add_slow_changes(ribbons[k], points);
    out["branches"].push_back(
        {{"points", std::move(points)}, {"connected", b.connected}, {"begin", b.begin}, {"end", b.end}});
    if (k >= ribbons.size()) continue;
    if (const auto none = std::ranges::find_if_not(ribbons[k], &std::string::empty, &RibbonPoint::no_way);
        none != ribbons[k].end())
      out["branches"].back()["slow_change_message"] = none->no_way;
  }
  for (std::size_t i = 0; i < d.special.size(); ++i) {
    const SpecialPoint& s = d.special[i];
    Json entry = {{"type", word(s.type)}, {"branch", s.branch}};
    entry.update(point_json(s.at));
    entry["parameter_error"] = s.at.parameter_error ? Json(*s.at.parameter_error) : Json(nullptr);
    if (hunting[i]) entry["hunting"] = hunting_json(*hunting[i]);
    out["special"].push_back(std::move(entry));
  }
  out["search"] = d.searched.empty() ? Json(nullptr)
                                     : Json({{"at", d.searched}, {"starts", d.starts}, {"complete", false}});
  return out;
}

std::string diagram_csv(const Mechanism& m, const std::string& address, const ResponseDiagram& d,
                        const Ribbons& ribbons) {
  const std::vector<ValueColumn> values = value_columns(m);
  std::string out = "branch," + csv_field(address);
  for (const ValueColumn& value : values)
    out += "," + csv_field(column_name(value.name));
  out += ",stable,special";
  if (!ribbons.empty()) out += ",rests_on_friction";
  if (!ribbons.empty())
    for (const ValueColumn& value : values)
      out += "," + csv_field(value.name + ".low") + "," + csv_field(value.name + ".high");
  out += "\n";
  const auto friction = [&](const ResponsePoint& p, const RibbonPoint& point) {
    return (ribbons.empty() ? "" : friction_cells(values, p, point)) + "\n";
  };
  for (std::size_t b = 0; b < d.branches.size(); ++b)
    for (std::size_t i = 0; i < d.branches[b].points.size(); ++i)
      out += point_cells(values, static_cast<int>(b), d.branches[b].points[i], "") +
             friction(d.branches[b].points[i], ribbons.empty() ? RibbonPoint{} : ribbons[b][i]);
  for (const SpecialPoint& s : d.special)
    out += point_cells(values, s.branch, s.at, word(s.type)) + friction(s.at, {});
  return out;
}

std::vector<Column> BranchColumns::columns() const {
  std::vector<Column> out;
  for (const Variation& variation : over)
    out.push_back({variation.address});
  out.insert(out.end(), {{"status", CellKind::word}, {"branch"}, {address}});
  for (const ValueColumn& value : values)
    out.push_back({column_name(value.name)});
  out.insert(out.end(),
             {{"stable", CellKind::verdict}, {"special", CellKind::word}, {"note", CellKind::text}});
  if (bands) out.push_back({"rests_on_friction", CellKind::word});
  for (std::size_t i = 0; bands && i < values.size(); ++i)
    out.insert(out.end(), {{values[i].name + ".low"}, {values[i].name + ".high"}});
  return out;
}

std::string csv_rows(const BranchColumns& columns, const GridBranches& place) {
  const ResponseDiagram& d = place.diagram;
  std::string grid, out;
  for (const double value : place.parameters)
    grid += csv_number(value) + ",";
  grid += word(d.status);
  if (d.branches.empty())
    return grid + std::string(columns.values.size() + 5, ',') + csv_field(printable(d.message)) +
           std::string(columns.bands ? 1 + 2 * columns.values.size() : 0, ',') + "\n";
  const auto add = [&](int branch, const ResponsePoint& p, std::string_view special, const std::string& words,
                       const RibbonPoint& band) {
    out += grid + "," + point_cells(columns.values, branch, p, special) + "," + words +
           (columns.bands ? friction_cells(columns.values, p, band) : "") + "\n";
  };
  for (std::size_t b = 0; b < d.branches.size(); ++b)
    for (std::size_t i = 0; i < d.branches[b].points.size(); ++i)
      add(static_cast<int>(b), d.branches[b].points[i], "", note(d.branches[b], i),
          columns.bands ? place.ribbons[b][i] : RibbonPoint{});
  for (std::size_t i = 0; i < d.special.size(); ++i) {
    const std::optional<HopfPoint>& hunts = place.hunting[i];
    add(d.special[i].branch, d.special[i].at, word(d.special[i].type),
        hunts ? std::string(word(hunts->loss())) : "", {});
  }
  return out;
}

std::string json_rows(const BranchColumns& columns, const GridBranches& place) {
  Json row;
  for (std::size_t v = 0; v < columns.over.size(); ++v)
    row["parameters"][columns.over[v].address] = place.parameters[v];
  row.update(diagram_json(place.diagram, place.ribbons, place.hunting));
  return json_row(row.dump(2));
}

namespace {

// Joints slip only where there is friction.
bool has_column(const BranchColumns& columns, SpecialPointType type) {
  return type != SpecialPointType::slip || columns.bands;
}

} // namespace

std::vector<std::string> table_head(const BranchColumns& columns, const Mechanism& mechanism) {
  std::vector<std::string> head;
  for (const Variation& v : columns.over)
    head.push_back(named_with_unit(v.address, parameter_unit(mechanism, v.address)));
  head.insert(head.end(), {"status", "branches", "points"});
  for (const SpecialPointType type : special_types)
    if (has_column(columns, type)) head.emplace_back(word(type));
  return head;
}

std::string table_rows(const BranchColumns& columns, const GridBranches& place) {
  const ResponseDiagram& d = place.diagram;
  std::string out;
  for (const double value : place.parameters)
    out += fmt::format("{:.8g}\t", value);
  std::size_t points = 0;
  for (const ResponseBranch& branch : d.branches)
    points += branch.points.size();
  out += fmt::format("{}\t{}\t{}", word(d.status), d.branches.size(), points);
  for (const SpecialPointType type : special_types)
    if (has_column(columns, type))
      out += fmt::format("\t{}", std::ranges::count(d.special, type, &SpecialPoint::type));
  return out + "\n";
}

} // namespace flyball::cli
