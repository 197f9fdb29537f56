#include <algorithm>
#include <cmath>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/verbs/heat_bodies.hpp>

namespace trocar::sim {
namespace {

constexpr double kJoined = 0.87;  // half of a cube's diagonal, in cells

using tissue::kBrickSide;

void fill_from(const geometry::CellMask& mask, Vec3d corner, double cell, std::span<std::uint8_t> out) noexcept {
  int first[3];
  for (int c = 0; c < 3; ++c) first[c] = int(std::floor(corner[c] / cell + 0.5));
  std::size_t n = 0;
  for (int k = 0; k < kBrickSide; ++k)
    for (int j = 0; j < kBrickSide; ++j)
      for (int i = 0; i < kBrickSide; ++i) out[n++] = mask.at(first[0] + i, first[1] + j, first[2] + k);
}

/// Outer radius at arc length s, in the drawn shape.
double radius_at(const StrandAnatomy& strand, const interactions::StrandBody& body, double s) noexcept {
  const interactions::StrandPlace at = place_at(body, s);
  const std::size_t e = std::size_t(at.element);
  return strand.outer[e] + at.w * (strand.outer[e + 1] - strand.outer[e]);
}

void fill(const Model& model, StrandRef r, Vec3d corner, double cell, std::span<std::uint8_t> out) noexcept {
  const StrandAnatomy& strand = model_of(model, r);
  const interactions::StrandBody& body = model.strand_bodies[r.index];
  double radius[kBrickSide];
  for (int i = 0; i < kBrickSide; ++i) {
    const double s = corner.x + (i + 0.5) * cell;
    // Strands thinner than a cell have at least the cells around their axis.
    radius[i] = s > 0 && s < body.length() ? std::max(radius_at(strand, body, s), kJoined * cell) : 0.0;
  }
  std::size_t n = 0;
  for (int k = 0; k < kBrickSide; ++k)
    for (int j = 0; j < kBrickSide; ++j) {
      const double y = corner.y + (j + 0.5) * cell, z = corner.z + (k + 0.5) * cell;
      for (int i = 0; i < kBrickSide; ++i) out[n++] = y * y + z * z < radius[i] * radius[i];
    }
}

void fill(const Model& model, MembraneRef r, Vec3d corner, double cell, std::span<std::uint8_t> out) noexcept {
  fill_from(model.energy.folds[r.index], corner, cell, out);
}

template <class Organ>
void fill(const Model& model, Organ r, Vec3d corner, double cell, std::span<std::uint8_t> out) noexcept {
  fill_from(model.energy.organs[r.organ()], corner, cell, out);
}

void fill_body(const void* context, BodyId body, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
  const Model& model = *static_cast<const Model*>(context);
  visit(model, body, [&](auto ref) { fill(model, ref, corner, cell, tissue); });
}

}  // namespace

void note_heat_bodies(Model& model) {
  const double cell = model.energy.heat.cell;
  for (int i = 0; i < model.organs(); ++i)
    model.energy.organs.push_back(geometry::cells_inside(model.skin(i).rest, model.skin(i).triangles, cell));
  for (const MembraneBody& m : model.membranes)
    model.energy.folds.push_back(
        geometry::cells_near(m.skin.rest, m.skin.triangles, cell, std::max(0.5 * m.sheet.thickness, kJoined * cell)));
}

tissue::TissueShape tissue_shape(const Model& model) noexcept { return {&model, fill_body}; }

}  // namespace trocar::sim
