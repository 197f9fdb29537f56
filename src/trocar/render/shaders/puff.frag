#include "common.glsl"

uniform sampler3D u_noise;
uniform vec4 u_look;  // density, three numbers that make each puff its own
in vec2 v_corner;
in vec3 v_eye;
out vec4 o_colour;

void main() {
  float r2 = dot(v_corner, v_corner);
  float body = clamp(1.0 - r2, 0.0, 1.0);
  // Curls eat into its rim, so that puffs which overlap are one plume and no balls.
  float curls = 0.65 * texture(u_noise, vec3(v_corner * 0.075, 0.0) + u_look.yzw).a +
                0.35 * texture(u_noise, vec3(v_corner * 0.21, 0.4) + u_look.zwy).a;
  float alpha = clamp(u_look.x * smoothstep(0.0, 1.5, body * body * (0.35 + 1.8 * smoothstep(0.25, 0.75, curls))), 0.0, 0.95);
  Lit lit = light_at(v_eye);
  vec3 colour = FOG_COLOUR * (min(lit.power, 6.0) * 0.6 + 0.25 * lit.bounce);
  o_colour = vec4(colour * alpha, alpha);
}
