// Four by four texels into one (SPREAD 1), or a smoothing in place (SPREAD 0.75); light and distance.
precision highp float;
uniform sampler2D u_picture;
uniform vec2 u_texel;  // of u_picture
in vec2 v_uv;
out vec4 o_colour;

void main() {
  vec2 d = u_texel * SPREAD;
  vec4 sum = texture(u_picture, v_uv + vec2(-d.x, -d.y)) + texture(u_picture, v_uv + vec2(d.x, -d.y)) +
             texture(u_picture, v_uv + vec2(-d.x, d.y)) + texture(u_picture, v_uv + d);
  o_colour = min(0.25 * sum, vec4(64.0));
}
