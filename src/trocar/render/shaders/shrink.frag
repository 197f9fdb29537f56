// Four by four texels into one.
precision highp float;
uniform sampler2D u_picture;
uniform vec2 u_texel;  // of u_picture
in vec2 v_uv;
out vec4 o_colour;

void main() {
  vec3 sum = texture(u_picture, v_uv + u_texel * vec2(-1.0, -1.0)).rgb + texture(u_picture, v_uv + u_texel * vec2(1.0, -1.0)).rgb +
             texture(u_picture, v_uv + u_texel * vec2(-1.0, 1.0)).rgb + texture(u_picture, v_uv + u_texel * vec2(1.0, 1.0)).rgb;
  o_colour = vec4(min(0.25 * sum, vec3(64.0)), 1.0);
}
