#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/breach_drawing.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kAround = 12, kPatchRings = 4;       // of a patch, and its middle
constexpr std::uint32_t kPatch = kAround * kPatchRings + 1;  // vertices
constexpr double kWider = 1.45;                              // than its bond's area: neighbours run into each other
constexpr double kStandsOut = 0.0009, kGoesIn = 0.0014;      // [m] in its middle; at its rim, below what is drawn there
constexpr double kCrumbs = 0.0005;                           // [m] how uneven it is
constexpr std::uint8_t kBleeding = 110, kCrust = 205;        // Paint::blood while it bleeds, Paint::burn afterwards

/// Out of an organ's skin around one of its vertices.
Vec3d out_of(const tissue::NodeView& nodes, const tissue::Skin& skin, int vertex) {
  Vec3d sum;
  for (int k = skin.face_first[std::size_t(vertex)]; k < skin.face_first[std::size_t(vertex) + 1]; ++k) {
    const std::array<int, 3>& t = skin.triangles[std::size_t(skin.face[std::size_t(k)])];
    const Vec3d a = tissue::skin_point(nodes, skin, t[0]);
    sum += cross(tissue::skin_point(nodes, skin, t[1]) - a, tissue::skin_point(nodes, skin, t[2]) - a);
  }
  return normalised(sum, Vec3d{0, 0, 1});
}

}  // namespace

BreachDrawing::BreachDrawing(const sim::Model& model, std::size_t set, render::Backend& backend)
    : m_model(&model), m_set(&model.bonds[set]), m_index(set) {
  for (std::size_t i = 0; i < m_set->bonds.size(); ++i) {
    const std::uint32_t first = m_buffer.size();
    for (std::uint32_t v = 0; v < kPatch; ++v) m_buffer.add({}, Paint{255, kBleeding, 0, 0});
    for (std::uint32_t r = 0; r + 1 < kPatchRings; ++r)
      join_rows(m_buffer, first + (r + 1) * kAround, first + r * kAround, kAround, true);
    join_pole(m_buffer, first, kAround, first + kPatch - 1, true);
  }
  place(sim::initial_state(model));
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void BreachDrawing::update(const sim::State& state) {
  place(state);
  m_mesh.repaint(m_buffer.positions, m_buffer.normals, m_buffer.paint);
}

/// A dome with a ragged rim. Without a radius it is nothing, below the skin.
void BreachDrawing::lay_patch(std::size_t bond, Vec3d middle, Vec3d out, double radius) {
  const Vec3d u = any_perpendicular(out), v = cross(out, u);
  const std::uint32_t first = std::uint32_t(bond) * kPatch;
  const bool there = radius > 0;
  const auto at = [&](std::uint32_t vertex, double x, double y, double up) {
    m_buffer.positions[first + vertex] = vec_cast<float>(middle + x * u + y * v + up * out);
  };
  for (std::uint32_t r = 0; r < kPatchRings; ++r) {
    const double s = double(r + 1) / kPatchRings;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const int number = int(first + r * kAround + k);
      const double turn = 2 * portable::pi * k / kAround, far = radius * s * (0.85 + 0.3 * varied(number, 1));
      const double up = kStandsOut - (kStandsOut + kGoesIn) * s * s + kCrumbs * (varied(number, 2) - 0.5);
      at(r * kAround + k, far * std::cos(turn), far * std::sin(turn), there ? up : -kGoesIn);
    }
  }
  at(kPatch - 1, 0, 0, there ? kStandsOut : -kGoesIn);
}

void BreachDrawing::place(const sim::State& state) {
  m_any = false;
  for (std::size_t i = 0; i < m_set->bonds.size(); ++i) {
    const interactions::Bond& bond = m_set->bonds[i];
    const interactions::BondState& s = state.bonds[m_index][i];
    const bool torn = bond.vertex >= 0 && interactions::breached(*m_set, s);
    m_any = m_any || torn;
    Vec3d middle, out{0, 0, 1};
    if (bond.vertex >= 0) {
      const int organ = int(bond.far.body.index());
      const tissue::NodeView nodes = sim::nodes_of(*m_model, state, organ);
      const tissue::Skin& skin = m_model->skin(organ);
      middle = tissue::skin_point(nodes, skin, bond.vertex);
      if (torn) out = out_of(nodes, skin, bond.vertex);
    }
    lay_patch(i, middle, out, torn ? kWider * std::sqrt(bond.area / portable::pi) : 0);
    const Paint paint{255, s.raw() ? kBleeding : std::uint8_t(0), s.raw() ? std::uint8_t(0) : kCrust, 0};
    for (std::uint32_t v = 0; v < kPatch; ++v) m_buffer.paint[i * kPatch + v] = paint;
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

}  // namespace trocar::view
