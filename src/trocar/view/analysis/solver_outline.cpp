#include <algorithm>

#include <trocar/view/analysis/solver_outline.hpp>

namespace trocar::view {
namespace {

constexpr float kNearer = 0.06f;       // share of the way to the eye that wires come nearer, so that nothing hides them
constexpr float kHalfWidth = 0.0006f;  // of a wire, seen from 1 m [m]
constexpr float kFinest = 0.025f;      // [rad] mean edge: finer ones hide the colours

Vec3f normal_of(const std::vector<Vec3f>& at, const std::array<int, 3>& t) {
  const Vec3f a = at[std::size_t(t[0])];
  return cross(at[std::size_t(t[1])] - a, at[std::size_t(t[2])] - a);
}

/// Edges of triangles that face the eye, each once for each of them, in order.
std::vector<std::array<int, 2>> facing_edges(const tissue::Skin& skin, const std::vector<Vec3f>& at, Vec3f eye) {
  std::vector<std::array<int, 2>> edges;
  for (const std::array<int, 3>& t : skin.triangles) {
    if (dot(normal_of(at, t), eye - at[std::size_t(t[0])]) <= 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Only those of one facing triangle: the silhouette.
void keep_silhouette(std::vector<std::array<int, 2>>& edges) {
  std::vector<std::array<int, 2>> once;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if ((i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i]))
      once.push_back(edges[i]);
  edges = std::move(once);
}

/// So far away that wires would lie side by side and hide the colours?
bool is_far(const std::vector<std::array<int, 2>>& edges, const std::vector<Vec3f>& at, Vec3f eye) {
  float seen = 0;
  for (const auto& [a, b] : edges)
    seen += length(at[std::size_t(a)] - at[std::size_t(b)]) / length(eye - at[std::size_t(a)]);
  return seen < kFinest * float(edges.size());
}

/// A wire as a band that faces the eye, as wide from afar as from near.
void add_wire(MeshBuffer& to, Vec3f a, Vec3f b, Vec3f eye, Paint paint) {
  const Vec3f near_a = a + kNearer * (eye - a), near_b = b + kNearer * (eye - b);
  const Vec3f across = normalised(cross(near_b - near_a, eye - near_a), Vec3f{1, 0, 0});
  const Vec3f side_a = kHalfWidth * length(eye - near_a) * across, side_b = kHalfWidth * length(eye - near_b) * across;
  const std::uint32_t first = to.add(near_a - side_a, paint);
  to.add(near_b - side_b, paint), to.add(near_b + side_b, paint), to.add(near_a + side_a, paint);
  to.quad(first, first + 1, first + 2, first + 3);
}

const tissue::Skin& drawn_skin(const sim::Model& model, int organ) {
  const std::int32_t lattice = sim::lattice_of(model, organ);
  return lattice >= 0 ? model.solids[std::size_t(lattice)].fine : model.skin(organ);
}

}  // namespace

void SolverOutline::update(const sim::State& state, const OrganBeside& beside, const AnalysisOptions& o, Vec3f eye,
                           render::Backend& backend) {
  update_surface(state, beside, o, backend);
  update_wires(beside, eye, backend);
}

void SolverOutline::update_surface(const sim::State& state, const OrganBeside& beside, const AnalysisOptions& o,
                                   render::Backend& backend) {
  const tissue::Skin& skin = drawn_skin(*m_model, beside.organ);
  tissue::SkinPose pose = tissue::make_pose(skin);
  pose_skin(nodes_of(*m_model, state, beside.organ), skin, pose);
  const bool first = m_surface.buffer.indices.empty();
  if (first)
    for (const std::array<int, 3>& t : skin.triangles)
      m_surface.buffer.triangle(std::uint32_t(t[0]), std::uint32_t(t[1]), std::uint32_t(t[2]));
  m_surface.buffer.positions = std::move(pose.position);
  m_surface.value.assign(m_surface.buffer.positions.size(), 0);
  m_surface.buffer.paint.resize(m_surface.value.size());
  for (std::size_t v = 0; v < m_surface.value.size(); ++v) {
    if (skin.at_surface(int(v))) m_surface.value[v] = length(m_surface.buffer.positions[v] - beside.skin[v]);
    m_surface.buffer.paint[v] = paint_shown_as(colour_of_distance(o, double(m_surface.value[v])));
  }
  m_surface.show(backend, first);
}

void SolverOutline::update_wires(const OrganBeside& beside, Vec3f eye, render::Backend& backend) {
  const std::vector<std::uint32_t> before = std::exchange(m_wires.buffer.indices, {});
  m_wires.buffer.positions.clear(), m_wires.buffer.paint.clear();
  const Paint paint = paint_shown_as(kOtherSolver);
  std::vector<std::array<int, 2>> edges = facing_edges(m_model->skin(beside.organ), beside.outline, eye);
  if (is_far(edges, beside.outline, eye)) keep_silhouette(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges)
    add_wire(m_wires.buffer, beside.outline[std::size_t(a)], beside.outline[std::size_t(b)], eye, paint);
  m_wires.show(backend, m_wires.buffer.indices.size() != before.size());
}

}  // namespace trocar::view
