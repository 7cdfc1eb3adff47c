#include "app/viewport/solid_meshes.hpp"

#include "app/viewport/primitives.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr int many_instances = 1500, very_many_instances = 6000;
constexpr double largest = 1e9; // camera distances; beyond it the shaders' floats would not do

struct GpuInstance {
  float position_round[4], rotation[4], extent_surface[4], tint[4];
};

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

GpuInstance gpu_instance(const Instance& instance, const ViewUnits& units) {
  const Vec3 p = (instance.position - units.origin) / units.length;
  const Vec3 e = instance.extent / units.length;
  const Quat& q = instance.rotation;
  const Color& c = instance.color;
  return {{float(p.x()), float(p.y()), float(p.z()), float(instance.round / units.length)},
          {float(q.x()), float(q.y()), float(q.z()), float(q.w())},
          {float(e.x()), float(e.y()), float(e.z()), static_cast<float>(instance.surface)},
          {c.r, c.g, c.b, c.a}};
}

bool drawable(const GpuInstance& instance) {
  for (const float* v : {instance.position_round, instance.extent_surface})
    for (int i = 0; i < 4; ++i)
      if (!(std::abs(v[i]) < largest)) return false;
  return true;
}

} // namespace

InstanceBatches::InstanceBatches() : buffer_(make_buffer()) {}

void InstanceBatches::set(std::span<const Instance> instances, const ViewUnits& units) {
  std::array<std::vector<GpuInstance>, primitive_count> sorted;
  for (const Instance& instance : instances) {
    const GpuInstance gpu = gpu_instance(instance, units);
    if (drawable(gpu)) sorted[static_cast<std::size_t>(instance.primitive)].push_back(gpu);
  }
  std::vector<GpuInstance> all;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    counts_[i] = static_cast<int>(sorted[i].size());
    all.insert(all.end(), sorted[i].begin(), sorted[i].end());
  }
  count_ = static_cast<int>(all.size());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(all.size() * sizeof(GpuInstance)), all.data(),
               GL_STREAM_DRAW);
}

int SolidMeshes::draw(const InstanceBatches& batches) {
  int calls = 0;
  std::size_t first = 0;
  const int detail = batches.count() < many_instances ? 2 : batches.count() < very_many_instances ? 1 : 0;
  for (std::size_t i = 0; i < batches.counts_.size(); ++i) {
    const int count = batches.counts_[i];
    if (count == 0) continue;
    const Solid& s = solid(i, detail);
    glBindVertexArray(s.vertex_array.get());
    glBindBuffer(GL_ARRAY_BUFFER, batches.buffer_.get());
    for (GLuint a = 0; a < 4; ++a)
      glVertexAttribPointer(2 + a, 4, GL_FLOAT, GL_FALSE, sizeof(GpuInstance),
                            byte_offset(first * sizeof(GpuInstance) + a * 4 * sizeof(float)));
    glDrawElementsInstanced(GL_TRIANGLES, s.index_count, GL_UNSIGNED_INT, nullptr, count);
    first += static_cast<std::size_t>(count);
    ++calls;
  }
  glBindVertexArray(0);
  return calls;
}

const SolidMeshes::Solid& SolidMeshes::solid(std::size_t primitive, int detail) {
  Solid& s = solids_[static_cast<std::size_t>(detail)][primitive];
  if (s.vertex_array) return s;
  const PrimitiveMesh mesh = primitive_mesh(static_cast<Primitive>(primitive), detail);
  s.vertex_array = make_vertex_array();
  s.vertices = make_buffer();
  s.indices = make_buffer();
  s.index_count = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(s.vertex_array.get());
  glBindBuffer(GL_ARRAY_BUFFER, s.vertices.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(PrimitiveVertex)),
               mesh.vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s.indices.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
               mesh.indices.data(), GL_STATIC_DRAW);
  for (GLuint a = 0; a < 6; ++a)
    glEnableVertexAttribArray(a);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PrimitiveVertex), byte_offset(0));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(PrimitiveVertex), byte_offset(3 * sizeof(float)));
  for (GLuint a = 2; a < 6; ++a)
    glVertexAttribDivisor(a, 1);
  return s;
}

} // namespace flyball
