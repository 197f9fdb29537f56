#include "common.glsl"

uniform sampler3D u_noise;
uniform vec4 u_look;  // density, where its curls' middle is [m]
uniform vec3 u_right, u_up;  // the eye's axes in the world
uniform float u_reach;       // radius [m]
in vec2 v_corner;
in vec3 v_eye;
out vec4 o_colour;

const vec3 kFresh = vec3(0.70, 0.73, 0.80), kFoot = vec3(0.80, 0.64, 0.52);

void main() {
  float r2 = dot(v_corner, v_corner);
  float body = clamp(1.0 - r2, 0.0, 1.0);
  // Puffs that overlap share one field of curls, which rises with them: they are one plume and no balls.
  vec3 at = u_look.yzw + u_reach * (v_corner.x * u_right + v_corner.y * u_up);
  vec4 swirl = texture(u_noise, at * 9.0);
  vec3 drawn = at + 0.005 * (swirl.rgb * 2.0 - 1.0);
  float curls = 0.6 * texture(u_noise, drawn * 17.0).a + 0.4 * texture(u_noise, drawn.zxy * 46.0).a;
  // At its foot it is one strand; curls part it as it widens.
  float parted = 0.12 + 1.5 * smoothstep(0.28, 0.80, curls);
  parted = mix(0.9, parted, smoothstep(0.0012, 0.0045, u_reach));
  float alpha = clamp(0.6 * u_look.x * body * body * body * parted, 0.0, 0.6);  // what lies below is seen through it
  Lit lit = light_at(v_eye);
  // Fresh droplets scatter blue the most; at a plume's foot, brown with what burns, they are warm. Red walls light them.
  vec3 fresh = mix(kFoot, kFresh, smoothstep(0.004, 0.013, u_reach));
  vec3 colour = fresh * (min(lit.power, 6.0) * 0.72) + FOG_COLOUR * (0.25 * lit.bounce);
  o_colour = vec4(colour * alpha, alpha);
}
