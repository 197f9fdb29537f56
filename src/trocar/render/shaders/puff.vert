// A square that faces the eye.
uniform mat4 u_projection;
uniform vec4 u_puff;  // eye-space centre, radius
out vec2 v_corner;
out vec3 v_eye;

void main() {
  v_corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  v_eye = u_puff.xyz + vec3(v_corner * u_puff.w, 0.0);
  gl_Position = u_projection * vec4(v_eye, 1.0);
}
