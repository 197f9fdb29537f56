#include <algorithm>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/render/meshes/patterns.hpp>

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

/// Where the vessels are drawn: a picture that tiles.
struct Canvas {
  Canvas(int width, int height) : size(width), rows(height), coverage(std::size_t(width) * height) {}

  int size, rows;
  std::vector<float> coverage;

  float at(float x, float y) const {
    return coverage[std::size_t(wrapped(int(std::floor(y)), rows)) * size + wrapped(int(std::floor(x)), size)];
  }

  /// A soft-edged disc; the darkest stroke stays.
  void dab(float x, float y, float radius, float strength, float softness) {
    const float reach = radius + softness;
    for (int j = int(std::floor(y - reach)); j <= int(std::ceil(y + reach)); ++j)
      for (int i = int(std::floor(x - reach)); i <= int(std::ceil(x + reach)); ++i) {
        const float dx = float(i) - x, dy = float(j) - y;
        const float edge = (radius + softness - std::sqrt(dx * dx + dy * dy)) / (2 * softness);
        float& texel = coverage[std::size_t(wrapped(j, rows)) * size + wrapped(i, size)];
        texel = std::max(texel, strength * std::clamp(edge, 0.0f, 1.0f));
      }
  }
};

struct Twig {
  float x, y, goal, radius;  // texels, the direction it strives in [rad]
  float until_fork;          // texels
};

/// How a kind of vessel grows.
struct Habit {
  int trees;
  float thinnest, thickest;  ///< radius of a root [texels]
  float strength, softness;  ///< of the stroke
  float wander;              ///< how much it meanders [rad]
  bool spares = false;       ///< it leaves some places bare
};

constexpr float kThinnestTwig = 0.5f;
constexpr float kTwig = 2.4f;      // texels of radius: what is thicker runs through a bare place, too
constexpr float kThins = 0.0022f;  // of its radius that a twig loses a texel ...
constexpr float kDies = 0.035f;    // ... and what more it does in a bare place

/// 0 .. 1: half of a serosa is nearly bare. Tiles.
float bare(float x, float y, int size) {
  const double u = 2 * portable::pi * double(x) / size, v = 2 * portable::pi * double(y) / size;
  const double wave = portable::sin(2 * u + 1.1 * portable::sin(v)) * portable::cos(v - 0.8 * portable::sin(u)) +
                      0.55 * portable::sin(3 * v + u + 1.3);
  return smooth(std::clamp(0.5f + 1.4f * float(wave), 0.0f, 1.0f));
}

float until_fork(float radius, core::Random& random) { return float(random.uniform(10, 28)) + 11 * radius; }

/// A vessel that comes upon another one runs into it, thinner: it has no blunt end before it.
void join(Canvas& canvas, const Twig& t, float heading, float way, const Habit& habit) {
  constexpr float kStep = 0.5f;  // texels
  const float x = float(portable::cos(heading)), y = float(portable::sin(heading));
  for (float s = 0; s < way; s += kStep) {
    const float radius = std::max(kThinnestTwig, t.radius * (1 - 0.75f * s / way));
    canvas.dab(t.x + s * x, t.y + s * y, radius, habit.strength * std::min(1.0f, 0.3f + 0.25f * radius),
               habit.softness);
  }
}

/// One branch from where it starts to where it thins out or meets another vessel; its forks go onto `tips`.
/// Murray's law at each fork: r0^3 = r1^3 + r2^3.
void grow_branch(Canvas& canvas, Twig t, const Habit& habit, std::vector<Twig>& tips, core::Random& random) {
  float meander = 0, bend = 0, age = 0;
  float side = random.uniform() < 0.5 ? -1.0f : 1.0f;
  const float born_radius = t.radius;
  while (t.radius > kThinnestTwig) {
    const float step = std::max(0.7f, 0.4f * t.radius);
    // The heading swings about the goal (a damped, randomly pushed swing), and the goal itself drifts.
    const float reach = 5 + 5 * t.radius;
    bend += (step / reach) * (-1.6f * bend - 1.2f * meander + 2.6f * habit.wander * float(random.uniform(-1, 1)));
    meander += (step / reach) * bend * 2;
    t.goal += 0.05f * std::sqrt(step / reach) * float(random.uniform(-1, 1));
    const float heading = t.goal + meander;
    t.x += step * float(portable::cos(heading));
    t.y += step * float(portable::sin(heading));
    age += step;
    const float ahead = 2.5f * t.radius + 3;
    if (age > 3 * born_radius + 14 &&
        canvas.at(t.x + ahead * float(portable::cos(heading)), t.y + ahead * float(portable::sin(heading))) > 0.15f)
      return join(canvas, t, heading, ahead, habit);
    const float tone = std::min(1.0f, 0.3f + 0.25f * t.radius);
    canvas.dab(t.x, t.y, t.radius, habit.strength * tone, habit.softness);
    t.radius -= kThins * step;
    if (habit.spares && t.radius < kTwig) t.radius -= kDies * bare(t.x, t.y, canvas.size) * step;
    t.until_fork -= step;
    if (t.until_fork > 0) continue;
    const float share = float(random.uniform(0.1, 0.45));  // of r^3, into the side branch
    const float child = t.radius * std::cbrt(share);
    side = random.uniform() < 0.25 ? side : -side;
    if (child > kThinnestTwig)
      tips.push_back({t.x, t.y, t.goal + side * float(random.uniform(0.5, 1.15)), child, until_fork(child, random)});
    t.radius *= std::cbrt(1 - share);
    t.goal -= side * float(random.uniform(0.05, 0.3));
    t.until_fork = until_fork(t.radius, random);
  }
}

/// Each tree is a vessel that comes up from the depth and goes down again: both ways from where it is widest.
void grow(Canvas& canvas, const Habit& habit, core::Random& random) {
  std::vector<Twig> tips;
  for (int i = 0; i < habit.trees; ++i) {
    const float radius = float(random.uniform(habit.thinnest, habit.thickest));
    const float x = float(random.uniform(0, canvas.size)), y = float(random.uniform(0, canvas.rows));
    const float goal = float(random.uniform(0, 2 * portable::pi)), back = goal + float(portable::pi);
    tips.push_back({x, y, goal, radius, until_fork(radius, random)});
    tips.push_back({x, y, back + float(random.uniform(-0.3, 0.3)), radius, until_fork(radius, random)});
  }
  // Breadth first, so that the trunks take their ground before the twigs fill what is left.
  for (std::size_t i = 0; i < tips.size(); ++i) grow_branch(canvas, Twig(tips[i]), habit, tips, random);
}

/// Arteries and veins as the two channels of a picture.
Pattern pattern_of(const Canvas& red, const Canvas& veins, int rows) {
  Pattern pattern{red.size, 2, std::vector<std::uint8_t>(2 * red.coverage.size()), rows};
  for (std::size_t i = 0; i < red.coverage.size(); ++i) {
    pattern.texels[2 * i] = to_byte(red.coverage[i]);
    pattern.texels[2 * i + 1] = to_byte(veins.coverage[i]);
  }
  return pattern;
}

}  // namespace

Pattern noise_pattern() {
  core::Random random(0x7e0cA1);
  const ValueNoise coarse(kNoiseFeatures, random), fine(2 * kNoiseFeatures, random), grit(4 * kNoiseFeatures, random);
  std::vector<float> value(std::size_t(kVolume) * kVolume * kVolume), rough = value;
  const float cells = float(kNoiseFeatures) / kVolume;
  for (int k = 0; k < kVolume; ++k)
    for (int j = 0; j < kVolume; ++j)
      for (int i = 0; i < kVolume; ++i) {
        const Vec3f p = cells * Vec3f{float(i), float(j), float(k)};
        value[voxel(i, j, k)] = 0.62f * coarse.at(p) + 0.38f * fine.at(2.0f * p);
        // Slopes have a third octave: it breaks highlights into flecks, which smooth noise would bend into rings.
        rough[voxel(i, j, k)] = value[voxel(i, j, k)] + 0.16f * grit.at(4.0f * p);
      }
  Pattern pattern{kVolume, 4, std::vector<std::uint8_t>(4 * value.size())};
  constexpr float kSlopeScale = 3.0f;
  for (int k = 0; k < kVolume; ++k)
    for (int j = 0; j < kVolume; ++j)
      for (int i = 0; i < kVolume; ++i) {
        const auto slope = [&](int di, int dj, int dk) {
          return signed_byte(kSlopeScale *
                             (rough[voxel(i + di, j + dj, k + dk)] - rough[voxel(i - di, j - dj, k - dk)]));
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
  Canvas red(size, size), veins = red;
  grow(red, {3, 0.6f * largest, 0.8f * largest, 1.0f, 0.8f, 1.1f, true}, random);
  grow(red, {14, 1.6f, 2.6f, 0.9f, 0.75f, 1.3f, true}, random);
  grow(red, {70, 1.0f, 1.5f, 0.7f, 0.65f, 1.4f, true}, random);
  grow(veins, {4, 0.7f * largest, largest, 0.9f, 2.0f, 0.8f}, random);
  return pattern_of(red, veins, 0);
}

namespace {

/// A twig of a fold: winds, thins out, forks at an acute angle, and ends before the fold's borders.
struct FoldTwig {
  float x, y, heading, radius, length;  // texels, [rad]
  int forks;
};

void grow_twig(Canvas& canvas, const FoldTwig& twig, core::Random& random) {
  float x = twig.x, y = twig.y, side = random.uniform() < 0.5 ? -1.0f : 1.0f;
  const float phase = float(random.uniform(0, 6)), reach = 9 + 5 * twig.radius;
  float fork = twig.length * float(random.uniform(0.22, 0.4));
  int forks = twig.forks;
  for (float way = 0; way < twig.length; way += 0.8f) {
    if (y < 4 || y > float(canvas.rows) - 5) return;
    const float left = 1 - way / twig.length;
    canvas.dab(x, y, std::max(0.5f, twig.radius * (0.3f + 0.7f * left)), 0.5f + 0.45f * std::min(1.0f, 2.5f * left),
               0.8f);
    const float heading = twig.heading + 0.38f * float(portable::sin(double(way / reach + phase))) +
                          0.2f * float(portable::sin(double(2.7f * way / reach + 2 * phase)));
    x += 0.8f * float(portable::cos(double(heading)));
    y += 0.8f * float(portable::sin(double(heading)));
    fork -= 0.8f;
    if (fork > 0 || forks == 0) continue;
    --forks;
    side = -side;
    fork = twig.length * float(random.uniform(0.15, 0.35));
    grow_twig(canvas,
              {x, y, heading + side * float(random.uniform(0.5, 0.95)), twig.radius * (0.3f + 0.5f * left),
               (0.35f + 0.4f * left) * twig.length * float(random.uniform(0.6, 1.0)), forks},
              random);
  }
}

}  // namespace

Pattern arcade_pattern() {
  constexpr int size = 1024, rows = 512;
  core::Random random(0xA2CADE);
  Canvas red(size, rows), veins = red;
  const auto arch = [](float x) {  // where the arcade runs
    const float k = 2 * float(portable::pi) * x / size;
    return 0.25f * rows + 26 * float(portable::sin(double(2 * k))) + 12 * float(portable::sin(double(5 * k + 1))) +
           5 * float(portable::sin(double(17 * k))) + 2.5f * float(portable::sin(double(41 * k + 2)));
  };
  // Feeders come up from the root, lean over into the arcade, and are widest there; between two of them it is narrow.
  constexpr float kJoins[] = {0.15f * size, 0.47f * size, 0.83f * size};
  const auto from_feeder = [&](float x) {
    float least = size;
    for (const float join : kJoins)
      for (const float turn : {-float(size), 0.0f, float(size)}) least = std::min(least, std::fabs(x + turn - join));
    return std::min(1.0f, least / (0.19f * size));
  };
  for (float x = 0; x < size; x += 0.7f) {
    const float narrow = 1 - 0.62f * from_feeder(x);
    red.dab(x, arch(x), 4.6f * narrow, 1, 0.9f);
    veins.dab(x, arch(x + 6) + 15, 6.5f * narrow, 0.9f, 2.2f);
  }
  float lean = 0.34f * rows;
  for (const float join : kJoins) {
    for (float u = 0; u <= 1; u += 0.002f) {  // u: from the arcade down, along it first
      const float sway = 8 * float(portable::sin(double(7 * u + join))) + 4 * float(portable::sin(double(23 * u)));
      const float x = join + lean * u * (1.6f - 0.6f * u) + u * (2 - u) * sway;
      const float y = arch(join) + (rows - 1 - arch(join)) * u * (0.45f + 0.55f * u);
      red.dab(x, y, 3.6f + 0.9f * u, 1, 0.9f);
      veins.dab(x + 13, y, 5.2f + 1.4f * u, 0.9f, 2.2f);
    }
    lean = -0.8f * lean;
  }
  // Twigs to the tube leave it at acute angles, some to either side; fewer and finer ones to the root.
  float side = 1;
  for (float x = 0; x < size; x += float(random.uniform(18, 58))) {
    side = random.uniform() < 0.3 ? side : -side;
    const bool down = random.uniform() < 0.25;
    const float steep = float(random.uniform(0.75, 1.25)) * (down ? 1.0f : -1.0f);
    const float heading = side > 0 ? steep : float(portable::pi) - steep;
    const float radius = float(random.uniform(0.8, 2.1)) * (down ? 0.8f : 1.0f) * (1 - 0.35f * from_feeder(x));
    grow_twig(red, {x, arch(x), heading, radius, float(random.uniform(70, 210)), 3}, random);
    if (radius > 1.5f) grow_twig(veins, {x + 6, arch(x) + 6, heading, 1.5f * radius, 90, 0}, random);
  }
  grow(red, {6, 1.2f, 1.8f, 0.75f, 0.75f, 1.3f}, random);
  grow(red, {26, 0.8f, 1.2f, 0.65f, 0.7f, 1.4f}, random);
  return pattern_of(red, veins, rows);
}

namespace {

/// A branch of a wall's tree, as an artery, a vein or both side by side.
struct Branch {
  float x, y, goal, radius, length;  // texels, heading [rad]
  int order;                         // 0 trunk
  bool red, vein;
};

/// A point of a path as it is drawn: with its share of the way and its heading.
void dab_pair(Canvas& red, Canvas& veins, const Branch& b, float x, float y, float heading, float share) {
  const float thin = b.order == 0 ? 1.0f : 1 - 0.55f * share;
  const float faint = b.order == 0 ? 1.0f : std::min(1.0f, (1.15f - share) * (b.order > 1 ? 1.0f : 2.2f));
  const float tone = (b.order == 0 ? 0.95f : b.order == 1 ? 0.85f : 0.72f) * faint;
  const float radius = std::max(0.55f, b.radius * thin);
  const float aside = b.red ? 2.2f * radius + 0.9f : 0.0f;
  if (b.red) red.dab(x, y, radius, tone, 0.9f);
  if (b.vein)
    veins.dab(x - aside * float(portable::sin(double(heading))), y + aside * float(portable::cos(double(heading))),
              1.2f * radius, 0.85f * tone, 1.3f);
}

/// Draws one branch and lists those that leave it.
void grow_lining(Canvas& red, Canvas& veins, const Branch& b, std::vector<Branch>& more, core::Random& random) {
  float x = b.x, y = b.y, sway = 0, turn = 0, side = random.uniform() < 0.5 ? -1.0f : 1.0f;
  float fork = b.length * float(random.uniform(0.12, 0.3));
  const float step = 0.8f, reach = 9 + 7 * b.radius;
  for (float way = 0; way < b.length; way += step) {
    turn += (step / reach) * (-1.5f * turn - 1.1f * sway + 5.5f * float(random.uniform(-1, 1)));
    sway += (step / reach) * 2 * turn;
    const float heading = b.goal + sway;
    x += step * float(portable::cos(double(heading)));
    y += step * float(portable::sin(double(heading)));
    dab_pair(red, veins, b, x, y, heading, way / b.length);
    fork -= step;
    if (fork > 0 || b.order > 2) continue;
    side = random.uniform() < 0.2 ? side : -side;
    const float slimmer = b.order == 0 ? 0.6f : 0.58f, left = b.length - way;
    const bool both = b.order == 0 && random.uniform() < 0.6, redder = random.uniform() < 0.72;
    more.push_back(
        {x, y, heading + side * float(random.uniform(0.5, 1.05)), b.radius * slimmer,
         std::min(b.order == 0 ? 1e9f : 0.8f * left + 14, float(random.uniform(0.5, 1.0)) * (b.order == 0   ? 230.0f
                                                                                             : b.order == 1 ? 105.0f
                                                                                                            : 42.0f)),
         b.order + 1, b.red && (both || redder || !b.vein), b.vein && (both || !redder || !b.red)});
    fork = float(random.uniform(12, 40)) * (b.order == 1 ? 1.0f : 0.7f);
  }
}

}  // namespace

Pattern lining_pattern() {
  constexpr int size = 1024;
  core::Random random(0x11A1A6);
  constexpr float trunk = 0.5f * size / kLiningTileWidth;
  Canvas red(size, size), veins = red;
  std::vector<Branch> branches;
  const auto lay_trunk = [&](float at, float phase, bool artery, float radius) {
    Branch b{0, 0, 0, radius, 0, 0, artery, true};
    float fork = 40, side = 1;
    for (float y = 0; y < size; y += 0.8f) {  // winds, and meets itself over the tile's edge
      const double k = 2 * portable::pi * double(y) / size;
      const float x = at + 36 * float(portable::sin(k + double(phase))) +
                      8 * float(portable::sin(3 * k + 1 + double(phase))) +
                      3.2f * float(portable::sin(7 * k + 2 + double(phase))) + 0.7f * float(portable::sin(19 * k));
      const float slope = float(36 * portable::cos(k + double(phase)) * 2 * portable::pi / size);
      const float heading = 0.5f * float(portable::pi) - slope;
      dab_pair(red, veins, b, x, y, heading, 0);
      fork -= 0.8f;
      if (fork > 0) continue;
      fork = float(random.uniform(45, 100));
      side = -side;
      const bool both = random.uniform() < 0.55;
      branches.push_back({x, y, heading + side * float(random.uniform(0.55, 1.0)), 0.6f * radius,
                          float(random.uniform(150, 290)), 1, artery && (both || random.uniform() < 0.7),
                          both || !artery || random.uniform() < 0.4});
      if (!branches.back().red && !branches.back().vein) branches.back().red = true;
    }
  };
  lay_trunk(0.16f * size, 0.4f, true, trunk);
  lay_trunk(0.66f * size, 2.9f, true, 0.75f * trunk);
  lay_trunk(0.30f * size, 4.6f, false, 0.55f * trunk);
  lay_trunk(0.78f * size, 1.3f, true, 0.45f * trunk);
  for (std::size_t i = 0; i < branches.size(); ++i) grow_lining(red, veins, Branch(branches[i]), branches, random);
  grow(red, {60, 0.8f, 1.2f, 0.6f, 0.8f, 1.5f}, random);  // a fine net between
  return pattern_of(red, veins, 0);
}

}  // namespace trocar::render
