layout(location = 0) in vec4 a_position;  // and the depth below it
layout(location = 1) in vec4 a_normal;    // and how far inside the border
layout(location = 2) in vec4 a_mix;       // shares of the second and third kind, froth, how clotted
uniform mat4 u_view;
uniform mat4 u_projection;
out vec3 v_eye;
out vec3 v_normal;
out vec2 v_depth_cover;
out vec4 v_mix;

void main() {
  vec4 eye = u_view * vec4(a_position.xyz, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_view) * a_normal.xyz;
  v_depth_cover = vec2(a_position.w, a_normal.w);
  v_mix = a_mix;
  gl_Position = u_projection * eye;
  gl_Position.z -= 2.0e-4 * gl_Position.w;  // a shallow sheet lies on tissue that is drawn finer than its floor
}
