#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/organ_drawing.hpp>

namespace trocar::view {

std::vector<std::uint32_t> flat_indices(const tissue::Skin& skin) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * skin.triangles.size());
  for (const auto& t : skin.triangles)
    for (const int v : t) indices.push_back(std::uint32_t(v));
  return indices;
}

OrganDrawing::OrganDrawing(const sim::SolidModel& solid, const Relief& relief, std::vector<Paint> paint,
                           render::Backend& backend)
    : m_solid(&solid), m_pose(tissue::make_pose(solid.fine)), m_indices(flat_indices(solid.fine)) {
  if (relief.any()) m_height = heights(relief, solid.fine, paint);
  m_pose.position = solid.fine.rest;
  m_normals = solid.fine.rest_normal;
  lift();
  m_mesh = OwnedMesh(backend, {.positions = m_pose.position,
                               .normals = m_normals,
                               .rest = m_pose.position,
                               .paint = paint,
                               .indices = m_indices});
}

void OrganDrawing::lift() {
  if (m_height.empty()) return;
  for (std::size_t i = 0; i < m_height.size(); ++i) m_pose.position[i] += m_height[i] * m_normals[i];
  render::vertex_normals(m_pose.position, m_indices, m_normals);
}

bool OrganDrawing::moved(const tissue::NetworkState& state) {
  const auto same = [](const tissue::NodeState& a, const tissue::NodeState& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  bool all = m_drawn.size() == state.nodes.size();
  for (std::size_t i = 0; all && i < state.nodes.size(); ++i) all = same(m_drawn[i], state.nodes[i]);
  if (!all) m_drawn = state.nodes;
  return !all;
}

void OrganDrawing::update(const tissue::NetworkState& state) {
  if (!moved(state)) return;
  tissue::pose_skin(m_solid->network, m_solid->fine, state, m_pose);
  render::vertex_normals(m_pose.position, m_indices, m_normals);
  lift();
  m_mesh.move(m_pose.position, m_normals);
}

}  // namespace trocar::view
