// Shared by all scene shaders. The numbers in brackets are the rows that gl_packing.cpp fills; keep both in step.
precision highp float;
precision highp sampler3D;

uniform vec4 u_frame[8];
#define LIGHT_POSITION u_frame[0].xyz    /* eye space [m] */
#define LIGHT_POWER u_frame[0].w
#define LIGHT_COLOUR u_frame[1].rgb
#define LIGHT_REFERENCE2 u_frame[1].w    /* reference distance squared */
#define BOUNCE u_frame[2].rgb
#define INVERSE_SQUARE u_frame[2].w      /* 1 or 0 */
#define FOG_COLOUR u_frame[3].rgb
#define FOG u_frame[3].w                 /* [1/m] */
#define AMBIENT u_frame[4].x
#define MIRRORS u_frame[4].y             /* 1 if the picture before may be used for reflections */
#define LIGHT_RING u_frame[4].z          /* radius of the luminous area [m] */
#define CREVICES u_frame[4].w            /* how much of the baked openness shows */

const float kNearestLight2 = 6.0e-5;  // [m^2] the ring is no point: fall-off stops within 8 mm

struct Lit {
  vec3 direction;  // to the light
  float power;     // irradiance on a facing surface
  float bounce;    // irradiance from the walls
};

// The ring light: 1/d^2, a soft beam edge, and the cavity's own return, which falls off slower.
Lit light_at(vec3 eye) {
  vec3 to_light = LIGHT_POSITION - eye;
  float d2 = max(dot(to_light, to_light), kNearestLight2);
  float inverse = inversesqrt(d2);
  Lit lit;
  lit.direction = to_light * inverse;
  float near_far = LIGHT_REFERENCE2 / d2;
  float cosine = clamp(lit.direction.z, 0.0, 1.0);
  lit.power = LIGHT_POWER * mix(1.0, near_far * (0.35 + 0.65 * cosine * cosine), INVERSE_SQUARE);
  lit.bounce = LIGHT_POWER * mix(1.0, min(sqrt(near_far), 1.6), INVERSE_SQUARE);
  return lit;
}

// Smoke between the lens and the surface: takes light away twice and sends some back.
vec3 through_air(vec3 colour, vec3 eye) {
  float d = length(eye);
  float clear = exp(-FOG * d);
  return colour * clear + FOG_COLOUR * (LIGHT_POWER * 0.55 * (1.0 - clear));
}

vec3 from_srgb(vec3 c) { return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878); }
