// Both eyes' pictures on one screen. Variants: MODE (0 side by side, 1 top and bottom, 2 rows in turn, 3 anaglyph).
precision highp float;
uniform sampler2D u_left, u_right;
uniform vec4 u_place;  // lower left corner of the target [px], and its size
out vec4 o_colour;

#if MODE == 3
// Least squares in the space of what the filtered eyes see [Dubois 2001]; columns: what one unit of the picture's red,
// green, blue gives.
const mat3 kLeft = mat3(0.456, -0.040, -0.015, 0.500, -0.038, -0.021, 0.176, -0.016, -0.005);
const mat3 kRight = mat3(-0.043, 0.378, -0.072, -0.088, 0.734, -0.113, -0.002, -0.018, 1.226);
#endif

void main() {
  vec2 at = gl_FragCoord.xy - u_place.xy, uv = at / u_place.zw;
#if MODE == 0
  bool left = uv.x < 0.5;
  uv.x = fract(2.0 * uv.x);
#elif MODE == 1
  bool left = uv.y >= 0.5;
  uv.y = fract(2.0 * uv.y);
#elif MODE == 2
  bool left = mod(floor(u_place.w - at.y), 2.0) < 0.5;
#endif
#if MODE == 3
  vec3 colour = kLeft * texture(u_left, uv).rgb + kRight * texture(u_right, uv).rgb;
#else
  vec3 colour = left ? texture(u_left, uv).rgb : texture(u_right, uv).rgb;
#endif
  o_colour = vec4(clamp(colour, 0.0, 1.0), 1.0);
}
