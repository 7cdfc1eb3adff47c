#include "tests/engine/reference/mujoco_reference.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#ifdef FLYBALL_HAVE_MUJOCO
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#endif

namespace flyball::reference {

namespace {

std::size_t index_of(int i) {
  return static_cast<std::size_t>(i);
}

// One joint of MuJoCo's for one coordinate of ours, or for three of a rotation.
struct Part {
  enum class Kind { hinge, slide, ball } kind = Kind::hinge;
  int index = 0; // first coordinate of ours
  Vec3 axis = Vec3::Zero();
};

// MuJoCo composes a body's joints from the parent outward, each about axes turned by those before it. A joint
// that the tree meets from its child's side is the inverse motion: the reverse order about opposite axes.
std::vector<Part> parts_of(const Joint& joint, bool reversed) {
  using Kind = Part::Kind;
  const Vec3 a = joint.axis.normalized(), b = joint.axis2.normalized();
  std::vector<Part> parts;
  switch (joint.type) {
  case JointType::revolute: parts = {{Kind::hinge, 0, a}}; break;
  case JointType::prismatic: parts = {{Kind::slide, 0, a}}; break;
  case JointType::cylindrical: parts = {{Kind::hinge, 0, a}, {Kind::slide, 1, a}}; break;
  case JointType::universal: parts = {{Kind::hinge, 0, a}, {Kind::hinge, 1, b}}; break;
  case JointType::spherical: parts = {{Kind::ball, 0, Vec3::Zero()}}; break;
  case JointType::planar: {
    const Vec3 x = (b - a * a.dot(b)).normalized();
    parts = {{Kind::slide, 0, x}, {Kind::slide, 1, a.cross(x)}, {Kind::hinge, 2, a}};
    break;
  }
  case JointType::free:
    parts = {{Kind::slide, 0, Vec3::UnitX()},
             {Kind::slide, 1, Vec3::UnitY()},
             {Kind::slide, 2, Vec3::UnitZ()},
             {Kind::ball, 3, Vec3::Zero()}};
    break;
  case JointType::fixed:
  case JointType::distance:
  case JointType::gear: break;
  }
  if (reversed) {
    std::reverse(parts.begin(), parts.end());
    for (Part& part : parts)
      part.axis = -part.axis;
  }
  return parts;
}

std::string part_name(const Joint& joint, const Part& part) {
  return joint.name + "_" + std::to_string(part.index);
}

std::string numbers(const Vec3& v) {
  std::ostringstream out;
  out << std::setprecision(17) << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

void write_body(std::ostream& out, const Mechanism& mechanism, const Tree& tree, const Tree::Link& link) {
  const Body& body = mechanism.bodies[index_of(link.to)];
  const Joint& joint = mechanism.joints[index_of(link.joint)];
  const Vec3 base = link.from < 0 ? Vec3(Vec3::Zero()) : mechanism.bodies[index_of(link.from)].position;
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  Mat3 inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  // MuJoCo's own diagonalisation of a full tensor stops at seven digits.
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(inertia);
  Mat3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  const Quat q = body.rotation.normalized() * Quat(axes);
  out << "<body name=\"" << body.name << "\" pos=\"" << numbers(body.position - base) << "\">\n";
  out << "<inertial pos=\"0 0 0\" mass=\"" << body.mass << "\" diaginertia=\""
      << numbers(principal.eigenvalues()) << "\" quat=\"" << q.w() << ' ' << numbers(q.vec()) << "\"/>\n";
  for (const Part& part : parts_of(joint, link.reversed)) {
    const Coordinate& c = joint.coordinates[index_of(part.index)];
    const Vec3 anchor = joint.at - body.position;
    out << "<joint name=\"" << part_name(joint, part) << "\" pos=\"" << numbers(anchor) << '"';
    if (part.kind == Part::Kind::ball) {
      out << " type=\"ball\"/>\n";
      continue;
    }
    out << " type=\"" << (part.kind == Part::Kind::hinge ? "hinge" : "slide") << "\" axis=\""
        << numbers(part.axis) << "\" ref=\"" << c.drawn << "\" damping=\"" << c.damping << '"';
    if (c.spring) out << " stiffness=\"" << c.spring->stiffness << "\" springref=\"" << c.spring->free << '"';
    out << "/>\n";
  }
  for (const Tree::Link& next : tree.links)
    if (next.from == link.to) write_body(out, mechanism, tree, next);
  out << "</body>\n";
}

} // namespace

bool mujoco_can_hold(const Mechanism& mechanism) {
  if (!mechanism.forces.empty() || !default_cuts(mechanism).empty()) return false;
  for (const Body& body : mechanism.bodies) {
    if (body.mass <= 0 || body.inertia[0] <= 0 || body.inertia[1] <= 0 || body.inertia[2] <= 0) return false;
  }
  for (const Joint& joint : mechanism.joints)
    for (int i = 0; i < coordinate_count(joint.type); ++i) {
      const Coordinate& c = joint.coordinates[index_of(i)];
      if (c.stop || (is_rotation_vector(joint.type, i) && (c.spring || c.damping > 0))) return false;
    }
  return true;
}

std::string to_mjcf(const Mechanism& mechanism) {
  const Tree tree = span_tree(mechanism, {});
  std::ostringstream out;
  out << std::setprecision(17);
  out << "<mujoco>\n<compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n<option gravity=\""
      << numbers(mechanism.gravity) << "\"/>\n<worldbody>\n";
  for (const Tree::Link& link : tree.links)
    if (link.from < 0) write_body(out, mechanism, tree, link);
  out << "</worldbody>\n</mujoco>\n";
  return out.str();
}

#ifdef FLYBALL_HAVE_MUJOCO

bool mujoco_available() {
  return true;
}

namespace {

struct Free {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

std::unique_ptr<mjModel, Free> load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>(); // too large for the stack
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size()));
  const int file = mj_findFileVFS(files.get(), "model.xml");
  std::memcpy(files->filedata[file], xml.data(), xml.size());
  char error[1000] = "";
  std::unique_ptr<mjModel, Free> model(mj_loadXML("model.xml", files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) throw std::invalid_argument(error);
  return model;
}

} // namespace

std::map<std::string, VectorR> mujoco_inverse(const Mechanism& mechanism, const ReferenceState& state) {
  if (!mujoco_can_hold(mechanism)) throw std::invalid_argument("MuJoCo cannot hold this mechanism");
  const Tree tree = span_tree(mechanism, {});
  const auto model = load(to_mjcf(mechanism));
  const std::unique_ptr<mjData, Free> data(mj_makeData(model.get()));
  // Calls `visit(joint, part, reversed, position address, velocity address, rotation of a ball)`.
  const auto each_part = [&](auto&& visit) {
    for (const Tree::Link& link : tree.links) {
      const Joint& joint = mechanism.joints[index_of(link.joint)];
      const std::vector<Real> q = joint_values(joint, state);
      for (const Part& part : parts_of(joint, link.reversed)) {
        const int id = mj_name2id(model.get(), mjOBJ_JOINT, part_name(joint, part).c_str());
        Mat3R turned = Mat3R::Identity();
        if (part.kind == Part::Kind::ball) {
          Vec3R r, drawn;
          for (int i = 0; i < 3; ++i) {
            r[i] = q[index_of(part.index + i)];
            drawn[i] = joint.coordinates[index_of(part.index + i)].drawn;
          }
          turned = rotation_exp(r) * rotation_exp(drawn).transpose();
          if (link.reversed) turned.transposeInPlace();
        }
        visit(link, part, model->jnt_qposadr[id], model->jnt_dofadr[id], turned);
      }
    }
  };
  each_part([&](const Tree::Link& link, const Part& part, int position, int velocity, const Mat3R& turned) {
    const int first = tree.first[index_of(link.joint)] + part.index;
    if (part.kind == Part::Kind::ball) {
      const QuatR quaternion(turned);
      data->qpos[position] = static_cast<double>(quaternion.w());
      for (int i = 0; i < 3; ++i)
        data->qpos[position + 1 + i] = static_cast<double>(quaternion.vec()[i]);
      return;
    }
    data->qpos[position] = static_cast<double>(
        joint_values(mechanism.joints[index_of(link.joint)], state)[index_of(part.index)]);
    data->qvel[velocity] = static_cast<double>(tree.coordinates[index_of(first)].speed);
  });
  mj_inverse(model.get(), data.get());

  std::map<std::string, VectorR> forces;
  each_part([&](const Tree::Link& link, const Part& part, int, int velocity, const Mat3R& turned) {
    const Joint& joint = mechanism.joints[index_of(link.joint)];
    VectorR& f = forces[joint.name];
    if (f.size() == 0) f = VectorR::Zero(coordinate_count(joint.type));
    if (part.kind != Part::Kind::ball) {
      f[part.index] = data->qfrc_inverse[velocity];
      return;
    }
    // MuJoCo's torque is in the axes of the outer body, on it; ours in those of the joint's parent, on its
    // child.
    Vec3R torque;
    for (int i = 0; i < 3; ++i)
      torque[i] = data->qfrc_inverse[velocity + i];
    f.segment<3>(part.index) = link.reversed ? Vec3R(-torque) : Vec3R(turned * torque);
  });
  return forces;
}

std::vector<Pose> mujoco_motion(const Mechanism& mechanism,
                                const std::vector<std::pair<std::string, double>>& rates, double duration,
                                double step) {
  if (!mujoco_can_hold(mechanism)) throw std::invalid_argument("MuJoCo cannot hold this mechanism");
  const auto model = load(to_mjcf(mechanism));
  const auto steps = std::lround(duration / step);
  model->opt.integrator = mjINT_RK4;
  model->opt.timestep = duration / static_cast<double>(steps);
  const std::unique_ptr<mjData, Free> data(mj_makeData(model.get()));
  for (const auto& [name, rate] : rates) {
    const CoordinateReference c = find_coordinate(mechanism, name);
    if (c.joint < 0) throw std::invalid_argument("no coordinate " + name);
    const std::string part = mechanism.joints[index_of(c.joint)].name + "_" + std::to_string(c.coordinate);
    data->qvel[model->jnt_dofadr[mj_name2id(model.get(), mjOBJ_JOINT, part.c_str())]] = rate;
  }
  for (long i = 0; i < steps; ++i)
    mj_step(model.get(), data.get());
  mj_kinematics(model.get(), data.get());
  std::vector<Pose> poses;
  for (const Body& body : mechanism.bodies) {
    const int id = mj_name2id(model.get(), mjOBJ_BODY, body.name.c_str());
    const double *x = data->xpos + 3 * id, *q = data->xquat + 4 * id;
    poses.push_back({Vec3(x[0], x[1], x[2]), Quat(q[0], q[1], q[2], q[3])});
  }
  return poses;
}

#else

bool mujoco_available() {
  return false;
}

std::map<std::string, VectorR> mujoco_inverse(const Mechanism&, const ReferenceState&) {
  throw std::invalid_argument("built without MuJoCo");
}

std::vector<Pose> mujoco_motion(const Mechanism&, const std::vector<std::pair<std::string, double>>&, double,
                                double) {
  throw std::invalid_argument("built without MuJoCo");
}

#endif

} // namespace flyball::reference
