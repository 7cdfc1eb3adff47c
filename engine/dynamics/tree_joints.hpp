// What an algorithm along a tree keeps of every joint that gives way: one coordinate or the three of a ball,
// each with matrices of its own size.
#pragma once

#include "engine/system/system.hpp"

namespace flyball {

template <template <int> class Joint>
class TreeJoints {
 public:
  // Of a released system; its first `free` coordinates give way.
  TreeJoints(const System& released, int free) : slots_(released.links.size()) {
    for (std::size_t l = 0; l < slots_.size(); ++l) {
      const Link& link = released.links[l];
      if (link.v < 0 || link.v >= free) continue;
      if (link.type == LinkType::spherical) {
        slots_[l] = {link.v, static_cast<int>(balls_.size()), true};
        balls_.emplace_back();
      } else {
        slots_[l] = {link.v, static_cast<int>(singles_.size()), false};
        singles_.emplace_back();
      }
    }
  }

  // Calls visit(v, joint) for a link's joint, v its first coordinate; not where it does not give way.
  template <class Visit>
  void visit(std::size_t link, Visit visit) {
    const Slot& slot = slots_[link];
    if (slot.v < 0) return;
    if (slot.ball)
      visit(slot.v, balls_[static_cast<std::size_t>(slot.joint)]);
    else
      visit(slot.v, singles_[static_cast<std::size_t>(slot.joint)]);
  }

  bool gives_way(std::size_t link) const { return slots_[link].v >= 0; }
  // Which of the balls, in the order of their links.
  std::size_t ball(std::size_t link) const { return static_cast<std::size_t>(slots_[link].joint); }

 private:
  struct Slot {
    int v = -1;
    int joint = -1; // in one of these
    bool ball = false;
  };
  std::vector<Slot> slots_; // by link
  std::vector<Joint<1>> singles_;
  std::vector<Joint<3>> balls_;
};

} // namespace flyball
