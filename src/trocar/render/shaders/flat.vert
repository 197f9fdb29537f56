layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_paint;

uniform mat4 u_model_view;
uniform mat4 u_projection;

out vec3 v_eye;
out vec3 v_normal;
out vec4 v_paint;

void main() {
  vec4 eye = u_model_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_model_view) * a_normal;
  v_paint = a_paint;
  gl_Position = u_projection * eye;
}
