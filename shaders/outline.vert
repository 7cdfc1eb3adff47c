#include "instance.glsl"

uniform mat4 view_projection;
uniform vec3 eye;         // of a perspective view
uniform float pixel;      // the size of a pixel at distance one
uniform float perspective; // 1, or 0 for an orthographic view
uniform float width;      // pixels
uniform vec2 viewport;    // pixels

out vec2 v_across;      // the normal on the screen (pixels)
flat out vec2 v_middle; // where the solid stands (pixels)
flat out float v_radius; // of what is round about it (pixels)

vec2 on_screen(vec4 clip) { return (0.5 * clip.xy / clip.w + 0.5) * viewport; }

void main() {
  vec3 at = world_point();
  vec3 n = world_normal();
  float away = mix(1.0, length(at - eye), perspective);
  gl_Position = view_projection * vec4(at + n * (width * pixel * away), 1.0);
  vec4 foot = view_projection * vec4(at, 1.0), side = view_projection * vec4(n, 0.0);
  v_across = (side.xy * foot.w - foot.xy * side.w) * viewport;
  v_middle = on_screen(view_projection * vec4(position_round.xyz, 1.0));
  v_radius = (position_round.w + min(extent_surface.x, extent_surface.y)) / (pixel * away);
}
