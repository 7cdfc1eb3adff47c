#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/classify.hpp"
#include "engine/system/joint_parts.hpp"
#include "engine/system/law_elements.hpp"
#include "engine/system/spanning_tree.hpp"

#include <algorithm>
#include <queue>
#include <tuple>

namespace flyball {
namespace {

constexpr int ground = -1;

class Compiler {
 public:
  Compiler(const Mechanism& mechanism, const CutChoice& choice, TorqueDriven torque_driven)
      : m_(mechanism), torque_driven_(torque_driven), numbers_(mechanism),
        tree_(choose_tree(mechanism, choice, numbers_)) {}

  System run() {
    build_links();
    add_cuts();
    expect_few_repetitions();
    add_forces();
    list_coordinates();
    add_drive_torques(m_, torque_links_, s_);
    add_force_laws(m_, s_);
    find_potential(m_, s_);
    choose_kkt_form(s_);
    s_.division = divide(s_);
    return std::move(s_);
  }

 private:
  const Joint& joint(int j) const { return m_.joints[static_cast<std::size_t>(j)]; }
  int joint_count() const { return static_cast<int>(m_.joints.size()); }
  Link& link(int l) { return s_.links[static_cast<std::size_t>(l)]; }
  const Link& link_at(int l) const { return s_.links[static_cast<std::size_t>(l)]; }

  int body_of(const std::string& name, const std::string& where) const {
    return body_number(numbers_, name, where);
  }
  std::string joint_path(int j) const { return "joints." + joint(j).name; }

  const std::array<int, 2>& ends(int j) const { return tree_.ends[static_cast<std::size_t>(j)]; }

  const std::optional<Drive>& drive_of(int j, int coordinate) const {
    return joint(j).coordinates[static_cast<std::size_t>(coordinate)].drive;
  }

  // Appends the links of a joint; returns the outermost.
  int add_chain(int j, JointType type, int parent_link, bool reversed, TreeJoint record) {
    const std::vector<ChainPart> parts = chain_of(type);
    record.joint = j;
    record.type = type;
    record.first_link = static_cast<int>(s_.links.size());
    record.link_count = static_cast<int>(parts.size());
    record.reversed = reversed;
    const int index = static_cast<int>(s_.tree_joints.size());
    int last = parent_link;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const ChainPart& part = reversed ? parts[parts.size() - 1 - i] : parts[i];
      Link l;
      l.type = part.type;
      l.parent = last;
      l.tree_joint = index;
      l.coordinate = part.coordinate;
      l.reversed = reversed;
      l.axis = part.axis;
      last = static_cast<int>(s_.links.size());
      const DriveOrigin* o = nullptr;
      if (j >= 0 && part.type != LinkType::fixed)
        o = &tree_.origins[static_cast<std::size_t>(j)][static_cast<std::size_t>(part.coordinate)];
      if (o && o->driven && part.type == LinkType::spherical)
        throw SceneError(joint_path(j) + ".drive", "a rotation vector cannot be driven; use revolute joints");
      const bool found = o && o->driven && o->finds_speed;
      const bool turns = o && o->driven && !(found && torque_driven_ == TorqueDriven::moves_freely);
      if (found && (turns || drive_of(j, part.coordinate))) torque_links_.push_back(last);
      if (turns) {
        l.drive = static_cast<int>(s_.drives.size());
        // Where a speed is found each has its own, and gears are equations between them.
        s_.drives.push_back({last, l.drive, found ? std::vector<int>() : o->gears});
        motors_.push_back(found ? CoordinateReference{j, part.coordinate}
                                : CoordinateReference{o->motor_joint, o->motor_coordinate});
      }
      if ((!turns || found) && part.type != LinkType::fixed) {
        l.q = s_.nq;
        l.v = s_.nv;
        s_.nq += part.type == LinkType::spherical ? 4 : 1;
        s_.nv += part.type == LinkType::spherical ? 3 : 1;
      }
      l.mobile = l.v >= 0 || (l.parent >= 0 && link(l.parent).mobile);
      l.depth = l.parent >= 0 ? link(l.parent).depth + 1 : 1;
      // What torques turn is a frame for the motion, too, so that it has the coordinates of the steady state.
      l.frame = turns || found ? last : l.parent >= 0 ? link(l.parent).frame : -1;
      s_.links.push_back(l);
    }
    s_.tree_joints.push_back(std::move(record));
    return last;
  }

  int drive_depth(int l) const {
    int depth = 0;
    for (l = moving_frame(s_, l); l >= 0; l = moving_frame(s_, link_at(l).parent))
      ++depth;
    return depth;
  }

  // Walks the tree outwards from a body that has its link already.
  void grow(int from) {
    offer_neighbours(from);
    std::vector<int> stack{from};
    while (!stack.empty()) {
      const int body = stack.back();
      stack.pop_back();
      std::vector<int> found;
      for (int j : joints_at_[static_cast<std::size_t>(body + 1)]) {
        const Joint& x = joint(j);
        const auto& [p, c] = ends(j);
        const bool reversed = p != body;
        const int other = reversed ? p : c;
        if (other == ground || s_.body_link[static_cast<std::size_t>(other)] >= 0) continue;
        const int parent = body == ground ? -1 : s_.body_link[static_cast<std::size_t>(body)];
        TreeJoint record;
        record.name = x.name;
        record.parent_body = p;
        record.child_body = c;
        const int l = add_chain(j, x.type, parent, reversed, std::move(record));
        link(l).body = other;
        s_.body_link[static_cast<std::size_t>(other)] = l;
        offer_neighbours(other);
        found.push_back(other);
      }
      stack.insert(stack.end(), found.rbegin(), found.rend());
    }
  }

  // A body that has its link offers itself to those it is connected with and that have none yet.
  void offer_neighbours(int body) {
    if (connections_at_.empty()) return;
    const int depth = drive_depth(link_of(body));
    for (int c : connections_at_[static_cast<std::size_t>(body + 1)])
      for (int end : {0, 1}) {
        const std::array<int, 2>& bodies = connections_[static_cast<std::size_t>(c)];
        if (bodies[static_cast<std::size_t>(end)] != body) continue;
        const int to = bodies[static_cast<std::size_t>(1 - end)];
        if (to != ground && s_.body_link[static_cast<std::size_t>(to)] < 0)
          offers_.push({-depth, 2 * c + end, body, to});
      }
  }

  // What connects bodies without being in the tree, found only where a body hangs on nothing else.
  void list_connections() {
    for (int j = 0; j < joint_count(); ++j)
      if (joint(j).type != JointType::gear) connections_.push_back(ends(j));
    for (const Force& f : m_.forces)
      if (acts_between(f.type))
        connections_.push_back(
            {body_of(f.bodies[0], "forces." + f.name), body_of(f.bodies[1], "forces." + f.name)});
    connections_at_.resize(m_.bodies.size() + 1);
    for (std::size_t c = 0; c < connections_.size(); ++c)
      for (int end : {0, 1})
        connections_at_[static_cast<std::size_t>(connections_[c][static_cast<std::size_t>(end)] + 1)]
            .push_back(static_cast<int>(c));
    for (int body = ground; body < static_cast<int>(m_.bodies.size()); ++body)
      if (body == ground || s_.body_link[static_cast<std::size_t>(body)] >= 0) offer_neighbours(body);
  }

  // A body held only by distance joints, springs or joints marked to be cut gets a free joint to the frame
  // that its most driven neighbour moves with. To the frame and not to the neighbour, so that the bodies of a
  // net stand side by side and each feels its own neighbours alone. Returns false when nothing joins what is
  // left to what is there.
  bool add_implicit_joint() {
    while (!offers_.empty() && s_.body_link[static_cast<std::size_t>(offers_.top().to)] >= 0)
      offers_.pop();
    if (offers_.empty()) return false;
    const auto [depth, order, from, to] = offers_.top();
    offers_.pop();
    int parent_body = from, parent = link_of(from);
    if (const int frame = moving_frame(s_, parent); frame < 0 || link_at(frame).body >= 0) {
      parent = frame;
      parent_body = frame < 0 ? ground : link_at(frame).body;
    }
    TreeJoint record;
    record.name = m_.bodies[static_cast<std::size_t>(to)].name + ".free";
    record.parent_body = parent_body;
    record.child_body = to;
    const int l = add_chain(-1, JointType::free, parent, false, std::move(record));
    link(l).body = to;
    s_.body_link[static_cast<std::size_t>(to)] = l;
    grow(to);
    return true;
  }

  void build_links() {
    s_.body_link.assign(m_.bodies.size(), -1);
    joints_at_.resize(m_.bodies.size() + 1);
    for (int j = 0; j < joint_count(); ++j) {
      if (!tree_.in_tree[static_cast<std::size_t>(j)]) continue;
      for (int body : ends(j))
        joints_at_[static_cast<std::size_t>(body + 1)].push_back(j);
    }
    grow(ground);
    for (auto lost = std::ranges::find(s_.body_link, -1); lost != s_.body_link.end();
         lost = std::find(lost, s_.body_link.end(), -1)) {
      if (connections_at_.empty()) list_connections();
      if (!add_implicit_joint())
        throw SceneError("bodies." + m_.bodies[static_cast<std::size_t>(lost - s_.body_link.begin())].name,
                         "is connected to nothing; join it to the ground or to another body");
    }
    for (std::size_t d = 0; d < s_.drives.size(); ++d)
      for (std::size_t e = 0; e < s_.drives.size(); ++e) {
        const Link& l = link(s_.drives[e].link);
        if (s_.drives[e].gears.empty() && reference_to(s_, l) == motors_[d])
          s_.drives[d].motor = static_cast<int>(e);
      }
  }

  int link_of(int body) const { return body == ground ? -1 : s_.body_link[static_cast<std::size_t>(body)]; }

  PairEnds ends_between(int a, int b) const {
    int top_a = a, top_b = b;
    while (top_a != top_b) // where the ways to the root meet
      if (top_b < 0 || (top_a >= 0 && link_at(top_a).depth >= link_at(top_b).depth))
        top_a = link_at(top_a).parent;
      else
        top_b = link_at(top_b).parent;
    PairEnds ends{a, b, {}};
    add_path(a, top_a, false, ends.support);
    add_path(b, top_a, true, ends.support);
    return ends;
  }

  // Free coordinates on the way from `top` (left out) to `l`, the nearest to the root first.
  void add_path(int l, int top, bool second, Support& out) const {
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    for (; l != top; l = link_at(l).parent) {
      const Link& x = link_at(l);
      if (x.v < 0) continue;
      const int n = x.type == LinkType::spherical ? 3 : 1;
      for (int k = n - 1; k >= 0; --k)
        out.push_back({x.v + k, l, second});
    }
    std::reverse(out.begin() + begin, out.end());
  }

  // Whether what moves the ends against each other turns, all of it, at speeds that are found.
  bool turns_at_found_speeds(const Support& support) const {
    return !support.empty() &&
           std::ranges::all_of(support, [&](const SupportColumn& c) { return finds_speed(link_at(c.link)); });
  }

  void add_cut(CutJoint cut, JointType type) {
    cut.type = type;
    if (type != JointType::gear) cut.by_rates = turns_at_found_speeds(cut.ends.support);
    cut.first_row = s_.rows;
    cut.rows = rows_of(type);
    s_.rows += static_cast<int>(cut.rows.size());
    s_.cuts.push_back(std::move(cut));
  }

  void add_cuts() {
    std::vector<int> gears;
    for (int j = 0; j < joint_count(); ++j) {
      const Joint& x = joint(j);
      if (x.type == JointType::gear) {
        gears.push_back(j);
        continue;
      }
      if (tree_.in_tree[static_cast<std::size_t>(j)]) continue;
      const auto& [a, b] = ends(j);
      const bool damped =
          std::ranges::any_of(x.coordinates, [](const Coordinate& c) { return is_damped(c); });
      const bool axial =
          x.type == JointType::revolute || x.type == JointType::prismatic || x.type == JointType::cylindrical;
      CutJoint cut;
      cut.joint = j;
      if (tree_.needs_coordinate[static_cast<std::size_t>(j)] || (damped && !axial)) {
        // A spring needs the joint's own coordinate: keep the joint, lead it to a massless twin of the child,
        // and close the loop by welding the twin to the child.
        TreeJoint record;
        record.name = x.name;
        record.parent_body = a;
        record.child_body = b;
        record.closes_loop = true;
        cut.tree_joint = static_cast<int>(s_.tree_joints.size());
        const int twin = add_chain(j, x.type, link_of(a), false, std::move(record));
        cut.ends = ends_between(twin, link_of(b));
        add_cut(std::move(cut), JointType::fixed);
        continue;
      }
      cut.ends = ends_between(link_of(a), link_of(b));
      if (damped)
        for (int k = 0; k < coordinate_count(x.type); ++k)
          if (is_damped(x.coordinates[static_cast<std::size_t>(k)]))
            s_.cut_dampers.push_back({j, k, is_angle(x.type, k), cut.ends});
      add_cut(std::move(cut), x.type);
    }
    for (int j : gears)
      add_gear(j);
  }

  // No more equations than coordinates are independent. Loops of spatial joints have several times as many,
  // nets of them included; what has far more repeats itself, and would take minutes to say so.
  void expect_few_repetitions() const {
    constexpr int many = 10'000, times = 20;
    const int most = std::max(many, times * s_.nv);
    if (s_.rows > most)
      throw SceneError("joints", "expected at most " + std::to_string(most) + " constraint equations on " +
                                     std::to_string(s_.nv) + " free coordinates, found " +
                                     std::to_string(s_.rows) +
                                     "; joints that hold what others hold already can be left out");
  }

  void add_gear(int j) {
    const CoordinateReference a = gear_end(m_, j, 0), b = gear_end(m_, j, 1);
    if (const DriveOrigin& o = tree_.origin(a); o.driven && !o.finds_speed) { // then b is, too
      s_.dropped_gears.push_back(j);
      return;
    }
    CutJoint cut;
    cut.joint = j;
    for (const Link& l : s_.links) {
      const int owner = s_.tree_joints[static_cast<std::size_t>(l.tree_joint)].joint;
      if (l.type != LinkType::revolute && l.type != LinkType::prismatic) continue;
      if (owner == a.joint && l.coordinate == a.coordinate) {
        cut.gear_a = l.q, cut.gear_va = l.v;
        cut.by_rates = finds_speed(l);
      }
      if (owner == b.joint && l.coordinate == b.coordinate) cut.gear_b = l.q, cut.gear_vb = l.v;
    }
    if (cut.gear_a < 0 || cut.gear_b < 0)
      throw SceneError(joint_path(j), "a gear couples coordinates of one axis; a rotation vector has none");
    add_cut(std::move(cut), JointType::gear);
  }

  void add_forces() {
    const std::string& turner = m_.air.turns_with;
    const int air = turner.empty() ? -1 : link_of(body_of(turner, "air.turns_with"));
    for (int f = 0; f < static_cast<int>(m_.forces.size()); ++f) {
      const Force& x = m_.forces[static_cast<std::size_t>(f)];
      const std::string path = "forces." + x.name;
      if (x.type == ForceType::spring) {
        s_.springs.push_back(
            {f, ends_between(link_of(body_of(x.bodies[0], path)), link_of(body_of(x.bodies[1], path)))});
        continue;
      }
      if (x.type == ForceType::bearing) {
        s_.bearings.push_back(
            {f, ends_between(link_of(body_of(x.bodies[0], path)), link_of(body_of(x.bodies[1], path))),
             bearing_size(x)});
        s_.bearings.back().turning = driven_turn_between(s_.bearings.back().ends);
        continue;
      }
      const int on = link_of(body_of(x.body, path));
      const PolarElement polar{read_force_law(lift_law(x), air_variable, path),
                               read_force_law(drag_law(x), air_variable, path)};
      if (!is_of_air(x.type) || air < 0)
        s_.body_forces.push_back({f, on, polar});
      else if (on != air) // else nothing flows
        s_.turning_air.push_back({f, ends_between(air, on), polar});
    }
  }

  void list_coordinates() {
    for (int l = 0; l < static_cast<int>(s_.links.size()); ++l) {
      const Link& x = link(l);
      if (x.type == LinkType::fixed) continue;
      const TreeJoint& t = s_.tree_joints[static_cast<std::size_t>(x.tree_joint)];
      const int n = x.type == LinkType::spherical ? 3 : 1;
      for (int k = 0; k < n; ++k)
        s_.coordinates.push_back({x.tree_joint, x.coordinate + k, is_angle(t.type, x.coordinate + k), l});
    }
    const auto key = [&](const CoordinateInfo& c) {
      const int j = s_.tree_joints[static_cast<std::size_t>(c.tree_joint)].joint;
      return std::tuple(j < 0 ? joint_count() + c.tree_joint : j, c.index);
    };
    std::ranges::stable_sort(s_.coordinates, [&](const auto& a, const auto& b) { return key(a) < key(b); });
    std::vector<std::pair<std::tuple<int, int>, ReportedCoordinate>> all;
    for (std::size_t c = 0; c < s_.coordinates.size(); ++c) {
      const CoordinateInfo& x = s_.coordinates[c];
      const TreeJoint& t = s_.tree_joints[static_cast<std::size_t>(x.tree_joint)];
      all.push_back({key(x), {t.name, x.index, coordinate_count(t.type), x.angle, static_cast<int>(c), -1}});
    }
    for (std::size_t c = 0; c < s_.cuts.size(); ++c) {
      const CutJoint& cut = s_.cuts[c];
      const int n = cut.type == JointType::fixed ? 0 : coordinate_count(cut.type);
      for (int k = 0; k < n; ++k)
        all.push_back(
            {{cut.joint, k}, {joint(cut.joint).name, k, n, is_angle(cut.type, k), -1, static_cast<int>(c)}});
    }
    std::ranges::stable_sort(all, {}, [](const auto& x) { return x.first; });
    for (auto& [place, coordinate] : all)
      s_.reported.push_back(std::move(coordinate));
  }

  // The link of a drive's turn on the way between two others; -1: none.
  int driven_turn_between(const PairEnds& ends) const {
    int a = ends.a, b = ends.b; // links come after their parents
    while (a != b) {
      int& further = a > b ? a : b;
      if (link_at(further).drive >= 0 && link_at(further).type == LinkType::revolute) return further;
      further = link_at(further).parent;
    }
    return -1;
  }

  const Mechanism& m_;
  const TorqueDriven torque_driven_;
  const BodyNumbers numbers_;
  SpanningTree tree_;
  System s_;
  std::vector<CoordinateReference> motors_; // by entry of s_.drives
  std::vector<int> torque_links_;
  std::vector<std::vector<int>> joints_at_;

  // For implicit joints: connections by their two bodies, and which of them could hold a body next, the most
  // driven first and then in the scene's order.
  struct Offer {
    int negative_depth, order, from, to;
    bool operator>(const Offer& o) const {
      return std::tie(negative_depth, order) > std::tie(o.negative_depth, o.order);
    }
  };
  std::vector<std::array<int, 2>> connections_;
  std::vector<std::vector<int>> connections_at_;
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers_;
};

} // namespace

System compile(const Mechanism& mechanism, const CutChoice& choice, TorqueDriven torque_driven) {
  return Compiler(mechanism, choice, torque_driven).run();
}

} // namespace flyball
