// Auto exposure: one pixel that follows the mean scene level with a lag. The mean is of square roots, so a burnt-out
// highlight does not darken everything.
precision highp float;
uniform sampler2D u_picture;   // small
uniform sampler2D u_memory;    // exposure so far
uniform vec4 u_meter;          // key, lag (share taken over this frame), limit [stops], memory column
uniform vec2 u_radius;         // of the view, in texture space
out vec4 o_exposure;

void main() {
  float sum = 0.0, weight = 0.0;
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) {
      vec2 at = (vec2(float(i), float(j)) + 0.5) / 8.0 - 1.0;
      float w = max(1.0 - 0.35 * dot(at, at), 0.0) * step(dot(at, at), 1.0);
      vec3 c = texture(u_picture, 0.5 + at * u_radius).rgb;
      sum += w * sqrt(max(dot(c, vec3(0.2126, 0.7152, 0.0722)), 0.0));
      weight += w;
    }
  float level = sum / weight;
  float wanted = clamp(log2(u_meter.x / max(level * level, 1.0e-6)), -u_meter.z, u_meter.z);
  float before = texelFetch(u_memory, ivec2(int(u_meter.w), 0), 0).r;
  o_exposure = vec4(mix(before, wanted, u_meter.y), 0.0, 0.0, 1.0);
}
