// What lens and camera do to the developed picture. Variants: FRINGE, SMOOTH (outlines without steps, and sharpened),
// SOILED (and those of soil.glsl).
precision highp float;
precision highp int;
uniform sampler2D u_picture;
uniform vec4 u_place;   // centre of the target [px], radius of the view [px], mask on
uniform vec4 u_box;     // size of the scene [px of the target], 1 / the same
uniform vec4 u_lens;    // barrel, fringe [px], sharpening, soft edge [px]
uniform vec2 u_texel;   // of the picture
uniform vec4 u_sensor;  // noise, notch, sine and cosine of its angle
uniform uint u_seed;
out vec4 o_colour;

#ifdef SOILED
#include "soil.glsl"
#endif

// Integer hash [Jarzynski & Olano 20, pcg].
uint scrambled(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

const vec3 kLuma = vec3(0.3, 0.59, 0.11);
const vec2 kChipsApart = vec2(0.45, 0.33);  // of the shift at the rim
const float kSharedColour = 0.75;  // of a pixel's colour is its neighbours'

void main() {
  vec2 from_centre = gl_FragCoord.xy - u_place.xy;
  float r = length(from_centre) / u_place.z;
  float edge = 1.0;
  if (u_place.w > 0.5) {
    edge = clamp((1.0 - r) * u_place.z / u_lens.w, 0.0, 1.0);
    // The notch: a small tooth on the rim.
    vec2 tooth = u_sensor.zw;
    float along = dot(from_centre, tooth) / u_place.z;
    float across = abs(dot(from_centre, vec2(tooth.y, -tooth.x))) / u_place.z;
    float inside = (1.0 - along) - 0.035 * u_sensor.y + across * 1.2;
    edge *= clamp(inside * u_place.z / u_lens.w, 0.0, 1.0);
  }

  vec2 source = from_centre * ((1.0 + u_lens.x * r * r) / (1.0 + u_lens.x));
  vec2 uv = source * u_box.zw + 0.5;
  vec4 developed = texture(u_picture, uv);
  vec3 picture = developed.rgb;
#ifdef FRINGE
  // Red and blue lie a little apart: the more, the nearer the rim, and a little everywhere, as a camera's three chips do
  // not lie on each other to the pixel. Only what is steep keeps it where neighbours share their colour.
  vec2 shift = (from_centre * (u_lens.y * r / u_place.z) + kChipsApart * u_lens.y) * u_box.zw;
  vec2 fringe = vec2(texture(u_picture, uv + shift).r, texture(u_picture, uv - shift).b) - picture.rb;
  fringe *= smoothstep(0.15, 0.45, abs(fringe));
#endif

#ifdef SMOOTH
  // The four diagonal neighbours serve twice: they say where outlines run, and they are the ring to sharpen against.
  vec2 px = u_texel * 1.05;
  vec3 a = texture(u_picture, uv + vec2(-px.x, px.y)).rgb, b = texture(u_picture, uv + px).rgb;
  vec3 c = texture(u_picture, uv - px).rgb, d = texture(u_picture, uv + vec2(px.x, -px.y)).rgb;
  vec4 ring = vec4(dot(a, kLuma), dot(b, kLuma), dot(c, kLuma), dot(d, kLuma));
  float middle = dot(picture, kLuma);
  float step_up = middle - 0.25 * (ring.x + ring.y + ring.z + ring.w);
  // Steps along an outline are blended along it [after Lottes 09].
  vec2 along_edge = vec2((ring.z + ring.w) - (ring.x + ring.y), (ring.x + ring.z) - (ring.y + ring.w));
  float least = mix(0.02, 0.10, developed.a);  // alpha: 0 at outlines, which show steps the most
  float strength = smoothstep(least, 2.5 * least, max(abs(along_edge.x), abs(along_edge.y)));
  vec2 walk = clamp(along_edge / (min(abs(along_edge.x), abs(along_edge.y)) + 0.03), -3.0, 3.0) * u_texel;
  vec3 blended = 0.5 * (texture(u_picture, uv + walk * 0.33).rgb + texture(u_picture, uv - walk * 0.33).rgb);
  picture = mix(picture, blended, 0.85 * strength);
  step_up *= 1.0 - 0.7 * strength;
  // What is thinner than a pixel comes out as a row of dots at an outline; no camera shows an edge so sharp.
  float outline = (1.0 - developed.a) * (1.0 - smoothstep(0.7, 0.9, middle));  // but what glitters there does
  picture = mix(picture, 0.25 * (a + b + c + d), 0.4 * outline);
  step_up *= 1.0 - 0.6 * outline;
  // Video sharpening: overshoot.
  picture += u_lens.z * clamp(step_up, -0.12, 0.12);
  // Video has half as many samples of colour as of brightness; what is clipped has no colour.
  vec3 around = 0.25 * (a + b + c + d);
  float bright = dot(picture, kLuma), shared = kSharedColour * (1.0 - smoothstep(0.6, 0.9, middle));
  picture = bright + mix(picture - bright, around - dot(around, kLuma), shared);
#endif

#ifdef FRINGE
  picture.rb += fringe;
#endif

#ifdef SOILED
  picture = through_soil(picture, uv, from_centre / u_place.z);
#endif

  uint seed = scrambled(uint(gl_FragCoord.x) + 8192u * uint(gl_FragCoord.y) + u_seed);
  vec3 grain = vec3(float(seed & 1023u), float((seed >> 10u) & 1023u), float((seed >> 20u) & 1023u)) / 1023.0 - 0.5;
  grain = mix(vec3(grain.g), grain, 0.03);
  picture += grain * (u_sensor.x * 3.4 * (1.4 - 0.8 * picture.g));
  // Brightness and differences of colour have 8 bits each, as in video: rounded one by one, channels would be noisy.
  picture *= edge;
  float brightness = dot(picture, kLuma);
  o_colour = vec4((floor(255.0 * brightness + 0.5) + floor(255.0 * (picture - brightness) + 0.5)) / 255.0, 1.0);
}
