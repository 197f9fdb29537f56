#include <algorithm>
#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/fluids/film_splats.hpp>
#include <trocar/view/fluids/pool_drawing.hpp>

namespace trocar::view {
namespace {

using render::Liquid;
using render::Splat;

// Our choice, all of them.
// What runs down a wall is no pool: where the floor is steeper than this and what is on it shallow it is drawn as film.
constexpr float kLevelFloor = 0.35f, kSteepFloor = 0.8f;         // rise over run
constexpr float kDeep = 0.0045f;                                 // [m]
constexpr float kThickestRun = 48e-6f, kThickestStain = 22e-6f;  // [m] of what is drawn so, and of a tide's mark
constexpr float kBelowPool = 0.7f;                               // cover of what the sheet hides
constexpr float kTide = 0.0045f;                                 // [m] how far it reaches

// Some of it runs ahead of the rest in tongues.
constexpr float kTongues = 0.55f;                               // of blocks that have one
constexpr float kShortTongue = 0.003f, kLongTongue = 0.0085f;   // [m]
constexpr float kTongueWide = 0.00055f;                         // [m] half of it
constexpr float kTongueThick = 1.5f, kThickestTongue = 26e-6f;  // over the film's; [m]
constexpr int kPoolRunBends = 3;

float smooth_step(float x) { return float(smooth(0.0, 1.0, double(x))); }

/// A thin run from the middle of a stain down, in bends, with a bead at its end.
void list_tongue(const Splat& stain, std::uint32_t id, Liquid& liquid) {
  const Vec3f along = liquid.down - dot(liquid.down, stain.normal) * stain.normal, across = cross(stain.normal, along);
  const float far = kShortTongue + (kLongTongue - kShortTongue) * std::fabs(own(id, 61));
  Splat s = stain;
  s.radius = kTongueWide * (1 + 0.4f * own(id, 62));
  s.height = std::min(kTongueThick * stain.height, kThickestTongue);
  s.to = 0.5f * (stain.from + stain.to);
  for (int bend = 0; bend < kPoolRunBends; ++bend) {
    s.from = s.to;
    s.to = s.from + (far / kPoolRunBends) * (along + 0.2f * own(id, 63 + bend) * across);
    liquid.splats.push_back(s);
  }
  s.from = s.to;
  s.radius *= 1.4f;
  liquid.splats.push_back(s);
}

}  // namespace

/// Rise of the floor over a cell's width, along both axes.
std::array<float, 2> PoolDrawing::floor_rise(std::span<const float> floor, int i, int j) const {
  const fluids::PoolModel& m = m_model->pool;
  const int west = std::max(i - 1, 0), east = std::min(i + 1, m.nx - 1);
  const int south = std::max(j - 1, 0), north = std::min(j + 1, m.ny - 1);
  const float cell = float(m.cell);
  return {(floor_at(m, floor, east, j) - floor_at(m, floor, west, j)) / (cell * float(east - west)),
          (floor_at(m, floor, i, north) - floor_at(m, floor, i, south)) / (cell * float(north - south))};
}

/// Which share of a cell's fluid runs down a wall, 0 to 1.
float PoolDrawing::runs_down(const fluids::PoolState& pool, std::span<const float> floor, int i, int j) const {
  const float depth = depth_at(m_model->pool, pool, i, j);
  if (!(depth > 0)) return 0;
  const auto [u, v] = floor_rise(floor, i, j);
  const double steep = smooth(double(kLevelFloor), double(kSteepFloor), double(std::hypot(u, v)));
  return float(steep * smooth(double(kDeep), double(kPoolShallow), double(depth)));
}

/// Two by two of the pool's cells, as a place of film on the floor.
FilmPlace PoolDrawing::block_of(std::span<const float> floor, int i, int j) const {
  const fluids::PoolModel& m = m_model->pool;
  const auto at = [&](int a, int b) {
    return double(floor_at(m, floor, std::min(i + a, m.nx - 1), std::min(j + b, m.ny - 1)));
  };
  const auto [u, v] = floor_rise(floor, i, j);
  FilmPlace place;
  place.position =
      vec_cast<float>(world(m, (i + 1) * m.cell, (j + 1) * m.cell, 0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))));
  place.normal = vec_cast<float>(normalised(m.up - double(u) * m.u - double(v) * m.v, m.up));
  place.area = 4 * float(m.cell * m.cell) * std::sqrt(1 + u * u + v * v);
  return place;
}

/// What runs down walls into the pool, and the stain that it leaves beyond its border where it has been.
void PoolDrawing::list_runs(const FluidSight& sight, Liquid& liquid) const {
  const fluids::PoolModel& m = m_model->pool;
  const Vec3f down = normalised(vec_cast<float>(m_model->droplets.gravity), Vec3f{0, 0, -1});
  const float now = now_of(m_model->droplets, sight.state.droplets);
  for (int j = m_window.j0 & 1; j + 1 < m_window.height; j += 2)
    for (int i = m_window.i0 & 1; i + 1 < m_window.width; i += 2) {
      const std::size_t k = std::size_t(j) * m_window.width + i;
      const int ci = m_window.i0 + i, cj = m_window.j0 + j;
      const float runs = runs_down(sight.state.pool, sight.floor, ci, cj) * depth_at(m, sight.state.pool, ci, cj);
      // Far off, or below the pool.
      if ((m_known[k] <= 0 && !(runs > 0)) || m_depth[k] > kPoolShallow || m_cover[k] > kBelowPool) continue;
      const FilmPlace place = block_of(sight.floor, ci, cj);
      int wet_i = ci, wet_j = cj;
      float thickness = std::min(0.3f * runs, kThickestRun) * rivulets(place, down);
      if (!(thickness > 2e-6f)) thickness = tide_mark(i, j, place, wet_i, wet_j);
      if (!(thickness > 1.5e-6f)) continue;
      Splat s = stain(place, thickness * place.area, float(varied(ci + 977 * cj, 5)), down);
      const Vec3f middle = 0.5f * (s.from + s.to), half = 0.2f * (s.to - s.from);  // blocks overlap enough
      const Vec3f shift = float(m.cell) * Vec3f{own(std::uint32_t(ci), cj), own(std::uint32_t(cj), ci + 7), 0.0f};
      const Vec3f aside = 0.7f * (shift - dot(shift, s.normal) * s.normal);
      s.from = middle - half + aside, s.to = middle + half + aside;
      s.radius = 1.25f * float(m.cell);
      s.height = thickness;
      s.share = shares_of(mix_at(m, sight.state.pool, wet_i, wet_j));
      s.dark = darkness(now, sight.state.pool.shed, s.share);
      liquid.splats.push_back(s);
      const auto id = std::uint32_t(ci + 977 * cj);
      if (runs > 0 && std::fabs(own(id, 60)) < kTongues) list_tongue(s, id, liquid);
    }
}

/// How thick the stain beside the pool is on a block of cells that is not wet [m], and which wet cell is nearest.
float PoolDrawing::tide_mark(int i, int j, const FilmPlace& place, int& wet_i, int& wet_j) const {
  const int reach = std::max(1, int(std::lround(double(kTide) / m_model->pool.cell)));
  const float tide = near_pool(i, j, reach, wet_i, wet_j);
  const float uneven = 0.5f + 0.6f * float(waves(vec_cast<double>(place.position), 0.008));
  return kThickestStain * tide * smooth_step(uneven + 0.8f * tide - 0.45f);
}

/// How near the pool is to a dry cell of the window, 1 beside it, 0 at `reach` cells; and which cell of it.
float PoolDrawing::near_pool(int i, int j, int reach, int& wet_i, int& wet_j) const {
  const int w = m_window.width, h = m_window.height;
  float nearest = float(reach) + 0.5f;
  for (int b = std::max(j - reach, 0); b <= std::min(j + reach, h - 1); ++b)
    for (int a = std::max(i - reach, 0); a <= std::min(i + reach, w - 1); ++a) {
      const float far = std::hypot(float(a - i), float(b - j));
      if (m_depth[std::size_t(b) * w + a] < 0.0008f || far >= nearest) continue;
      nearest = far;
      wet_i = m_window.i0 + a, wet_j = m_window.j0 + b;
    }
  return std::max(0.0f, 1 - nearest / (float(reach) + 0.5f));
}

}  // namespace trocar::view
