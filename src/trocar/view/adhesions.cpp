#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/adhesions.hpp>
#include <trocar/view/looks.hpp>

namespace trocar::view {
namespace {

constexpr int kAlong = 13, kAcross = 6;               // vertices of a veil
constexpr double kNearest = 0.005, kFarthest = 0.03;  // [m] from the organ to the wall
constexpr float kApart = 0.016f;                      // [m] between two
constexpr float kSunk = 0.0012f;                      // [m] both ends, in what they hang on
constexpr float kSag = 0.08f;                         // of the length

}  // namespace

Adhesions::Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
                     render::Backend& backend)
    : m_down(normalised(vec_cast<float>(model.gravity), Vec3f{0, 0, -1})) {
  for (std::size_t i = 0; i < organs.size(); ++i)
    choose(i, look(model.solids[i].look).adhesions, model.solids[i].fine, walls);
  if (m_veils.empty()) return;
  for (std::size_t k = 0; k < m_veils.size(); ++k) {
    const std::uint32_t first = m_buffer.size();
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j) {
        // Denser towards its ends and its borders; the borders themselves are strings.
        const double u = double(i) / (kAlong - 1), v = std::fabs(2.0 * j / (kAcross - 1) - 1);
        const double ends = smooth(0.3, 0, std::min(u, 1 - u));
        m_buffer.add({}, {to_byte(std::min(u, 1 - u) * (kAlong - 1) < 0.5 ? 0.1 : 1), 0, 0,
                          to_byte(std::max(0.5 * smooth(0.5, 1, v), 0.35 * ends))});
      }
    for (int i = 0; i + 1 < kAlong; ++i)
      join_rows(m_buffer, first + std::uint32_t(i * kAcross), first + std::uint32_t((i + 1) * kAcross), kAcross, false);
  }
  place(organs);
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

/// Places on the organ from where the wall is near, none near another.
void Adhesions::choose(std::size_t organ, int count, const tissue::Skin& skin, const WallSurface& walls) {
  const int seed = 400 + 37 * int(organ);
  const std::size_t before = m_veils.size();
  for (int k = 0; k < 60 * count && int(m_veils.size() - before) < count; ++k) {
    const auto v = std::size_t(varied(seed + k, 3) * double(skin.rest.size() - 1));
    const Vec3f p = skin.rest[v], n = skin.rest_normal[v];
    const auto close = [&](const Veil& other) {
      return other.organ == organ && length(skin.rest[other.vertex] - p) < kApart;
    };
    if (std::any_of(m_veils.begin(), m_veils.end(), close)) continue;
    const Vec3d aim{varied(seed + k, 4) - 0.5, varied(seed + k, 5) - 0.5, varied(seed + k, 6) - 0.5};
    const WallSurface::Place wall = walls.nearest(vec_cast<double>(p + 0.012f * n) + 0.016 * aim);
    const Vec3f way = vec_cast<float>(wall.point) - p;
    const float far = length(way);
    if (!wall.there || far < kNearest || far > kFarthest || dot(way, n) < 0.35f * far) continue;
    Veil veil;
    veil.organ = organ;
    veil.vertex = v;
    veil.to = vec_cast<float>(wall.point);
    veil.to_normal = vec_cast<float>(wall.normal);
    veil.side = normalised(cross(way, vec_cast<float>(aim)), any_perpendicular(normalised(way)));
    veil.wide = float(0.0012 + 0.0045 * varied(seed + k, 7) * varied(seed + k, 7));
    veil.waist = float(0.12 + 0.4 * varied(seed + k, 8));
    veil.seed = seed + k;
    m_veils.push_back(veil);
  }
}

void Adhesions::place(const std::vector<OrganDrawing>& organs) {
  std::size_t at = 0;
  for (const Veil& veil : m_veils) {
    const OrganDrawing& organ = organs[veil.organ];
    const Vec3f a = organ.positions()[veil.vertex] - kSunk * organ.normals()[veil.vertex];
    const Vec3f b = veil.to - kSunk * veil.to_normal, way = b - a;
    const Vec3f side = normalised(veil.side - dot(veil.side, normalised(way)) * normalised(way), veil.side);
    for (int i = 0; i < kAlong; ++i) {
      const float u = float(i) / (kAlong - 1), middle = 4 * u * (1 - u);
      const float half = veil.wide * (1 - (1 - veil.waist) * middle * (2 - middle));
      const Vec3f centre = a + u * way + (kSag * length(way) * middle) * m_down +
                           (0.0006f * middle * std::sin(9 * u + float(veil.seed))) * side;
      for (int j = 0; j < kAcross; ++j) {
        const float v = 2 * float(j) / (kAcross - 1) - 1;
        const float ripple = 0.15f * half * std::sin(5 * v + 4 * u + float(veil.seed));
        m_buffer.positions[at++] = centre + (half * v) * side + ripple * cross(normalised(way), side);
      }
    }
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void Adhesions::update(const std::vector<OrganDrawing>& organs) {
  if (m_veils.empty()) return;
  place(organs);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
