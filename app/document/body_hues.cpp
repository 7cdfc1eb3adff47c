#include "app/document/body_hues.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>

namespace flyball {

namespace {

constexpr std::uint8_t none = 255;

// FNV-1a (Fowler, Noll, Vo): the same on every computer.
std::uint32_t name_hash(std::string_view name) {
  std::uint32_t hash = 2166136261u;
  for (const char c : name)
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

using Neighbours = std::vector<std::vector<std::size_t>>;

// Bodies that a joint or spring connects.
Neighbours neighbours_in(const Mechanism& mechanism) {
  std::unordered_map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
    index.emplace(mechanism.bodies[i].name, i);
  Neighbours all(mechanism.bodies.size());
  const auto connect = [&](const std::array<std::string, 2>& bodies) {
    const auto a = index.find(bodies[0]), b = index.find(bodies[1]);
    if (a == index.end() || b == index.end() || a == b) return;
    all[a->second].push_back(b->second);
    all[b->second].push_back(a->second);
  };
  for (const Joint& joint : mechanism.joints)
    if (joint.type != JointType::gear) connect(joint.bodies);
  for (const Force& force : mechanism.forces)
    if (acts_between(force.type)) connect(force.bodies);
  return all;
}

// Chooses for the bodies that have none, in the order of the list.
void choose_missing(const Mechanism& mechanism, BodyHues& hues) {
  const Neighbours neighbours = neighbours_in(mechanism);
  std::array<std::size_t, body_hue_count> used{};
  for (const std::uint8_t hue : hues)
    if (hue != none) ++used[hue % body_hue_count];
  for (std::size_t i = 0; i < hues.size(); ++i) {
    if (hues[i] != none) continue;
    std::array<std::size_t, body_hue_count> price = used;
    const std::size_t clash = mechanism.bodies.size() + 1;
    for (const std::size_t other : neighbours[i])
      if (hues[other] != none) price[hues[other] % body_hue_count] += clash;
    const std::size_t wanted = name_hash(mechanism.bodies[i].name) % body_hue_count;
    std::size_t best = wanted;
    for (std::size_t step = 1; step < body_hue_count; ++step)
      if (const std::size_t hue = (wanted + step) % body_hue_count; price[hue] < price[best]) best = hue;
    const std::size_t shade = used[best] % body_shade_count;
    hues[i] = static_cast<std::uint8_t>(best + shade * body_hue_count);
    ++used[best];
  }
}

} // namespace

bool same_bodies(const Mechanism& a, const Mechanism& b) {
  return std::ranges::equal(a.bodies, b.bodies, {}, &Body::name, &Body::name);
}

BodyHues choose_hues(const Mechanism& mechanism, const NamedHues& known) {
  BodyHues hues(mechanism.bodies.size(), none);
  for (std::size_t i = 0; i < hues.size(); ++i)
    if (const auto found = known.find(mechanism.bodies[i].name); found != known.end())
      hues[i] = found->second;
  choose_missing(mechanism, hues);
  return hues;
}

NamedHues hues_to_keep(const Mechanism& mechanism, const BodyHues& hues) {
  NamedHues named;
  if (hues == choose_hues(mechanism)) return named;
  for (std::size_t i = 0; i < mechanism.bodies.size() && i < hues.size(); ++i)
    named[mechanism.bodies[i].name] = hues[i];
  return named;
}

BodyHues carried_hues(const Mechanism& before, const BodyHues& hues, const Mechanism& after) {
  if (hues.size() == before.bodies.size() && same_bodies(before, after)) return hues;
  std::unordered_map<std::string_view, std::uint8_t> known;
  for (std::size_t i = 0; i < before.bodies.size() && i < hues.size(); ++i)
    known.emplace(before.bodies[i].name, hues[i]);
  BodyHues next(after.bodies.size(), none);
  bool missing = false;
  for (std::size_t i = 0; i < next.size(); ++i)
    if (const auto found = known.find(after.bodies[i].name); found != known.end())
      next[i] = found->second;
    else if (after.bodies.size() == before.bodies.size() && i < hues.size())
      next[i] = hues[i]; // renamed
    else
      missing = true;
  if (missing) choose_missing(after, next);
  return next;
}

BodyHues hues_for(const Mechanism& mechanism, const BodyColouring& colouring) {
  if (!colouring.of || !colouring.hues) return choose_hues(mechanism);
  return carried_hues(*colouring.of, *colouring.hues, mechanism);
}

} // namespace flyball
