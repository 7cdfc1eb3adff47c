precision highp float;

vec3 to_linear(vec3 c) { return pow(c, vec3(2.2)); }
vec3 to_screen(vec3 c) { return pow(c, vec3(1.0 / 2.2)); }

// Less than one step of 8-bit colour, so that gradients show no bands.
float dither(vec2 pixel) { return (fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))) - 0.5) / 255.0; }
