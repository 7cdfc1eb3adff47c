precision highp float;

uniform sampler2D picture;

in vec2 v_place;
in vec4 v_tint;

out vec4 color;

void main() { color = v_tint * texture(picture, v_place); }
