// Surface and places of what is nearest (RawLayers in layers.hpp). Variants: SHEET, of gathered liquid; SPLAT, of drops
// and films.
precision highp float;
const float kSeen = 2.0e-5;  // [m] what flies and is thinner is a mist that tissue is seen through
uniform vec2 u_part;  // part + 1, negative if its place before is not known; least openness that is seen
in vec3 v_eye;
#ifdef SPLAT
in vec2 v_at;
flat in vec3 v_normal;
flat in vec4 v_size;
#else
in vec3 v_normal;
#endif
#ifdef SHEET
in vec2 v_depth_cover;
#endif
#if !defined(SPLAT) && !defined(SHEET)
in vec3 v_before;
in float v_openness;
#endif
layout(location = 0) out vec4 o_surface;
layout(location = 1) out vec4 o_places;

void main() {
  vec3 before = vec3(0.0);
#if defined(SPLAT)
  // One blob alone, shaped as in splat.frag; 1.7 radii are the field's reach.
  vec2 off = vec2(max(abs(v_at.x) - v_size.x, 0.0), v_at.y) * (1.7 / v_size.y);
  float kind = mod(v_size.w, 4.0), fades = 1.0;
  if (kind > 2.5) {  // a spindle
    float share = v_at.x / (v_size.x + v_size.y);
    fades = 1.0 - share * share;
    off.y /= 0.28 + 0.72 * fades;
  }
  float s = max(1.0 - dot(off, off) / (1.7 * 1.7), 0.0);
  bool mist = (kind < 0.5 || kind > 2.5) && v_size.z * s * s * s * fades < kSeen;
  if (dot(off, off) > 1.0 || mist) discard;
#elif defined(SHEET)
  if (v_depth_cover.y < 0.333) discard;
#else
  if (v_openness < u_part.y) discard;
  before = v_before;
#endif
  vec3 n = normalize(v_normal);
  o_surface = vec4(dot(n, v_eye) > 0.0 ? -n : n, u_part.x);
  o_places = vec4(-v_eye.z, before);
}
