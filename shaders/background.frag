#include "common.glsl"

uniform vec3 top;
uniform vec3 bottom;

in vec2 v_place;
out vec4 color;

void main() {
  float t = smoothstep(0.0, 1.0, v_place.y);
  color = vec4(mix(bottom, top, t) + dither(gl_FragCoord.xy), 1.0);
}
