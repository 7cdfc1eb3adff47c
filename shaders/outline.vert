#include "instance.glsl"

uniform mat4 view_projection;
uniform vec3 eye;         // of a perspective view
uniform float pixel;      // the size of a pixel at distance one
uniform float perspective; // 1, or 0 for an orthographic view
uniform float width;      // pixels

void main() {
  vec3 at = world_point();
  float away = mix(1.0, length(at - eye), perspective);
  gl_Position = view_projection * vec4(at + world_normal() * (width * pixel * away), 1.0);
}
