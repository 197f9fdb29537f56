// The surface of drops and films over the scene. Where the field of the drops passes a threshold there is liquid; its
// height follows from how far it does. Variants: DETAIL.
#include "common.glsl"
#include "liquid.glsl"
uniform sampler2D u_field, u_thickness, u_film;  // sums; thickness in mm
uniform vec2 u_texel;                            // of them
in vec2 v_uv;
out vec4 o_colour;

/// How far inside a drop, 0 at its outline, 1 in the middle of a lone one.
float inside_of(float field) { return 1.0 - 2.89 * (1.0 - pow(max(field, 1.0e-6), 1.0 / 6.0)); }
float inside(vec2 uv) { return inside_of(texture(u_field, uv).w); }

void main() {
  vec4 field = texture(u_field, v_uv);
  if (field.w < 0.0001) discard;
  vec4 thick = texture(u_thickness, v_uv) * 1.0e-3, film = texture(u_film, v_uv) * 1.0e-3;
  vec4 bed = texelFetch(u_bed, ivec2(gl_FragCoord.xy), 0);
  float far = field.z / field.w;
  vec3 way = normalize(vec3((2.0 * v_uv - 1.0) * u_tan, -1.0));
  vec3 eye = way * far, V = -way;
  Lit lit = light_at(eye);
  float pixel = -eye.z * 2.0 * u_tan.y * u_size.w;  // [m]

  // Films: their amount is broken up a little, so that edges are ragged.
  vec3 place = to_world(way * bed.a);
  vec4 fine = texture(u_noise, place * 38.0);
  film *= smoothstep(-0.1, 0.75, fine.a + 0.35 * fine.r);

  // Drops.
  float in_drop = inside_of(field.w);
  vec2 slope = vec2(inside(v_uv + vec2(u_texel.x, 0.0)) - inside(v_uv - vec2(u_texel.x, 0.0)),
                    inside(v_uv + vec2(0.0, u_texel.y)) - inside(v_uv - vec2(0.0, u_texel.y))) * 0.25;  // a pixel
  float soft = clamp(0.7 * length(slope), 0.03, 0.3);
  float cover = smoothstep(-soft, soft, in_drop);
  float height = dot(thick.rgb, vec3(1.0)) / field.w;
  vec2 nb = field.xy / field.w;
  vec3 base = vec3(nb, sqrt(max(1.0 - dot(nb, nb), 0.01)));
  vec3 n = normalize(base - vec3(slope * (height * cover / pixel), 0.0));
  vec3 amount = thick.rgb / field.w * (cover * max(in_drop, 0.25));
  float dark = mix(film.w / max(dot(film.rgb, vec3(1.0)), 1.0e-7), thick.w / max(dot(thick.rgb, vec3(1.0)), 1.0e-7), cover);
  amount += film.rgb;
  vec3 tau = optical_depth(2.0 * amount, dark);
  vec3 through = exp(-tau);

  vec2 bend = -(n.xy - base.xy) * (0.35 * height * cover * max(in_drop, 0.0) / pixel) * u_size.zw;
  vec3 below = texture(u_bed, v_uv + clamp(bend, -0.03, 0.03)).rgb;
  float facing = clamp(0.25 + 0.75 * dot(n, lit.direction), 0.0, 1.0);
  vec3 light = LIGHT_COLOUR * (lit.power * facing) + (BOUNCE + vec3(AMBIENT)) * lit.bounce;
  vec3 colour = below * through + deep_colour(amount, dark) * light * (1.0 - through);

  // Wet: the lamp in drops, broken by the tissue's unevenness in films; the walls where seen at a grazing angle.
  float wet = cover;
  float gloss = smoothstep(4.0e-6, 2.5e-5, dot(film.rgb, vec3(1.0))) * (1.0 - cover);
  vec3 shine = cover * highlight(n, V, lit, u_shine.y);
#if DETAIL >= 1
  vec3 wrinkle = (fine.rgb * 2.0 - 1.0) * 0.45 + (texture(u_noise, place.zxy * 11.0).rgb * 2.0 - 1.0) * 0.35;
  vec3 m = normalize(base + vec3(dot(wrinkle, u_right), dot(wrinkle, u_up), 0.0));
  shine += gloss * highlight(m, V, lit, u_shine.z);
#endif
  float nv = clamp(dot(n, V), 0.0, 1.0);
  shine += (BOUNCE * 3.0 + vec3(AMBIENT)) * (lit.bounce * mirror_share(nv) * (cover + 0.5 * gloss));
  o_colour = vec4(colour + shine, cover > 0.5 ? min(far, bed.a) : bed.a);
}
