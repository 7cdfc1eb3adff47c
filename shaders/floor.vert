uniform mat4 view_projection;
uniform vec3 center; // of the floor
uniform vec3 side_a;
uniform vec3 side_b;
uniform float reach;

out vec3 v_point;
out vec2 v_place;

void main() {
  vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) - 1.0;
  if (gl_VertexID == 1) corner = vec2(3.0, -1.0);
  if (gl_VertexID == 2) corner = vec2(-1.0, 3.0);
  v_place = corner * reach;
  v_point = center + side_a * v_place.x + side_b * v_place.y;
  gl_Position = view_projection * vec4(v_point, 1.0);
}
