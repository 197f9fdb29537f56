// Four by four texels into one, light and distance.
precision highp float;
uniform sampler2D u_picture;
uniform vec2 u_texel;  // of u_picture
in vec2 v_uv;
out vec4 o_colour;

void main() {
  vec4 sum = texture(u_picture, v_uv + u_texel * vec2(-1.0, -1.0)) + texture(u_picture, v_uv + u_texel * vec2(1.0, -1.0)) +
             texture(u_picture, v_uv + u_texel * vec2(-1.0, 1.0)) + texture(u_picture, v_uv + u_texel * vec2(1.0, 1.0));
  o_colour = min(0.25 * sum, vec4(64.0));
}
