// Liquid that has gathered: what lies below, bent and coloured by its depth, what is around in its mirror, the lamp, and
// a border that climbs what it wets. Drawn where sheet_mark.frag was. Variants: DETAIL.
#include "common.glsl"
#include "liquid.glsl"
in vec3 v_eye;
in vec3 v_normal;
in vec2 v_depth_cover;
in vec4 v_mix;
out vec4 o_colour;

const float kDrawsBack = 0.0020;  // [m] along the eye's way, our choice
const float kStain = 6.0e-5;      // [m] along light's way, of what it leaves there
const float kBorder = 5.0e-5;     // [m] of it at its very border, where it climbs what it wets
const vec3 kPoolSends = vec3(2.1, 1.2, 1.3);  // of blood's colour, more from a pool than through a drop; our choice
const float kFlecks = 1.6;                    // of the lamp; our choice
// [1/m] where along and across both of them are in the noise: long waves, and ripples that break their light
const mat2 kWaves = mat2(15.0, -12.0, 12.0, 30.0), kRipples = mat2(47.0, 30.0, -52.0, 74.0);
const float kDeep = 0.007, kDarkens = 0.22;   // [m] at which it is darker by so much; our choice
const float kBlurred = 0.5;                   // share of a step that a mirrored ray is stepped farther or less far
const float kDull = 0.06;                     // what is darker than this does not show in blood's mirror; our choice

/// What the sheet mirrors: what the picture shows along the ray, near and far, as far as it lies there. Nothing is
/// searched for, so no outline of a search can show.
/// @param grain  0 .. 1, a pixel's own: what is mirrored is blurred by ripples finer than that
vec3 mirrored(vec3 r, float bounce, float grain) {
  // Beyond the picture: the front wall, brighter where the lamp grazes it.
  vec3 walls = (vec3(0.24, 0.060, 0.052) + BOUNCE) * (0.45 * bounce);
#if DETAIL < 2
  return walls;
#else
  vec3 seen = vec3(0.0);
  float found = 0.25, reach = 0.0035 * (1.0 + kBlurred * (grain - 0.5));  // [m]
  seen = 0.25 * walls;
  for (int i = 0; i < 6; ++i) {
    vec3 p = v_eye + reach * r;
    vec2 at = in_picture(p), edge = clamp(6.0 * (0.5 - abs(at - 0.5)), 0.0, 1.0);
    vec4 there = texture(u_bed, at);
    float off = (there.a - length(p)) / reach;
    float weight = edge.x * edge.y * smoothstep(0.002, 0.012, -p.z) / (1.0 + off * off * off * off);
    seen += weight * min(there.rgb, vec3(0.60, 0.44, 0.41));
    found += weight;
    reach *= 1.8;
  }
  return seen / found;
#endif
}

void main() {
  float inside = v_depth_cover.y - 0.333;
  vec2 cover_slope = vec2(dFdx(v_depth_cover.y), dFdy(v_depth_cover.y));
  vec3 ddx = dFdx(v_eye), ddy = dFdy(v_eye);
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
  vec3 unrest = (slow.rgb * 2.0 - 1.0) * 0.022 + (quick.rgb * 2.0 - 1.0) * (0.006 + 0.035 * smoothstep(0.50, 0.66, slow.a));
#if DETAIL == 2
  // Where it is thin it follows the tissue's relief, which stands still.
  float thin = exp(-max(v_depth_cover.x, 0.0) / 0.0005);
  unrest += (texture(u_noise, place * 38.0).rgb * 2.0 - 1.0) * (0.12 * thin);
#endif
  vec3 n = normalize(v_normal);
  // What it wets is uneven: here it stands higher, there it has drawn back and left a stain.
  float uneven = texture(u_noise, place * 11.0).g;
  float gap = straight.a - far - kDrawsBack * smoothstep(0.30, 0.70, uneven);
  float shore = smoothstep(0.0, 0.0016, gap);
  float rim = max(exp(-inside * 6.0), 0.8 - 0.8 * shore);
  // Towards the inside of the border, in eye space: of the sheet's own, or of what stands in it.
  vec2 slope = cover_slope;
#if DETAIL >= 1
  if (shore < 1.0) {
    vec2 step = 2.0 * u_size.zw;
    slope = vec2(texture(u_bed, uv + vec2(step.x, 0.0)).a, texture(u_bed, uv + vec2(0.0, step.y)).a) - straight.a -
            2.0 * vec2(dFdx(far), dFdy(far));
  }
#endif
  vec3 inward = slope.x * normalize(ddx) + slope.y * normalize(ddy);
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
  float wedge = min(clamp(inside * 2.5, 0.04, 1.0), 0.12 + 0.88 * shore);
  float depth = max(v_depth_cover.x, 0.0) * wedge * wedge;
  float slant = 1.0 / max(sqrt(1.0 - (1.0 - nv * nv) * 0.56), 0.3);  // of the bent ray
  vec3 amount = share * (depth + kBorder);
  vec3 through = let_through(amount * (1.0 + slant), v_mix.w);

  vec2 bend = -n.xy * (0.25 * min(depth, 0.012) / pixel) * u_size.zw;
  vec4 below = texture(u_bed, uv + clamp(bend, -0.04, 0.04));
  if (below.a < far - 0.0005) below = straight;
  // Wet tissue is darker and fuller in colour than dry.
  vec3 bed = below.rgb * mix(vec3(1.0), vec3(0.86, 0.80, 0.80), edge);

  // What comes back from within has been turned aside there: a bent surface dims it little.
  float facing = clamp(0.1 + 0.9 * dot(mix(n, level, 0.7 * share.x), lit.direction), 0.0, 1.0);
  vec3 light = LIGHT_COLOUR * (lit.power * facing) + (BOUNCE + vec3(AMBIENT)) * lit.bounce;
  float bent = smoothstep(0.0, 0.25, rim);
  vec3 deep = deep_colour(amount, v_mix.w) * (0.78 + 0.5 * smoothstep(0.25, 0.8, slow.a));
  deep *= 1.0 - kDarkens * smoothstep(0.0, kDeep, depth);
  deep *= mix(vec3(1.0), kPoolSends * (1.0 - 0.45 * bent), share.x);
  vec3 colour = bed * through + deep * light * (1.0 - through);
#if DETAIL >= 1
  float froth = v_mix.z * smoothstep(0.55, 0.75, quick.a + 0.3 * v_mix.z);
  colour = mix(colour, mix(vec3(0.55, 0.42, 0.40), vec3(0.45, 0.10, 0.10), share.x) * light, 0.7 * froth);
#endif

  // More than [Schlick 94] says: it is what tells liquid from paint (our choice).
  float share_back = min(mix(4.0, 8.0, share.x) * mirror_share(nv) + 0.01, 0.5);
  share_back *= 1.0 - 0.7 * rim;
  vec3 r = reflect(-V, n);
  float grain = fract(52.983 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584))));
  vec3 mirror = mirrored(r, lit.bounce, grain);
  vec2 other = 0.5 - mod(floor(gl_FragCoord.xy), 2.0);  // the mean of four pixels, each with its own steps
  mirror += other.x * dFdx(mirror);
  mirror += other.y * dFdy(mirror);
  mirror *= mix(vec3(1.0), mirror / (mirror + kDull), share.x);
  colour = mix(colour, mirror, share_back);
  // The rim is a bent mirror all along: its line of light is thin, and broken.
  float broken = smoothstep(0.52, 0.66, quick.a);
  vec3 shine = highlight(n, V, lit, mix(u_shine.y, 0.06, bent));
  colour += mix(shine, min(shine, LIGHT_COLOUR * ((mix(0.09, 0.02, share.x) + 0.4 * broken) * lit.power)), bent);
  // Its waves are finer than a pixel and broad: a soft sheen where it is turned to the lamp, broken by the clouds' unrest.
  float turned = clamp(dot(n, normalize(lit.direction + V)), 0.0, 1.0);
  colour += LIGHT_COLOUR * (0.022 * lit.power * lobe(turned, 0.16) * (0.75 + 0.25 * smoothstep(0.2, 0.8, slow.g)));
  // Where it cuts through what stands in it the depth buffer's steps would show.
  // Waves turn lines of it to the lamp, here and there, most where it is turned there itself.
  float toward = smoothstep(0.10, 0.40, lobe(turned, 0.16));
  float wave = texture(u_noise, vec3(kWaves * place.xy, 0.05 * u_eye.w)).r;
  vec4 ripple = texture(u_noise, vec3(kRipples * place.xy, 0.05 * u_eye.w));
  float fleck = smoothstep(0.83, 1.02, 0.5 * (wave + ripple.g) + 0.7 * (slow.b - 0.5) + 0.12 * bent);
  colour += LIGHT_COLOUR * (kFlecks * lit.power * toward * fleck * share.x);
  vec3 stained = below.rgb * let_through(share * (kStain * smoothstep(-kDrawsBack, 0.0, gap)), v_mix.w);
  colour = mix(stained, colour, edge * smoothstep(0.0, 0.0005, gap));
  o_colour = vec4(colour, far);
}
