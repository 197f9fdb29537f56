#include "sample_scene.hpp"

#include <cmath>
#include <numbers>

#include <trocar/render/meshes/openness.hpp>

namespace trocar::render::sample {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Wavy unevenness, so that nothing is a perfect solid.
float waves(Vec3f p, float size) {
  const float k = 2 * kPi / size;
  return std::sin(k * p.x + 1.3f * std::sin(0.7f * k * p.y)) * std::sin(k * p.y + 1.1f * std::sin(0.6f * k * p.z)) +
         0.5f * std::sin(1.9f * k * p.z + std::sin(k * p.x));
}

Shape ball(int rings, Vec3f centre, Vec3f half, float uneven, float wave) {
  Shape s = sheet(2 * rings, rings, [&](float u, float v) {
    const float a = 2 * kPi * u, b = kPi * v;
    const Vec3f d{std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a)};
    const Vec3f p = centre + Vec3f{half.x * d.x, half.y * d.y, half.z * d.z};
    return p + (uneven * waves(p, wave)) * d;
  });
  for (std::size_t i = 0; i + 2 < s.triangles.size(); i += 3) std::swap(s.triangles[i + 1], s.triangles[i + 2]);
  return s;
}

std::vector<Vec3f> curve(Vec3f a, Vec3f b, Vec3f c, Vec3f d, int n, float wiggle) {
  std::vector<Vec3f> path;
  for (int i = 0; i <= n; ++i) {
    const float t = float(i) / float(n), s = 1 - t;
    Vec3f p = s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
    p.z += wiggle * std::sin(19 * t);
    p.y += wiggle * std::cos(15 * t);
    path.push_back(p);
  }
  return path;
}

std::vector<float> radii(int n, float a, float b, float uneven) {
  std::vector<float> r;
  for (int i = 0; i <= n; ++i) {
    const float t = float(i) / float(n);
    r.push_back((a + (b - a) * t) * (1 + uneven * std::sin(31 * t)));
  }
  r.front() *= 0.05f;
  r.back() *= 0.05f;
  return r;
}

Material tissue(Vec3f a, Vec3f b, Vec3f c) {
  Material m;
  m.colour = a;
  m.colour_b = b;
  m.colour_c = c;
  return m;
}

Material uterus() {
  Material m = tissue(srgb(196, 140, 142), srgb(205, 156, 156), srgb(180, 116, 120));
  m.vessels = 0.55f;
  m.vessel_tile = 0.05f;
  m.mottle_size = 0.011f;
  return m;
}
Material fallopian() {
  Material m = tissue(srgb(196, 124, 124), srgb(206, 142, 138), srgb(176, 98, 100));
  m.vessels = 0.8f;
  m.vessel_tile = 0.022f;
  m.mottle_size = 0.006f;
  m.glow_amount = 0.15f;
  m.tint = srgb(190, 92, 96);
  return m;
}
Material ovary() {
  Material m = tissue(srgb(222, 198, 186), srgb(228, 206, 190), srgb(206, 170, 158));
  m.mottle_size = 0.004f;
  m.lobule_size = 0.005f;
  m.lobule_depth = 0.12f;
  m.lobule_contrast = 0.15f;
  m.vessels = 0.3f;
  return m;
}
Material peritoneum() {
  Material m = tissue(srgb(176, 104, 98), srgb(188, 122, 108), srgb(158, 82, 80));
  m.vessels = 0.9f;
  m.vessel_tile = 0.06f;
  m.mottle_size = 0.02f;
  m.mottle = 0.6f;
  return m;
}
Material fat() {
  Material m = tissue(srgb(214, 156, 118), srgb(222, 172, 124), srgb(204, 134, 104));
  m.lobule_size = 0.0045f;
  m.lobule_depth = 0.3f;
  m.lobule_contrast = 0.5f;
  m.wrap = {0.6f, 0.4f, 0.3f};
  m.vessels = 0.6f;
  m.vessel_tile = 0.03f;
  m.glow_amount = 0.12f;
  return m;
}
Material bowel() {
  Material m = tissue(srgb(200, 128, 122), srgb(208, 150, 140), srgb(184, 104, 104));
  m.vessels = 0.8f;
  m.vessel_tile = 0.035f;
  return m;
}
Material liver() {
  Material m = tissue(srgb(132, 62, 60), srgb(138, 70, 66), srgb(122, 52, 52));
  m.mottle_size = 0.0018f;
  m.mottle = 0.35f;
  m.bump = 0.05f;
  return m;
}
Material steel() {
  Material m;
  m.shading = Shading::metal;
  m.colour = srgb(168, 168, 172);
  m.colour_b = srgb(150, 150, 156);
  m.tint = srgb(30, 30, 32);
  m.roughness = 0.42f;
  m.mottle_size = 0.0025f;
  m.fibre_stretch = 14;
  m.bump = 0.06f;
  return m;
}
Material blood_pool() {
  Material m = tissue(srgb(96, 10, 12), srgb(92, 9, 11), srgb(86, 8, 10));
  m.shading = Shading::fluid;
  m.wetness = 1;
  m.film_bump = 0.06f;
  m.film_roughness = 0.08f;
  m.density = 5;
  m.bump = 0;
  return m;
}

struct Piece {
  Shape shape;
  Material material;
  bool translucent = false;
};

std::vector<Piece> pelvis(bool hurt) {
  std::vector<Piece> pieces;
  const auto wall = [](float u, float v) {
    const float a = kPi * (0.02f + 0.96f * u), b = kPi * (v - 0.5f) * 0.96f;
    Vec3f p{-0.085f * std::cos(a) * std::cos(b), 0.075f * std::sin(b), -0.075f * std::sin(a) * std::cos(b)};
    const Vec3f d = normalised(p);
    p += (0.0035f * waves(p, 0.045f) + 0.0012f * waves(p + Vec3f{0.3f, 0, 0.2f}, 0.013f)) * d;
    return p;
  };
  pieces.push_back({sheet(120, 90, wall), peritoneum()});
  Shape pear = ball(60, {0, -0.004f, -0.032f}, {0.025f, 0.031f, 0.022f}, 0.0008f, 0.02f);
  for (Vec3f& p : pear.positions) {
    const float taper = 0.78f + 0.22f * std::min(1.0f, std::max(0.0f, (p.y + 0.03f) / 0.035f));
    p.x *= taper;
  }
  if (hurt)
    for (std::size_t i = 0; i < pear.positions.size(); ++i) {
      const float d = length(pear.positions[i] - Vec3f{0.011f, 0.012f, -0.015f});
      pear.paint[i].burn = std::uint8_t(255 * std::max(0.0f, 1 - d / 0.009f));
      const float e = length(pear.positions[i] - Vec3f{-0.012f, -0.004f, -0.014f});
      pear.paint[i].blood = std::uint8_t(255 * std::max(0.0f, std::min(1.0f, 1.6f - e / 0.006f)));
    }
  pieces.push_back({pear, uterus()});
  for (float side : {-1.0f, 1.0f}) {
    const auto path = curve({side * 0.020f, 0.014f, -0.026f}, {side * 0.036f, 0.030f, -0.020f},
                            {side * 0.058f, 0.020f, -0.022f}, {side * 0.052f, -0.008f, -0.030f}, 70, 0.0012f);
    Shape t = tube(path, radii(70, 0.0022f, 0.0045f, 0.10f), 24);
    for (std::size_t i = 0; i < t.paint.size(); ++i)
      t.paint[i].tint = std::uint8_t(i > t.paint.size() * 4 / 5 ? 200 : 0);
    pieces.push_back({t, fallopian()});
    const auto ligament = curve({side * 0.018f, 0.010f, -0.020f}, {side * 0.04f, 0.035f, -0.008f},
                                {side * 0.06f, 0.04f, -0.010f}, {side * 0.082f, 0.03f, -0.02f}, 40, 0.0004f);
    pieces.push_back({tube(ligament, radii(40, 0.003f, 0.0025f, 0.03f), 18), uterus()});
    pieces.push_back({ball(28, {side * 0.042f, -0.006f, -0.036f}, {0.013f, 0.008f, 0.008f}, 0.0006f, 0.006f), ovary()});
    Shape fold = sheet(40, 16, [&](float u, float v) {
      const Vec3f top = path[std::size_t(u * 60 + 2)];
      const Vec3f low{side * (0.022f + 0.03f * u), -0.016f + 0.01f * u, -0.045f};
      return top + v * (low - top) + Vec3f{0, 0, 0.0012f * std::sin(20 * u) * v};
    });
    Material veil = peritoneum();
    veil.alpha = 0.45f;
    veil.rim_alpha = 0.9f;
    veil.two_sided = true;
    veil.vessel_tile = 0.03f;
    pieces.push_back({fold, veil, true});
  }
  for (int i = 0; i < 5; ++i) {
    const float x = -0.06f + 0.03f * float(i);
    const auto loop = curve({x, -0.075f, -0.03f}, {x + 0.03f, -0.03f, -0.02f - 0.004f * float(i % 2)},
                            {x - 0.02f, -0.045f, -0.028f}, {x + 0.035f, -0.078f, -0.03f}, 60, 0.001f);
    pieces.push_back({tube(loop, radii(60, 0.0105f, 0.011f, 0.04f), 36), i == 2 ? fat() : bowel()});
  }
  Material shaft_steel = steel();
  const std::vector<Vec3f> shaft{{0.075f, 0.07f, 0.052f}, {0.05f, 0.045f, 0.025f}, {0.031f, 0.026f, 0.004f}};
  shaft_steel.fibre_axis = normalised(shaft.back() - shaft.front());
  pieces.push_back({tube(shaft, {0.0025f, 0.0025f, 0.0025f}, 32), shaft_steel});
  const std::vector<Vec3f> jaw{{0.031f, 0.026f, 0.004f}, {0.024f, 0.021f, -0.004f}, {0.0165f, 0.0165f, -0.0110f}};
  pieces.push_back({tube(jaw, {0.0022f, 0.0017f, 0.0008f}, 24), steel()});
  if (hurt) {
    Shape pool = sheet(40, 40, [](float u, float v) {
      const float r = 0.024f * std::sqrt(v), a = 2 * kPi * u;
      return Vec3f{-0.004f + r * std::cos(a) * 1.3f, 0.040f + 0.8f * r * std::sin(a), -0.026f + 0.0006f * (1 - v)};
    });
    for (Paint& p : pool.paint) p.tint = 140;
    pieces.push_back({pool, blood_pool(), true});
  }
  return pieces;
}

std::vector<Piece> upper() {
  std::vector<Piece> pieces;
  const auto dome = [](float u, float v) {
    const float x = 0.18f * (u - 0.5f), y = 0.16f * (v - 0.5f);
    const Vec3f p{x, y, -0.07f - 4.5f * x * x - 3 * y * y};
    return p + Vec3f{0, 0, 0.002f * waves(p, 0.05f)};
  };
  pieces.push_back({sheet(80, 80, dome), peritoneum()});
  pieces.push_back({ball(70, {-0.03f, 0.035f, -0.06f}, {0.07f, 0.038f, 0.028f}, 0.0015f, 0.05f), liver()});
  Material bladder = tissue(srgb(206, 158, 132), srgb(196, 140, 124), srgb(214, 176, 150));
  bladder.vessels = 0.9f;
  bladder.vessel_tile = 0.025f;
  pieces.push_back({ball(50, {0.01f, 0.004f, -0.042f}, {0.016f, 0.030f, 0.014f}, 0.0008f, 0.02f), bladder});
  for (int i = 0; i < 6; ++i) {
    const float x = -0.06f + 0.024f * float(i);
    pieces.push_back({ball(40, {x, -0.035f - 0.006f * float(i % 3), -0.058f + 0.003f * float(i % 2)},
                           {0.019f, 0.020f, 0.013f}, 0.0008f, 0.02f),
                      i == 3 ? bowel() : fat()});
  }
  Material shaft_steel = steel();
  const std::vector<Vec3f> shaft{{0.08f, -0.03f, 0.045f}, {0.045f, -0.012f, -0.005f}, {0.022f, -0.002f, -0.026f}};
  shaft_steel.fibre_axis = normalised(shaft.back() - shaft.front());
  pieces.push_back({tube(shaft, {0.0025f, 0.0025f, 0.0022f}, 32), shaft_steel});
  return pieces;
}

}  // namespace

Shape sphere(Vec3f centre, float radius, int rings) { return ball(rings, centre, {radius, radius, radius}, 0, 1); }

Shape tube(const std::vector<Vec3f>& path, const std::vector<float>& r, int around) {
  const int n = int(path.size()) - 1;
  std::vector<Vec3f> right(path.size()), up(path.size());
  Vec3f last = any_perpendicular(normalised(path[1] - path[0]));
  for (int i = 0; i <= n; ++i) {
    const Vec3f t = normalised(path[std::size_t(std::min(i + 1, n))] - path[std::size_t(std::max(i - 1, 0))]);
    last = normalised(last - dot(last, t) * t);
    right[std::size_t(i)] = last;
    up[std::size_t(i)] = cross(t, last);
  }
  return sheet(around, n, [&](float u, float v) {
    const auto i = std::size_t(v * float(n) + 0.5f);
    const float a = 2 * kPi * u;
    return path[i] + r[i] * (std::cos(a) * right[i] + std::sin(a) * up[i]);
  });
}

MeshHandle create(Backend& backend, const Shape& shape) {
  MeshData data;
  data.positions = shape.positions;
  data.paint = shape.paint;
  data.indices = shape.triangles;
  return backend.create_mesh(data);
}

void build(Backend& backend, int kind, Frame& frame) {
  std::vector<Piece> pieces = kind == 1 ? upper() : pelvis(kind == 2);
  std::vector<Occluder> occluders;
  for (const Piece& piece : pieces)
    if (!piece.translucent) occluders.push_back({piece.shape.positions, piece.shape.triangles});
  const OpennessBaker baker(occluders);
  for (Piece& piece : pieces) {
    std::vector<Vec3f> normals;
    vertex_normals(piece.shape.positions, piece.shape.triangles, normals);
    baker.bake(piece.shape.positions, normals, piece.shape.paint);
    frame.items.push_back({create(backend, piece.shape), piece.material, Mat4{}, piece.translucent});
  }
}

}  // namespace trocar::render::sample
