// What drops, films and the sheet share: colour of a mix by depth, highlights, and where a point lies in the picture.
uniform vec4 u_kinds[6];  // two rows a kind: absorption [1/m], and more of it in orange; what comes back from the deep, and its weight
uniform float u_orange;   // of what a camera calls red
uniform vec4 u_shine;     // reflectance, (alpha of drops and sheet)^2, (alpha of films)^2, darkness of a clot
uniform mat4 u_projection;
uniform sampler2D u_bed;  // the scene below; alpha: distance [m]
uniform sampler3D u_noise;
uniform vec3 u_tan;       // of half the angles of view, and of how far right the middle looks
uniform vec4 u_size;      // of the scene picture [px], and 1 / it
uniform vec3 u_right, u_up, u_back;  // the eye's axes in the world
uniform vec3 u_down;                 // the way things fall, in the world
uniform vec4 u_eye;       // where it is, and the time [s]

/// Optical depth, per channel, of `amount` metres of each kind along the light's way.
vec3 optical_depth(vec3 amount, float dark) {
  return (u_kinds[0].rgb * amount.x + u_kinds[2].rgb * amount.y + u_kinds[4].rgb * amount.z) * (1.0 + 1.5 * dark);
}

/// What `amount` metres of each kind along the light's way let through. Haemoglobin takes the orange in a camera's red
/// first, so that thin films darken red, too, and what is deep goes on letting the rest of it through.
vec3 let_through(vec3 amount, float dark) {
  vec3 through = exp(-optical_depth(amount, dark));
  float orange = dot(vec3(u_kinds[0].w, u_kinds[2].w, u_kinds[4].w), amount) * (1.0 + 1.5 * dark);
  through.r *= 1.0 - u_orange + u_orange * exp(-orange);
  return through;
}

/// What a bottomless depth of the mix sends back.
vec3 deep_colour(vec3 amount, float dark) {
  vec3 weight = amount * vec3(u_kinds[1].w, u_kinds[3].w, u_kinds[5].w);
  float all = max(weight.x + weight.y + weight.z, 1.0e-12);
  vec3 deep = (u_kinds[1].rgb * weight.x + u_kinds[3].rgb * weight.y + u_kinds[5].rgb * weight.z) / all;
  return deep * (1.0 - u_shine.w * dark);
}

vec3 to_world(vec3 eye) { return u_eye.xyz + u_right * eye.x + u_up * eye.y + u_back * eye.z; }

// Normal distribution of GGX [Walter 07] without its 1/pi, as in surface.frag.
float lobe(float nh, float alpha2) {
  float d = nh * nh * (alpha2 - 1.0) + 1.0;
  return alpha2 / (d * d);
}

/// The lamp in a wet surface.
vec3 highlight(vec3 n, vec3 V, Lit lit, float alpha2) {
  float nh = clamp(dot(n, normalize(lit.direction + V)), 0.0, 1.0);
  float facing = clamp(4.0 * dot(n, lit.direction), 0.0, 1.0);
  return LIGHT_COLOUR * (0.31 * u_shine.x * lobe(nh, alpha2) * facing * lit.power);
}

/// The lamp's share in what is seen of tissue: whiter than any, and brighter than any could be in this light. A film on
/// it shines there as well, and colours only what comes from below it.
float glint_of(vec3 seen, Lit lit) {
  const float kPalest = 0.60, kBrightest = 0.30;  // green to red, and green to the lamp; our choice
  float white = (seen.g - kPalest * seen.r) / (1.0 - kPalest);
  return max(min(white, seen.g - kBrightest * (lit.power + BOUNCE.g * lit.bounce)), 0.0);
}

/// Reflectance at this angle [Schlick 94].
float mirror_share(float nv) {
  float g = 1.0 - nv, g2 = g * g;
  return u_shine.x + (1.0 - u_shine.x) * g2 * g2 * g;
}

/// Where an eye-space point is in the picture, 0..1.
vec2 in_picture(vec3 eye) {
  return 0.5 + 0.5 * (eye.xy / max(-eye.z, 1.0e-4) - vec2(u_tan.z, 0.0)) / u_tan.xy;
}
