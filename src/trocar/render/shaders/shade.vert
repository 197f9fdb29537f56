// The part of the picture that one instrument may shade.
uniform vec4 u_corners[2];  // four points in clip space
out vec2 v_at;              // clip space

void main() {
  vec4 pair = u_corners[gl_VertexID / 2];
  v_at = (gl_VertexID % 2 == 0) ? pair.xy : pair.zw;
  // In front of everything but the endoscope's mask.
  gl_Position = vec4(v_at, -0.99999, 1.0);
}
