#include "app/session/follow_names.hpp"

#include "app/document/explored.hpp"
#include "app/session/session.hpp"

#include <utility>

namespace flyball {

namespace {

class Names {
 public:
  Names(const Mechanism& before, const Mechanism& after) : before_(before), after_(after) {}

  // "joints.spin.drive.speed"
  void follow_address(std::string& address) const { address = renamed_address(address, before_, after_); }
  // A name in one of the lists of a scene; of a coordinate "ball.3" or "spin.speed", too.
  void follow_name(const std::string& list, std::string& name) const {
    const std::string address = list + "." + name;
    name = renamed_address(address, before_, after_).substr(list.size() + 1);
  }
  // "value ball.3", "force spin"; measures are called what they are.
  void follow_quantity(std::string& key) const {
    const std::size_t space = key.find(' ');
    if (space == std::string::npos || key.starts_with("measure ")) return;
    std::string name = key.substr(space + 1);
    follow_name("joints", name);
    key = key.substr(0, space + 1) + name;
  }

 private:
  const Mechanism &before_, &after_;
};

} // namespace

void follow_names(Session& session, const Mechanism& before) {
  const Names names(before, session.mechanism());
  StudyState& study = session.study;
  for (ChosenTolerance& each : study.spread.choice.tolerances)
    names.follow_address(each.address);
  for (std::string& address : session.goals.held)
    names.follow_address(address);
  names.follow_address(study.response.choice.address);
  names.follow_quantity(study.response.choice.quantity);
  names.follow_name("joints", study.response.design.coordinate);
  for (MapAxis& axis : study.map.choice.axes)
    names.follow_address(axis.address);
  names.follow_name("joints", study.map.choice.shown);
  names.follow_address(study.modes.campbell.drive);
  ToldPoints points;
  for (const auto& [body, at] : session.points) {
    std::string name = body;
    names.follow_name("bodies", name);
    points.emplace(std::move(name), at);
  }
  session.points = std::move(points);
}

Part renamed_part(Part part, const Mechanism& before, const Mechanism& after) {
  const char* list = part.kind == PartKind::body    ? "bodies"
                     : part.kind == PartKind::joint ? "joints"
                                                    : "forces";
  Names(before, after).follow_name(list, part.name);
  return part;
}

} // namespace flyball
