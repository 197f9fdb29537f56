#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {
namespace {

constexpr float kWoundDepth = 0.003f;  // [m] of a bite's bed
constexpr float kBurnSinks = 0.0009f;  // [m] the middle of a burn, which has shrunk
constexpr Paint kBed{140, 125, 0, 0}, kOrganLip{190, 80, 0, 0};

}  // namespace

std::vector<std::uint32_t> flat_indices(const tissue::Skin& skin) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * skin.triangles.size());
  for (const auto& t : skin.triangles)
    for (const int v : t) indices.push_back(std::uint32_t(v));
  return indices;
}

OrganDrawing::OrganDrawing(const sim::SolidModel& solid, const Relief& relief, std::vector<Paint> paint,
                           render::Backend& backend, const Detail& detail)
    : m_solid(&solid),
      m_pose(tissue::make_pose(solid.fine)),
      m_indices(flat_indices(solid.fine)),
      m_rest(pattern_coordinates(relief, solid.fine)) {
  if (relief.any()) m_height = heights(relief, solid.fine, paint);
  m_pose.position = solid.fine.rest;
  m_normals = solid.fine.rest_normal;
  lift();
  m_coarser = coarser_lists(m_pose.position, m_indices, paint, detail, kBends);
  m_mesh = OwnedMesh(backend, {.positions = m_pose.position,
                               .normals = m_normals,
                               .rest = m_rest,
                               .paint = paint,
                               .indices = m_indices,
                               .coarser = m_coarser});
  m_paint = std::move(paint);
}

void OrganDrawing::lift() {
  if (m_height.empty()) return;
  for (std::size_t i = 0; i < m_height.size(); ++i) m_pose.position[i] += m_height[i] * m_normals[i];
  render::vertex_normals(m_pose.position, m_indices, m_normals);
}

/// What has been burnt has lost water and shrunk.
void OrganDrawing::shrink_burns() {
  bool any = false;
  for (std::size_t i = 0; i < m_paint.size(); ++i) {
    if (m_paint[i].burn < 60) continue;
    any = true;
    m_pose.position[i] -= (kBurnSinks * float(smooth(60, 200, double(m_paint[i].burn)))) * m_normals[i];
  }
  if (any) render::vertex_normals(m_pose.position, m_indices, m_normals);
}

/// The mesh's new topology: cut triangles go down, walls close the gap, and the skin around is stained.
void OrganDrawing::open_wounds(std::span<const std::uint8_t> parted) {
  m_parted.assign(parted.begin(), parted.end());
  m_wound.clear();
  m_open = {};
  m_open.rest = m_rest;
  m_open.paint = m_paint;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;    // of cut triangles, as they run
  std::vector<std::uint8_t> at_rim(m_solid->fine.rest.size(), 0);  // touches an uncut triangle
  for (std::size_t t = 0; 3 * t < m_indices.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = m_indices[3 * t + k], b = m_indices[3 * t + (k + 1) % 3];
      if (m_parted[t])
        ++edges[{a, b}];
      else
        at_rim[a] = 1;
    }
  const auto copy = [&](std::uint32_t of, float depth, Paint paint) {
    m_wound.push_back({of, depth});
    paint.burn = m_paint[of].burn;
    m_open.rest.push_back(m_rest[of]);
    m_open.paint.push_back(paint);
    return std::uint32_t(m_open.rest.size() - 1);
  };
  std::map<std::uint32_t, std::uint32_t> bed;
  const auto bed_of = [&](std::uint32_t v) {
    const auto found = bed.find(v);
    if (found != bed.end()) return found->second;
    return bed[v] = copy(v, at_rim[v] ? 0.6f * kWoundDepth : kWoundDepth, kBed);
  };
  for (std::size_t t = 0; 3 * t < m_indices.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = m_indices[3 * t + k];
      m_open.indices.push_back(m_parted[t] ? bed_of(v) : v);
      if (m_parted[t]) m_open.paint[v].blood = std::max(m_open.paint[v].blood, std::uint8_t(70));
    }
  std::map<std::uint32_t, std::uint32_t> before, after;  // along the border
  for (const auto& [edge, count] : edges) {
    if (edges.count({edge.second, edge.first})) continue;  // both its triangles are cut
    const auto [a, b] = edge;
    after[a] = b;
    before[b] = a;
    const std::uint32_t low_a = bed_of(a), low_b = bed_of(b);
    const std::uint32_t high_a = copy(a, 0, kOrganLip), high_b = copy(b, 0, kOrganLip);
    m_open.quad(low_a, high_a, high_b, low_b);
  }
  m_rim.clear();
  for (const auto& [at, next] : after)
    if (before.count(at)) m_rim.push_back({at, before[at], next});
}

/// Positions of skin and wounds.
void OrganDrawing::sink_wounds() {
  // Whole triangles are cut, so the border runs in teeth: pull it straight.
  std::vector<Vec3f> straight(m_rim.size());
  for (int pass = 0; pass < 3; ++pass) {
    for (std::size_t i = 0; i < m_rim.size(); ++i) {
      const RimVertex& r = m_rim[i];
      straight[i] = 0.4f * m_pose.position[r.at] + 0.3f * (m_pose.position[r.before] + m_pose.position[r.after]);
    }
    for (std::size_t i = 0; i < m_rim.size(); ++i) m_pose.position[m_rim[i].at] = straight[i];
  }
  m_open.positions = m_pose.position;
  for (const WoundVertex& w : m_wound) m_open.positions.push_back(m_pose.position[w.of] - w.depth * m_normals[w.of]);
  render::vertex_normals(m_open.positions, m_open.indices, m_open.normals);
}

void OrganDrawing::update(const tissue::NetworkState& state, std::span<const std::uint8_t> parted,
                          std::span<const collision::Capsule> rods, const HeatMarks* burnt, const Blanching* blanched) {
  if (blanched && m_own_tint.empty())
    for (const Paint& p : m_paint) m_own_tint.push_back(p.tint);
  for (std::size_t i = 0; blanched && i < m_paint.size(); ++i)
    m_paint[i].tint = std::max(m_own_tint[i], blanched->pale(i));
  const bool repainted = burnt || blanched;
  for (std::size_t i = 0; burnt && i < m_paint.size(); ++i) m_paint[i].burn = burnt->burn(i);
  const auto cut = [](std::uint8_t p) { return p != 0; };
  const bool was_open = !m_wound.empty(), open = std::any_of(parted.begin(), parted.end(), cut);
  const bool changed =
      open ? repainted || !std::equal(parted.begin(), parted.end(), m_parted.begin(), m_parted.end()) : was_open;
  if (!m_moved(state.nodes) && !changed && !repainted && !m_dented && !near(m_box, rods)) return;
  ++m_version;
  tissue::pose_skin(view_of(m_solid->network, state), m_solid->fine, m_pose);
  render::vertex_normals(m_pose.position, m_indices, m_normals);
  lift();
  shrink_burns();
  m_box = {};
  for (const Vec3f& p : m_pose.position) m_box.add(p);
  m_dented = near(m_box, rods) && dent(rods, m_pose.position, m_normals);
  if (m_dented) render::vertex_normals(m_pose.position, m_indices, m_normals);
  if (!open) {
    m_wound.clear();
    m_parted.clear();
    if (changed)  // a replay that starts again
      m_mesh.replace({.positions = m_pose.position,
                      .normals = m_normals,
                      .rest = m_rest,
                      .paint = m_paint,
                      .indices = m_indices,
                      .coarser = m_coarser});
    else if (repainted)
      m_mesh.repaint(m_pose.position, m_normals, m_paint);
    else
      m_mesh.move(m_pose.position, m_normals);
    return;
  }
  if (changed) open_wounds(parted);
  sink_wounds();
  if (changed)
    m_mesh.replace(m_open.data());
  else
    m_mesh.move(m_open.positions, m_open.normals);
}

}  // namespace trocar::view
