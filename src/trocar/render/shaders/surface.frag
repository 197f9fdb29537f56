// Living tissue, metal and pools. Variants: SHADING (0 tissue, 1 metal, 2 fluid), DETAIL (0..2), FINE, VESSELS, LOBULES,
// LINING, TWO_SIDED, STAINED (some blood or burn), FOGGY, RODS (instruments
// shade it; opaque surfaces get that afterwards, by shade.frag).
#include "common.glsl"

uniform vec4 u_material[14];
#define COLOUR_A u_material[0].rgb
#define MOTTLE u_material[0].w
#define COLOUR_B u_material[1].rgb
#define NOISE_SCALE u_material[1].w      /* tiles of the noise volume per metre */
#define COLOUR_C u_material[2].rgb
#define BUMP u_material[2].w
#define TINT u_material[3].rgb
#define WETNESS u_material[3].w
#define FIBRE_AXIS u_material[4].xyz
#define FIBRE_SQUEEZE u_material[4].w    /* 1 - 1 / stretch */
#define VESSEL_COLOUR u_material[5].rgb
#define VESSEL_AMOUNT u_material[5].w
#define WRAP u_material[6].rgb
#define VESSEL_SCALE u_material[6].w
#define GLOW u_material[7].rgb
#define GLOW_AMOUNT u_material[7].w
#define ROUGH2 u_material[8].x           /* (alpha of the tissue)^2 */
#define FILM2 u_material[8].y            /* (alpha of the film)^2 */
#define FILM_SCALE u_material[8].z
#define FILM_BUMP u_material[8].w
#define FRESNEL u_material[9].x
#define ALPHA u_material[9].y
#define RIM_ALPHA u_material[9].z
#define DENSITY u_material[9].w
#define CELL_SCALE u_material[10].x
#define CELL_DEPTH u_material[10].y
#define CELL_CONTRAST u_material[10].z
#define SCATTER u_material[10].w         /* metal: share that it scatters instead of mirroring */
#define SOIL u_material[11].x            /* metal: share of Paint's blood and burn that is there */
#define VESSELS_LEFT u_material[11].x    /* tissue: of its vessels, where Paint's tint is whole */
#define MIDDLE u_material[11].yzw        /* of the cavity that a lining encloses */

uniform mat4 u_model_view;
#if SHADING != 0
uniform mat4 u_projection;
uniform sampler2D u_before;  // the picture before, small
#endif
uniform sampler3D u_noise;
#ifdef LOBULES
uniform sampler3D u_cells;
#endif
#ifdef VESSELS
uniform sampler2D u_vessels;
in vec3 v_rest_normal;
#endif

uniform float u_blended;  // 1: alpha says how opaque, 0: how far
in vec3 v_eye;
centroid in vec3 v_normal;
centroid in vec4 v_paint;
in vec3 v_rest;
out vec4 o_colour;

#define OPENNESS v_paint.x
#define BLOOD v_paint.y
#define BURN v_paint.z

// Turns axes between octaves of noise so that their lattices do not line up.
const mat3 kTurn = mat3(0.36, 0.48, -0.8, -0.8, 0.60, 0.0, 0.48, 0.64, 0.60);

const float kSheenWaves = 290.0;  // [rad/m] of a lining's film, 2 pi over 22 mm
const float kBeadWaves = 1100.0;  // [rad/m] of the moisture that stands on it, 2 pi over 5.7 mm
const float kBeadSlope = 0.46, kBead2 = 0.035, kBeads = 90.0;  // of a bead: how steep, (its alpha)^2, how bright
const float kDullest2 = 0.008;   // (alpha of a film)^2 up to which it sparkles where it stands in wrinkles
const float kClumps = 0.014;     // [m] distance of the places where a film sparkles ...
const float kWetPlaces = 0.06;   // ... and of those where it does so most
const float kFoldWidth = 0.10, kFoldSlope = 0.35;  // of a lining's low folds: in values of the noise, and how steep
const float kLiningBall = 0.12;  // [m] radius of the ball that a lining's vessels are drawn on

#if SHADING == 1
const float kSteelLit = 1.0;  // metal near the lens is no brighter than under this much of the lamp's light
const float kLine = 1.9, kSheen = 1.15;  // of that, mirrored as a line and as a sheen about it
const float kBody = 0.16, kBrushed = 0.036;  // ... spread by wear, and by grinding
const float kMirrors = 1.1, kEdge = 0.2;  // share of its grey that it mirrors of what is around; of the lamp, at edges
#endif

vec3 along_surface(vec3 v, vec3 n) { return v - n * dot(n, v); }
vec3 to_eye(vec3 rest_direction) { return mat3(u_model_view) * rest_direction; }

// Normal distribution of GGX [Walter 07] without its 1/pi (irradiance here carries none either).
float lobe(float nh, float alpha2) {
  float d = nh * nh * (alpha2 - 1.0) + 1.0;
  return alpha2 / (d * d);
}

#ifdef VESSELS
#ifdef ARCADE
// The rest coordinates are the fold's own: along it, from its free border to its root, and a constant.
vec2 vessels_at(vec3 p, vec3 n) { return texture(u_vessels, p.xy * vec2(1.0, 2.0) * VESSEL_SCALE).rg; }
#elif defined(LINING)
// On a ball around the cavity's middle, by arc length from the pole: no seam but opposite to it, where the endoscope is.
vec2 vessels_at(vec3 p, vec3 n) {
  vec3 d = normalize(p - MIDDLE);
  float along = clamp(dot(d, FIBRE_AXIS), -0.999, 0.999);
  vec3 off = d - along * FIBRE_AXIS;
  vec3 side = normalize(vec3(FIBRE_AXIS.y, -FIBRE_AXIS.x, 0.001)), up = cross(FIBRE_AXIS, side);
  vec2 at = vec2(dot(off, side), dot(off, up)) * (acos(along) * inversesqrt(dot(off, off)) * kLiningBall);
  at = at * VESSEL_SCALE + 0.37;
  // A wall is mostly seen aslant, so a pixel covers a long strip of the picture: two looks along it, each one level finer,
  // or trunks would be sheared by the texels of a level that is too coarse across the strip.
  vec2 step_x = dFdx(at), step_y = dFdy(at), strip = 0.25 * (dot(step_x, step_x) > dot(step_y, step_y) ? step_x : step_y);
  vec2 seen = texture(u_vessels, at + strip, -1.2).rg + texture(u_vessels, at - strip, -1.2).rg;
  return (0.5 * smoothstep(0.2, 0.55, abs(dot(d, n)))) * seen;  // not smeared along a steep place
}
#elif defined(LOBULES)
// Seen from where one looks at it, as lobules turn their faces everywhere; what turns far away has none.
vec2 vessels_at(vec3 p, vec3 n) {
  const vec3 towards = vec3(0.0, -0.5, 0.866);
  return texture(u_vessels, vec2(p.x, dot(p, cross(vec3(1.0, 0.0, 0.0), towards))) * VESSEL_SCALE).rg *
         smoothstep(0.1, 0.35, abs(dot(n, towards)));
}
#else
// Trees are drawn in the planes that the rest surface faces. Beside a place where it turns from one to the next both are
// seen: each fades out only where it would be smeared, so that a trunk does not end where the other plane begins.
vec2 vessels_at(vec3 p, vec3 n) {
  vec3 at = p * VESSEL_SCALE, step_x = dFdx(at), step_y = dFdy(at), facing = smoothstep(0.45, 0.66, abs(n));
  vec2 off_zx = VESSEL_SCALE * vec2(0.71, 0.53), off_yz = VESSEL_SCALE * vec2(0.37, 0.11);
  vec2 seen = vec2(0.0);
  if (facing.x > 0.0) seen = facing.x * textureGrad(u_vessels, at.yz + off_yz, step_x.yz, step_y.yz).rg;
  if (facing.y > 0.0) seen = max(seen, facing.y * textureGrad(u_vessels, at.zx + off_zx, step_x.zx, step_y.zx).rg);
  if (facing.z > 0.0) seen = max(seen, facing.z * textureGrad(u_vessels, at.xy, step_x.xy, step_y.xy).rg);
  return seen;
}
#endif
#endif

#ifdef RODS
#include "shade.glsl"
uniform vec4 u_rods[32];  // two rows a rod
uniform int u_rod_count;
#endif

#if SHADING != 0
// What a mirror at v_eye shows in direction r: the picture before where the ray ends up after `reach` metres, the red
// glow of the walls where that is outside.
vec3 mirrored(vec3 r, float reach, float bounce) {
  vec4 clip = u_projection * vec4(v_eye + reach * r, 1.0);
  vec2 at = clip.xy / max(clip.w, 0.001);
  float inside = MIRRORS * step(0.0, clip.w) * clamp(4.0 - 4.5 * max(abs(at.x), abs(at.y)), 0.0, 1.0);
  return mix(BOUNCE * bounce, min(texture(u_before, 0.5 + 0.5 * at).rgb, vec3(4.0)), inside);
}
#endif

void main() {
  vec3 V = normalize(-v_eye);
  vec3 N = normalize(v_normal);
#ifdef TWO_SIDED
  if (dot(N, V) < 0.0) N = -N;
#endif
  Lit lit = light_at(v_eye);

  // Patterns in rest space.
  vec3 p = v_rest - FIBRE_AXIS * (dot(FIBRE_AXIS, v_rest) * FIBRE_SQUEEZE);
  vec4 broad = texture(u_noise, p * NOISE_SCALE);
  vec3 slope = broad.rgb * 2.0 - 1.0;
#if SHADING != 1 && DETAIL >= 1
#ifdef LINING
  vec4 ripple = texture(u_noise, kTurn * (p * vec3(0.7, 1.0, 1.0)).zxy * FILM_SCALE);  // muscle runs across
#else
  vec4 ripple = texture(u_noise, kTurn * p.zxy * FILM_SCALE);
#endif
#endif
#if defined(FINE)
  vec4 fine = texture(u_noise, kTurn * p * (NOISE_SCALE * 5.0));
#elif SHADING != 1 && DETAIL >= 1
  vec4 fine = ripple.brga;  // the film's noise is of about that size: one fetch serves both
#else
  vec4 fine = broad.gbra;
#endif
#ifndef LINING  // smooth: what is fine there lies below it
  slope += fine.rgb * 2.0 - 1.0;
#endif

#if SHADING == 1
  // Steel, titanium, and what insulates them: bare metal mirrors the scene, paint and ceramic scatter the lamp's light,
  // and towards the rim both mirror what is behind them, so that no outline is a row of dark dots.
  vec3 n = normalize(N + BUMP * along_surface(to_eye(slope), N));
  // Grinding runs along the axis, so a highlight spreads along it.
  vec3 H = normalize(lit.direction + V);
  vec3 axis = normalize(to_eye(FIBRE_AXIS));
  H = normalize(H - axis * (0.85 * step(0.01, FIBRE_SQUEEZE) * dot(H, axis)));
  float nh = clamp(dot(n, H), 0.0, 1.0), nv = clamp(dot(n, V), 0.0, 1.0), nl = clamp(dot(n, lit.direction), 0.0, 1.0);
  // Edges of a pixel or less are as rough as their normals differ [Kaplanyan 16].
  vec3 turn_x = dFdx(N), turn_y = dFdy(N);
  float turns = dot(turn_x, turn_x) + dot(turn_y, turn_y);
  float alpha2 = ROUGH2 + min(0.3 * turns, 0.2);
  float blurred = clamp(2.0 * sqrt(turns), 0.0, 0.85);
  nv = mix(nv, 0.65, blurred);
  nl = mix(nl, 0.65, blurred);
  vec3 grey = mix(COLOUR_A, COLOUR_B, MOTTLE * fine.a);
  grey = mix(grey, TINT, v_paint.w);
  // Blood lies where the work is done, in crevices first: a film that instruments and tissue have wiped along it, through
  // which metal shines where it is thin; it dries brown where it runs out. Char in flakes.
#if DETAIL >= 1
  vec4 moisture = texture(u_noise, kTurn * (v_rest - FIBRE_AXIS * (0.3 * dot(FIBRE_AXIS, v_rest))) * 70.0);
  float ragged = 0.45 * moisture.a + 0.25 * fine.a + 0.3 * broad.a;
#else
  float ragged = 0.6 * fine.a + 0.4 * broad.a;
#endif
  float smeared = 0.62 * BLOOD * SOIL;  // most of it has been wiped off
  float film = clamp((smeared - 0.9 * (ragged - 0.2) * (1.0 - smeared)) * 2.0, 0.0, 1.0) * step(0.01, smeared);
  film *= 1.0 - 0.9 * blurred;  // edges are wiped bright
  vec3 through = exp(-film * vec3(2.2, 5.2, 4.8));
  float clotted = smoothstep(0.3, 0.9, film);
  float dried = smoothstep(0.0, 0.12, film) * (1.0 - smoothstep(0.14, 0.45, film));
  float blood = smoothstep(0.1, 0.75, film);  // how little of a mirror it leaves
  grey = mix(grey * through, vec3(0.080, 0.0095, 0.0080), 0.9 * clotted);
  grey = mix(grey, vec3(0.090, 0.032, 0.020), 0.45 * dried);
  float char_ = smoothstep(0.3, 0.6, BURN * SOIL * (0.5 + ragged));
  float heated = smoothstep(0.1, 0.45, BURN * SOIL * (0.4 + 1.2 * ragged));  // what current has boiled on it: tan, brown
  grey = mix(grey, grey * vec3(0.55, 0.34, 0.2) + vec3(0.02, 0.01, 0.004), 0.85 * heated);
  grey = mix(grey, vec3(0.016, 0.013, 0.012), 0.9 * char_);
  float plain = max(SCATTER, max(0.8 * blood, char_));  // no longer a mirror
  float bare = 1.0 - max(blood, char_);
  float ao = OPENNESS;
  float rim = min(1.0 - nv, 0.8), schlick = rim * rim * rim * rim;  // no further: the last pixel would be a dot
  // Worn steel spreads what it mirrors, and mirrors more of it than glass does: dark as that it would look like smoked
  // glass, and so it would with what is right behind it in all its colours.
  vec3 mirror = mix(kMirrors * grey, vec3(0.03), plain);
  mirror += (vec3(0.6) - mirror) * (0.45 * schlick * (0.15 + 0.85 * bare));
  // Scratches break a highlight up along the axis, moisture in any direction: only where that stands in beads it clips.
  float broken = (0.15 + 1.2 * smoothstep(0.35, 0.7, broad.a)) * (0.35 + 0.8 * smoothstep(0.42, 0.64, fine.r));
  broken = mix(0.5, broken, clamp(20.0 * BUMP, 0.0, 1.0));  // what is polished has none
#if DETAIL >= 1
  broken *= 0.4 + 0.8 * smoothstep(0.36, 0.64, moisture.a);
#endif
  // A mirror's picture of the lamp is as bright from near as from far; only what is scattered falls off. So it is one
  // thin line, which clips where it is whole, in a sheen that never does.
  lit.bounce *= 1.25 * inversesqrt(1.0 + lit.bounce * lit.bounce);
  float lamp = lit.power * inversesqrt(1.0 + lit.power * lit.power / (kSteelLit * kSteelLit));
  float line2 = 0.10 * ROUGH2 + min(0.1 * turns, 0.05);
  float line = lobe(nh, line2) * line2 * min(1.0, 0.25 * ROUGH2 / line2) * smoothstep(0.25, 0.75, broken);
  float sheen = lobe(nh, alpha2) * alpha2 * broken * (1.0 - 0.8 * blurred);
  // Worn edges turn through the way to the lens, wherever they lie: a bright rim, which tells metal from glass.
  float edge = smoothstep(0.06, 0.4, blurred) * smoothstep(0.05, 0.6, nl) * (0.3 + 0.7 * smoothstep(0.25, 0.6, broken));
  vec3 gloss = mix(vec3(1.0), vec3(0.5), plain) * (kLine * line * bare * bare) + mix(grey, vec3(0.12), plain) * (kSheen * sheen);
  gloss += vec3(kEdge * edge * bare * (1.0 - SCATTER));
  gloss *= mix(through, vec3(1.0), 0.1);
  vec3 around = mirrored(reflect(-V, n), 0.04, mix(0.6, 3.0, rim) * lit.bounce);  // the lens itself is dark
  around = mix(vec3((0.1 + 0.3 * smoothstep(-0.2, 0.8, reflect(-V, n).y)) * lit.bounce), around, INVERSE_SQUARE);  // a room
  vec3 from_below = around * clamp(0.9 - 0.6 * n.y - 1.2 * nv, 0.0, 1.0);
  around = mix(around, vec3(dot(around, vec3(0.3, 0.45, 0.25))), 0.45 * bare);
  // The lamp straight on, which is strong near the lens, what comes from all around, and tissue's pink from below.
  vec3 even = LIGHT_COLOUR * lamp * (mix(kBody, mix(0.13, 0.42, smoothstep(0.5, 1.0, SCATTER)), plain) * nl * nl + mix(kBrushed, 0.012, plain) * lobe(nh, mix(0.2, 0.35, plain)));
  even += (BOUNCE * (mix(0.3, 1.0, plain) + 3.0 * rim) + vec3(mix(0.02, 0.21, plain) + AMBIENT)) * lit.bounce + from_below;
  vec3 colour = (grey * even + LIGHT_COLOUR * lamp * gloss + around * mirror) * ao;
#ifdef FOGGY
  colour = through_air(colour, v_eye);
#endif
  o_colour = vec4(colour * mix(1.0, ALPHA, u_blended), mix(length(v_eye), ALPHA, u_blended));
#else
  vec3 albedo = mix(COLOUR_A, COLOUR_B, MOTTLE * smoothstep(0.2, 0.8, broad.a));
  albedo = mix(albedo, COLOUR_C, MOTTLE * smoothstep(0.35, 1.0, fine.a));
  float tint = v_paint.w;
#if SHADING == 0
  albedo = mix(albedo, TINT, tint);
#endif
#ifdef LINING
  // Yellow here, violet there, paler and redder; below it fibres and fat of a millimetre or two.
  albedo *= 1.0 + vec3(0.02, 0.04, -0.10) * (broad.g - 0.5) + vec3(0.03, -0.03, 0.02) * (broad.r - 0.5);
  // Over a hand's breadth it goes from mauve to brown-orange, where fat lies below it, and from pale to red.
  float fat = smoothstep(-0.5, 1.0, sin(dot(v_rest, vec3(30.0, 23.0, 16.0)) + 1.3 * sin(dot(v_rest, vec3(-20.0, 28.0, 35.0)))));
  float red = sin(dot(v_rest, vec3(-25.0, 14.0, 31.0)) + 1.1 * sin(dot(v_rest, vec3(27.0, 31.0, -12.0))));
  albedo *= 1.0 + vec3(0.02, 0.03, -0.36) * (fat - 0.45) - vec3(0.03, 0.11, 0.06) * red;
#if DETAIL >= 1
  albedo *= 1.0 + 0.3 * (vec3(0.55, 1.25, 1.1) * (ripple.a - 0.5) + vec3(0.35, 0.6, 0.55) * (broad.b - 0.5)) + vec3(0.0, 0.05, -0.08) * (ripple.g - 0.5);
#endif
#else
  float hues = min(6.0 * length(COLOUR_B - COLOUR_C), 1.0);  // towards yellow here, mauve there: not what is of one colour
  albedo *= 1.0 + vec3(-0.01, 0.10, -0.30) * (hues * (broad.g - 0.5));
#endif
  vec3 relief = BUMP * slope;
#if defined(LINING) && DETAIL >= 1
  // Low, winding folds in which it lies here and there.
  float from_crest = (broad.a + 0.05 * (fine.b - 0.5) - 0.5) / kFoldWidth;
  float fold = exp(-from_crest * from_crest) * smoothstep(0.32, 0.52, broad.g);
  relief -= (2.0 * from_crest * fold * kFoldSlope) * (broad.rgb * 2.0 - 1.0);
#endif

#ifdef LOBULES
  vec4 cell = texture(u_cells, p * CELL_SCALE + slope * 0.008 + (broad.rgb - 0.5) * 0.05);  // of unequal sizes
  float apart = 0.12 + 0.88 * smoothstep(0.35, 0.65, broad.b);  // lobules run together here and there
  float seam = 1.0 - smoothstep(0.0, 0.42, cell.a);
  seam *= seam * apart;
  relief += (CELL_DEPTH * 2.6 * (0.3 + 0.7 * apart)) * (cell.rgb * 2.0 - 1.0);
  albedo *= 1.0 - CELL_CONTRAST * seam * vec3(0.22, 0.55, 0.60);
#else
  float seam = 0.0;
#endif

#ifdef VESSELS
  vec2 vessel = vessels_at(v_rest, v_rest_normal) * (VESSEL_AMOUNT * mix(1.0, VESSELS_LEFT, tint));
  albedo = mix(albedo, albedo * vec3(0.62, 0.5, 0.72), vessel.g);
  albedo = mix(albedo, VESSEL_COLOUR, vessel.r * 0.85);
#endif

#ifdef STAINED
  // Heat: a blanched margin that fades, then a dry crust, tan, browner towards the middle, with black specks and cracks.
  // What has shrunk lies in folds that run towards the middle.
  float crust = 0.0, glassy = 0.0;
  vec3 rest_x = dFdx(v_rest), rest_y = dFdy(v_rest);
  vec2 burn_slope = vec2(dFdx(BURN), dFdy(BURN));
  if (BURN > 0.004) {
    float xx = dot(rest_x, rest_x), xy = dot(rest_x, rest_y), yy = dot(rest_y, rest_y);
    vec3 inwards = rest_x * (yy * burn_slope.x - xy * burn_slope.y) + rest_y * (xx * burn_slope.y - xy * burn_slope.x);
    inwards /= max(length(inwards), 1.0e-20);
    vec4 grain = textureLod(u_noise, kTurn * v_rest * 260.0, 0.0), patchy = textureLod(u_noise, v_rest.yzx * 75.0, 0.0);
    vec4 folds = textureLod(u_noise, kTurn * (v_rest + 0.0005 * inwards) * 200.0, 0.0) +
                 textureLod(u_noise, kTurn * v_rest * 200.0, 0.0) +
                 textureLod(u_noise, kTurn * (v_rest - 0.0005 * inwards) * 200.0, 0.0);
    folds *= 1.0 / 3.0;
    float at = 1.1 * BURN + 0.26 * (patchy.a - 0.5) + 0.22 * (folds.a - 0.5);
    float pale = smoothstep(0.0, 0.36, BURN + 0.10 * (patchy.a - 0.5) * smoothstep(0.0, 0.2, BURN));
    crust = smoothstep(0.30, 0.68, at);
    float burnt = smoothstep(0.50, 1.05, at + 0.16 * (grain.g - 0.5));
    float crack = burnt * (1.0 - smoothstep(0.01, 0.05, abs(patchy.r - 0.5 + 0.10 * (folds.g - 0.5)))) * smoothstep(0.4, 0.55, folds.r);
    glassy = crust * smoothstep(0.56, 0.66, grain.b) * smoothstep(0.45, 0.6, folds.b);
    albedo = mix(albedo, vec3(0.70, 0.53, 0.46) * (0.86 + 0.28 * folds.a), 0.86 * pale);
    vec3 baked = mix(vec3(0.45, 0.265, 0.165), vec3(0.165, 0.066, 0.036), smoothstep(0.10, 0.75, burnt + 0.6 * (folds.a - 0.5)));
    float speck = smoothstep(0.0, 0.10, 0.62 * grain.a + 0.38 * patchy.g + 0.20 * (burnt - 1.0) - 0.43);
    baked = mix(baked * (0.75 + 0.5 * grain.r), vec3(0.0145, 0.0070, 0.0052), speck * smoothstep(0.25, 0.6, burnt));
    albedo = mix(albedo, baked, 0.94 * crust);
    albedo *= 1.0 - 0.55 * crack;
    vec3 puckered = folds.rgb * 2.0 - 1.0;
    relief += (puckered - inwards * dot(puckered, inwards)) * (0.5 * pale + 0.9 * crust);
    relief += crust * ((patchy.rgb * 2.0 - 1.0) * 0.55 + (grain.rgb * 2.0 - 1.0) * 0.45);
  }

  // Blood lies in a film with a soft, ragged edge: thin it stains like a filter, thick it hides what is below; most of
  // all is raw tissue, dark and granular.
  float ragged = 0.55 * fine.a + 0.45 * broad.g;
  float cover = smoothstep(0.0, 0.24, 1.2 * BLOOD - 0.5 * ragged * (1.0 - BLOOD)) * smoothstep(0.0, 0.03, BLOOD);
  float blood = clamp(cover * (0.16 + 0.84 * BLOOD) * (0.8 + 0.4 * broad.a), 0.0, 1.0);
  albedo *= exp(-blood * vec3(2.1, 5.4, 4.8));
  // Cut faces: maroon, granular; where blood stands on them (tint) dark and smooth.
  float raw = smoothstep(0.5, 0.85, blood), standing = 0.0, beaded = 1.0;
  if (raw > 0.0) {
    vec4 grain = textureGrad(u_noise, kTurn * v_rest * 330.0, rest_x * 330.0, rest_y * 330.0);
    standing = raw * smoothstep(0.3, 0.7, 0.3 + 0.8 * tint + 0.5 * (broad.a - 0.5) + 0.3 * (fine.a - 0.5));
    float granular = 0.6 + 0.5 * smoothstep(0.3, 0.7, fine.a) + 0.8 * (grain.a - 0.5);
    vec3 flesh = mix(vec3(0.100, 0.0215, 0.0185) * granular, vec3(0.046, 0.0021, 0.0024), 0.85 * standing);
    albedo = mix(albedo, flesh, raw);
    beaded = mix(1.0, 0.9 * smoothstep(0.46, 0.60, 0.4 * grain.r + 0.6 * fine.r), raw);  // wet on its grains, not between
    relief += ((fine.rgb * 2.0 - 1.0) * 0.25 + (grain.rgb * 2.0 - 1.0) * 0.35) * (raw - 0.5 * standing);
  }
#endif

  vec3 n = normalize(N + along_surface(to_eye(relief), N));
  float nl = dot(n, lit.direction);
  float nv = clamp(dot(N, V), 0.0, 1.0);

  // Light wraps past the terminator, red the furthest; crevices keep red longest.
  vec3 wrapped = clamp((vec3(nl) + WRAP) / (1.0 + WRAP), 0.0, 1.0);
  float openness = max(OPENNESS, 0.65 * u_blended);  // a fold that runs out is no crevice
  float open = clamp(mix(1.0, openness, CREVICES) * (1.0 - min(0.35, 1.6 * CELL_CONTRAST) * seam), 0.02, 1.0);
  vec3 ao = open * mix(vec3(sqrt(open)), vec3(1.0), vec3(1.0, 0.0, 0.05));
  vec3 direct = LIGHT_COLOUR * lit.power * wrapped * mix(ao, vec3(1.0), 0.35);
  vec3 indirect = (BOUNCE + vec3(AMBIENT)) * (lit.bounce * ao);
#ifdef RODS
  vec2 shade = vec2(1.0);
  for (int i = 0; i < u_rod_count; ++i)
    shade *= shade_of_rod(v_eye, kShadowSpread * LIGHT_POSITION, LIGHT_RING, u_rods[2 * i], u_rods[2 * i + 1]);
  direct *= shaded_by(shade);
  indirect *= shade.y;
  lit.power *= mix(1.0, shade.x, 0.8);
#endif
  float rim = (1.0 - nv) * (1.0 - nv);
  vec3 thin = GLOW * (GLOW_AMOUNT * lit.power * rim * open);
  vec3 colour = albedo * (direct + indirect) + thin * albedo.r;

  // The film on top has its own ripples; it is broken where the tissue is dry. Most of it is drawn out smooth and thin, a
  // soft sheen as dull as what it lies on; in clumps it stands in wrinkles and bubbles, and only there it sparkles.
#if DETAIL >= 1
  vec3 q = v_rest * (6.2832 / kClumps);
  float clump = 0.5 + 0.2 * (sin(q.x + 1.3 * sin(0.71 * q.y)) * cos(0.83 * q.y + 0.9 * sin(0.64 * q.z)) +
                             sin(0.77 * q.z + 1.1 * sin(0.59 * q.x) + 0.3 * q.y)) + 0.5 * (broad.b - 0.5);
  float wrinkled = smoothstep(-0.1, 0.1, clump + 0.4 * WETNESS - 0.8) * INVERSE_SQUARE;  // none in a room
  // Moisture gathers: here a palm of tissue is wet, there one is nearly dry.
  q = v_rest * (6.2832 / kWetPlaces);
  float wetter = smoothstep(-0.5, 0.5, sin(q.x + 1.2 * sin(0.8 * q.y + 1.0)) * cos(0.9 * q.z + 0.7 * sin(0.7 * q.x)) + 0.4 * sin(1.3 * q.y + 0.6 * q.z));
#ifdef STAINED
  wrinkled = max(wrinkled, crust);
#endif
  vec3 film_slope = (ripple.rgb * 2.0 - 1.0 + 0.35 * (fine.bra * 2.0 - 1.0)) * (FILM_BUMP * mix(0.2, 1.3, wrinkled));
  float wet_noise = 0.5 * (ripple.a + broad.b);
#else
  const float wrinkled = 0.4, wetter = 0.75;
  vec3 film_slope = slope * (0.5 * FILM_BUMP);
  float wet_noise = broad.b;
#endif
#if defined(LINING) && DETAIL >= 1
  // A wall has one broad, soft sheen; it sparkles in beads of moisture, which stand on crests of its folds, on what
  // stands out and in patches elsewhere. Both are waves, not a noise of voxels: near the lens those would be seen, with
  // corners.
  vec3 wide = v_rest * kSheenWaves;
  film_slope = FILM_BUMP * sin(wide + 1.4 * sin(0.63 * wide.yzx + 2.0));
  float crest = smoothstep(0.5, 0.85, fold + 1.2 * (fine.b - 0.5)) * (0.35 + 0.65 * wrinkled);
  crest = max(crest, (0.4 + 0.5 * smoothstep(0.61, 0.7, broad.a + 0.3 * (fine.b - 0.5))) * wrinkled);
  crest = max(crest, 0.5 * smoothstep(0.53, 0.8, broad.b));
  crest = min(crest * mix(0.14, 1.25, wetter), 0.86);  // at 1 it would be all white
  vec3 bead = kTurn * (v_rest * vec3(1.0, 1.0, 0.6)) * kBeadWaves;  // drawn out downwards, as it runs
  float in_pixel = length(fwidth(bead));  // [rad]
  vec3 bead_slope = vec3(0.0);
  if (crest > 0.0) {
    bead += sin(0.57 * bead.zxy + 3.0 * wide);
    vec3 turned = sin(bead + 0.7 * sin(1.31 * bead.yzx));
    bead_slope = (kBeadSlope * smoothstep(3.5, 1.2, in_pixel)) * (turned + 0.45 * sin(2.3 * bead.zxy + 1.6 * turned));
  }
#elif defined(LINING)
  film_slope = FILM_BUMP * (broad.rgb * 2.0 - 1.0);
#endif
  float wet = smoothstep(1.0 - WETNESS - 0.2, 1.0 - WETNESS + 0.2, wet_noise);
#ifdef STAINED
  film_slope *= 1.0 - 0.5 * raw;
  wet = max(mix(wet, glassy, crust), (0.75 - 0.35 * raw) * smoothstep(0.1, 0.4, blood));
#endif
  // What mirrors the lamp is broken again by the film's thickness: flecks in clumps, no rings around its bumps.
#if DETAIL >= 1
  float flecks = smoothstep(0.34, 0.66, fine.g + 0.5 * (broad.b - 0.5));
  flecks = mix(0.45, flecks, 0.15 + 0.85 * INVERSE_SQUARE);
#elif defined(LINING)
  const float flecks = 0.17;
#else
  const float flecks = 0.45;
#endif
  wet *= 0.6 + 0.3 * flecks;
  wet = mix(0.45, wet, INVERSE_SQUARE);
  film_slope *= 0.1 + 0.9 * INVERSE_SQUARE;  // a room's lamps are large: they do not sparkle
  vec3 m = normalize(N + along_surface(to_eye(film_slope + relief * 0.6), N));
  vec3 H = normalize(lit.direction + V);
  float facing = clamp(nl * 4.0, 0.0, 1.0) * open;
#if defined(LINING) && DETAIL >= 1
  const float sparkle = 1.1;
  float film2 = 4.0 * FILM2;
#else
  float sparkle = mix(1.1, 7.0, wrinkled * min(1.0, kDullest2 / FILM2)) * mix(0.3, 1.15, wetter), film2 = FILM2 * mix(4.0, 1.8, wrinkled);
#endif
#if DETAIL >= 1
  // Ripples of a pixel or less are as rough as their normals differ [Kaplanyan 16].
  vec3 turn_x = dFdx(m), turn_y = dFdy(m);
  film2 += min(0.12 * (dot(turn_x, turn_x) + dot(turn_y, turn_y)), 0.06);
#else
  film2 += 0.008;
#endif
#ifdef STAINED
  film2 *= 1.0 - 0.5 * standing;
#endif
  film2 += 0.03 * (1.0 - INVERSE_SQUARE);
  float mh = clamp(dot(m, H), 0.0, 1.0), nh = clamp(dot(n, H), 0.0, 1.0);
  float glint = lobe(mh, film2);
#if defined(LINING) && DETAIL >= 1
  vec3 b = normalize(m + along_surface(to_eye(bead_slope), N));
  float mirrors = lobe(clamp(dot(b, H), 0.0, 1.0), kBead2) * kBead2;  // 1: right at the lens
  mirrors = smoothstep(0.90 - 0.9 * crest, 1.04 - 0.7 * crest, mirrors) * smoothstep(0.15, 0.4, crest);  // no lone pixel
  mirrors *= smoothstep(0.34, 0.46, 0.6 * ripple.a + 0.4 * broad.r);  // broken, else it would be hooks and commas
  glint = 0.35 * glint + kBeads * mirrors;
#endif
  float gloss = 0.42 * FRESNEL * (wet * (0.4 + 1.3 * flecks) * sparkle * glint + (0.35 + 0.65 * wet) * lobe(nh, ROUGH2)) * facing * lit.power;
  float grazing = FRESNEL + (1.0 - FRESNEL) * rim * rim * (1.0 - nv);
#if SHADING == 2
  vec3 around = 0.7 * mirrored(reflect(-V, m), 0.03, lit.bounce);
#else
  vec3 around = (BOUNCE * 1.5 + vec3(AMBIENT) * 0.5) * lit.bounce;
#endif
#ifdef STAINED
  gloss *= beaded * (1.0 + 1.2 * glassy + 2.5 * raw);  // charred protein is as smooth as glass here and there
#endif
  vec3 shine = LIGHT_COLOUR * gloss + around * (grazing * wet * open);

#if SHADING == 2
  float opaque = 1.0 - exp(-DENSITY * (0.25 + 4.0 * tint));
  float alpha = mix(opaque, 1.0, 0.6 * rim);
#else
  // A fold is thin as a veil in places; vessels and the fat in it (tint) hide what is behind.
  float sheer = mix(ALPHA, RIM_ALPHA, rim) * (0.55 + 0.9 * smoothstep(0.25, 0.8, broad.a));
  sheer = max(sheer, 0.92 * tint);
  float ends = smoothstep(0.02, 0.4, OPENNESS);  // a fold may run out into nothing
#ifdef VESSELS
  sheer = max(sheer, max(0.85 * vessel.r, 0.6 * vessel.g));
#endif
  float alpha = mix(1.0, min(sheer, 1.0) * ends, u_blended);
  shine *= mix(1.0, ends, u_blended);
#ifdef STAINED
  alpha = max(alpha, smoothstep(0.0, 0.5, max(blood, BURN)) * step(0.001, ALPHA));
#endif
#endif
#ifdef FOGGY
  colour = through_air(colour, v_eye);
  shine *= exp(-FOG * length(v_eye));
#endif
  o_colour = vec4(colour * alpha + shine, mix(length(v_eye), alpha, u_blended));
#endif
}
