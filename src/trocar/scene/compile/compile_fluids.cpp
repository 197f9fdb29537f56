#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/fluids/pool_bed.hpp>
#include <trocar/interactions/wetting/fluid_contact.hpp>
#include <trocar/scene/compile/compile_fluids.hpp>

namespace trocar::scene {
namespace {

constexpr int kPoolCells = 128;
constexpr int kCrowdsPool =
    2;  // tick of the pool's first step beside a crowd: heat, and forces between drops, work on others
constexpr int kCrowd = 4096;     // drops at a time; with more of them each is looked at less often.  Our choice
constexpr double kFilm = 40e-6;  // [m] the thickest film that stays on tissue.  Our choice
constexpr double kPlace = 8e-6;  // [m^2] about a vertex of a skin, typically
constexpr float kNothing = -1e6f;
constexpr float kOutwards = 0.0005f;  // [m] a cell: floor that nothing covers rises so from what is beside it

/// Raises the floor to a skin's drawn triangles that look up.
void lay_on(const tissue::Skin& skin, const fluids::PoolModel& pool, std::vector<float>& floor) {
  const auto corner = [&](int v) { return in_cells(pool, vec_cast<double>(skin.rest[size_t(v)])); };
  for (const auto& t : skin.triangles) raise_bed(pool, {corner(t[0]), corner(t[1]), corner(t[2])}, 0, pool.ny, floor);
}

bool covers_any(const std::vector<float>& floor) {
  return std::any_of(floor.begin(), floor.end(), [](float h) { return h > kNothing; });
}

/// Cells that nothing covers continue from their neighbours, rising: what lies beyond the walls holds no fluid.
void fill_gaps(const fluids::PoolModel& pool, std::vector<float>& floor) {
  const bool any = covers_any(floor);
  if (!any) std::fill(floor.begin(), floor.end(), 0.0f);
  for (bool open = any; open;) {
    open = false;
    const std::vector<float> now = floor;
    for (int j = 0; j < pool.ny; ++j)
      for (int i = 0; i < pool.nx; ++i) {
        const size_t at = size_t(j) * size_t(pool.nx) + size_t(i);
        if (now[at] > kNothing) continue;
        float most = kNothing;
        for (int y = std::max(j - 1, 0); y <= std::min(j + 1, pool.ny - 1); ++y)
          for (int x = std::max(i - 1, 0); x <= std::min(i + 1, pool.nx - 1); ++x)
            most = std::max(most, now[size_t(y) * size_t(pool.nx) + size_t(x)]);
        if (most > kNothing) floor[at] = most + kOutwards;
        open = true;
      }
  }
}

/// Walls, and which organs lie on them. Where there are no walls, nothing is below the organs: they stay in
/// the drawn shape.
void lay_floor(const FluidsSetting& f, sim::Model& model) {
  const fluids::PoolModel& pool = model.wet.model.pool;
  std::vector<float>& floor = model.wet.floor;
  floor.assign(size_t(pool.nx) * size_t(pool.ny), kNothing);
  for (const sim::WallModel& wall : model.walls) lay_on(wall.skin, pool, floor);
  for (const std::string& name : f.pool_on)
    if (const int i = model.organ_index(name); i >= 0) model.wet.floor_organs.push_back(i);
  if (!covers_any(floor))
    for (const int i : model.wet.floor_organs) lay_on(model.skin(i), pool, floor);
  fill_gaps(pool, floor);
}

std::vector<std::int32_t> places_of_film(const sim::Model& model) {
  std::vector<const tissue::Skin*> surfaces, sheets;
  for (int i = 0; i < model.organs(); ++i) surfaces.push_back(&model.skin(i));
  for (const sim::WallModel& wall : model.walls) surfaces.push_back(&wall.skin);
  for (const sim::MembraneBody& m : model.membranes) sheets.push_back(&m.skin);
  return interactions::film_places(surfaces, sheets, model.strand_bodies);
}

}  // namespace

void compile_fluids(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  if (!d.fluids || !faults.empty()) return;
  const FluidsSetting& f = *d.fluids;
  fluids::FluidsDescription out;
  const Vec3d up = normalised(-1.0 * d.gravity, Vec3d{0, 0, 1});
  out.pool.u = normalised(cross(any_perpendicular(up), up));
  if (std::fabs(up.x) < 0.9) out.pool.u = normalised(Vec3d{1, 0, 0} - up.x * up);
  out.pool.v = cross(up, out.pool.u);
  out.pool.nx = out.pool.ny = kPoolCells;
  out.pool.cell = f.pool_size / kPoolCells;
  out.pool.origin = f.pool_middle - 0.5 * f.pool_size * (out.pool.u + out.pool.v);
  out.pool.gravity = length(d.gravity);
  out.droplets.capacity = f.drops;
  if (f.drops > kCrowd) {
    fluids::set_crowd_level_of_detail(out.droplets);
    out.pool.first = kCrowdsPool;
  }
  model.wet.film = places_of_film(model);
  for (const sim::WallModel& wall : model.walls)
    model.wet.grids.push_back(interactions::make_skin_grid(wall.skin, interactions::kWetReach));
  out.droplets.film_cells = model.wet.film.back();
  out.droplets.film_capacity = std::int64_t(kFilm * kPlace * fluids::kPicolitresPerM3);
  out.droplets.gravity = d.gravity;
  out.smoke.origin = f.pool_middle - Vec3d{0.1, 0.1, 0.03};
  try {
    model.wet.model = fluids::build(out, sim::kTick);
  } catch (const std::invalid_argument& e) {
    faults.push_back({f.at, std::string("expected fluids that can be computed, got: ") + e.what()});
    return;
  }
  lay_floor(f, model);
  model.wet.pool_at_start.blood = std::int64_t(f.pool_at_start * fluids::kPicolitresPerM3);
  model.wet.pool_at_start.bile = std::int64_t(f.bile_at_start * fluids::kPicolitresPerM3);
  model.wet.there = true;
}

}  // namespace trocar::scene
