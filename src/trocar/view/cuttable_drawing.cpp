#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/cuttable_drawing.hpp>
#include <trocar/view/organ_drawing.hpp>

namespace trocar::view {
namespace {

constexpr Paint kFlesh{200, 105, 0, 0};  // laid bare
constexpr std::uint8_t kRimBlood = 70;   // on the skin at a cut's rim

/// Nodes at which the inside is bare: the skin ends there, so it has no relief that would leave a gap.
std::vector<std::uint8_t> rim_nodes(const tissue::FaceSkin& skin, std::size_t nodes) {
  std::vector<std::uint8_t> rim(nodes, 0);
  for (std::size_t i = 0; i < skin.bare.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (skin.bare[i] && skin.between[i][k] > 0) rim[std::size_t(skin.corners[i][k])] = 1;
  return rim;
}

float at_rim(const tissue::FaceSkin& skin, const std::vector<std::uint8_t>& rim, std::size_t vertex) {
  float sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t node = std::size_t(skin.corners[vertex][k]);
    if (rim[node]) sum += skin.between[vertex][k];
  }
  return sum;
}

}  // namespace

CuttableDrawing::CuttableDrawing(const sim::CuttableOrgan& organ, Relief relief, render::Backend& backend)
    : m_organ(&organ), m_relief(std::move(relief)), m_open(organ.body.drawn.rest.size(), 255) {
  const tissue::CuttableState rest = tissue::rest_state(organ.body);
  make_skin(rest);
  place(rest, {});
  m_mesh = OwnedMesh(backend, {.positions = m_pose.position,
                               .normals = m_normals,
                               .rest = m_skin.skin.rest,
                               .paint = m_paint,
                               .indices = m_indices});
}

void CuttableDrawing::shade(const render::OpennessBaker& baker) {
  std::vector<Paint> paint(m_skin.skin.rest.size());
  baker.bake(m_skin.skin.rest, m_normals, paint);
  for (std::size_t i = 0; i < paint.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (m_skin.between[i][k] == 1) m_open[std::size_t(m_skin.corners[i][k])] = paint[i].openness;
  m_version = ~0ull;
}

void CuttableDrawing::make_skin(const tissue::CuttableState& state) {
  const tissue::CuttableModel& body = m_organ->body;
  m_skin = tissue::face_skin(state.tets, body.drawn.across, body.row_of_node, tissue::kDrawnParts);
  m_version = state.version;
  // A double has the openness of the node that it was made from.
  for (std::int32_t i = body.own_nodes; i < state.tets.nodes; ++i)
    m_open[std::size_t(i)] = m_open[std::size_t(state.tets.source[std::size_t(i)])];
  m_pose = tissue::make_pose(m_skin.skin);
  m_indices = flat_indices(m_skin.skin);
  paint_skin();
}

void CuttableDrawing::paint_skin() {
  const std::size_t n = m_skin.skin.rest.size();
  m_paint.assign(n, Paint{});
  m_at_rim.clear();
  m_height.clear();
  if (m_relief.any()) m_height = heights(m_relief, m_skin.skin, m_paint);
  const std::vector<std::uint8_t> rim = rim_nodes(m_skin, m_open.size());
  for (std::size_t i = 0; i < n; ++i) {
    const float edge = at_rim(m_skin, rim, i);
    m_at_rim.push_back(edge > 0.999f);
    if (!m_height.empty()) m_height[i] *= m_skin.bare[i] ? 0 : 1 - edge;
    if (m_skin.bare[i]) {
      m_paint[i] = kFlesh;
      continue;
    }
    float open = 0;
    for (std::size_t k = 0; k < 3; ++k) open += m_skin.between[i][k] * float(m_open[std::size_t(m_skin.corners[i][k])]);
    m_paint[i].openness = std::uint8_t(open + 0.5f);
    m_paint[i].blood = std::uint8_t(float(kRimBlood) * edge);
  }
}

void CuttableDrawing::place(const tissue::CuttableState& state, std::span<const collision::Capsule> rods) {
  tissue::pose_skin(view_of(m_organ->body, state), m_skin.skin, m_pose);
  m_normals.resize(m_pose.position.size());
  render::vertex_normals(m_pose.position, m_indices, m_normals);
  if (!m_height.empty()) {
    for (std::size_t i = 0; i < m_height.size(); ++i) m_pose.position[i] += m_height[i] * m_normals[i];
    render::vertex_normals(m_pose.position, m_indices, m_normals);
  }
  m_box = m_pose.bounds;
  m_dented = near(m_box, rods);
  if (m_dented) {
    const std::vector<Vec3f> before = m_pose.position;
    m_dented = dent(rods, m_pose.position, m_normals);
    for (std::size_t i = 0; i < before.size(); ++i)  // skin and flesh at a rim would part: they have different normals
      if (m_at_rim[i]) m_pose.position[i] = before[i];
  }
  if (m_dented) render::vertex_normals(m_pose.position, m_indices, m_normals);
}

void CuttableDrawing::burn(const sim::State& state, HeatMarks& marks) {
  if (!marks.stirred(state)) return;
  m_burnt = true;
  const std::vector<Vec3d> places = below_skin(m_skin.skin);
  for (std::size_t i = 0; i < places.size(); ++i) m_paint[i].burn = marks.burn_at(state, places[i]);
}

void CuttableDrawing::update(const tissue::CuttableState& state, std::span<const collision::Capsule> rods) {
  const bool changed = state.version != m_version;
  if (!m_moved(state.nodes) && !changed && !m_burnt && !m_dented && !near(m_box, rods)) return;
  if (changed) make_skin(state);
  place(state, rods);
  if (changed)
    m_mesh.replace({.positions = m_pose.position,
                    .normals = m_normals,
                    .rest = m_skin.skin.rest,
                    .paint = m_paint,
                    .indices = m_indices});
  else if (m_burnt)
    m_mesh.repaint(m_pose.position, m_normals, m_paint);
  else
    m_mesh.move(m_pose.position, m_normals);
  m_burnt = false;
}

}  // namespace trocar::view
