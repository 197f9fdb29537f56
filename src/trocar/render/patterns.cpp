#include <algorithm>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/render/patterns.hpp>

namespace trocar::render {

namespace {

constexpr int kVolume = 64;

std::uint8_t to_byte(float unit) { return std::uint8_t(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f); }
std::uint8_t signed_byte(float value) { return std::uint8_t(std::clamp(128.0f + 127.0f * value, 0.0f, 255.0f)); }
int wrapped(int i, int n) { return ((i % n) + n) % n; }
float smooth(float t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// Lattice of random values, `cells` a tile edge, interpolated smoothly.
class ValueNoise {
 public:
  ValueNoise(int cells, core::Random& random) : m_cells(cells), m_value(std::size_t(cells) * cells * cells) {
    for (float& v : m_value) v = float(random.uniform(-1, 1));
  }
  /// @param p in cells
  float at(Vec3f p) const {
    const int i = int(p.x), j = int(p.y), k = int(p.z);
    const float u = smooth(p.x - float(i)), v = smooth(p.y - float(j)), w = smooth(p.z - float(k));
    const auto lerp = [](float a, float b, float t) { return a + t * (b - a); };
    const auto row = [&](int dj, int dk) { return lerp(node(i, j + dj, k + dk), node(i + 1, j + dj, k + dk), u); };
    return lerp(lerp(row(0, 0), row(1, 0), v), lerp(row(0, 1), row(1, 1), v), w);
  }

 private:
  float node(int i, int j, int k) const {
    return m_value[std::size_t(wrapped(i, m_cells)) +
                   std::size_t(m_cells) * (wrapped(j, m_cells) + std::size_t(m_cells) * wrapped(k, m_cells))];
  }
  int m_cells;
  std::vector<float> m_value;
};

std::size_t voxel(int i, int j, int k) {
  return std::size_t(wrapped(i, kVolume)) +
         std::size_t(kVolume) * (wrapped(j, kVolume) + std::size_t(kVolume) * wrapped(k, kVolume));
}

/// Where the vessels are drawn.
struct Canvas {
  int size;
  std::vector<float> coverage;

  /// A soft-edged disc; the darkest stroke stays.
  void dab(float x, float y, float radius, float strength, float softness) {
    const float reach = radius + softness;
    for (int j = int(std::floor(y - reach)); j <= int(std::ceil(y + reach)); ++j)
      for (int i = int(std::floor(x - reach)); i <= int(std::ceil(x + reach)); ++i) {
        const float dx = float(i) - x, dy = float(j) - y;
        const float edge = (radius + softness - std::sqrt(dx * dx + dy * dy)) / (2 * softness);
        float& texel = coverage[std::size_t(wrapped(j, size)) * size + wrapped(i, size)];
        texel = std::max(texel, strength * std::clamp(edge, 0.0f, 1.0f));
      }
  }
};

struct Twig {
  float x, y, heading, radius;  // texels, rad
};

/// Grows one tree: a wandering walk that tapers, gives off side branches and forks.
void grow_tree(Canvas& canvas, Twig root, float strength, float softness, float wander, core::Random& random) {
  std::vector<Twig> tips{root};
  constexpr float kThinnest = 0.45f;
  while (!tips.empty()) {
    Twig t = tips.back();
    tips.pop_back();
    float turn = 0;
    const float step = std::max(0.8f, 0.7f * t.radius);
    float until_branch = float(random.uniform(8, 40)) + 9 * t.radius;
    while (t.radius > kThinnest) {
      turn = 0.9f * turn + wander * float(random.uniform(-1, 1));
      t.heading += turn * step / (1 + t.radius);
      t.x += step * float(portable::cos(t.heading));
      t.y += step * float(portable::sin(t.heading));
      canvas.dab(t.x, t.y, t.radius, strength * std::min(1.0f, 0.35f + 0.25f * t.radius), softness);
      t.radius -= 0.0016f * step;
      until_branch -= step;
      if (until_branch > 0) continue;
      const float share = float(random.uniform(0.12, 0.5));  // of r^3, into the side branch
      const float side = random.uniform() < 0.5 ? -1.0f : 1.0f;
      const float child = t.radius * std::cbrt(share);
      if (child > kThinnest) tips.push_back({t.x, t.y, t.heading + side * float(random.uniform(0.5, 1.2)), child});
      t.radius *= std::cbrt(1 - share);
      t.heading -= side * float(random.uniform(0.05, 0.35));
      until_branch = float(random.uniform(8, 50)) + 9 * t.radius;
    }
  }
}

Canvas grown(int size, int trees, float low_radius, float high_radius, float strength, float softness, float wander,
             core::Random& random) {
  Canvas canvas{size, std::vector<float>(std::size_t(size) * size)};
  for (int i = 0; i < trees; ++i) {
    const Twig root{float(random.uniform(0, size)), float(random.uniform(0, size)),
                    float(random.uniform(0, 2 * portable::pi)), float(random.uniform(low_radius, high_radius))};
    grow_tree(canvas, root, strength, softness, wander, random);
  }
  return canvas;
}

}  // namespace

Pattern noise_pattern() {
  core::Random random(0x7e0cA1);
  const ValueNoise coarse(kNoiseFeatures, random), fine(2 * kNoiseFeatures, random);
  std::vector<float> value(std::size_t(kVolume) * kVolume * kVolume);
  const float cells = float(kNoiseFeatures) / kVolume;
  for (int k = 0; k < kVolume; ++k)
    for (int j = 0; j < kVolume; ++j)
      for (int i = 0; i < kVolume; ++i) {
        const Vec3f p = cells * Vec3f{float(i), float(j), float(k)};
        value[voxel(i, j, k)] = 0.62f * coarse.at(p) + 0.38f * fine.at(2.0f * p);
      }
  Pattern pattern{kVolume, 4, std::vector<std::uint8_t>(4 * value.size())};
  constexpr float kSlopeScale = 3.0f;
  for (int k = 0; k < kVolume; ++k)
    for (int j = 0; j < kVolume; ++j)
      for (int i = 0; i < kVolume; ++i) {
        const auto slope = [&](int di, int dj, int dk) {
          return signed_byte(kSlopeScale *
                             (value[voxel(i + di, j + dj, k + dk)] - value[voxel(i - di, j - dj, k - dk)]));
        };
        std::uint8_t* texel = &pattern.texels[4 * voxel(i, j, k)];
        texel[0] = slope(1, 0, 0);
        texel[1] = slope(0, 1, 0);
        texel[2] = slope(0, 0, 1);
        texel[3] = to_byte(0.5f + 0.75f * value[voxel(i, j, k)]);
      }
  return pattern;
}

Pattern cell_pattern() {
  core::Random random(0xCE115);
  constexpr int n = kCellFeatures;
  std::vector<Vec3f> centre(std::size_t(n) * n * n);
  for (Vec3f& c : centre)
    c = {float(random.uniform(0.1, 0.9)), float(random.uniform(0.1, 0.9)), float(random.uniform(0.1, 0.9))};
  Pattern pattern{kVolume, 4, std::vector<std::uint8_t>(std::size_t(4) * kVolume * kVolume * kVolume)};
  for (int k = 0; k < kVolume; ++k)
    for (int j = 0; j < kVolume; ++j)
      for (int i = 0; i < kVolume; ++i) {
        const Vec3f p = (float(n) / kVolume) * Vec3f{float(i), float(j), float(k)};
        const int ci = int(p.x), cj = int(p.y), ck = int(p.z);
        float nearest = 1e9f, second = 1e9f;
        Vec3f to_nearest;
        for (int dk = -1; dk <= 1; ++dk)
          for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) {
              const Vec3f jitter = centre[std::size_t(wrapped(ci + di, n)) +
                                          n * (wrapped(cj + dj, n) + std::size_t(n) * wrapped(ck + dk, n))];
              const Vec3f d = p - (Vec3f{float(ci + di), float(cj + dj), float(ck + dk)} + jitter);
              const float distance = length(d);
              if (distance < nearest) {
                second = nearest;
                nearest = distance;
                to_nearest = d;
              } else if (distance < second) {
                second = distance;
              }
            }
        std::uint8_t* texel = &pattern.texels[4 * voxel(i, j, k)];
        texel[0] = signed_byte(to_nearest.x);
        texel[1] = signed_byte(to_nearest.y);
        texel[2] = signed_byte(to_nearest.z);
        texel[3] = to_byte(second - nearest);
      }
  return pattern;
}

Pattern vessel_pattern() {
  constexpr int size = 1024;
  core::Random random(0x5E55E1);
  constexpr float largest = 0.5f * size / kVesselTileWidth;
  Canvas red = grown(size, 5, 0.3f * largest, 0.5f * largest, 1.0f, 0.8f, 0.5f, random);
  const Canvas capillaries = grown(size, 46, 1.0f, 2.0f, 0.8f, 0.7f, 0.6f, random);
  for (std::size_t i = 0; i < red.coverage.size(); ++i)
    red.coverage[i] = std::max(red.coverage[i], capillaries.coverage[i]);
  const Canvas veins = grown(size, 3, 0.6f * largest, largest, 0.9f, 3.0f, 0.35f, random);
  Pattern pattern{size, 2, std::vector<std::uint8_t>(std::size_t(2) * size * size)};
  for (std::size_t i = 0; i < red.coverage.size(); ++i) {
    pattern.texels[2 * i] = to_byte(red.coverage[i]);
    pattern.texels[2 * i + 1] = to_byte(veins.coverage[i]);
  }
  return pattern;
}

}  // namespace trocar::render
