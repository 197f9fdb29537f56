#include <algorithm>

#include <trocar/fluids/pool_bed.hpp>
#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/sim/model/pool_floor.hpp>

namespace trocar::sim {
namespace {

constexpr int kRows = 4;  // a tick

/// Raises rows of the floor to what of an organ's skin looks up.
void raise_to(const Model& model, const interactions::Surface& surface, int first, int last,
              std::span<float> floor) noexcept {
  const fluids::PoolModel& pool = model.wet.model.pool;
  const Vec3d along = (1 / pool.cell) * pool.v;
  const double origin = dot(pool.origin, along), from = first + origin, to = last + origin;
  for (const auto& t : surface.skin->triangles) {
    const Vec3d a = surface.position(t[0]), b = surface.position(t[1]), c = surface.position(t[2]);
    const double ja = dot(a, along), jb = dot(b, along), jc = dot(c, along);
    if (std::min({ja, jb, jc}) >= to || std::max({ja, jb, jc}) <= from) continue;
    if (surface.torn(t[0]) || surface.torn(t[1]) || surface.torn(t[2])) continue;
    raise_bed(pool, {in_cells(pool, a), in_cells(pool, b), in_cells(pool, c)}, first, last, floor);
  }
}

void clear_rows(const Model& model, int first, int last, std::span<float> floor) noexcept {
  const size_t wide = size_t(model.wet.model.pool.nx);
  std::copy(model.wet.floor.begin() + std::ptrdiff_t(size_t(first) * wide),
            model.wet.floor.begin() + std::ptrdiff_t(size_t(last) * wide),
            floor.begin() + std::ptrdiff_t(size_t(first) * wide));
}

}  // namespace

void follow_floor(const Model& model, std::span<const interactions::Surface> surfaces, State& state) noexcept {
  if (model.wet.floor_organs.empty()) return;
  const int ny = model.wet.model.pool.ny, strips = (ny + kRows - 1) / kRows;
  const int first = int(state.tick % std::uint64_t(strips)) * kRows, last = std::min(first + kRows, ny);
  clear_rows(model, first, last, state.pool_floor);
  for (const int i : model.wet.floor_organs) raise_to(model, surfaces[size_t(i)], first, last, state.pool_floor);
}

void lay_floor(const Model& model, State& state) {
  const int ny = model.wet.model.pool.ny;
  state.pool_floor = model.wet.floor;
  for (const int i : model.wet.floor_organs) {
    const tissue::Skin& skin = model.skin(i);
    tissue::SkinPose pose = make_pose(skin);
    const tissue::NodeView nodes = nodes_of(model, state, i);
    pose_skin(nodes, skin, pose);
    raise_to(model, {&skin, &pose, nodes}, 0, ny, state.pool_floor);
  }
}

}  // namespace trocar::sim
