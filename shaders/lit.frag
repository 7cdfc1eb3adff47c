#include "common.glsl"
#include "shadow.glsl"

uniform vec3 eye;
uniform vec3 backward;     // towards the viewer, for an orthographic view
uniform float perspective; // 1, or 0 for an orthographic view
uniform vec3 up;
uniform vec3 key;          // direction to the key light
uniform float stripe;      // width of a hatch line
uniform float normal_bias;
uniform float lightness;   // of the surroundings: 1 in the light theme
uniform float glass;       // 1 for the translucent passes

in vec3 v_point;
in vec3 v_normal;
in vec3 v_local;
in vec4 v_tint;
flat in float v_surface;

out vec4 color;

void main() {
  vec3 n = normalize(v_normal);
  vec3 to_eye = normalize(mix(backward, eye - v_point, perspective));
  if (dot(n, to_eye) < 0.0) n = -n;
  float facing = clamp(dot(n, to_eye), 0.0, 1.0);
  float rim = pow(1.0 - facing, 3.0);

  if (glass > 0.5) {
    color = vec4(v_tint.rgb * (0.9 + 0.1 * dot(n, up)), v_tint.a * mix(0.75, 1.9, rim));
    return;
  }

  vec3 albedo = to_linear(v_tint.rgb);
  if (v_surface > 1.5) {
    float across = (v_local.x + v_local.y) / stripe;
    float edge = fwidth(across);
    float line = smoothstep(0.25 - edge, 0.25 + edge, abs(fract(across) - 0.5));
    albedo *= mix(0.28, 1.0, line);
  }
  float metal = v_surface > 0.5 && v_surface < 1.5 ? 1.0 : 0.0;

  float toward = dot(n, key);
  float lit = clamp(toward, 0.0, 1.0);
  if (lit > 0.0) lit *= light_reaching(v_point + n * normal_bias * (1.5 - toward), 1.1);
  float fill = clamp(dot(n, normalize(to_eye + 0.35 * up)), 0.0, 1.0);
  float sky = 0.5 + 0.5 * dot(n, up);

  vec3 ambient = mix(vec3(0.20, 0.20, 0.21), vec3(0.46, 0.48, 0.52), sky) * mix(0.72, 1.0, lightness);
  vec3 light = ambient + vec3(0.86, 0.84, 0.80) * lit + vec3(0.15) * fill;

  vec3 half_way = normalize(key + to_eye);
  float shine = pow(clamp(dot(n, half_way), 0.0, 1.0), mix(48.0, 90.0, metal)) * mix(0.16, 0.40, metal) * lit;
  float mirror = metal * 0.20 * pow(clamp(0.5 + 0.5 * dot(reflect(-to_eye, n), up), 0.0, 1.0), 4.0);
  vec3 result = albedo * light + vec3(shine) + vec3(mirror) * (0.4 + 0.6 * facing);
  // A soft dark edge in the light theme and a soft bright one in the dark make outlines crisp.
  result = mix(result, result * mix(1.0, 0.45, lightness) + vec3(0.10) * (1.0 - lightness), 0.55 * rim);
  color = vec4(to_screen(min(result, vec3(1.0))) + dither(gl_FragCoord.xy), 1.0);
}
