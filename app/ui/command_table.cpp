// Every command: those of the menus, one after the other.
#include "app/ui/menus/menu_commands.hpp"

#include <vector>

namespace flyball {

std::span<const Command> commands() {
  static const std::vector<Command> all = [] {
    std::vector<Command> joined;
    for (const auto menu : {menus::file(), menus::edit(), menus::insert(), menus::view(), menus::units(),
                            menus::study(), menus::help()})
      joined.insert(joined.end(), menu.begin(), menu.end());
    return joined;
  }();
  return all;
}

} // namespace flyball
