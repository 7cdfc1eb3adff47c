precision highp float;

uniform vec4 ink;
uniform float dash; // pixels from one dash to the next; 0: no gaps

in vec2 v_across;
flat in vec2 v_middle;
flat in float v_radius;

out vec4 color;

// The length along the outline, which runs across the normal: straight lines by their direction, circles
// about the solid's middle by their angle.
float along_outline() {
  vec2 n = normalize(v_across);
  return dot(gl_FragCoord.xy - v_middle, vec2(-n.y, n.x)) + v_radius * atan(n.y, n.x);
}

void main() {
  if (dash > 0.0 && fract(along_outline() / dash) > 0.6) discard;
  color = ink;
}
