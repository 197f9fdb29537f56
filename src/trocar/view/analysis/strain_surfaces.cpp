#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/analysis/strain_surfaces.hpp>
#include <trocar/view/analysis/surface_strain.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kStrainAround = 12;

void paint_by_strain(const AnalysisOptions& o, FalseColourMesh& mesh) {
  mesh.buffer.paint.resize(mesh.value.size());
  for (std::size_t v = 0; v < mesh.value.size(); ++v)
    mesh.buffer.paint[v] = paint_shown_as(colour_of_strain(o, double(mesh.value[v])));
}

/// All triangles but those that are cut open. @param left_out  in/out: as drawn last  @return they are others than then
bool connect(std::span<const std::array<int, 3>> triangles, std::span<const std::uint8_t> open,
             std::vector<std::uint8_t>& left_out, MeshBuffer& to) {
  std::vector<std::uint8_t> now(triangles.size(), 0);
  for (std::size_t t = 0; t < std::min(now.size(), open.size()); ++t) now[t] = open[t];
  if (now == left_out) return false;
  left_out = std::move(now);
  to.indices.clear();
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!left_out[t])
      to.triangle(std::uint32_t(triangles[t][0]), std::uint32_t(triangles[t][1]), std::uint32_t(triangles[t][2]));
  return true;
}

}  // namespace

void FalseColourMesh::show(render::Backend& backend, bool new_triangles, render::Primitive primitive) {
  m_there = !buffer.indices.empty();
  if (!m_there) return;
  render::MeshData data = buffer.data();
  data.primitive = primitive;
  if (!m_made)
    m_mesh = OwnedMesh(backend, data);
  else if (new_triangles)
    m_mesh.replace(data);
  else
    m_mesh.update(buffer);
  m_made = true;
}

StrainSurfaces::StrainSurfaces(const sim::Model& model)
    : m_model(&model),
      m_organs(std::size_t(model.organs())),
      m_strands(model.strands.size()),
      m_membranes(model.membranes.size()),
      m_left_out(m_organs.size() + m_membranes.size()) {
  for (const sim::CuttableOrgan& c : model.cuttables) m_skins.push_back(tissue::make_skin(c.body));
}

void StrainSurfaces::update(const sim::State& state, const AnalysisOptions& o, render::Backend& backend) {
  sim::visit_organs(*m_model, [&](auto organ) { update_organ(organ, state, o, backend); });
  for (std::size_t i = 0; i < m_strands.size(); ++i) update_strand(i, state, o, backend);
  for (std::size_t i = 0; i < m_membranes.size(); ++i) update_membrane(i, state, o, backend);
}

void StrainSurfaces::update_organ(sim::SolidRef r, const sim::State& state, const AnalysisOptions& o,
                                  render::Backend& backend) {
  const std::size_t i = r.index;
  const sim::SolidModel& solid = model_of(*m_model, r);
  FalseColourMesh& mesh = m_organs[r.organ()];
  tissue::SkinPose pose = tissue::make_pose(solid.fine);
  pose_skin(view_of(solid.network, state_of(state, r)), solid.fine, pose);
  const bool changed = connect(solid.fine.triangles, state.parted[i], m_left_out[i], mesh.buffer);
  mesh.buffer.positions = std::move(pose.position);
  vertex_strains(solid.fine.rest, mesh.buffer.positions, solid.fine.triangles, mesh.value);
  paint_by_strain(o, mesh);
  mesh.show(backend, changed);
}

void StrainSurfaces::update_organ(sim::CuttableRef r, const sim::State& state, const AnalysisOptions& o,
                                  render::Backend& backend) {
  const std::size_t i = r.index;
  const tissue::CuttableModel& body = model_of(*m_model, r).body;
  const tissue::CuttableState& now = state_of(state, r);
  FalseColourMesh& mesh = m_organs[r.organ()];
  const bool changed = m_skins[i].made_for != now.version || mesh.buffer.indices.empty();
  tissue::update(body, now, m_skins[i]);
  const std::size_t nodes = std::size_t(now.tets.nodes);
  std::vector<Vec3f> drawn(nodes);
  mesh.buffer.positions.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    drawn[n] = vec_cast<float>(now.tets.rest[n]);
    mesh.buffer.positions[n] = vec_cast<float>(position(body, now, int(n)));
  }
  if (changed) {
    mesh.buffer.indices.clear();
    for (const std::array<int, 3>& t : m_skins[i].skin.triangles)
      mesh.buffer.triangle(std::uint32_t(t[0]), std::uint32_t(t[1]), std::uint32_t(t[2]));
  }
  vertex_strains(drawn, mesh.buffer.positions, m_skins[i].skin.triangles, mesh.value);
  paint_by_strain(o, mesh);
  mesh.show(backend, changed);
}

void StrainSurfaces::update_membrane(std::size_t i, const sim::State& state, const AnalysisOptions& o,
                                     render::Backend& backend) {
  const tissue::MembraneModel& sheet = m_model->membranes[i].sheet;
  FalseColourMesh& mesh = m_membranes[i];
  const std::size_t nodes = std::size_t(sheet.nodes());
  std::vector<Vec3f> drawn(nodes);
  mesh.buffer.positions.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    drawn[n] = vec_cast<float>(sheet.network.rest[n]);
    mesh.buffer.positions[n] = vec_cast<float>(position(sheet.network, state.membranes[i].network, int(n)));
  }
  const bool changed = connect(sheet.triangles, state.torn[i], m_left_out[m_organs.size() + i], mesh.buffer);
  vertex_strains(drawn, mesh.buffer.positions, sheet.triangles, mesh.value);
  paint_by_strain(o, mesh);
  mesh.show(backend, changed);
}

/// Two rings an element, so that each has its own colour; what is cut through has none.
void StrainSurfaces::update_strand(std::size_t i, const sim::State& state, const AnalysisOptions& o,
                                   render::Backend& backend) {
  const tissue::StrandModel& body = m_model->strand_bodies[i].model;
  const tissue::StrandState& now = state.strands[i];
  FalseColourMesh& mesh = m_strands[i];
  const std::vector<std::uint32_t> before = std::exchange(mesh.buffer.indices, {});
  mesh.buffer.positions.clear(), mesh.buffer.normals.clear(), mesh.value.clear();
  Vec3d across{0, 0, 1};
  for (std::size_t node = 0; node < now.x.size(); ++node) {
    const bool first = node == 0, last = node + 1 == now.x.size();
    const Vec3d tangent = normalised(now.x[last ? node : node + 1] - now.x[first ? node : node - 1], Vec3d{1, 0, 0});
    across = normalised(across - dot(across, tangent) * tangent, any_perpendicular(tangent));
    for (int side = first ? 1 : 0; side < (last ? 1 : 2); ++side)  // the end of one element, the beginning of the next
      for (std::uint32_t k = 0; k < kStrainAround; ++k) {
        const double angle = 2 * portable::pi * k / kStrainAround;
        const Vec3d out = std::cos(angle) * across + std::sin(angle) * cross(tangent, across);
        mesh.buffer.positions.push_back(vec_cast<float>(now.x[node] + m_model->strands[i].outer[node] * out));
        mesh.buffer.normals.push_back(vec_cast<float>(out));
        mesh.value.push_back(float(element_strain(body, now, int(node) + side - 1)));
      }
  }
  for (std::uint32_t e = 0; e + 1 < now.x.size(); ++e)
    if (now.alive[e]) join_rows(mesh.buffer, 2 * e * kStrainAround, (2 * e + 1) * kStrainAround, kStrainAround, true);
  paint_by_strain(o, mesh);
  mesh.show(backend, mesh.buffer.indices != before);
}

}  // namespace trocar::view
