// Surface and places of what is nearest (RawLayers in layers.hpp). Variants: SHEET, of gathered liquid; SPLAT, of drops
// and films.
precision highp float;
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
  // The outline of one blob alone, as in splat.frag; 1.7 radii are the field's reach.
  vec2 off = vec2(max(abs(v_at.x) - v_size.x, 0.0), v_at.y) * (1.7 / v_size.y);
  if (dot(off, off) > 1.0) discard;
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
