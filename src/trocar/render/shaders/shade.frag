// What one instrument leaves of the light on the opaque surfaces that the picture shows: lamp (red), around (green); of
// their blood, where it presses them (blue).
// Blended by multiplying.
precision highp float;
#include "shade.glsl"
uniform sampler2D u_scene;  // alpha: distance [m]
uniform vec4 u_rod, u_way;
uniform float u_pressed;  // 0..1
uniform vec4 u_lamp;  // and the radius of its disc
uniform vec3 u_tan;   // of half the angles of view, and of how far right the middle looks
in vec2 v_at;
out vec4 o_shade;

void main() {
  float far = texelFetch(u_scene, ivec2(gl_FragCoord.xy), 0).a;
  vec3 eye = far * normalize(vec3(v_at * u_tan.xy + vec2(u_tan.z, 0.0), -1.0));
  float paled = u_pressed * (1.0 - smoothstep(0.0005, 0.0045, gap_of_rod(eye, u_rod, u_way)));
  o_shade = vec4(shade_of_rod(eye, u_lamp.xyz, u_lamp.w, u_rod, u_way), 1.0 - paled, 1.0);
}
