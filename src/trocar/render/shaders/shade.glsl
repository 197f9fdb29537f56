// An instrument over tissue. The lamp is a small disc beside the lens, so a shadow is narrow and soft, lies to one side,
// and moves away from the instrument and widens with its height: together with the darkening right under it, what tells
// height in a picture without parallax. All in eye space [m].

// The lamp counts as farther off the lens than it is, and as larger, for shadows: under a true one they hide behind the
// instrument, and 25 mm look like 8.
const float kShadowSpread = 6.0;
const float kShadowSoft = 2.0;
const float kContact = 0.0016;  // [m] nearer than this a surface is dark right under an instrument

/// What a rod leaves at a point: of the lamp (x) and of the light from around (y).
/// Closest points of two segments as in [Ericson 05, 5.1.9].
/// rod: one end and the radius; way: to the other end and 1 / its square
vec2 shade_of_rod(vec3 eye, vec3 lamp, float ring, vec4 rod, vec4 way) {
  vec3 u = lamp - eye, w = eye - rod.xyz;
  float a = dot(u, u), inverse = 1.0 / a;
  float e = dot(way.xyz, w), b = dot(u, way.xyz), d = dot(u, w);
  // Towards the lamp.
  float s = clamp((b * e * way.w - d) / max(a - b * b * way.w, 1.0e-3 * a), 0.0, 1.0);
  float t = clamp((b * s + e) * way.w, 0.0, 1.0);
  s = clamp((t * b - d) * inverse, 0.0, 1.0);
  float gap = length(w + s * u - t * way.xyz) - rod.w;
  float soft = 1.0 / (kShadowSoft * ring * s + 0.0003);
  float covered = clamp(0.5 - 0.5 * gap * soft, 0.0, 1.0) * min(1.0, 1.5 * rod.w * soft);
  covered *= 1.0 - smoothstep(0.36, 0.6, s);
  // Right under it.
  vec3 near = clamp(e * way.w, 0.0, 1.0) * way.xyz - w;
  float under = clamp(1.0 - (length(near) - rod.w) / kContact, 0.0, 1.0);
  return vec2(1.0 - covered, 1.0 - 0.65 * under * under);
}

/// What is left of the light: red the most, which has gone through tissue; right under an instrument it is hardly else.
vec3 shaded_by(vec2 shade) {
  vec3 contact = 1.0 - (1.0 - shade.y) * vec3(0.45, 0.85, 0.82);
  return mix(vec3(shade.x), vec3(1.0), vec3(0.28, 0.09, 0.09)) * contact;
}

/// How far a point is from a rod's surface [m].
float gap_of_rod(vec3 eye, vec4 rod, vec4 way) {
  vec3 w = eye - rod.xyz;
  return length(w - clamp(dot(way.xyz, w) * way.w, 0.0, 1.0) * way.xyz) - rod.w;
}

/// Pressed tissue gives its blood away and pales. share: how much, 0..1
vec3 paled(vec3 colour, float share) {
  float grey = dot(colour, vec3(0.42, 0.4, 0.18));
  return mix(colour, grey * vec3(1.4, 1.0, 0.93), 0.34 * share);
}
