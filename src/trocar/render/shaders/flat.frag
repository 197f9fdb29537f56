// Colours that were given per vertex: false-colour maps and plastic (LIT), lines and gizmos.
#include "common.glsl"

uniform float u_blended;  // 1: alpha says how opaque, 0: how far
uniform vec4 u_tone;  // multiplies colour and alpha
#ifdef LIT
uniform float u_gloss;
#endif
in vec3 v_eye;
in vec3 v_normal;
in vec4 v_paint;
out vec4 o_colour;

void main() {
  vec3 colour = from_srgb(v_paint.rgb) * u_tone.rgb;
  float alpha = v_paint.a * u_tone.a;
#ifdef LIT
  vec3 V = normalize(-v_eye);
  vec3 N = normalize(v_normal);
  if (dot(N, V) < 0.0) N = -N;
  Lit lit = light_at(v_eye);
  float wrapped = clamp((dot(N, lit.direction) + 0.25) / 1.25, 0.0, 1.0);
  float nh = clamp(dot(N, normalize(lit.direction + V)), 0.0, 1.0);
  float gloss = u_gloss * exp2(64.0 * (nh - 1.0));
  colour = colour * (LIGHT_COLOUR * lit.power * wrapped + (BOUNCE + vec3(AMBIENT)) * lit.bounce) + gloss * lit.power;
#endif
  o_colour = vec4(mix(colour, colour * alpha, u_blended), mix(length(v_eye), alpha, u_blended));
}
