// Edges of triangles, in the colour of what they are of, as bright as the lamp makes what is there.
#include "common.glsl"

uniform vec4 u_tone;
in vec3 v_eye;
in vec3 v_normal;
in vec4 v_paint;
out vec4 o_colour;

void main() {
  Lit lit = light_at(v_eye);
  o_colour = vec4(u_tone.rgb * (0.4 * lit.power + 0.5 * lit.bounce), length(v_eye));
}
