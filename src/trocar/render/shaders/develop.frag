// Scene light to picture values, before the lens: focus, contact shade, veil, exposure, camera curve. Variants: EFFECTS, RODS,
// SMOKE, SAMPLED (what is a shadow's border at an outline has to be as smooth as that).
// The scene's alpha is the distance of the nearest opaque surface [m].
precision highp float;
precision highp int;
uniform sampler2D u_scene;
uniform sampler2D u_small;     // 1/4 of the scene
uniform sampler2D u_smaller;   // 1/16
uniform sampler2D u_exposure;  // stops, one column an eye
uniform vec4 u_camera;         // exposure on top [stops], memory column or -1, bloom, saturation
uniform vec4 u_place;          // radius of the view in picture sizes (x, y), vignette
uniform vec4 u_depth;          // 1 / focus [1/m], aperture [px m], contact, picture height at 1 m [m]
uniform vec2 u_shadow;         // how far towards the lamp to look
uniform vec3 u_white;
#ifdef RODS
#include "shade.glsl"
uniform sampler2D u_rod_shade;  // what instruments leave of the light
#endif
in vec2 v_uv;
out vec4 o_colour;
#ifdef SMOKE
uniform sampler2D u_smoke;  // see smoke.frag
uniform vec3 u_smoke_colour, u_smoke_near;

// From a smaller picture: of the four texels around, those whose surface is about as far off count, so that no smoke
// hangs over an outline.
vec3 in_smoke(vec3 colour, float far) {
  ivec2 size = textureSize(u_smoke, 0);
  vec2 at = v_uv * vec2(size) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 part = at - vec2(low);
  vec3 sum = vec3(0.0);
  float weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 aside = ivec2(k & 1, k >> 1);
    vec4 smoke = texelFetch(u_smoke, clamp(low + aside, ivec2(0), size - 1), 0);
    vec2 share = mix(1.0 - part, part, vec2(aside));
    float w = (share.x * share.y + 0.01) / (0.03 + abs(smoke.a - far) / far);
    sum += w * smoke.rgb;
    weight += w;
  }
  sum /= weight;
  // Light that smoke has turned aside on its way does not meet again: glints go first, then outlines.
  float haze = 1.0 - sum.b;
  vec3 mean = texture(u_smaller, v_uv).rgb;
  colour = mix(colour, min(colour, 1.1 * mean + 0.01), min(3.4 * haze, 1.0));
  colour = mix(colour, texture(u_small, v_uv).rgb, min(1.1 * haze, 0.9));
  return colour * sum.b + u_smoke_colour * sum.r + u_smoke_near * sum.g;
}
#endif

// Camera curve with the display's gamma in it: toe, straight middle, long shoulder, clipped; each channel on its own,
// so that what is bright pales [form after Hejl & Burgess-Dawson 10].
vec3 developed(vec3 x) {
  return clamp(1.25 * x * (6.2 * x + 3.7) / (x * (6.2 * x + 5.4) + 0.78), 0.0, 1.0);
}

const float kSeen = 1.1;   // [px] smaller circles are the camera's own: so is all behind the focus
const float kWide = 8.0;   // [px] larger circles are taken from the small picture, so that taps leave no gaps
const float kMost = 22.0;  // [px]

// Diameter of the circle of confusion of what stands before the focus [px].
float circle_of(float distance) { return u_depth.y * (1.0 / max(distance, 0.002) - u_depth.x); }

#if defined(EFFECTS) || (defined(RODS) && defined(SAMPLED))
// A pixel on an outline has a mean of distances and of lights: shade belongs to that share of it that is behind.
struct Outline {
  float is, behind;       // 0..1: it is one; the share that is behind
  float far;              // [m]
  ivec2 near_at, far_at;  // the pixels beside it
};

Outline on_outline(ivec2 at, float distance, float unit, float near_one) {
  Outline o = Outline(0.0, 1.0, distance, at, at);
  if (near_one < 0.4) return o;
  float nearest = distance;
  for (int k = 0; k < 4; ++k) {
    ivec2 beside = at + (k < 2 ? ivec2(2 * k - 1, 0) : ivec2(0, 2 * k - 5));
    float d = texelFetch(u_scene, beside, 0).a;
    if (d > o.far) o.far = d, o.far_at = beside;
    if (d < nearest) nearest = d, o.near_at = beside;
  }
  float apart = o.far - nearest;
  o.is = clamp(apart / (0.02 * unit) - 0.5, 0.0, 1.0);
  o.behind = clamp((distance - nearest) / max(apart, 0.0001), 0.0, 1.0);
  return o;
}
#endif

#ifdef EFFECTS
// What the surface here gets farther from pixel to pixel [m]: to each side, the smaller of two differences, as in the
// other direction something may stand before it.
vec2 slope_at(ivec2 at, float distance) {
  const int kApart = 8;  // [px] half precision tells no less apart
  vec2 slope;
  for (int k = 0; k < 2; ++k) {
    ivec2 aside = kApart * ivec2(1 - k, k), most = textureSize(u_scene, 0) - 1;
    float on = texelFetch(u_scene, min(at + aside, most), 0).a - distance;
    float back = distance - texelFetch(u_scene, max(at - aside, ivec2(0)), 0).a;
    slope[k] = (abs(on) < abs(back) ? on : back) / float(kApart);
  }
  return slope;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 scene = texelFetch(u_scene, pixel, 0);
  vec3 colour = scene.rgb;
  float outline = 0.0;  // of a thing that stands before others: for the lens pass, which smooths steps there
#if defined(EFFECTS) || (defined(RODS) && defined(SAMPLED))
  vec4 soft = texture(u_small, v_uv);
  float unit = scene.a * u_depth.w;  // height of the picture at this distance
  outline = clamp(abs(scene.a - soft.a) / (unit * 0.007), 0.0, 1.0);
  // A pixel half covered may be as far as the small picture's mean there, but not as far as its neighbours.
  Outline on = on_outline(pixel, scene.a, unit, max(outline, clamp(fwidth(scene.a) / (unit * 0.014), 0.0, 1.0)));
#endif
#ifdef RODS
  vec3 shade = texelFetch(u_rod_shade, pixel, 0).rgb;
#ifdef SAMPLED
  if (on.is > 0.0) {
    vec3 before = texelFetch(u_rod_shade, on.near_at, 0).rgb, behind_it = texelFetch(u_rod_shade, on.far_at, 0).rgb;
    shade = mix(shade, mix(before, behind_it, on.behind), on.is);
  }
#endif
  colour = paled(colour * shaded_by(shade.rg), 1.0 - shade.b);
#endif
#ifdef EFFECTS
  vec4 softer = texture(u_smaller, v_uv + u_shadow);
  // The circle of confusion grows with 1/d: a disc of taps, so that strong lights blur round. What is out of focus covers
  // what is around it as far as that goes, so a near thing's outline is soft, too.
  float nearest = min(scene.a, soft.a), farthest = max(scene.a, soft.a);
  if (softer.a < 0.95 * scene.a) {  // something before it is close by
    vec2 reach = 0.5 * kMost / vec2(textureSize(u_scene, 0));
    for (int k = 0; k < 8; ++k) {
      float far = texture(u_small, v_uv + reach * vec2(cos(0.7854 * float(k)), sin(0.7854 * float(k)))).a;
      nearest = min(nearest, far);
      farthest = max(farthest, far);
    }
  }
  float circle = circle_of(nearest);
  if (circle > kSeen) {
    vec2 radius = 0.5 * min(circle, kMost) / vec2(textureSize(u_scene, 0));
    int taps = circle > 3.0 ? 12 : 5;
    float apart = 1.0 / max(scene.a - nearest, 0.001);
    vec4 before = vec4(0.0), back = vec4(0.0);
    for (int k = 0; k < taps; ++k) {
      float turn = 2.39996 * float(k), out_ = sqrt((float(k) + 0.7) / float(taps));  // a sunflower's seeds
      vec2 at = v_uv + radius * out_ * vec2(cos(turn), sin(turn));
      vec4 tap = circle > kWide ? texture(u_small, at) : texture(u_scene, at);
      vec4 light = vec4(min(tap.rgb, vec3(6.0)), 1.0);
      float near = clamp((scene.a - tap.a) * apart, 0.0, 1.0);  // of a mean of distances: the share that is near
      before += light * near;
      back += light * (1.0 - near);
    }
    vec3 covers = before.rgb / max(before.w, 0.01), covered = back.w > 0.01 ? back.rgb / back.w : covers;
    // What is covered is sharp where that is in focus; a pixel on the outline itself is both.
    float sharp = smoothstep(0.4, 0.8, (scene.a - nearest) / max(farthest - nearest, 0.001));
    covered = mix(covered, colour, sharp * clamp(2.0 - circle_of(scene.a) / kSeen, 0.0, 1.0));
    colour = mix(colour, mix(covered, covers, before.w / float(taps)), min(circle - kSeen, 1.0));
  }
  // Depth darkening [Luft 06]: what lies just behind the mean depth towards the lamp sees less light: a soft shadow to
  // the side that the ring light is off the lens; red stays longest.
  colour = mix(colour, min(colour, 1.4 * soft.rgb), on.is);  // one sample that glitters there would be a spark
  vec2 behind = (vec2(on.far) - vec2(soft.a, softer.a)) / (unit * vec2(0.02, 0.05));
  // What stands far before it touches nothing and leaves no rim (instruments' shadows are another pass); at the border of
  // a mean it seems near, so what is around counts, too. A thread hardly moves the mean: it is looked for where that comes
  // nearer, and what lies here is as dark as without it.
  vec2 touches = clamp(vec2(1.5, 2.2) - behind.y, 0.0, 1.0);
  if (max(behind.x, behind.y) > 0.02) {
    const float kReach = 18.0, kStep = 4.5;  // [px]
    vec2 size = vec2(textureSize(u_scene, 0)), slope = slope_at(pixel, scene.a), nearer = 4.0 * kReach * slope;
    float stands = nearest;
    for (int k = 0; k < 4; ++k) {
      vec2 corner = vec2(ivec2(2 * (k & 1) - 1, (k & 2) - 1));
      float far = texture(u_smaller, v_uv + kReach / size * corner).a;
      stands = min(stands, far);
      nearer -= far * corner;
    }
    touches *= 1.0 - smoothstep(0.08, 0.2, (scene.a - stands) / unit);
    vec2 plane = vec2(0.0, -dot(slope, u_shadow * size) / (0.05 * unit));  // as dark as it is without anything before it
    if (any(greaterThan(behind - plane, vec2(0.02)))) {
      nearer *= kStep / max(length(nearer), 1e-6);
      float line = 0.0, thin = 0.0;
      for (int k = 0; k < 7; ++k) {
        vec2 at = v_uv + float(k) / size * nearer;
        float far = texture(u_small, at).a, before = scene.a + float(k) * dot(slope, nearer) - far;
        if (before <= line) continue;
        line = before;
        thin = (texture(u_smaller, at).a - far) / before;
      }
      float wide = (1.0 - thin) * 32.0 * unit / size.y;  // [m] at most: the coarser mean reaches over 32 pixels
      thin = smoothstep(0.3, 0.55, thin) * smoothstep(0.002, 0.008, line / unit);
      thin *= 1.0 - smoothstep(0.0035, 0.005, wide);
      touches = mix(touches, vec2(1.0), thin);
      behind = mix(behind, plane, thin);
    }
  }
  behind = clamp(behind, 0.0, 1.0) * clamp(3.0 - 0.5 * behind, 0.0, 1.0) * touches;
  float open = 1.0 - u_depth.z * max(0.9 * behind.x, 0.7 * behind.y);
  open = mix(1.0, open, mix(1.0, on.behind, on.is));
  colour *= vec3(open, open * open, open * open);
  colour = mix(colour, min(0.6 * soft.rgb + 0.4 * softer.rgb, vec3(8.0)), u_camera.z);
#endif
#ifdef SMOKE
  colour = in_smoke(colour, scene.a);
#endif
  float stops = u_camera.x;
  if (u_camera.y >= 0.0) stops += texelFetch(u_exposure, ivec2(int(u_camera.y), 0), 0).r;
  vec2 off = (v_uv - 0.5) / u_place.xy;
  float cosine2 = 1.0 / (1.0 + 0.30 * dot(off, off));
  float gain = exp2(stops) * mix(1.0, cosine2 * cosine2, u_place.z);
  vec3 light = max(colour * u_white * gain, 0.0);
  light = max(mix(vec3(dot(light, vec3(0.2126, 0.7152, 0.0722))), light, u_camera.w), 0.0);
  o_colour = vec4(developed(light), 1.0 - outline);
}
