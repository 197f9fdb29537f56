#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/base/finding_drawing.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/moved.hpp>

namespace trocar::view {
namespace {

constexpr int kFindingRings = 16, kFindingSectors = 40;
constexpr double kSunk = 0.0007;  // [m] below the skin where it ends: deeper than an organ's relief

/// Radius of its border at this angle, of its mean one: no disc.
double border(double angle) {
  return 1 + 0.09 * std::sin(2 * angle + 0.7) + 0.07 * std::sin(3 * angle + 2.1) + 0.04 * std::sin(7 * angle);
}
/// Height over the skin at `out`, 0 in the middle to 1 at the border, of what stands out by `high` [m].
double dome(double out, double high) {
  const double flat = high > 0.001 ? 2 : 6;  // a nub is round, a patch is flat
  return (high + kSunk) * std::sqrt(std::max(0.0, 1 - std::pow(out, flat))) - kSunk;
}

}  // namespace

bool FindingDrawing::draws(const sim::Model& model, const sim::MarkModel& mark) {
  return !mark.look.empty() && mark.on_organ() && sim::lattice_of(model, mark.body()) >= 0;
}

FindingDrawing::FindingDrawing(const sim::Model& model, const sim::MarkModel& mark, render::Backend& backend)
    : m_model(&model),
      m_organ(mark.body()),
      m_solid(sim::lattice_of(model, mark.body())),
      m_backend(&backend),
      m_material(&look(model, mark.look).material) {
  lay(mark);
}

std::int32_t FindingDrawing::number_of(std::int32_t vertex) {
  const auto at = std::find(m_vertex.begin(), m_vertex.end(), vertex);
  if (at != m_vertex.end()) return std::int32_t(at - m_vertex.begin());
  m_vertex.push_back(vertex);
  return std::int32_t(m_vertex.size()) - 1;
}

FindingDrawing::Foot FindingDrawing::foot_of(Vec3d p, std::span<const std::int32_t> near, float high) {
  const tissue::Skin& skin = m_model->solids[std::size_t(m_solid)].fine;
  Foot foot;
  double least = 1e30;
  std::array<int, 3> best{};
  for (const std::int32_t t : near) {
    const auto& corner = skin.triangles[std::size_t(t)];
    const auto at = geometry::closest_on_triangle(p, vec_cast<double>(skin.rest[std::size_t(corner[0])]),
                                                  vec_cast<double>(skin.rest[std::size_t(corner[1])]),
                                                  vec_cast<double>(skin.rest[std::size_t(corner[2])]));
    if (at.distance2 >= least) continue;
    least = at.distance2;
    best = {corner[0], corner[1], corner[2]};
    foot.weight = vec_cast<float>(at.weights);
  }
  for (std::size_t i = 0; i < 3; ++i) foot.corner[i] = number_of(best[i]);
  foot.high = high;
  return foot;
}

void FindingDrawing::lay(const sim::MarkModel& mark) {
  const tissue::Skin& skin = m_model->solids[std::size_t(m_solid)].fine;
  std::vector<std::int32_t> near;  // triangles about it, of its own side
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const auto v = std::size_t(skin.triangles[t][0]);
    const bool faces = dot(vec_cast<double>(skin.rest_normal[v]), mark.normal) > -0.3;
    if (faces && length(vec_cast<double>(skin.rest[v]) - mark.place) < 1.6 * mark.half + 0.004)
      near.push_back(std::int32_t(t));
  }
  if (near.empty()) return;
  const Vec3d aside = std::fabs(mark.normal.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d right = normalised(cross(aside, mark.normal)), up = cross(mark.normal, right);
  for (int r = 0; r <= kFindingRings; ++r)
    for (int k = 0; k < kFindingSectors; ++k) {
      const double angle = 2 * portable::pi * k / kFindingSectors, out = double(r) / kFindingRings;
      const double way = mark.half * out * border(angle);
      const Vec3d p = mark.place + way * (std::cos(angle) * right + std::sin(angle) * up);
      m_foot.push_back(foot_of(p, near, float(dome(out, mark.high))));
      const double tint = std::max(0.0, std::min(1.0, 1.6 - 1.6 * out));
      m_buffer.add({}, Paint{235, 0, 0, std::uint8_t(255 * tint)});
    }
  const auto number = [](int r, int k) { return std::uint32_t(r * kFindingSectors + k % kFindingSectors); };
  for (int r = 0; r < kFindingRings; ++r)
    for (int k = 0; k < kFindingSectors; ++k)
      m_buffer.quad(number(r, k), number(r + 1, k), number(r + 1, k + 1), number(r, k + 1));
  m_place.resize(m_vertex.size());
}

void FindingDrawing::update(const sim::State& state) {
  if (m_foot.empty()) return;
  const tissue::Skin& skin = m_model->solids[std::size_t(m_solid)].fine;
  const tissue::NodeView nodes = nodes_of(*m_model, state, m_organ);
  bool moved = !m_there;
  for (std::size_t i = 0; i < m_vertex.size(); ++i) {
    const auto now = vec_cast<float>(tissue::skin_point(nodes, skin, m_vertex[i]));
    moved = moved || length(now - m_place[i]) > float(kSeenToMove);
    m_place[i] = now;
  }
  if (!moved) return;
  for (std::size_t i = 0; i < m_foot.size(); ++i) {
    const Foot& f = m_foot[i];
    const Vec3f a = m_place[std::size_t(f.corner[0])], b = m_place[std::size_t(f.corner[1])],
                c = m_place[std::size_t(f.corner[2])];
    const Vec3f out = normalised(cross(b - a, c - a));
    m_buffer.positions[i] = f.weight.x * a + f.weight.y * b + f.weight.z * c + f.high * out;
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  if (m_there) return m_mesh.move(m_buffer.positions, m_buffer.normals);
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(*m_backend, m_buffer.data());
  m_there = true;
}

void FindingDrawing::list(std::size_t part, const Listing& to) const {
  if (!m_there) return;
  render::DrawItem drawn;
  drawn.mesh = m_mesh.handle();
  drawn.material = *m_material;
  drawn.part = std::uint16_t(part);
  to.add(drawn);
}

}  // namespace trocar::view
