#include "instance.glsl"

uniform mat4 view_projection;

void main() { gl_Position = view_projection * vec4(world_point(), 1.0); }
