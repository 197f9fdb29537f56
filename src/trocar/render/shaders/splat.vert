// One blob of liquid as a square: facing the eye where it flies, on its surface where it lies.
layout(location = 0) in vec4 a_from;    // eye space, and the radius
layout(location = 1) in vec4 a_to;      // eye space, and the height
layout(location = 2) in vec4 a_normal;  // eye space, and the kind: 0 flies, 1 lies, 2 film, 3 flies and is smeared; + 4 on something sheer
layout(location = 3) in vec4 a_mix;     // shares, and how clotted
uniform mat4 u_projection;
out vec3 v_eye;
out vec2 v_at;          // on the square [m]
flat out vec3 v_middle, v_along, v_across, v_normal;
flat out vec4 v_size;   // half length of the axis, reach of the field, height, kind
flat out vec4 v_mix;

const float kReach = 1.7;
const float kSkirt = 0.0018;  // [m] around a film, where only its normal is known: it runs there (wet.frag)

void main() {
  float kind = mod(a_normal.w, 4.0);
  vec3 middle = 0.5 * (a_from.xyz + a_to.xyz);
  vec3 n = kind > 0.5 && kind < 2.5 ? a_normal.xyz : normalize(-middle);
  vec3 axis = a_to.xyz - a_from.xyz;
  axis -= n * dot(n, axis);
  float size = length(axis);
  vec3 other = abs(n.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  v_along = size > 1.0e-6 ? axis / size : normalize(cross(other, n));
  v_across = cross(n, v_along);
  float reach = kReach * a_from.w;
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  float far = reach + (kind > 1.5 && kind < 2.5 ? kSkirt : 0.0);
  v_at = corner * vec2(0.5 * size + far, far);
  v_middle = middle;
  v_normal = n;
  v_size = vec4(0.5 * size, reach, a_to.w, a_normal.w);
  v_mix = a_mix;
  v_eye = middle + v_along * v_at.x + v_across * v_at.y;
  gl_Position = u_projection * vec4(v_eye, 1.0);
}
