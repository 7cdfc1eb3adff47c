#include "app/ui/inspector/coordinate_rows.hpp"

#include "app/ui/inspector/inspector_rows.hpp"

#include <algorithm>

namespace flyball {

std::string CoordinateRows::key(const std::string& word) const {
  return joint.coordinates.size() > 1 ? word + "." + std::to_string(i) : word;
}

std::string CoordinateRows::widget(std::string address) {
  std::ranges::replace(address, '.', '/');
  return "inspector/" + address;
}

bool CoordinateRows::all_have(bool (*has)(const Coordinate&)) const {
  return has(coordinate()) && std::ranges::all_of(others, [&](const Joint* each) {
           return has(each->coordinates[static_cast<std::size_t>(i)]);
         });
}

bool CoordinateRows::some_have(bool (*has)(const Coordinate&)) const {
  return has(coordinate()) || std::ranges::any_of(others, [&](const Joint* each) {
           return has(each->coordinates[static_cast<std::size_t>(i)]);
         });
}

const char* CoordinateRows::refused_of_any(const char* (*refused)(const CoordinateRows&)) const {
  const char* why = refused(*this);
  for (auto other = others.begin(); !why && other != others.end(); ++other)
    why = refused({session, ui, **other, i});
  return why;
}

const CoordinateSolution* CoordinateRows::solution() const {
  if (!converged(session)) return nullptr;
  for (const CoordinateSolution& found : session.answer.solution.coordinates)
    if (found.joint == joint.name && found.index == i) return &found;
  return nullptr;
}

void CoordinateRows::change(const std::string& step, const std::function<void(Coordinate&)>& edit) const {
  edit_joint(session, ui, step, joint.name, [edit, i = static_cast<std::size_t>(i)](Joint& same) {
    if (i < same.coordinates.size()) edit(same.coordinates[i]);
  });
}

void CoordinateRows::number(const std::string& label, const std::string& address, double value,
                            const std::string& unit, const char* help, Least least,
                            const std::function<void()>& reset) const {
  number_row(session, ui, label,
             {.name = widget(address),
              .value = value,
              .unit = unit,
              .help = help,
              .least = least,
              .address = "joints." + joint.name + "." + address},
             reset);
}

void CoordinateRows::number_or_law(const std::string& label, const std::string& address, const Formula* law,
                                   const std::optional<double>& in_state, double value,
                                   const std::string& unit, const char* help) const {
  number_row(session, ui, label,
             {.name = widget(address),
              .value = law && in_state ? *in_state : value,
              .unit = unit,
              .help = help,
              .address = "joints." + joint.name + "." + address,
              .law = law && !in_state ? law->text : std::string()});
}

} // namespace flyball
