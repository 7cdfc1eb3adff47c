precision highp sampler2DShadow;

uniform sampler2DShadow shadow_map;
uniform mat4 shadow_matrix; // to the map's unit cube
uniform float shadow_texel; // of the map's width
uniform float shadow_on;
uniform int shadow_taps;    // a side of the square that is looked at

// The share of the key light that reaches a point, softened over `spread` texels.
float light_reaching(vec3 point, float spread) {
  if (shadow_on < 0.5) return 1.0;
  vec3 place = (shadow_matrix * vec4(point, 1.0)).xyz;
  if (any(greaterThan(abs(place.xy - 0.5), vec2(0.51)))) return 1.0;
  place.z = min(place.z, 0.9999); // the floor may lie farther from the light than anything that casts
  float sum = 0.0;
  float middle = 0.5 * float(shadow_taps - 1);
  for (int i = 0; i < shadow_taps; ++i)
    for (int j = 0; j < shadow_taps; ++j) {
      vec2 offset = (vec2(float(i), float(j)) - middle) * spread * shadow_texel;
      sum += texture(shadow_map, vec3(place.xy + offset, place.z));
    }
  return sum / float(shadow_taps * shadow_taps);
}
