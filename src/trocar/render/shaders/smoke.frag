// A ray through the smoke: what it sends back of the lamp's light (red: seen far off, green: close by), what it lets
// through (blue), and how far the surface behind it is (alpha). Variants: DETAIL.
#include "common.glsl"
uniform sampler2D u_scene;  // alpha: distance [m]
uniform sampler3D u_grid;   // square root of the density
uniform sampler3D u_noise;
uniform vec3 u_tan;                  // of half the angles of view, and of how far right the middle looks
uniform vec3 u_right, u_up, u_back;  // the eye's axes in the world
uniform vec4 u_from;                 // the eye from the grid's corner [m], and 1 / edge of a cell
uniform vec3 u_extent;               // of the grid, in cells
uniform float u_dense;               // extinction at the grid's largest value [1/m]
uniform vec3 u_risen;                // how far its curls have gone [m]
in vec2 v_uv;
out vec4 o_smoke;

#if DETAIL == 2
const int kSteps = 11;
#elif DETAIL == 1
const int kSteps = 8;
#else
const int kSteps = 6;
#endif

const float kByLaw = 0.70, kLeastSeen = 0.64;  // of the light from behind

const float kFromAround = 0.32;  // of the lamp's light on what is around: tissue sends it on, and smoke again

/// The lamp's power where tissue is in the mean. Far places weigh most, so a shaft that passes is not seen in it.
float power_around() {
  float sum = 0.0;
  for (int k = 0; k < 9; ++k) {
    float far = min(texture(u_scene, 0.5 + 0.2 * vec2(float(k % 3 - 1), float(k / 3 - 1))).a, 0.15);
    sum += far * far;
  }
  return light_at(vec3(0.0, 0.0, -sqrt(sum / 9.0))).power;
}

void main() {
  vec3 way = normalize(vec3((2.0 * v_uv - 1.0) * u_tan.xy + vec2(u_tan.z, 0.0), -1.0));
  float far = texture(u_scene, v_uv).a;
  vec3 to = u_right * way.x + u_up * way.y + u_back * way.z;
  // Where the ray is in the grid.
  vec3 inverse = 1.0 / (abs(to) + 1.0e-6) * (step(0.0, to) * 2.0 - 1.0);
  vec3 a = -u_from.xyz * inverse, b = (u_extent / u_from.w - u_from.xyz) * inverse;
  float enter = max(max(min(a.x, b.x), min(a.y, b.y)), max(min(a.z, b.z), 0.002));
  float leave = min(min(min(max(a.x, b.x), max(a.y, b.y)), max(a.z, b.z)), far);
  float clear = 1.0;
  vec2 back = vec2(0.0);
  if (leave > enter) {
    float stride = (leave - enter) / float(kSteps);
    for (int i = 0; i < kSteps; ++i) {
      float d = enter + (float(i) + 0.5) * stride;
      vec3 p = u_from.xyz + to * d;
      vec3 drawn = p;
#if DETAIL >= 1
      vec4 curls = textureLod(u_noise, (p - u_risen) * 5.5, 0.0);
      drawn += 0.030 * (curls.rgb - 0.5);  // [m] they draw it about: what rises sways
#endif
      float root = textureLod(u_grid, drawn * u_from.w / u_extent, 0.0).r;
      float sigma = u_dense * root * root;
#if DETAIL >= 1
      sigma *= 0.06 + 1.95 * smoothstep(0.30, 0.72, 0.65 * curls.a + 0.35 * curls.g);
      // It hangs much thicker on one side than on the other, in banks.
      vec3 drifts = p - 0.3 * u_risen;
      float bank = 0.5 + 0.42 * sin(dot(drifts, vec3(38.0, 9.0, 13.0)) + 5.0) + 0.12 * sin(dot(drifts, vec3(-47.0, 52.0, 68.0)));
      sigma *= 0.18 + 1.25 * bank * bank * bank;
#endif
      float taken = 1.0 - exp(-sigma * stride);
      Lit lit = light_at(way * d);
      float near = exp(-d * 22.0);
      // The lamp's light has come the same way through it; right before the lens its ring's beams have not met yet.
      float reached = clear * smoothstep(0.003, 0.03, d);
      back += clear * taken * reached * (0.068 * min(lit.power, 2.6) + 0.038 * lit.bounce) * vec2(1.0 - near, near);
      clear *= 1.0 - taken;
    }
  }
  // A camera's gain and the surgeon's eye go on seeing shapes where the eye alone would not: no denser than this (our choice).
  float knee = kByLaw - kLeastSeen;
  float kept = clear > kByLaw ? clear : kLeastSeen + knee * exp((clear - kByLaw) / knee);
  back *= (1.0 - kept) / max(1.0 - clear, 1.0e-4);
  back += back / max(back.x + back.y, 1.0e-5) * (kFromAround * (1.0 - kept) * power_around());
  o_smoke = vec4(back, kept, far);
}
