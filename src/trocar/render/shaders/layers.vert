// Where a point is, and where the same point was in the picture before.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_paint;
layout(location = 5) in vec3 a_before;
uniform mat4 u_model_view;
uniform mat4 u_model_view_before;
uniform mat4 u_projection;
out vec3 v_eye;
out vec3 v_normal;
out vec3 v_before;
out float v_openness;

void main() {
  vec4 eye = u_model_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_model_view) * a_normal;
  v_before = (u_model_view_before * vec4(a_before, 1.0)).xyz;
  v_openness = a_paint.x;
  gl_Position = u_projection * eye;
}
