precision highp sampler2DShadow;

uniform sampler2DShadow shadow_map;
uniform mat4 shadow_matrix; // to the map's unit cube
uniform float shadow_texel; // of the map's width
uniform float shadow_on;

// The share of the key light that reaches a point, softened over `spread` texels.
float light_reaching(vec3 point, float spread) {
  if (shadow_on < 0.5) return 1.0;
  vec3 place = (shadow_matrix * vec4(point, 1.0)).xyz;
  if (any(greaterThan(abs(place.xy - 0.5), vec2(0.51)))) return 1.0;
  place.z = min(place.z, 0.9999); // the floor may lie farther from the light than anything that casts
  float sum = 0.0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      vec2 offset = (vec2(float(i), float(j)) - 1.5) * spread * shadow_texel;
      sum += texture(shadow_map, vec3(place.xy + offset, place.z));
    }
  return sum / 16.0;
}
