// The surface of drops and films over the scene. Where the field of the drops passes a threshold there is liquid; its
// height follows from how far it does. Variants: DETAIL.
#include "common.glsl"
#include "liquid.glsl"
uniform sampler2D u_field, u_thickness, u_film;  // sums; thickness in mm
uniform vec2 u_texel;                            // of them
uniform float u_part;                            // pixels of the scene to one of them
in vec2 v_uv;
out vec4 o_colour;

/// How far inside a drop, 0 at its outline, 1 in the middle of a lone one.
float inside_of(float field) { return 1.0 - 2.89 * (1.0 - sqrt(sqrt(field))); }
float inside(vec2 uv) { return inside_of(texture(u_field, uv).w); }

/// Films run: where a place squeezed along the fall is noisy, all of a column lies lower or higher, so that a film's
/// lower edge is drawn out into fingers, and what ran apart merges.
/// @param fall  down along the surface, eye space, shorter where it is level
/// @param column  noise drawn out along the fall
vec2 run_off(vec3 place, vec3 fall, float pixel, out vec4 column) {
  vec3 squeezed = place - u_down * (0.88 * dot(u_down, place));
  column = texture(u_noise, squeezed * 36.0);
  return fall.xy * ((0.0040 * (column.a - 0.5) + 0.0010 * (column.g - 0.5)) / pixel) * u_size.zw;
}

const float kNone = 1.0e-7;        // [m] of liquid that nobody sees
const float kLeast = 2.0e-6;       // [m] a film draws back from where there is less
const float kAside = 0.0009;       // [m] gaps narrower than that close
const float kLevel = 3.0e-5;       // [m] at which it levels
const float kThroughTissue = 4.5;  // light that tissue scatters crosses the film on it more than twice

const float kLost = 1.0e4;         // [1/m] of red that a film's cells turn aside into tissue, where it ends; our choice
const float kPatch = 0.18;         // of a film's thickness: where a column has drained
const float kSheen = 0.007;        // of the lamp, where a film faces it; our choice, from frames of films

const float kRim = 1.6;            // more of it at its border, where surface tension holds it
const float kStands = 60.0;        // a film's slopes over those of what colours it; our choice, so that it glints
const float kFurrow = 0.0016;      // [m] how far aside the ground's relief is looked up
const float kFills = 1100.0;       // [1/m] more of a film where the ground is lower than around
const vec2 kBeside = vec2(0.60, 0.35);  // where the lamp is beside the lens, for what is thin and round; our choice
const float kRounded = 1.0e-3;     // of a distance, to which the picture rounds it
const float kStep = 0.0015;        // [m] what differs by more is another thing's outline

vec3 middle_of(vec3 a, vec3 b, vec3 c, vec3 d) {
  return 0.5 * (a + b + c + d - max(max(a, b), max(c, d)) - min(min(a, b), min(c, d)));
}

/// How much lower than around the ground is [m], and its slopes to the right and up. Not across outlines.
/// @param around_it  its colour without what is thin on it, vessels and glints
vec3 relief(float here, float pixel, out vec3 around_it) {
  vec2 aside = kFurrow / pixel * u_size.zw;
  vec2 x = vec2(aside.x, 0.0), y = vec2(0.0, aside.y);
  vec4 right = texture(u_bed, v_uv + x), left = texture(u_bed, v_uv - x), up = texture(u_bed, v_uv + y),
       low = texture(u_bed, v_uv - y);
  vec4 around = vec4(right.a, left.a, up.a, low.a);
  around_it = middle_of(right.rgb, left.rgb, up.rgb, low.rgb);
  vec2 lower = vec2(here) - 0.5 * (around.xz + around.yw);
  vec2 one = step(abs(lower), vec2(kStep)), slope = (around.xz - around.yw) * (0.5 / kFurrow) * one;
  lower = sign(lower) * max(abs(lower) - kRounded * here, 0.0) * one;
  return vec3(0.5 * (lower.x + lower.y), clamp(slope, -2.0, 2.0));
}

float film_at(vec2 uv) { return dot(texture(u_film, uv).rgb, vec3(1.0e-3)); }

void main() {
  vec4 field = texture(u_field, v_uv);
  vec4 bed = texelFetch(u_bed, ivec2(gl_FragCoord.xy), 0);
  vec3 way = normalize(vec3((2.0 * v_uv - 1.0) * u_tan.xy + vec2(u_tan.z, 0.0), -1.0)), V = -way;
  float pixel = -way.z * bed.a * 2.0 * u_tan.y * u_size.w;  // [m]

  vec4 marked = texture(u_thickness, v_uv);
  float there = dot(marked.rgb, vec3(1.0));
  float flying = smoothstep(0.9, 1.6, marked.w / max(there, 1.0e-6));
  // Outlines on tissue wander as it does.
  vec3 place = to_world(way * (flying > 0.5 ? field.z / max(field.w, 1.0e-6) : bed.a));
  vec4 fine = texture(u_noise, place * 38.0);
  vec2 wander = (fine.rg - 0.5) * (0.0008 / pixel) * u_size.zw;
  vec2 uv = flying > 0.5 ? v_uv : v_uv + wander;
  field = texture(u_field, uv);
  vec4 thick = texture(u_thickness, uv) * 1.0e-3;
  float all = max(dot(thick.rgb, vec3(1.0)), 1.0e-9), mark = thick.w / all;
  if (flying < 0.5 && mark > 1.6) thick = vec4(0.0);  // what flies past is no outline on tissue
  float far = field.z / max(field.w, 1.0e-6);
  vec3 eye = way * far;
  Lit lit = light_at(eye);

  vec2 nb = field.xy / max(field.w, 1.0e-6);
  vec3 base = vec3(nb, sqrt(max(1.0 - dot(nb, nb), 0.01)));

  // Films.
  vec3 down = vec3(dot(u_down, u_right), dot(u_down, u_up), dot(u_down, u_back));
  vec3 fall = down - base * dot(down, base);
  float streak = 0.5;
#if DETAIL >= 1
  vec4 column;
  vec2 film_uv = uv + (1.0 - flying) * run_off(place, fall, pixel, column);
  streak = mix(column.a, column.b, 0.35);
#else
  vec2 film_uv = uv;
  streak = 0.25 + 0.5 * fine.a;
#endif
  vec4 film = texture(u_film, film_uv) * 1.0e-3;
  float stain = dot(film.rgb, vec3(1.0));
  vec3 film_rise = vec3(0.0), ground = vec3(0.0), around_it = bed.rgb;
  // What covers the place in between is nearer to the eye.
  if (flying < 0.5 && stain > kNone && bed.a > far - 0.0015 - 6.0 * pixel) {
    // Surface tension draws it together: a smooth border where there is enough of it, and a rim that stands up there.
    // Where a column carries little it has drained away.
    float least = kLeast * (0.8 + 0.9 * smoothstep(0.25, 0.70, 1.0 - streak)), soft = 0.35 * least, lower = stain;
#if DETAIL >= 1
    vec2 aside = kAside / pixel * u_size.zw;
    vec2 grows = vec2(film_at(film_uv + vec2(aside.x, 0.0)), film_at(film_uv + vec2(0.0, aside.y))) - stain;
    soft = clamp(2.0 * length(grows) * pixel / kAside, 0.4 * least, 2.0 * least);
    lower = film_at(film_uv + fall.xy * 1.6 * aside);
    // Narrow gaps have closed.
    float closed = 0.25 * (4.0 * stain + grows.x + grows.y + lower - stain);
    film *= clamp(closed / stain, 0.6, 8.0);
    stain = dot(film.rgb, vec3(1.0));
#endif
    float over = (stain - least) / least, rim = exp(-max(over, 0.0) * 1.4);
    float wet = smoothstep(-soft, soft, stain - least);
    // It is thickest where it stops, at its lower edge, and has drained away from its upper one.
    float edge = clamp(1.0 - lower / stain, -1.0, 1.0);
    float drained = edge > 0.0 ? 1.0 + 0.8 * edge * edge : 1.0 + 0.75 * edge;
    // What several drops brought runs together: a film is no map of where they fell.
    float level = kLevel * (1.0 - exp(-stain / kLevel)) / stain;
    float full = smoothstep(0.32, 0.66, 0.8 * streak + 0.2 * fine.a);
#if DETAIL >= 1
    // It gathers in furrows and runs off what stands out.
    ground = relief(bed.a, pixel, around_it);
    film *= clamp(1.0 + kFills * ground.x, 0.55, 1.8);
#endif
    film *= 1.0 + kRim * rim;
    film *= wet * drained * mix(level, 1.0, 0.15) * mix(kPatch, 1.2, full);
#if DETAIL >= 1
    // It stands up at its borders, and is level within.
    float stands = kStands / kAside * exp(-0.8 * stain / kLevel);
    film_rise = vec3(grows * (0.25 * rim * wet / max(length(grows), 1.0e-7) + stands), 0.0);
#endif
    stain = dot(film.rgb, vec3(1.0));
  } else if (flying < 0.5) {
    film = vec4(0.0);
    stain = 0.0;
  }

  // Drops.
  float in_drop = -1.0, cover = 0.0;
  vec2 slope = vec2(0.0);
  if (dot(thick.rgb, vec3(1.0)) > 0.0) {
    in_drop = inside(uv);
    slope = vec2(inside(uv + vec2(u_texel.x, 0.0)) - inside(uv - vec2(u_texel.x, 0.0)),
                 inside(uv + vec2(0.0, u_texel.y)) - inside(uv - vec2(0.0, u_texel.y))) * (0.5 / u_part);  // a pixel
    float soft = clamp(mix(0.7, 1.2, flying) * length(slope), 0.03, mix(0.3, 0.6, flying));
    cover = smoothstep(-soft, soft, in_drop);
  }
  float height = all / max(field.w, 1.0e-6);
  // A cap is no steeper at its edge than liquid stands on tissue.
  vec2 rise = slope * (height * cover / pixel);
  rise *= min(1.0, mix(0.5, 1.8, flying) / max(length(rise), 1.0e-4));
  // No liquid that moves is as smooth as glass.
  vec3 n = normalize(base - vec3(rise - (fine.gb - 0.5) * 0.34, 0.0));
  vec3 amount = thick.rgb / max(field.w, 1.0e-6) * (cover * max(in_drop, mix(0.03, 0.3, flying)));
  float dark = mix(film.w / max(stain, 1.0e-7), clamp(mark - 2.0 * flying, 0.0, 1.0), cover);
  amount += film.rgb;
  vec3 through = let_through(mix(kThroughTissue, 2.0, flying) * amount, dark);
  through.r *= exp(-kLost * film.r);

  vec2 bend = -(n.xy - base.xy) * (0.35 * height * cover * max(in_drop, 0.0) / pixel) * u_size.zw;
  vec3 below = texture(u_bed, v_uv + clamp(bend, -0.03, 0.03)).rgb;
  float covers = smoothstep(2.0e-6, 1.0e-5, stain) * (1.0 - cover);
  float glint = covers * glint_of(below, lit);
  // Cells blur what is below them.
  float blurred = 0.85 * smoothstep(5.0e-6, 3.0e-5, film.r) * (1.0 - cover);
  below = mix(below - glint, around_it - glint_of(around_it, lit), blurred);
  float facing = clamp(0.25 + 0.75 * dot(n, lit.direction), 0.0, 1.0);
  vec3 light = LIGHT_COLOUR * (lit.power * facing) + (BOUNCE + vec3(AMBIENT)) * lit.bounce;
  // What flies is lit from all round.
  // What lies is dark and uneven, as its cells gather here and there.
  float lying = (0.27 + 0.22 * smoothstep(0.25, 0.75, 0.6 * fine.a + 0.4 * streak)) * (1.0 - flying);
  // One side of a column is towards the lamp beside the lens, the other is in its own shade.
  float sunny = smoothstep(-0.9, 0.8, dot(n.xy, kBeside)) * (0.75 + 0.5 * smoothstep(0.3, 0.7, fine.a));
  vec3 deep = deep_colour(amount, dark) * (lying + mix(0.36, 1.2, sunny) * flying) + vec3(0.0, 0.012, 0.017) * lying;
  vec3 colour = below * through + deep * light * (1.0 - through);

  // Wet: the lamp in drops, broken by the tissue's unevenness in films; the walls where seen at a grazing angle. What
  // flies wobbles: it glints here and there.
  float gloss = smoothstep(5.0e-6, 2.5e-5, stain) * (1.0 - cover) * (1.0 - flying);
  float glints = mix(1.0, 1.4 * smoothstep(0.40, 0.62, fine.r), flying);
  vec3 toward = normalize(n - vec3(0.7 * flying * kBeside, 0.0));
  vec3 shine = vec3(glint) + cover * glints * highlight(toward, V, lit, u_shine.y * (1.0 + 5.0 * flying));
#if DETAIL >= 1
  vec3 wrinkle = (fine.rgb * 2.0 - 1.0) * 0.35 + (column.rgb * 2.0 - 1.0) * 0.75;  // its ridges run down
  // It lies as the ground does; across an outline as its splats do.
  vec3 lies = dot(ground.yz, ground.yz) > 0.0 ? normalize(base + normalize(vec3(ground.yz, 1.0))) : base;
  vec3 m = normalize(lies + vec3(dot(wrinkle, u_right), dot(wrinkle, u_up), 0.0) - film_rise);
  shine += gloss * (min(highlight(m, V, lit, 3.0 * u_shine.z), LIGHT_COLOUR * (1.1 * lit.power)) + 0.15 * highlight(m, V, lit, 0.03));
  // Its waves are finer than a pixel: a soft sheen wherever it is turned to the lamp, which pales its red.
  float turned = clamp(dot(m, normalize(lit.direction + V)), 0.0, 1.0);
  shine += LIGHT_COLOUR * (kSheen * gloss * lit.power * lobe(turned, 0.35));
#endif
  float nv = clamp(dot(n, V), 0.0, 1.0);
  float mirrors = mirror_share(nv);
  shine += (BOUNCE * 3.0 + vec3(AMBIENT)) * (lit.bounce * (min(mirrors, 0.2) * cover + min(mirrors, 0.05) * gloss));
  // What flies casts no shadow on what is behind it.
  o_colour = vec4(colour + shine, mix(bed.a, min(far, bed.a), cover * (1.0 - flying)));
}
