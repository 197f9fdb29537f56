precision highp float;
out vec4 o_colour;

// Alpha is a distance: outside the view counts as a working distance away, so that mean depths near the rim do not jump.
void main() { o_colour = vec4(0.0, 0.0, 0.0, 0.09); }
