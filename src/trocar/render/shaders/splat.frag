// Adds a blob to the field (normal and distance weighted with it), to the thickness of drops, or to that of films. What
// lies follows the surface that the picture shows there, so no square sticks out of it.
precision highp float;
uniform sampler2D u_scene;  // alpha: distance [m]
uniform int u_part;         // of its pixels to one here
in vec3 v_eye;
in vec2 v_at;
flat in vec3 v_middle, v_along, v_across, v_normal;
flat in vec4 v_size;
flat in vec4 v_mix;
layout(location = 0) out vec4 o_field;
layout(location = 1) out vec4 o_thickness;
layout(location = 2) out vec4 o_film;

const float kSkirt = 0.0018;  // as in splat.vert
const float kReach = 1.7;     // as there
const float kRoot = 0.0010;   // [m] so far before a surface it is whole
const float kRound = 0.75;    // sine of how far a column's sides turn away
const float kNoGlint = 0.6;   // sine of how far what is smeared turns away from the lamp

void main() {
  ivec2 last = textureSize(u_scene, 0) - 1;
  float far = texelFetch(u_scene, min(u_part * ivec2(gl_FragCoord.xy), last), 0).a;
  float own = length(v_eye), reach = v_size.y;
  bool sheer = v_size.w > 3.5;
  float kind = v_size.w - (sheer ? 4.0 : 0.0);
  bool flies = kind < 0.5 || kind > 2.5;
  vec2 at = v_at;
  float off = 0.0, held = 1.0;
  if (!flies) {
    vec3 shown = v_eye * (far / own) - v_middle;
    off = dot(shown, v_normal);
    float most = max(0.0012 + 0.8 * reach, 0.0034);
    if (abs(off) < (kind > 1.5 ? 2.0 : 1.0) * most) {
      at = vec2(dot(shown, v_along), dot(shown, v_across));
      held = 1.0 - smoothstep(0.45, 1.0, abs(off) / most);  // no border where the surface turns away; a film runs beyond
    }
    else if (!sheer || far < own)
      discard;
    else
      off = 0.0;
  }
  float along = max(abs(at.x) - v_size.x, 0.0), fades = 1.0;
  if (kind > 2.5) {  // a spindle: its ends are smeared most
    float share = at.x / (v_size.x + reach), rest = 1.0 - share * share;
    at.y /= 0.28 + 0.72 * rest;
    fades = rest;
  }
  float far2 = along * along + at.y * at.y + 0.4 * off * off, skirt = reach;
  if (kind > 1.5 && kind < 2.5) skirt += kSkirt;
  if (far2 >= skirt * skirt) discard;
  float shows = 1.0;
  if (flies) {  // It is round, so its near side comes out of tissue first; and it grows out of what wets that.
    float before = far - own + sqrt(max(reach * reach / (kReach * kReach) - far2, 0.0));
    if (before <= 0.0) discard;
    shows = smoothstep(0.0, kRoot, before);
  }
  float s = max(1.0 - far2 / (reach * reach), 0.0);
  float f = s * s;
  f *= f * shows;  // blobs that overlap grow little
  if (kind > 1.5 && kind < 2.5) {
    o_field = vec4(v_normal.xy, min(own, far), 1.0) * (0.002 * (1.0 - far2 / (skirt * skirt)));
    o_thickness = vec4(0.0);
    o_film = v_mix * (v_size.z * 1.0e3 * s * s * held);
  } else {
    // A column turns away to its sides; what is smeared by its speed has no glint.
    vec2 n = flies ? (kind > 2.5 ? kNoGlint : kRound * clamp(at.y * kReach / reach, -1.0, 1.0)) * v_across.xy : v_normal.xy;
    o_field = vec4(n, own, 1.0) * f;
    // What flies is marked: it has no edge that runs out thin.
    o_thickness = vec4(v_mix.rgb, v_mix.a + (flies ? 2.0 : 0.0)) * (v_size.z * 1.0e3 * f * fades);
    o_film = vec4(0.0);
  }
}
