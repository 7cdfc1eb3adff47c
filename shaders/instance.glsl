// One solid: its surface point is  position + rotation * (core * extent + normal * round), in units of the
// camera's distance, seen from its target.
layout(location = 0) in vec3 core;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 position_round;
layout(location = 3) in vec4 rotation;
layout(location = 4) in vec4 extent_surface;
layout(location = 5) in vec4 tint;

vec3 turn(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

vec3 local_point() { return core * extent_surface.xyz + normal * position_round.w; }
vec3 world_normal() { return turn(rotation, normal); }
vec3 world_point() { return position_round.xyz + turn(rotation, local_point()); }
