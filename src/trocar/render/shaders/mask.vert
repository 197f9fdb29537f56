// A ring around the endoscope's circle at the near plane: what it covers is never shaded.
uniform vec2 u_radius;  // of the circle, in clip space

void main() {
  float angle = 6.28318531 * float(gl_VertexID / 2) / 96.0;
  // The inner edge is a polygon around the circle, so it may not cut into it.
  float size = (gl_VertexID % 2 == 0) ? 1.006 : 3.0;
  gl_Position = vec4(u_radius * size * vec2(cos(angle), sin(angle)), -1.0, 1.0);
}
