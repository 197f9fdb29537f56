#include <algorithm>
#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/film_splats.hpp>
#include <trocar/view/fluids/pool_drawing.hpp>

namespace trocar::view {
namespace {

using render::Liquid;

constexpr float kWetDepth = 60e-6f;       // [m] at which a cell of the pool counts as wet
constexpr int kPoolMargin = 6;            // cells around the wet ones
constexpr float kOverhang = 0.004f;       // [m] a floor so far above the level is an organ with room below it
constexpr std::uint32_t kNoVertex = ~0u;  // a corner without a vertex

/// Three by three, 1 2 1, in place.
void smooth_once(std::vector<float>& field, std::vector<float>& scratch, int width, int height) {
  scratch.resize(field.size());
  const auto line = [](const std::vector<float>& in, std::vector<float>& out, std::size_t first, std::size_t step,
                       int n) {
    for (int k = 0; k < n; ++k) {
      const std::size_t c = first + step * std::size_t(k);
      const float low = in[k > 0 ? c - step : c], high = in[k + 1 < n ? c + step : c];
      out[c] = 0.25f * low + 0.5f * in[c] + 0.25f * high;
    }
  };
  for (int j = 0; j < height; ++j) line(field, scratch, std::size_t(j) * width, 1, width);
  for (int i = 0; i < width; ++i) line(scratch, field, std::size_t(i), std::size_t(width), height);
}

}  // namespace

void PoolDrawing::list(const FluidSight& sight, Liquid& liquid) {
  list_sheet(sight, liquid);
  list_runs(sight, liquid);
}

bool PoolDrawing::find_window(const fluids::PoolState& pool) {
  const fluids::PoolModel& m = m_model->pool;
  int i0 = m.nx, i1 = -1, j0 = m.ny, j1 = -1;
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i)
      if (depth_at(m, pool, i, j) > 0.3f * kWetDepth) {
        i0 = std::min(i0, i), i1 = std::max(i1, i);
        j0 = std::min(j0, j), j1 = std::max(j1, j);
      }
  if (i1 < 0) {
    m_window = {};
    return false;
  }
  i0 = std::max(i0 - kPoolMargin, 0), j0 = std::max(j0 - kPoolMargin, 0);
  i1 = std::min(i1 + kPoolMargin, m.nx - 1), j1 = std::min(j1 + kPoolMargin, m.ny - 1);
  m_window = {i0, j0, i1 - i0 + 1, j1 - j0 + 1};
  return true;
}

/// Around what is known.
void PoolDrawing::spread_level() {
  const int w = m_window.width, h = m_window.height;
  for (int ring = 0; ring < kPoolMargin + 1; ++ring) {
    std::vector<float>& next = m_scratch;
    next.assign(m_known.begin(), m_known.end());
    for (int j = 0; j < h; ++j)
      for (int i = 0; i < w; ++i) {
        const auto k = std::size_t(j) * w + i;
        if (m_known[k] > 0) continue;
        float sum = 0, weight = 0;
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, h - 1); ++b)
          for (int a = std::max(i - 1, 0); a <= std::min(i + 1, w - 1); ++a) {
            const auto q = std::size_t(b) * w + a;
            if (m_known[q] > 0) sum += m_level[q], weight += 1;
          }
        if (weight > 0) m_level[k] = sum / weight, next[k] = 1;
      }
    m_known.swap(next);
  }
}

/// Depth, cover and level of the cells that are wet and of those around them, smoothed; the level continues beyond the
/// border as if the pool did, so that the border lies where the surface meets what is drawn.
void PoolDrawing::smooth_fields(const fluids::PoolState& pool, std::span<const float> floor) {
  const fluids::PoolModel& m = m_model->pool;
  if (!find_window(pool)) return;
  const int i0 = m_window.i0, j0 = m_window.j0;
  const int w = m_window.width, h = m_window.height;
  for (std::vector<float>* field : {&m_depth, &m_cover, &m_level, &m_known}) field->assign(m_window.size(), 0);
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const auto k = std::size_t(j) * w + i;
      m_depth[k] = depth_at(m, pool, i0 + i, j0 + j) * (1 - runs_down(pool, floor, i0 + i, j0 + j));
      m_cover[k] = std::min(m_depth[k] / kWetDepth, 1.0f);
      m_known[k] = m_cover[k] >= 1 ? 1.0f : 0.0f;
      m_level[k] = (floor_at(m, floor, i0 + i, j0 + j) + m_depth[k]) * m_known[k];
    }
  spread_level();
  // Under what overhangs the pool continues; what stands before it hides that.
  for (std::size_t k = 0; k < m_window.size(); ++k)
    if (m_known[k] > 0 && floor_at(m, floor, i0 + int(k) % w, j0 + int(k) / w) > m_level[k] + kOverhang)
      m_cover[k] = 1, m_depth[k] = std::max(m_depth[k], kPoolShallow);
  for (std::size_t k = 0; k < m_window.size(); ++k)
    if (m_known[k] <= 0) m_level[k] = floor_at(m, floor, i0 + int(k) % w, j0 + int(k) / w);
  smooth_once(m_cover, m_scratch, w, h);
  smooth_once(m_cover, m_scratch, w, h);
  smooth_once(m_depth, m_scratch, w, h);
  smooth_once(m_level, m_scratch, w, h);
}

/// The sheet's vertex there, made when it is first asked for.
std::uint32_t PoolDrawing::corner(const FluidSight& sight, int i, int j, Liquid& liquid) {
  const fluids::PoolModel& m = m_model->pool;
  const fluids::PoolState& pool = sight.state.pool;
  const int w = m_window.width, h = m_window.height;
  const float now = now_of(m_model->droplets, sight.state.droplets);
  const auto cell = [w](int a, int b) { return std::size_t(b) * w + a; };
  std::uint32_t& at_corner = m_corner[cell(i, j)];
  if (at_corner != kNoVertex) return at_corner;
  at_corner = std::uint32_t(liquid.sheet.size());
  const int west = std::max(i - 1, 0), east = std::min(i + 1, w - 1);
  const int south = std::max(j - 1, 0), north = std::min(j + 1, h - 1);
  const double du = double(m_level[cell(east, j)] - m_level[cell(west, j)]) / (m.cell * (east - west));
  const double dv = double(m_level[cell(i, north)] - m_level[cell(i, south)]) / (m.cell * (north - south));
  const int ci = m_window.i0 + i, cj = m_window.j0 + j;
  fluids::Mix mix;
  for (int b = std::max(cj - 1, 0); b <= std::min(cj + 1, m.ny - 1); ++b)
    for (int a = std::max(ci - 1, 0); a <= std::min(ci + 1, m.nx - 1); ++a) mix += mix_at(m, pool, a, b);
  const std::array<float, 3> share = shares_of(mix);
  const auto k = cell(i, j);
  render::SheetVertex v;
  v.position = vec_cast<float>(world(m, (ci + 0.5) * m.cell, (cj + 0.5) * m.cell, double(m_level[k])));
  v.normal = vec_cast<float>(normalised(m.up - du * m.u - dv * m.v, m.up));
  v.depth = m_depth[k];
  v.cover = m_cover[k];
  v.share_b = share[1];
  v.share_c = share[2];
  v.dark = darkness(now, pool.shed, share);
  // Where it is stirred it froths.
  const auto face = std::size_t(m.at(ci, cj));
  const float u = pool.u[face], s = pool.v[face];
  v.froth = float(smooth(0.05, 0.15, double(std::sqrt(u * u + s * s)))) * (1 - 0.6f * share[0]);
  liquid.sheet.push_back(v);
  return at_corner;
}

void PoolDrawing::list_sheet(const FluidSight& sight, Liquid& liquid) {
  smooth_fields(sight.state.pool, sight.floor);
  const int w = m_window.width, h = m_window.height;
  if (w < 2 || h < 2) return;
  m_corner.assign(m_window.size(), kNoVertex);
  const auto cell = [w](int i, int j) { return std::size_t(j) * w + i; };
  for (int j = 0; j + 1 < h; ++j)
    for (int i = 0; i + 1 < w; ++i) {
      const float most = std::max(std::max(m_cover[cell(i, j)], m_cover[cell(i + 1, j)]),
                                  std::max(m_cover[cell(i, j + 1)], m_cover[cell(i + 1, j + 1)]));
      if (most < 0.32f) continue;
      const std::uint32_t a = corner(sight, i, j, liquid), b = corner(sight, i + 1, j, liquid),
                          c = corner(sight, i + 1, j + 1, liquid), d = corner(sight, i, j + 1, liquid);
      liquid.triangles.insert(liquid.triangles.end(), {a, b, c, a, c, d});
    }
}

}  // namespace trocar::view
