// What lens and camera do to the picture. Variants: BLOOM, FRINGE.
precision highp float;
precision highp int;
uniform sampler2D u_scene;
uniform sampler2D u_small;     // 1/4 of the scene
uniform sampler2D u_smaller;   // 1/16
uniform sampler2D u_exposure;  // stops, one column an eye
uniform vec4 u_place;          // centre of the target [px], radius of the view [px], mask on
uniform vec4 u_box;            // size of the scene [px of the target], 1 / size of the scene texture
uniform vec4 u_lens;           // barrel, fringe [px], vignette, soft edge [px]
uniform vec4 u_camera;         // exposure on top [stops], memory column or -1, bloom, sharpening
uniform vec4 u_sensor;         // noise, saturation, notch, notch angle
uniform vec3 u_white;
uniform uint u_seed;
in vec2 v_uv;
out vec4 o_colour;

// Integer hash [Jarzynski & Olano 20, pcg].
uint scrambled(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// Camera curve: a toe, a straight middle and a long shoulder, each channel on its own, so that what is bright pales.
vec3 developed(vec3 x) {
  x = max(x, 0.0);
  return clamp(x * (1.9 * x + 0.62) / (x * (1.8 * x + 1.05) + 0.19), 0.0, 1.0);
}

vec3 encoded(vec3 c) { return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThan(c, vec3(0.0031308)))); }

void main() {
  vec2 from_centre = gl_FragCoord.xy - u_place.xy;
  float r = length(from_centre) / u_place.z;
  float edge = 1.0;
  if (u_place.w > 0.5) {
    edge = clamp((1.0 - r) * u_place.z / u_lens.w, 0.0, 1.0);
    // The notch: a small tooth on the rim.
    vec2 tooth = vec2(sin(u_sensor.w), cos(u_sensor.w));
    float along = dot(from_centre, tooth) / u_place.z, across = abs(dot(from_centre, vec2(tooth.y, -tooth.x))) / u_place.z;
    float inside = (1.0 - along) - 0.035 * u_sensor.z + across * 1.2;
    edge *= clamp(inside * u_place.z / u_lens.w, 0.0, 1.0);
  }
  if (edge <= 0.0) {
    o_colour = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }

  vec2 source = from_centre * ((1.0 + u_lens.x * r * r) / (1.0 + u_lens.x));
  vec2 uv = source / u_box.xy + 0.5;
  vec3 colour = texture(u_scene, uv).rgb;
#ifdef FRINGE
  vec2 shift = from_centre * (u_lens.y * r / u_place.z) / u_box.xy;
  colour.r = texture(u_scene, uv + shift).r;
  colour.b = texture(u_scene, uv - shift).b;
#endif

  // Video sharpening: overshoot against the ring around.
  vec2 px = u_box.zw * 1.1;
  vec3 around = 0.25 * (texture(u_scene, uv + vec2(px.x, px.y)).rgb + texture(u_scene, uv + vec2(-px.x, px.y)).rgb +
                        texture(u_scene, uv + vec2(px.x, -px.y)).rgb + texture(u_scene, uv - vec2(px.x, px.y)).rgb);
#ifdef BLOOM
  vec3 veil = 0.6 * texture(u_small, uv).rgb + 0.4 * texture(u_smaller, uv).rgb;
  colour = mix(colour, min(veil, vec3(8.0)), u_camera.z);
#endif

  float stops = u_camera.x;
  if (u_camera.y >= 0.0) stops += texelFetch(u_exposure, ivec2(int(u_camera.y), 0), 0).r;
  float cosine2 = 1.0 / (1.0 + 0.30 * r * r);
  float gain = exp2(stops) * mix(1.0, cosine2 * cosine2, u_lens.z);
  vec3 tone = developed(colour * u_white * gain);
  vec3 ring = developed(around * u_white * gain);
  float luma = dot(tone, vec3(0.2126, 0.7152, 0.0722));
  tone = mix(vec3(luma), tone, u_sensor.y);
  vec3 picture = encoded(clamp(tone, 0.0, 1.0));
  float step_up = dot(sqrt(tone) - sqrt(ring), vec3(0.3, 0.59, 0.11));
  picture += u_camera.w * clamp(step_up, -0.12, 0.12);

  uint seed = scrambled(uint(gl_FragCoord.x) + 8192u * uint(gl_FragCoord.y) + u_seed);
  vec3 grain = vec3(float(seed & 1023u), float((seed >> 10u) & 1023u), float((seed >> 20u) & 1023u)) / 1023.0 - 0.5;
  grain = mix(vec3(grain.g), grain, 0.35);
  picture += grain * (u_sensor.x * 3.4 * (0.6 + 0.8 * (1.0 - luma)));
  o_colour = vec4(picture * edge, 1.0);
}
