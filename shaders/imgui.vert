uniform vec2 origin;
uniform vec2 size;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 place;
layout(location = 2) in vec4 tint;

out vec2 v_place;
out vec4 v_tint;

void main() {
  v_place = place;
  v_tint = tint;
  vec2 unit = (position - origin) / size;
  gl_Position = vec4(2.0 * unit.x - 1.0, 1.0 - 2.0 * unit.y, 0.0, 1.0);
}
