#include "app/document/names.hpp"

#include "app/document/create.hpp"

#include <charconv>

namespace flyball {
namespace {

template <class List>
void add_names(std::unordered_set<std::string>& names, const List& parts) {
  for (const auto& part : parts)
    names.insert(part.name);
}

} // namespace

UsedNames::UsedNames(const Mechanism& mechanism, PartKind kind) {
  switch (kind) {
  case PartKind::none: break;
  case PartKind::body: add_names(names_, mechanism.bodies); break;
  case PartKind::joint: add_names(names_, mechanism.joints); break;
  case PartKind::force: add_names(names_, mechanism.forces); break;
  }
}

std::string UsedNames::take(const std::string& name) {
  return names_.insert(name).second ? name : take_next(name);
}

std::string UsedNames::take_next(const std::string& name) {
  constexpr std::size_t most_digits = 9;                      // more are no number that anybody counts
  std::size_t stem = name.find_last_not_of("0123456789") + 1; // npos + 1 is 0
  if (name.size() - stem > most_digits) stem = name.size();
  int number = 1;
  std::from_chars(name.data() + stem, name.data() + name.size(), number);
  return take_numbered(name.substr(0, stem), number + 1);
}

std::string UsedNames::take_numbered(const std::string& stem, int number) {
  for (;; ++number) {
    std::string name = stem + std::to_string(number);
    if (names_.insert(name).second) return name;
  }
}

std::string unused_name(const Mechanism& mechanism, PartKind kind, std::string_view stem) {
  return UsedNames(mechanism, kind).take_first(std::string(stem));
}

} // namespace flyball
