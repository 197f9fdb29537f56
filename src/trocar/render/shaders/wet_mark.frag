// Where wet.frag has anything to draw: it costs twenty times as much, and a driver that draws on the processor skips
// pixels that fail the stencil's test, though not those that a shader discards.
precision highp float;
uniform sampler2D u_field;
in vec2 v_uv;

const float kNoLiquid = 2.0e-5;  // of the field; even a film's skirt has more (splat.frag)

void main() {
  if (texture(u_field, v_uv).w < kNoLiquid) discard;
}
