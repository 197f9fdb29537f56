// What is on the lens: fog, smears, drops, a swab that wipes. All of it lies too near to be in focus, so it only blurs,
// veils and shifts the picture. Positions `at` in radii of the view. Variants: UNEVEN, SMEARED, WIPED,
// DROPS (a software driver pays for what it does not take, so they are no branches).
precision highp sampler3D;
uniform sampler2D u_blur, u_blurrer, u_blurred;  // of the developed picture, 1/4, 1/16 and 1/64
uniform sampler3D u_noise;
uniform vec4 u_soil;    // fog, smear, sine and cosine of its streaks' direction
uniform vec4 u_smear;   // what the smear lets through, how far the swab has passed (< 0: none)
uniform vec4 u_swab;    // its colour, time [s]
uniform vec4 u_drops[16];  // two rows a drop: x, y, radius; what it lets through
uniform int u_drop_count;

vec3 blurred(vec2 uv, vec3 sharp, float by) {
  vec3 soft = texture(u_blur, uv).rgb, softer = texture(u_blurrer, uv).rgb;
  return mix(mix(sharp, soft, clamp(by * 2.4, 0.0, 1.0)), softer, clamp((by - 0.44) * 0.85, 0.0, 1.0));
}

vec3 through_soil(vec3 picture, vec2 uv, vec2 at) {
  const vec3 kLuma = vec3(0.3, 0.59, 0.11);
  vec3 mean = texture(u_blurred, mix(uv, vec2(0.5), 0.75)).rgb, around = texture(u_blurred, mix(uv, vec2(0.5), 0.15)).rgb;
  float light = dot(mean, kLuma);
#ifdef UNEVEN
  vec4 broad = texture(u_noise, vec3(at * 0.055, 0.31));
#else
  const vec4 broad = vec4(0.5);
#endif
  // It condenses all over the glass, more towards the rim, which is colder, to one side, and in patches.
  float thicker = dot(at, vec2(0.20, -0.14)) + 0.9 * (broad.a - 0.5);
  float fog = clamp(u_soil.x * (0.84 + 0.15 * dot(at, at) + thicker), 0.0, 1.0);
  vec2 bent = vec2(0.0);
  float beads = 0.0;
#ifdef UNEVEN
  // Drops too fine to be told apart bend light to all sides, as ground glass does.
  vec4 drops = texture(u_noise, vec3(mat2(0.8, 0.6, -0.6, 0.8) * at * 7.0, 0.57));
  bent = (drops.rg - 0.5) * (0.015 * fog);
  beads = (drops.a - 0.5) * fog;
#endif

  // Streaks along the wiping.
  float streaks = 0.5;
#ifdef SMEARED
  vec2 streak_at = vec2(dot(at, u_soil.wz), dot(at, vec2(-u_soil.z, u_soil.w)));
#ifdef UNEVEN
  streaks = texture(u_noise, vec3(streak_at * vec2(0.012, 0.22), 0.7)).a;
  streaks = smoothstep(0.32, 0.75, 0.6 * streaks + 0.4 * texture(u_noise, vec3(streak_at * vec2(0.03, 0.6), 0.2)).g);
#else
  streaks += 0.4 * sin(9.0 * streak_at.y + 4.0 * sin(3.0 * streak_at.y));
#endif
#endif

  // The swab goes across and back; where it has been there is no fog, but a smear.
  float smear = u_soil.y;
  float swab = 0.0;
#ifdef WIPED
    // A fold of gauze, so near that it has no outline; it leaves what its threads pass over.
    float lift = dot(at, vec2(-u_soil.z, u_soil.w));
    float side = dot(at, u_soil.wz) + 0.35 * (broad.a - 0.5) + 0.10 * lift * lift + 0.10 * lift * sin(9.0 * u_smear.w);
    float edge = mix(-1.7, 1.7, u_smear.w);
    float wiped = 1.0 - smoothstep(edge - 0.35, edge + 0.15, side);
    swab = 1.0 - smoothstep(0.06, 0.34, abs(side - edge));
    // A stroke clears a lane; beside it fog is pushed together and smeared.
    float lane = 1.0 - smoothstep(0.45, 0.95, abs(lift + 0.25 * (broad.g - 0.5)) + 0.25 * (streaks - 0.5));
    wiped *= 0.35 + 0.65 * lane;
    fog *= 1.0 - wiped * (0.90 + 0.10 * smoothstep(0.15, 0.6, 1.0 - streaks));
    smear = max(smear, 0.55 * wiped * exp(-4.0 * clamp(edge - side, 0.0, 3.0)));
#endif

  float greasy = 0.0;
#ifdef SMEARED
  greasy = smear * (0.10 + 0.90 * streaks * streaks);
#endif

  float by = max(fog, 0.55 * greasy);
  // Between the drops light comes straight through, but no glint is left as sharp as it was.
  vec3 soft = blurred(uv + bent, picture, by);
  picture = mix(soft, min(picture, mix(vec3(1.0), 1.2 * soft + 0.03, min(2.0 * by, 1.0))), 0.5);
  // What drops turn aside comes from all around: the organs' own colours, milky, brightest where the lamp shines back.
  // Warm where the light is, bluish grey beside it.
  vec3 veil = mix(mix(around, mean, 0.35), vec3(light), 0.12);
  float beside = smoothstep(0.1, 0.9, length(at - vec2(-0.15, 0.2)));
  vec3 milk = mix(mix(veil, light * vec3(1.16, 0.98, 0.87), 0.6), mix(veil, light * vec3(0.95, 0.99, 1.08), 0.75), beside);
  picture = mix(picture, milk * (1.14 - 0.22 * dot(at, at)) + 0.05, 0.6 * fog);
  picture *= 1.0 + 0.12 * beads;
  picture = mix(picture, veil * u_smear.rgb * 1.05 + 0.02, 0.33 * greasy);

#ifdef DROPS
  for (int i = 0; i < u_drop_count; ++i) {
    vec4 drop = u_drops[2 * i];
    vec2 off = (at - drop.xy) / drop.z;
    if (dot(off, off) > 1.5) continue;
    vec4 wobble = texture(u_noise, vec3(off * 0.05, float(i) * 0.17));
    float r = length(off) * (0.82 + 0.36 * wobble.a);
    float body = 1.0 - smoothstep(0.2, 1.0, r);
    if (body <= 0.0) continue;
    // It shows what is around it upside down, and small, all out of focus.
    vec2 inner = uv - off * drop.z * 0.35 * (1.0 + 0.5 * r * r);
    vec3 seen = mix(texture(u_blur, inner).rgb, texture(u_blurrer, inner).rgb, 0.8);
    float low = clamp(0.5 - 0.5 * off.y, 0.0, 1.0);
    seen = seen * (0.92 + 0.25 * low) + light * 0.10 * low;
    picture = mix(picture, seen * u_drops[2 * i + 1].rgb, 0.9 * body);
  }
#endif
  vec3 cloth = u_swab.rgb * (0.68 + 0.85 * light) * (0.85 + 0.3 * broad.a);
#ifdef WIPED
  // Gauze, far out of focus: soft folds along its edge, and pink where it has taken blood up.
  vec4 pulled = texture(u_noise, vec3(streak_at * 0.13, 0.45));
  cloth *= 0.93 + 0.07 * sin(11.0 * side + 7.0 * pulled.a + 1.5 * lift) + 0.20 * (pulled.a - 0.5);
  cloth *= mix(vec3(1.0), vec3(0.99, 0.93, 0.91), smoothstep(0.15, 0.95, pulled.g));
#endif
  return mix(picture, min(cloth, vec3(0.93)), 0.995 * swab);
}
