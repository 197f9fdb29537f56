// One rectangle of the picture an instance.
layout(location = 0) in vec4 a_tile;  // left, low, right, high, 0..1
out vec2 v_uv;

void main() {
  v_uv = vec2((gl_VertexID & 1) == 0 ? a_tile.x : a_tile.z, (gl_VertexID >> 1) == 0 ? a_tile.y : a_tile.w);
  gl_Position = vec4(2.0 * v_uv - 1.0, 0.0, 1.0);
}
