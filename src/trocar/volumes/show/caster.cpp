#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <trocar/core/instruction_set.hpp>
#include <trocar/core/require.hpp>
#include <trocar/volumes/show/caster.hpp>
#include <trocar/volumes/show/caster_kernel.hpp>
#include <trocar/volumes/show/cells.hpp>

namespace trocar::volumes {
namespace {

constexpr int kTile = 32;  // pixels along each side
constexpr double kHiddenOpacity = 1e-3;

struct Rung {
  int shrink;
  double step;
  bool fine;
  double cost;  // about, of the first
};
constexpr Rung kLadder[] = {{1, 0.5, true, 1},    {1, 1, true, 0.55},  {1, 1, false, 0.4},
                            {1, 1.5, false, 0.3}, {2, 1, false, 0.12}, {2, 2, false, 0.06},
                            {3, 2, false, 0.03},  {3, 3, false, 0.02}, {4, 4, false, 0.01}};

/// From places in the scene [m] to voxels: p -> turn p + shift.
struct IntoVoxels {
  Mat3d turn;
  Vec3d shift;

  explicit IntoVoxels(const Grid& grid) {
    const Mat3d from_patient = inverse(grid.step());
    turn = 1e3 * (from_patient * transposed(kSceneFromPatient));
    shift = -(from_patient * grid.origin);
  }
};

void put(float (&to)[3], Vec3d v) {
  for (int k = 0; k < 3; ++k) to[k] = float(v[k]);
}

}  // namespace

const CasterKernel& caster_kernel() noexcept {
  static const CasterKernel* const sets[] = {caster_avx2(), caster_plain()};
  static const char* const names[] = {"avx2", "plain"};
  static const CasterKernel* const chosen = core::widest(sets, names, core::wished_instruction_set(), 0);
  return *chosen;
}

struct VolumeCaster::Impl {
  const Volume& volume;
  core::ThreadPool& pool;
  CellRanges ranges;
  TransferFunction transfer;
  std::vector<std::uint8_t> skip;
  double table_from = 0, table_to = 1;  // numbers
  std::vector<float> table;
  double table_step = 0;  // [mm] for which the table's opacities hold
  std::vector<ClipPlane> planes;
  Box box;
  std::vector<std::uint8_t> tints;
  std::vector<float> tint_table, tint_opacity;

  Impl(const Volume& v, core::ThreadPool& p) : volume(v), pool(p), ranges(cell_ranges(v, p)), box(whole(v.grid)) {}

  /// Where the points are, a little beyond the last ones, and no wider than the numbers.
  void choose_table_range() {
    const double low = transfer.points.empty() ? 0 : transfer.points.front().value;
    const double high = transfer.points.empty() ? 0 : transfer.points.back().value;
    table_from = std::clamp((low - volume.offset) / volume.scale, -32768.0, 32767.0);
    table_to = std::clamp((high - volume.offset) / volume.scale, -32768.0, 32767.0);
    if (table_to - table_from < 1) table_to = table_from + 1;
    table_step = 0;
  }
  double value_of_entry(int entry) const {
    const double number = table_from + (table_to - table_from) * entry / (kTableSize - 1);
    return volume.offset + volume.scale * number;
  }

  void find_empty_cells() {
    std::vector<std::uint32_t> visible(65537);
    for (int n = -32768; n <= 32767; ++n) {
      const double at = (n - table_from) / (table_to - table_from) * (kTableSize - 1);
      const bool seen =
          transfer.at(value_of_entry(int(std::clamp(at, 0.0, kTableSize - 1.0)))).opacity > kHiddenOpacity;
      visible[std::size_t(n + 32769)] = visible[std::size_t(n + 32768)] + (seen ? 1 : 0);
    }
    skip = empty_around(ranges, visible);
  }

  /// Opacities of a step of this length.
  void fill_table(double step_mm) {
    if (table_step == step_mm) return;
    table.resize(4 * kTableSize);
    for (int e = 0; e < kTableSize; ++e) {
      const TransferPoint point = transfer.at(value_of_entry(e));
      float* entry = table.data() + 4 * e;
      for (std::size_t c = 0; c < 3; ++c) entry[c] = float(point.colour[c]);
      const double clear = 1 - std::clamp(point.opacity, 0.0, 1.0);
      entry[3] = point.opacity > kHiddenOpacity ? float(1 - std::pow(clear, step_mm)) : 0;
    }
    table_step = step_mm;
  }

  CastJob job(const View& view, const Quality& quality, int width, int height) {
    CastJob j;
    const Grid& grid = volume.grid;
    j.voxels = volume.stored.data();
    j.step = float(grid.least_spacing() * std::clamp(quality.step, 0.1, 16.0));
    fill_table(double(j.step));
    for (int k = 0; k < 3; ++k) {
      const auto a = std::size_t(k);
      j.size[k] = grid.size[a];
      j.cells[k] = ranges.cells[a];
      j.inverse_spacing[k] = float(1 / grid.spacing[k]);
      j.low[k] = float(box.low[a]);
      j.high[k] = float(box.high[a] - 1);
    }
    j.skip = skip.data();
    j.table = table.data();
    j.table_from = float(table_from);
    j.table_scale = float((kTableSize - 1) / (table_to - table_from));
    if (!tints.empty()) j.tints = tints.data(), j.tint_table = tint_table.data(), j.tint_opacity = tint_opacity.data();
    j.shade_full = float((table_to - table_from) / 30);
    j.fine_gradient = quality.fine_gradient;
    j.width = width;
    j.height = height;
    place_rays(j, view, quality.shrink);
    place_planes(j);
    return j;
  }

  void place_rays(CastJob& j, const View& view, int shrink) const {
    const IntoVoxels into(volume.grid);
    const Vec3d forward = normalised(view.target - view.eye, {0, 0, -1});
    const Vec3d right = normalised(cross(forward, view.up), any_perpendicular(forward));
    const Vec3d down = cross(forward, right);
    j.perspective = view.fov_deg > 0;
    const double height =
        j.perspective ? 2 * std::tan(std::clamp(view.fov_deg, 0.1, 170.0) * 3.14159265358979 / 360) : view.height_m;
    const double pixel = height / std::max(view.height, 1) * shrink;
    put(j.origin, into.turn * view.eye + into.shift);
    // A millimetre along the ray, in voxels.
    const Mat3d in_mm = 1e-3 * into.turn;
    const auto direction = [&](Vec3d v) { return in_mm * v; };
    put(j.forward, direction(forward));
    put(j.right, j.perspective ? direction(pixel * right) : into.turn * (pixel * right));
    put(j.down, j.perspective ? direction(pixel * down) : into.turn * (pixel * down));
    // The same turned into the grid's axes, unscaled: what slopes per millimetre are compared with.
    const Mat3d turned = transposed(volume.grid.direction) * transposed(kSceneFromPatient);
    put(j.metric_forward, turned * forward);
    put(j.metric_right, turned * (pixel * right));
    put(j.metric_down, turned * (pixel * down));
  }

  /// n p >= d, where p = back (v - shift).
  void place_planes(CastJob& j) const {
    const IntoVoxels into(volume.grid);
    const Mat3d back = inverse(into.turn);
    for (const ClipPlane& plane : planes) {
      const Vec3d normal = transposed(back) * plane.normal;
      float* out = j.plane[j.planes++];
      for (int k = 0; k < 3; ++k) out[k] = float(normal[k]);
      out[3] = float(plane.offset + dot(normal, into.shift));
    }
  }
};

VolumeCaster::VolumeCaster(const Volume& volume, core::ThreadPool& pool) {
  for (const int size : volume.grid.size)
    core::require(size >= 2, "a volume that is shown has 2 voxels along each axis");
  core::require(volume.stored.size() == volume.grid.count(), "a volume has a number for each voxel");
  core::require(volume.stored.size() < (std::size_t(1) << 30), "a volume that is shown has fewer than 2^30 voxels");
  core::require(shear_deg(volume.grid) < 0.1, "a volume that is shown is not sheared");
  m_impl = std::make_unique<Impl>(volume, pool);
  set_transfer(grey_ramp(volume.value_of(-32768), volume.value_of(32767)));
}
VolumeCaster::~VolumeCaster() = default;

void VolumeCaster::set_transfer(const TransferFunction& transfer) {
  m_impl->transfer = transfer;
  m_impl->choose_table_range();
  m_impl->find_empty_cells();
}

void VolumeCaster::set_planes(std::span<const ClipPlane> planes) {
  core::require(planes.size() < kMostPlanes, "at most 7 planes cut a volume");
  m_impl->planes.assign(planes.begin(), planes.end());
}

void VolumeCaster::set_box(const Box& box) {
  m_impl->box = box.empty() ? whole(m_impl->volume.grid) : common(box, whole(m_impl->volume.grid));
}

void VolumeCaster::set_labels(const Labels* labels, double tint) {
  Impl& m = *m_impl;
  m.tints.clear();
  if (!labels) return;
  core::require(labels->grid.size == m.volume.grid.size, "labels and volume must have the same number of voxels");
  std::vector<std::uint8_t> row_of(65536, 0);
  m.tint_table.assign(4 * 256, 0);
  m.tint_opacity.assign(256, 1);
  std::size_t row = 0;
  for (const Segment& s : labels->segments) {
    if (++row > 255) break;
    row_of[s.label] = std::uint8_t(row);
    for (std::size_t c = 0; c < 3; ++c) m.tint_table[4 * row + c] = s.colour[c];
    m.tint_table[4 * row + 3] = float(std::clamp(tint, 0.0, 1.0));
    if (!s.visible) m.tint_opacity[row] = 0;
  }
  m.tints.resize(labels->at.size() + 3);
  for (std::size_t i = 0; i < labels->at.size(); ++i) m.tints[i] = row_of[labels->at[i]];
}

Rendered VolumeCaster::render(const View& view, const Quality& quality) {
  const auto start = std::chrono::steady_clock::now();
  Rendered out;
  const int shrink = std::clamp(quality.shrink, 1, 64);
  Picture& picture = out.picture;
  picture.width = std::clamp((view.width + shrink - 1) / shrink, 1, 16384);
  picture.height = std::clamp((view.height + shrink - 1) / shrink, 1, 16384);
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  std::vector<std::uint32_t> packed(pixels);
  picture.depth.assign(pixels, std::numeric_limits<float>::infinity());
  CastJob job = m_impl->job(view, quality, picture.width, picture.height);
  job.pixels = packed.data();
  job.depth = picture.depth.data();
  const int across = (picture.width + kTile - 1) / kTile, down = (picture.height + kTile - 1) / kTile;
  const CasterKernel& kernel = caster_kernel();
  std::atomic<bool> skipped{false};
  core::run(m_impl->pool, across * down, [&](int tile) noexcept {
    if (quality.stop && quality.stop->load(std::memory_order_relaxed)) return skipped.store(true);
    const int x = tile % across * kTile, y = tile / across * kTile;
    kernel.cast(job, x, y, std::min(x + kTile, picture.width), std::min(y + kTile, picture.height));
  });
  out.finished = !skipped.load();
  picture.rgba.resize(4 * pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 4; ++c) picture.rgba[4 * i + c] = std::uint8_t(packed[i] >> 8 * c & 255);
  for (float& d : picture.depth)
    if (d > 1e29f) d = std::numeric_limits<float>::infinity();
  out.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return out;
}

Quality moving_quality() { return {.shrink = 2, .step = 2, .fine_gradient = false}; }

Quality QualityGovernor::quality() const {
  const Rung& r = kLadder[m_level];
  return {.shrink = r.shrink, .step = r.step, .fine_gradient = r.fine};
}

void QualityGovernor::took(double milliseconds) {
  const int last = int(std::size(kLadder)) - 1;
  if (milliseconds > m_budget) {
    // As far down as it takes by the ladder's costs.
    const double wanted = kLadder[m_level].cost * m_budget / milliseconds;
    while (m_level < last && kLadder[m_level].cost > wanted) ++m_level;
    m_quick = 0;
    return;
  }
  const bool room = m_level > 0 && milliseconds * kLadder[m_level - 1].cost / kLadder[m_level].cost < 0.8 * m_budget;
  m_quick = room ? m_quick + 1 : 0;
  if (m_quick >= 3) --m_level, m_quick = 0;  // not to and fro
}

}  // namespace trocar::volumes
