// What a person points at and picks: the parts of a mechanism.
#pragma once

#include "engine/mechanism/mechanism.hpp"

#include <string>
#include <vector>

namespace flyball {

enum class PartKind { none, body, joint, force };

// A part by its place in the mechanism's list: for one picture, while the mechanism stays as it is.
struct PartId {
  PartKind kind = PartKind::none;
  int index = -1;
  bool operator==(const PartId&) const = default;
};

// A part by its name, which lasts through edits.
struct Part {
  PartKind kind = PartKind::none;
  std::string name;
  bool operator==(const Part&) const = default;
};

// PartKind::none where there is no such part.
PartId find_part(const Mechanism& mechanism, const Part& part);
// An empty Part where there is no such index.
Part part_of(const Mechanism& mechanism, PartId id);

// In the order they were picked; the last one is what an inspector shows first.
struct Selection {
  std::vector<Part> parts;

  bool empty() const { return parts.empty(); }
  bool has(const Part& part) const;
  bool has(PartKind kind) const;
  std::vector<std::string> names(PartKind kind) const;
  void set(Part part);    // it alone; none for an empty Part
  void add(Part part);    // unless it is there already
  void toggle(Part part); // adds it or takes it out
  bool operator==(const Selection&) const = default;
};

// Of the selected parts that the mechanism has.
std::vector<PartId> find_parts(const Mechanism& mechanism, const Selection& selection);
// Without the parts that the mechanism does not have.
Selection existing(Selection selection, const Mechanism& mechanism);

} // namespace flyball
