// Liquid that has gathered: what lies below, bent and coloured by its depth, what is around in its mirror, the lamp, and
// a border that climbs what it wets. Variants: DETAIL.
#include "common.glsl"
#include "liquid.glsl"
in vec3 v_eye;
in vec3 v_normal;
in vec2 v_depth_cover;
in vec4 v_mix;
out vec4 o_colour;

/// What the sheet mirrors: a ray through the picture, in steps that grow.
vec3 mirrored(vec3 r, float bounce, float jitter) {
  // Beyond the picture: the front wall, brighter where the lamp grazes it.
  vec3 up = to_world(r) - u_eye.xyz;
  vec3 walls = (vec3(0.20, 0.085, 0.075) + BOUNCE) * (bounce * (0.15 + 1.9 * texture(u_noise, up * 0.09).a));
#if DETAIL < 2
  return walls;
#else
  float reach = 0.0025 * (0.97 + 0.06 * jitter), before = 0.0;
  for (int i = 0; i < 8; ++i) {
    vec3 p = v_eye + reach * r;
    vec2 at = in_picture(p);
    if (p.z > -0.004 || max(abs(at.x - 0.5), abs(at.y - 0.5)) > 0.49) break;
    float step_off = reach - before, gap = length(p) - texture(u_bed, at).a;
    if (gap > 0.0 && gap < 0.012 + 0.5 * step_off) {
      for (int k = 0; k < 3; ++k) {  // between the last two steps
        float middle = 0.5 * (before + reach);
        vec3 q = v_eye + middle * r;
        if (length(q) > texture(u_bed, in_picture(q)).a) reach = middle; else before = middle;
      }
      at = in_picture(v_eye + reach * r);
      // What it meets fades out where the picture ends and where it goes on behind what is seen: no outlines of either.
      vec2 edge = clamp(8.0 * (0.49 - abs(at - 0.5)), 0.0, 1.0);
      float met = edge.x * edge.y * clamp(1.5 - gap / (0.006 + 0.25 * step_off), 0.0, 1.0);
      return mix(walls, min(texture(u_bed, at).rgb, vec3(0.35)), 0.8 * met);
    }
    before = reach;
    reach *= 1.6;
  }
  return walls;
#endif
}

void main() {
  float inside = v_depth_cover.y - 0.333;
  vec2 cover_slope = vec2(dFdx(v_depth_cover.y), dFdy(v_depth_cover.y));
  vec3 ddx = dFdx(v_eye), ddy = dFdy(v_eye);
  if (inside < 0.0) discard;
  float edge = clamp(inside / max(length(cover_slope), 1.0e-4), 0.0, 1.0);
  vec2 uv = gl_FragCoord.xy * u_size.zw;
  // Where it meets what stands in it, it runs out thin as well.
  vec4 straight = texture(u_bed, uv);
  vec3 V = normalize(-v_eye);
  float far = length(v_eye);
  Lit lit = light_at(v_eye);
  vec3 place = to_world(v_eye);
  float pixel = -v_eye.z * 2.0 * u_tan.y * u_size.w;

  // Small unrest on top of the waves that the simulation knows.
  vec4 slow = texture(u_noise, vec3(place.xy * 9.0, 0.13 * u_eye.w));
  vec4 quick = texture(u_noise, vec3(place.yx * 31.0, 0.21 * u_eye.w));
  vec3 unrest = (slow.rgb * 2.0 - 1.0) * 0.034 + (quick.rgb * 2.0 - 1.0) * 0.018;
#if DETAIL == 2
  // Where it is thin it follows the tissue's relief, which stands still.
  float thin = exp(-max(v_depth_cover.x, 0.0) / 0.0005);
  unrest += (texture(u_noise, place * 38.0).rgb * 2.0 - 1.0) * (0.6 * thin);
#endif
  vec3 n = normalize(v_normal);
  float gap = max(straight.a - far, 0.0), shore = smoothstep(0.0, 0.0016, gap);
  float rim = max(exp(-inside * 6.0), 0.8 - 0.8 * shore);
  // Towards the inside of the border, in eye space.
  vec3 inward = cover_slope.x * normalize(ddx) + cover_slope.y * normalize(ddy);
  inward -= n * dot(n, inward);
  float steep = length(inward);
  inward = steep > 1.0e-5 ? inward / steep : vec3(0.0);
  vec3 level = n;
  n = normalize(n + vec3(dot(unrest, u_right), dot(unrest, u_up), 0.0) + inward * (1.25 * rim * rim));
  float nv = clamp(dot(n, V), 0.05, 1.0);

  // The mix is not even: what is redder hangs in clouds.
  vec3 share = vec3(max(1.0 - v_mix.x - v_mix.y, 0.0), v_mix.xy);
  float cloud = 0.45 + 1.1 * smoothstep(0.2, 0.8, 0.6 * slow.a + 0.4 * quick.a);
  share.x = mix(share.x * cloud, share.x, share.x);
  float wedge = min(clamp(inside * 1.7, 0.04, 1.0), 0.12 + 0.88 * shore);
  float depth = max(v_depth_cover.x, 0.0) * wedge * wedge * wedge;
  float slant = 1.0 / max(sqrt(1.0 - (1.0 - nv * nv) * 0.56), 0.3);  // of the bent ray
  vec3 amount = share * depth;
  vec3 through = let_through(amount * (1.0 + slant), v_mix.w);

  vec2 bend = -n.xy * (0.25 * min(depth, 0.012) / pixel) * u_size.zw;
  vec4 below = texture(u_bed, uv + clamp(bend, -0.04, 0.04));
  if (below.a < far - 0.0005) below = straight;
  // Wet tissue is darker and fuller in colour than dry.
  vec3 bed = below.rgb * mix(vec3(1.0), vec3(0.86, 0.80, 0.80), edge);

  float facing = clamp(0.1 + 0.9 * dot(n, lit.direction), 0.0, 1.0);
  vec3 light = LIGHT_COLOUR * (lit.power * facing) + (BOUNCE + vec3(AMBIENT)) * lit.bounce;
  vec3 deep = deep_colour(amount, v_mix.w) * (0.90 + 0.20 * slow.g);
  vec3 colour = bed * through + deep * light * (1.0 - through);
#if DETAIL >= 1
  float froth = v_mix.z * smoothstep(0.55, 0.75, quick.a + 0.3 * v_mix.z);
  colour = mix(colour, mix(vec3(0.55, 0.42, 0.40), vec3(0.45, 0.10, 0.10), share.x) * light, 0.7 * froth);
#endif

  // A little more than [Schlick 94] says: it is what tells liquid from paint (our choice).
  float share_back = min(2.5 * mirror_share(nv) + 0.05, 1.0);
  vec3 r = reflect(-V, n);
  colour = mix(colour, mirrored(r, lit.bounce, quick.g), share_back);
  colour += highlight(n, V, lit, u_shine.y);
  colour = mix(below.rgb, colour, edge);
  o_colour = vec4(colour, far);
}
