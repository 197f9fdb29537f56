// Depth of gathered liquid, and by the stencil where it shows: what is shaded afterwards is tested before (as in
// wet_mark.frag).
precision highp float;
in vec2 v_depth_cover;

void main() {
  if (v_depth_cover.y < 0.333) discard;
}
