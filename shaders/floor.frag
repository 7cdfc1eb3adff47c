#include "common.glsl"
#include "shadow.glsl"

uniform vec4 ink;      // of the lines
uniform vec2 origin;   // the floor's centre in the world's grid, modulo ten large cells
uniform float cell;    // of the fine grid
uniform float fading;  // of the fine grid, 0 to 1: how far it has faded out
uniform float reach;   // where the floor has faded out
uniform float weight;  // of a line, pixels
uniform float shade;   // of a full shadow
uniform float lines;   // 1: with the grid
uniform float above;   // 1: seen from above

in vec3 v_point;
in vec2 v_place;

out vec4 color;

float line(vec2 place, float size) {
  vec2 unit = place / size;
  vec2 step_size = fwidth(unit);
  vec2 away = abs(fract(unit - 0.5) - 0.5) / step_size;
  vec2 inked = clamp(0.5 * weight + 0.5 - away, 0.0, 1.0);
  // Lines closer than a few pixels melt into nothing rather than into moire.
  vec2 open = 1.0 - smoothstep(0.08, 0.3, step_size);
  return max(inked.x * open.x, inked.y * open.y);
}

void main() {
  float away = length(v_place) / reach;
  if (away > 1.0) discard;
  float here = 1.0 - smoothstep(0.25, 1.0, away);
  vec2 place = v_place + origin;
  float fine = line(place, cell) * 0.38 * (1.0 - fading);
  float coarse = line(place, 10.0 * cell) * mix(1.0, 0.38, fading);
  float huge = line(place, 100.0 * cell);
  float inked = max(max(fine, coarse), huge * fading) * ink.a * lines * here * mix(0.5, 1.0, above);

  float dark = 0.0;
  if (above > 0.5) dark = (1.0 - light_reaching(v_point, 2.4)) * shade * (1.0 - smoothstep(0.5, 1.0, away));
  float alpha = inked + dark * (1.0 - inked);
  color = vec4(alpha > 0.0 ? ink.rgb * inked / alpha : ink.rgb, alpha);
}
