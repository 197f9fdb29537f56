#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/bonds/bond_drawing.hpp>

namespace trocar::view {
namespace {

constexpr int kThreads = 4;                              // of a bond
constexpr std::uint32_t kRings = 5, kSides = 4;          // of a thread
constexpr double kThin = 0.00004, kThick = 0.00012;      // [m] radius in its middle, and where it spreads
constexpr double kSpread = 0.0012;                       // [m] how far from its bond a thread may stand
constexpr double kBow = 0.18;                            // of its length, to the side
constexpr double kShred = 0.0012, kShrivelled = 0.0005;  // [m] what is left of one on either side; where current went
constexpr std::uint8_t kSinged = 150, kBlack = 240;      // Paint::burn of that
constexpr std::uint32_t kEach = kRings * kSides;

/// Across `along`, as far as `reach`, another way for every number.
Vec3d scatter(Vec3d along, double reach, int i, int k) {
  const Vec3d u = any_perpendicular(along), v = cross(along, u);
  return reach * ((2 * varied(i, k) - 1) * u + (2 * varied(i, k + 100) - 1) * v);
}

}  // namespace

BondDrawing::BondDrawing(const sim::Model& model, std::size_t set, render::Backend& backend)
    : m_model(&model), m_set(&model.bonds[set]), m_index(set) {
  for (std::size_t i = 0; i < m_set->bonds.size() * kThreads; ++i) {
    const std::uint32_t first = m_buffer.size();
    for (std::uint32_t v = 0; v < kEach; ++v) m_buffer.add({}, Paint{235, 0, 0, 0});
    for (std::uint32_t r = 0; r + 1 < kRings; ++r)
      join_rows(m_buffer, first + r * kSides, first + (r + 1) * kSides, kSides, true);
  }
  place(sim::initial_state(model));
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void BondDrawing::update(const sim::State& state) {
  place(state);
  m_mesh.repaint(m_buffer.positions, m_buffer.normals, m_buffer.paint);
}

/// Spread where it is rooted, thin elsewhere, bowed to the side.
void BondDrawing::lay_thread(std::uint32_t first, Vec3d from, Vec3d to, Vec3d aside, bool rooted_at_both_ends) {
  const Vec3d way = to - from, along = normalised(way, Vec3d{0, 0, 1});
  const Vec3d u = any_perpendicular(along), v = cross(along, u);
  for (std::uint32_t r = 0; r < kRings; ++r) {
    const double s = double(r) / (kRings - 1), out = 2 * s - 1,
                 swell = out < 0 || rooted_at_both_ends ? out * out * out * out : 0;
    const double radius = std::min(kThin + (kThick - kThin) * swell, 0.5 * length(way) + 1e-5);
    const Vec3d middle = from + s * way + (1 - out * out) * kBow * length(way) * aside;
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double turn = 2 * portable::pi * k / kSides;
      m_buffer.positions[first + r * kSides + k] =
          vec_cast<float>(middle + radius * (std::cos(turn) * u + std::sin(turn) * v));
    }
  }
}

void BondDrawing::place(const sim::State& state) {
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  for (std::size_t i = 0; i < m_set->bonds.size(); ++i) {
    const interactions::Bond& bond = m_set->bonds[i];
    const Vec3d foot = root_of(bodies, bond);
    const Vec3d node = place_of(bodies, bond.near);
    const Vec3d along = normalised(node - foot, Vec3d{0, 0, 1});
    for (int k = 0; k < kThreads; ++k) {
      const int number = int(i) * kThreads + k;
      Vec3d from = foot + scatter(along, kSpread, number, 1), to = node + scatter(along, kSpread, number, 2);
      const interactions::BondState& bond_state = state.bonds[m_index][i];
      const bool holds = bond_state.holds(), burnt = !holds && !bond_state.raw();
      if (!holds) {
        if (k % 2) std::swap(from, to);
        to = from + std::min(burnt ? kShrivelled : kShred, 0.4 * length(to - from)) * normalised(to - from, along);
      }
      const auto singed = std::uint8_t(kSinged + (kBlack - kSinged) * varied(number, 4));
      for (std::uint32_t v = 0; v < kEach; ++v)
        m_buffer.paint[std::uint32_t(number) * kEach + v].burn = burnt ? singed : std::uint8_t(0);
      lay_thread(std::uint32_t(number) * kEach, from, to, scatter(along, 1, number, 3), holds);
    }
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

}  // namespace trocar::view
