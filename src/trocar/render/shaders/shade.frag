// What one instrument leaves of the light on the opaque surfaces that the picture shows: lamp (red), around (green); of
// their blood, where it presses them (blue).
// Blended by multiplying. Variant: SAMPLED (a pixel at an outline has the mean of two distances).
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
  ivec2 at = ivec2(gl_FragCoord.xy);
  float far = texelFetch(u_scene, at, 0).a;
#ifdef SAMPLED
  // What is shaded is behind the outline.
  far = max(far, max(texelFetch(u_scene, at + ivec2(1, 0), 0).a, texelFetch(u_scene, at - ivec2(1, 0), 0).a));
  far = max(far, max(texelFetch(u_scene, at + ivec2(0, 1), 0).a, texelFetch(u_scene, at - ivec2(0, 1), 0).a));
#endif
  vec3 eye = far * normalize(vec3(v_at * u_tan.xy + vec2(u_tan.z, 0.0), -1.0));
  float paled = u_pressed * (1.0 - smoothstep(0.0005, 0.0045, gap_of_rod(eye, u_rod, u_way)));
  o_shade = vec4(shade_of_rod(eye, u_lamp.xyz, u_lamp.w, u_rod, u_way), 1.0 - paled, 1.0);
}
