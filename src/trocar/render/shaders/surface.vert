layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_paint;
layout(location = 3) in vec3 a_rest;
layout(location = 4) in vec3 a_rest_normal;

uniform mat4 u_model_view;
uniform mat4 u_projection;

out vec3 v_eye;
centroid out vec3 v_normal;  // not beyond an outline, where it would turn away
centroid out vec4 v_paint;
out vec3 v_rest;
#ifdef VESSELS
out vec3 v_rest_normal;
#endif

void main() {
  vec4 eye = u_model_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_model_view) * a_normal;
  v_paint = a_paint;
  v_rest = a_rest;
#ifdef VESSELS
  v_rest_normal = a_rest_normal;
#endif
  gl_Position = u_projection * eye;
}
