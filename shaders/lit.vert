#include "instance.glsl"

uniform mat4 view_projection;

out vec3 v_point;
out vec3 v_normal;
out vec3 v_local;
out vec4 v_tint;
flat out float v_surface;

void main() {
  v_point = world_point();
  v_normal = world_normal();
  v_local = local_point();
  v_tint = tint;
  v_surface = extent_surface.w;
  gl_Position = view_projection * vec4(v_point, 1.0);
}
