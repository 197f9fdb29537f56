#include "common.glsl"

uniform sampler3D u_noise;
uniform vec4 u_look;  // density, three numbers that make each puff its own
in vec2 v_corner;
in vec3 v_eye;
out vec4 o_colour;

void main() {
  float r2 = dot(v_corner, v_corner);
  float body = clamp(1.0 - r2, 0.0, 1.0);
  float curls = texture(u_noise, vec3(v_corner * 0.11, 0.0) + u_look.yzw).a;
  float alpha = clamp(u_look.x * body * body * (0.3 + 1.5 * curls), 0.0, 0.95);
  Lit lit = light_at(v_eye);
  vec3 colour = FOG_COLOUR * (min(lit.power, 6.0) * 0.6 + 0.25 * lit.bounce);
  o_colour = vec4(colour * alpha, alpha);
}
