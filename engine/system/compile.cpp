#include "engine/mechanism/body_groups.hpp"
#include "engine/mechanism/damped.hpp"
#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/system/joint_parts.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>

namespace flyball {
namespace {

constexpr int ground = -1, no_body = -2;

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& p = parent_[static_cast<std::size_t>(i)];
      i = p = parent_[static_cast<std::size_t>(p)];
    }
    return i;
  }
  bool unite(int a, int b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[static_cast<std::size_t>(b)] = a;
    return true;
  }

 private:
  std::vector<int> parent_;
};

// How a coordinate is driven: from which motor, through which gears.
struct DriveOrigin {
  bool driven = false;
  bool finds_speed = false;
  int motor_joint = -1, motor_coordinate = 0;
  std::vector<int> gears;
};

class Compiler {
 public:
  Compiler(const Mechanism& mechanism, const CutChoice& choice, TorqueDriven torque_driven)
      : m_(mechanism), choice_(choice), torque_driven_(torque_driven), numbers_(mechanism) {}

  System run() {
    find_ends();
    propagate_drives();
    choose_tree();
    build_links();
    add_cuts();
    expect_few_repetitions();
    add_forces();
    list_coordinates();
    add_drive_torques();
    add_force_laws();
    classify();
    choose_kkt_form();
    s_.division = divide(s_);
    return std::move(s_);
  }

 private:
  const Joint& joint(int j) const { return m_.joints[static_cast<std::size_t>(j)]; }
  int joint_count() const { return static_cast<int>(m_.joints.size()); }
  Link& link(int l) { return s_.links[static_cast<std::size_t>(l)]; }
  const Link& link_at(int l) const { return s_.links[static_cast<std::size_t>(l)]; }

  int body_of(const std::string& name, const std::string& where) const {
    if (!numbers_.has(name)) throw SceneError(where, "there is no body \"" + name + "\"");
    return static_cast<int>(numbers_[name]) - 1;
  }
  std::string joint_path(int j) const { return "joints." + joint(j).name; }

  void find_ends() {
    ends_.resize(m_.joints.size(), {no_body, no_body}); // gears join coordinates, not bodies
    for (int j = 0; j < joint_count(); ++j) {
      if (joint(j).type == JointType::gear) continue;
      const std::string path = joint_path(j);
      for (std::size_t end = 0; end < 2; ++end)
        ends_[static_cast<std::size_t>(j)][end] = body_of(joint(j).bodies[end], path);
    }
  }
  const std::array<int, 2>& ends(int j) const { return ends_[static_cast<std::size_t>(j)]; }

  CoordinateReference gear_end(int j, int end) const {
    const std::string& name = joint(j).joints[static_cast<std::size_t>(end)];
    const CoordinateReference r = find_coordinate(m_, name);
    if (r.joint < 0) throw SceneError(joint_path(j), "there is no joint coordinate \"" + name + "\"");
    return r;
  }
  DriveOrigin& origin(CoordinateReference r) {
    return origins_[static_cast<std::size_t>(r.joint)][static_cast<std::size_t>(r.coordinate)];
  }

  // A gear to a driven coordinate makes the other driven.
  void propagate_drives() {
    origins_.resize(m_.joints.size());
    for (int j = 0; j < joint_count(); ++j) {
      auto& o = origins_[static_cast<std::size_t>(j)];
      o.resize(joint(j).coordinates.size());
      for (std::size_t k = 0; k < o.size(); ++k)
        if (const auto& drive = joint(j).coordinates[k].drive)
          o[k] = {true, finds_speed(*drive), j, static_cast<int>(k), {}};
    }
    for (const CoordinateReference& c : choice_.turning)
      if (!origin(c).driven) origin(c) = {true, true, c.joint, c.coordinate, {}};
    for (bool changed = true; changed;) {
      changed = false;
      for (int j = 0; j < joint_count(); ++j) {
        if (joint(j).type != JointType::gear) continue;
        const CoordinateReference a = gear_end(j, 0), b = gear_end(j, 1);
        if (origin(a).driven && origin(b).driven && origin(a).finds_speed != origin(b).finds_speed)
          throw SceneError(joint_path(j), "ties a coordinate whose speed is found to one at a given speed");
        if (origin(a).driven == origin(b).driven) continue;
        DriveOrigin& from = origin(a).driven ? origin(a) : origin(b);
        DriveOrigin& to = origin(a).driven ? origin(b) : origin(a);
        to = from;
        to.gears.push_back(j);
        changed = true;
      }
    }
    needs_coordinate_.assign(m_.joints.size(), false);
    for (int j = 0; j < joint_count(); ++j) {
      for (const Coordinate& c : joint(j).coordinates)
        if (c.spring || c.stop || c.friction) needs_coordinate_[static_cast<std::size_t>(j)] = true;
      if (joint(j).type == JointType::gear)
        for (int end : {0, 1})
          needs_coordinate_[static_cast<std::size_t>(gear_end(j, end).joint)] = true;
      ask_for_coordinates_of_laws(j);
    }
  }

  // What the drives' laws of a joint ask for.
  void ask_for_coordinates_of_laws(int j) {
    for (int i = 0; i < static_cast<int>(joint(j).coordinates.size()); ++i)
      for (const char* which : {"torque", "load"})
        read_drive_law_of(joint(j), i, which, [&](const Expression& law) {
          for (const ResultCall& call : law.results())
            if (const ResultQuantity asked = find_law_quantity(m_, call); asks_for_coordinate(call))
              needs_coordinate_[static_cast<std::size_t>(asked.of[0].part)] = true;
        });
  }

  const std::optional<Drive>& drive_of(int j, int coordinate) const {
    return joint(j).coordinates[static_cast<std::size_t>(coordinate)].drive;
  }

  // What turns at a given speed, or has a drive of its own. What turns at a speed that is found because
  // others do may close a loop.
  bool is_driven(int j) const {
    const auto& all = origins_[static_cast<std::size_t>(j)];
    for (std::size_t k = 0; k < all.size(); ++k)
      if (drive_of(j, static_cast<int>(k)) || (all[k].driven && !all[k].finds_speed)) return true;
    return false;
  }

  // Lower is kept in the tree first.
  auto preference(int j) const {
    const Joint& x = joint(j);
    const bool labelled = std::ranges::any_of(
        x.coordinates, [](const Coordinate& c) { return c.drawn != 0 || c.damping != 0 || c.damping_force; });
    int rank = 4;
    if (labelled) rank = 3;
    if (needs_coordinate_[static_cast<std::size_t>(j)]) rank = 2;
    if (x.cut == false || x.type == JointType::free) rank = 1; // a free joint cannot close a loop
    if (is_driven(j)) rank = 0;
    return std::tuple(rank, coordinate_count(x.type), j);
  }

  void choose_tree() {
    std::vector<decltype(preference(0))> order;
    for (int j = 0; j < joint_count(); ++j)
      if (joins_trees(joint(j).type)) order.push_back(preference(j));
    std::ranges::sort(order);
    in_tree_.assign(m_.joints.size(), false);
    UnionFind parts(m_.bodies.size() + 1);
    for (const auto& [rank, coordinates, j] : order) {
      const Joint& x = joint(j);
      if (x.cut == true || std::ranges::find(choice_.cut, j) != choice_.cut.end()) continue;
      const auto& [a, b] = ends(j);
      if (parts.unite(a + 1, b + 1)) {
        in_tree_[static_cast<std::size_t>(j)] = true;
      } else if (is_driven(j)) {
        throw SceneError(joint_path(j) + ".drive",
                         "driven joints close a loop; a driven joint cannot be cut");
      } else if (x.type == JointType::free) {
        throw SceneError(joint_path(j),
                         "a free joint joins bodies that are joined already; it constrains nothing");
      }
    }
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
        o = &origins_[static_cast<std::size_t>(j)][static_cast<std::size_t>(part.coordinate)];
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
    for (l = moving_frame(l); l >= 0; l = moving_frame(link_at(l).parent))
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
    if (const int frame = moving_frame(parent); frame < 0 || link_at(frame).body >= 0) {
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
      if (!in_tree_[static_cast<std::size_t>(j)]) continue;
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
        const TreeJoint& t = s_.tree_joints[static_cast<std::size_t>(l.tree_joint)];
        if (s_.drives[e].gears.empty() && t.joint == motors_[d].joint &&
            l.coordinate == motors_[d].coordinate)
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
      if (in_tree_[static_cast<std::size_t>(j)]) continue;
      const auto& [a, b] = ends(j);
      const bool damped =
          std::ranges::any_of(x.coordinates, [](const Coordinate& c) { return is_damped(c); });
      const bool axial =
          x.type == JointType::revolute || x.type == JointType::prismatic || x.type == JointType::cylindrical;
      CutJoint cut;
      cut.joint = j;
      if (needs_coordinate_[static_cast<std::size_t>(j)] || (damped && !axial)) {
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
    const CoordinateReference a = gear_end(j, 0), b = gear_end(j, 1);
    if (origin(a).driven && !origin(a).finds_speed) { // then b is, too
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
      const PolarElement polar{read_law(lift_law(x), air_variable, path),
                               read_law(drag_law(x), air_variable, path)};
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

  void add_drive_torques() {
    for (const int l : torque_links_) {
      const Joint& x = joint(s_.tree_joints[static_cast<std::size_t>(link(l).tree_joint)].joint);
      const auto& drive = x.coordinates[static_cast<std::size_t>(link(l).coordinate)].drive;
      s_.torques.push_back({l, law_of(x, link(l).coordinate, "torque"), law_of(x, link(l).coordinate, "load"),
                            drive && !drive->torque, !drive});
    }
    for (const DriveTorqueElement& kept : s_.torques)
      for (const DriveTorqueElement& other : s_.torques)
        if (kept.keeps_momentum && !other.keeps_momentum &&
            (hangs_from(s_, kept.link, other.link) || hangs_from(s_, other.link, kept.link)))
          throw SceneError(
              "joints." + s_.tree_joints[static_cast<std::size_t>(link(kept.link).tree_joint)].name +
                  ".drive.keeps",
              "expected speed, or no drive by torque that carries it or that it carries, found " +
                  s_.tree_joints[static_cast<std::size_t>(link(other.link).tree_joint)].name +
                  ": its momentum in the drawn pose is not given then");
  }

  DriveLaw::Input input_of(const ResultCall& call) const {
    DriveLaw::Input out{find_law_quantity(m_, call)};
    if (asks_for_coordinate(call)) out.coordinate = tree_coordinate(out.quantity);
    if (call.result == Result::length) {
      const auto spring = std::ranges::find(s_.springs, out.quantity.of[0].part, &PointSpringElement::force);
      out.spring = static_cast<int>(spring - s_.springs.begin());
    }
    return out;
  }

  // Where a coordinate stands that a law asks for.
  int tree_coordinate(const ResultQuantity& asked) const {
    const ResultQuantity::Of& at = asked.of[0];
    const bool rate = asked.result == Result::rate;
    const std::string name = coordinate_name(joint(at.part), at.coordinate);
    const auto found = std::ranges::find_if(s_.coordinates, [&](const CoordinateInfo& c) {
      return s_.tree_joints[static_cast<std::size_t>(c.tree_joint)].joint == at.part &&
             c.index == at.coordinate;
    });
    if (found == s_.coordinates.end())
      throw ExpressionError("expected a coordinate that closes no loop, found " + name +
                            "; with \"cut\": false on that joint its loop is cut elsewhere");
    if (link_at(found->link).drive >= 0 && !rate)
      throw ExpressionError("expected a rate: the coordinate " + name + " goes on and on as its drive turns");
    if (rate && link_at(found->link).type == LinkType::spherical)
      throw ExpressionError("expected no rate of " + name + ", a component of a rotation vector");
    return static_cast<int>(found - s_.coordinates.begin());
  }

  DriveLaw law_of(const Joint& of, int i, std::string_view which) const {
    DriveLaw out;
    read_drive_law_of(of, i, which, [&](const Expression& law) {
      for (const ResultCall& call : law.results())
        out.inputs.push_back(input_of(call));
      out.expression = law;
    });
    return out;
  }

  // Hands on what a drive's torque or load is read as, where it is one of the state.
  template <class Take>
  void read_drive_law_of(const Joint& of, int i, std::string_view which, Take take) const {
    const Formula* law = drive_law(m_, of, i, which);
    if (!law) return;
    try {
      take(read_drive_law(m_, law->text));
    } catch (const ExpressionError& error) {
      throw SceneError("joints." + of.name + ".drive." + std::string(which),
                       "\"=" + law->text + "\": " + error.what());
    }
  }

  static std::shared_ptr<const ForceLaw> read_law(const Formula* law, std::string_view variable,
                                                  const std::string& part) {
    try {
      return law ? std::make_shared<const ForceLaw>(law->text, variable) : nullptr;
    } catch (const ExpressionError& error) {
      throw SceneError(part + "." + law->key, "\"=" + law->text + "\": " + error.what());
    }
  }

  void add_force_laws() {
    for (int l = 0; l < static_cast<int>(s_.links.size()); ++l) {
      const Link& x = link(l);
      const TreeJoint& t = s_.tree_joints[static_cast<std::size_t>(x.tree_joint)];
      if (t.joint < 0 || x.type == LinkType::fixed) continue;
      const Joint& of = joint(t.joint);
      for (int k = 0; k < (x.type == LinkType::spherical ? 3 : 1); ++k) {
        const int i = x.coordinate + k;
        const Coordinate& c = of.coordinates[static_cast<std::size_t>(i)];
        const bool spring = c.spring && c.spring->force, damper = c.damping_force.has_value();
        if (spring || damper)
          s_.coordinate_laws.push_back({l, k, spring, damper,
                                        read_law(spring_law(of, i), spring_variable, joint_path(t.joint)),
                                        read_law(damper_law(of, i), damper_variable, joint_path(t.joint))});
      }
    }
    for (int i = 0; i < static_cast<int>(s_.springs.size()); ++i) {
      const Force& x = m_.forces[static_cast<std::size_t>(s_.springs[static_cast<std::size_t>(i)].force)];
      const std::string part = "forces." + x.name;
      if (x.force || x.damping_force)
        s_.spring_laws.push_back({i, 0, x.force.has_value(), x.damping_force.has_value(),
                                  read_law(spring_law(x), spring_variable, part),
                                  read_law(damper_law(x), damper_variable, part)});
    }
    for (int i = 0; i < static_cast<int>(s_.cut_dampers.size()); ++i) {
      const CutDamperElement& e = s_.cut_dampers[static_cast<std::size_t>(i)];
      const Joint& of = joint(e.joint);
      if (of.coordinates[static_cast<std::size_t>(e.coordinate)].damping_force)
        s_.cut_damper_laws.push_back(
            {i, 0, false, true, nullptr,
             read_law(damper_law(of, e.coordinate), damper_variable, joint_path(e.joint))});
    }
  }

  // Whether damping may be negative, so that a minimum of the potential need not be stable.
  bool some_damper_may_drive() const {
    const auto drives = [&](const Formula* law) { return law && !resists_at_rest(*law); };
    return std::ranges::any_of(m_.joints,
                               [&](const Joint& x) {
                                 for (int i = 0; i < static_cast<int>(x.coordinates.size()); ++i)
                                   if (drives(damper_law(x, i))) return true;
                                 return false;
                               }) ||
           std::ranges::any_of(m_.forces, [&](const Force& x) { return drives(damper_law(x)); });
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

  // The drives a link turns with, innermost last; two links with the same ones never move against each other
  // in the steady state.
  int moving_frame(int l) const { return l < 0 ? -1 : link_at(l).frame; }

  void classify() {
    for (const DrivenCoordinate& d : s_.drives)
      if (const int l = link(d.link).parent; l >= 0 && (link(l).frame >= 0 || link(l).mobile))
        s_.single_drives = false;
    for (const BodyForceElement& e : s_.body_forces) {
      const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
      if (f.type != ForceType::force || f.frame != ForceFrame::world) s_.conservative = false;
    }
    for (const PointSpringElement& e : s_.springs)
      if (const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
          (f.damping != 0 || f.damping_force) && moving_frame(e.ends.a) != moving_frame(e.ends.b))
        s_.conservative = false;
    for (const CutDamperElement& e : s_.cut_dampers)
      if (moving_frame(e.ends.a) != moving_frame(e.ends.b)) s_.conservative = false;
    for (const TurningAirElement& e : s_.turning_air) // takes energy alone, as dampers do
      if (moving_frame(e.ends.a) != moving_frame(e.ends.b)) s_.conservative = false;
    // A bearing's matrices may be symmetric, but the next number may change that.
    s_.conservative = s_.conservative && s_.bearings.empty();
    if (!s_.coordinate_laws.empty() || !s_.spring_laws.empty() || !s_.cut_damper_laws.empty())
      s_.conservative = s_.conservative && !some_damper_may_drive();
    s_.conservative_at_speeds = s_.conservative;
    s_.conserves = s_.conservative && std::ranges::all_of(s_.torques, &DriveTorqueElement::keeps_momentum);
    s_.conservative = s_.conservative && s_.torques.empty();
  }

  // Below some coordinates the dense equations are faster (measured: `flyball_bench`, chains).
  void choose_kkt_form() {
    // Without a potential stability asks for eigenvalues, and so for the matrices, as far as those are found.
    constexpr int few = 8, few_for_bodies = 60, few_without_potential = 200;
    const bool potential = s_.conservative && s_.single_drives;
    if (!s_.torques.empty()) {
      if (s_.nv > few + static_cast<int>(s_.torques.size()) && speeds_can_border(s_))
        s_.kkt_form = KktForm::tree;
      return;
    }
    if (!s_.bearings.empty() || !s_.turning_air.empty() || !no_drive_rides(s_) ||
        s_.nv <= (potential ? few : few_without_potential))
      return;
    if (is_plain_tree(s_))
      s_.kkt_form = KktForm::tree;
    else if (s_.nv > few_for_bodies)
      s_.kkt_form = KktForm::sparse;
  }

  const Mechanism& m_;
  const CutChoice& choice_;
  const TorqueDriven torque_driven_;
  const BodyNumbers numbers_;
  System s_;
  std::vector<std::array<int, 2>> ends_; // bodies, by joint
  std::vector<std::vector<DriveOrigin>> origins_;
  std::vector<CoordinateReference> motors_; // by entry of s_.drives
  std::vector<int> torque_links_;
  std::vector<bool> needs_coordinate_, in_tree_;
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

bool no_drive_rides(const System& system) {
  return std::ranges::none_of(system.drives, [&](const DrivenCoordinate& d) {
    const int parent = system.links[static_cast<std::size_t>(d.link)].parent;
    return parent >= 0 && system.links[static_cast<std::size_t>(parent)].mobile;
  });
}

bool is_plain_tree(const System& system) {
  return system.rows == 0 && system.springs.empty() && system.cut_dampers.empty() &&
         system.bearings.empty() && system.turning_air.empty() && no_drive_rides(system);
}

bool speeds_can_border(const System& system) {
  const auto plain = [&](const DriveLaw& law) {
    return std::ranges::none_of(law.inputs, [&](const DriveLaw::Input& input) {
      if (input.coordinate < 0) return false;
      const CoordinateInfo& c = system.coordinates[static_cast<std::size_t>(input.coordinate)];
      return system.links[static_cast<std::size_t>(c.link)].type == LinkType::spherical;
    });
  };
  return system.conservative_at_speeds && system.single_drives && is_plain_tree(system) &&
         std::ranges::all_of(system.torques, [&](const DriveTorqueElement& torque) {
           return !torque.keeps_momentum && !torque.implied && plain(torque.torque) && plain(torque.load);
         });
}

System compile(const Mechanism& mechanism, const CutChoice& choice, TorqueDriven torque_driven) {
  return Compiler(mechanism, choice, torque_driven).run();
}

} // namespace flyball
