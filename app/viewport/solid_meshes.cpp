#include "app/viewport/solid_meshes.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr double largest = 1e9; // camera distances; beyond it the shaders' floats would not do

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

} // namespace

InstanceBatches::GpuInstance InstanceBatches::gpu_instance(const Instance& instance, const SeenSolid& seen,
                                                           const ViewUnits& units) {
  const Vec3 p = (instance.position - units.origin) / units.length;
  const Vec3 e = instance.extent * (seen.grow / units.length);
  const double round = seen.round * (seen.grow / units.length);
  const Quat& q = seen.rotation;
  const Color& c = instance.color;
  return {{float(p.x()), float(p.y()), float(p.z()), float(round)},
          {float(q.x()), float(q.y()), float(q.z()), float(q.w())},
          {float(e.x()), float(e.y()), float(e.z()), static_cast<float>(instance.surface)},
          {c.r, c.g, c.b, c.a}};
}

bool InstanceBatches::drawable(const GpuInstance& instance) {
  for (const float* v : {instance.position_round, instance.extent_surface})
    for (int i = 0; i < 4; ++i)
      if (!(std::abs(v[i]) < largest)) return false;
  return true;
}

InstanceBatches::InstanceBatches() : buffer_(make_buffer()) {}

void InstanceBatches::set(std::span<const Instance> instances, const ViewUnits& units, const Sight& sight,
                          bool thinned) {
  for (std::vector<GpuInstance>& kept : kept_)
    kept.clear();
  count_ = 0;
  const Quat facing = sight.facing();
  for (const Instance& instance : instances) {
    const auto seen = see(instance, sight, facing, thinned);
    if (!seen) continue;
    const GpuInstance gpu = gpu_instance(instance, *seen, units);
    if (!drawable(gpu)) continue;
    kept_[kind_of(seen->primitive, seen->detail)].push_back(gpu);
    ++count_;
  }
  const std::size_t bytes = static_cast<std::size_t>(count_) * sizeof(GpuInstance);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.get());
  // Memory of its own for every picture, so that the card need not have finished the last one; always of a
  // size, so that it can be used again.
  if (bytes > room_) room_ = bytes + bytes / 4;
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(room_), nullptr, GL_STREAM_DRAW);
  std::size_t at = 0;
  for (const std::vector<GpuInstance>& kept : kept_) {
    if (kept.empty()) continue;
    const std::size_t size = kept.size() * sizeof(GpuInstance);
    glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(at), static_cast<GLsizeiptr>(size), kept.data());
    at += size;
  }
}

int SolidMeshes::draw(const InstanceBatches& batches, int from, int to) {
  int calls = 0;
  std::size_t first = 0;
  for (std::size_t kind = 0; kind < batches.kept_.size(); ++kind) {
    const std::size_t count = batches.kept_[kind].size();
    const int detail = InstanceBatches::detail_of(kind);
    if (count == 0) continue;
    if (detail < from || detail > to) {
      first += count;
      continue;
    }
    const Solid& s = solid(kind);
    glBindVertexArray(s.vertex_array.get());
    glBindBuffer(GL_ARRAY_BUFFER, batches.buffer_.get());
    constexpr std::size_t stride = sizeof(InstanceBatches::GpuInstance);
    for (GLuint a = 0; a < 4; ++a)
      glVertexAttribPointer(2 + a, 4, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                            byte_offset(first * stride + a * 4 * sizeof(float)));
    glDrawElementsInstanced(GL_TRIANGLES, s.index_count, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(count));
    first += count;
    ++calls;
  }
  glBindVertexArray(0);
  return calls;
}

const SolidMeshes::Solid& SolidMeshes::solid(std::size_t kind) {
  Solid& s = solids_[kind];
  if (s.vertex_array) return s;
  const PrimitiveMesh mesh =
      primitive_mesh(InstanceBatches::primitive_of(kind), InstanceBatches::detail_of(kind));
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
