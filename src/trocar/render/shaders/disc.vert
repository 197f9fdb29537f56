// A fan that covers the endoscope's circle in the middle of the viewport, and little more.
uniform vec2 u_radius;  // of the circle, in clip space
out vec2 v_uv;

void main() {
  float angle = 6.28318531 * float(gl_VertexID - 1) / 96.0;
  vec2 at = gl_VertexID == 0 ? vec2(0.0) : u_radius * 1.006 * vec2(cos(angle), sin(angle));
  v_uv = 0.5 + 0.5 * at;
  gl_Position = vec4(at, 0.0, 1.0);
}
