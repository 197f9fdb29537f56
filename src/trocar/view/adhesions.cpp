#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/adhesions.hpp>
#include <trocar/view/looks.hpp>

namespace trocar::view {
namespace {

constexpr double kNearest = 0.005, kFarthest = 0.036;  // [m] from the organ to the wall
constexpr float kSteepest = 0.6f;                      // sine: below an organ blood gathers, which would cut them off
constexpr float kLate = 0.6f;                          // of the way: what is there already ...
constexpr double kClear = 0.7;                         // sine: ... so flat over a wall would sink into it too soon
constexpr float kAim = 0.014f;                         // [m] outwards and up: what lies there is aimed at
constexpr float kApart = 0.016f;                       // [m] between two
constexpr float kSunk = 0.0012f;                       // [m] both ends, in what they hang on
constexpr float kSag = 0.08f;                          // of the length
constexpr double kFoot = 0.24;                         // of the length: there it is lost in what it hangs on ...
constexpr double kTongue = 0.3;                        // ... and so much earlier at its sides: no foot is square

std::size_t nearest_vertex(Vec3f p, const tissue::Skin& skin) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < skin.rest.size(); ++i)
    if (length(skin.rest[i] - p) < length(skin.rest[best] - p)) best = i;
  return best;
}

/// Thin and soft at its borders, dense where it is narrow, gone in its feet. @param u along @param v across, -1 .. 1
Paint paint_at(double u, double v) {
  const double end = std::min(u, 1 - u), border = std::fabs(v);
  const double ragged = 0.35 * std::sin(7 * v + 3) + 0.65, sides = kTongue * border * border * ragged;
  const double foot = smooth(0.4 * sides, kFoot + sides, end), soft = smooth(1.02, 0.5, border);
  return {to_byte(0.62 * foot * (0.3 + 0.7 * soft)), 0, 0,
          to_byte(0.12 + 0.5 * smooth(0.1, 0.4, end) * (1 - 0.7 * border))};
}

}  // namespace

bool Adhesions::Veil::near(Vec3f p, const tissue::Skin& skin) const {
  return length(skin.rest[from[kAcross / 2].vertex] - p) < kApart;
}

Adhesions::Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
                     render::Backend& backend, const Detail& detail)
    : m_down(normalised(vec_cast<float>(model.gravity), Vec3f{0, 0, -1})) {
  for (std::size_t i = 0; i < organs.size(); ++i)
    choose(i, look(model.solids[i].look).adhesions, model.solids[i].fine, walls);
  if (m_veils.empty()) return;
  for (std::size_t k = 0; k < m_veils.size(); ++k) {
    const std::uint32_t first = m_buffer.size();
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j)
        m_buffer.add({}, paint_at(double(i) / (kAlong - 1), 2.0 * j / (kAcross - 1) - 1));
    for (int i = 0; i + 1 < kAlong; ++i)
      join_rows(m_buffer, first + std::uint32_t(i * kAcross), first + std::uint32_t((i + 1) * kAcross), kAcross, false);
  }
  place(organs);
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

/// Places on the organ from where the wall is near, none near another.
void Adhesions::choose(std::size_t organ, int count, const tissue::Skin& skin, const WallSurface& walls) {
  const int seed = 400 + 37 * int(organ);
  const std::size_t before = m_veils.size();
  for (int k = 0; k < 60 * count && int(m_veils.size() - before) < count; ++k) {
    const auto v = std::size_t(varied(seed + k, 3) * double(skin.rest.size() - 1));
    const Vec3f p = skin.rest[v], n = skin.rest_normal[v];
    const auto close = [&](const Veil& other) { return other.organ == organ && other.near(p, skin); };
    if (std::any_of(m_veils.begin(), m_veils.end(), close)) continue;
    const Vec3d aim{varied(seed + k, 4) - 0.5, varied(seed + k, 5) - 0.5, varied(seed + k, 6) - 0.5};
    const WallSurface::Place wall = walls.nearest(vec_cast<double>(p + kAim * (n - m_down)) + 0.016 * aim);
    const Vec3f way = vec_cast<float>(wall.point) - p;
    const float far = length(way);
    if (!wall.there || far < kNearest || far > kFarthest || dot(way, n) < 0.35f * far) continue;
    if (dot(way, m_down) > kSteepest * far) continue;
    const Vec3d late = vec_cast<double>(p + kLate * way);
    if (length(walls.nearest(late).point - late) < kClear * double((1 - kLate) * far)) continue;
    const Vec3f side = normalised(cross(way, vec_cast<float>(aim)), any_perpendicular(normalised(way)));
    const double wide = varied(seed + k, 7), half = 0.0034 + 0.0056 * wide * wide;
    Veil veil;
    veil.organ = organ;
    veil.waist = float(0.11 + 0.36 * varied(seed + k, 8) * wide);
    veil.seed = seed + k;
    for (std::size_t j = 0; j < kAcross; ++j) {
      const Vec3f beside = float(half * (2.0 * double(j) / (kAcross - 1) - 1)) * side;
      const std::size_t vertex = j == kAcross / 2 ? v : nearest_vertex(p + beside, skin);
      veil.from[j] = {vertex, p + beside - skin.rest[vertex]};
      const WallSurface::Place foot = walls.nearest(wall.point + 1.3 * vec_cast<double>(beside));
      veil.to[j] = vec_cast<float>(foot.point) - kSunk * vec_cast<float>(foot.normal);
    }
    m_veils.push_back(veil);
  }
}

void Adhesions::place(const std::vector<OrganDrawing>& organs) {
  for (std::size_t k = 0; k < m_veils.size(); ++k)
    place_veil(m_veils[k], organs[m_veils[k].organ], k * kAlong * kAcross);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void Adhesions::place_veil(const Veil& veil, const OrganDrawing& organ, std::size_t first) {
  std::array<Vec3f, kAcross> from;
  for (std::size_t j = 0; j < kAcross; ++j) {
    const OnSkin& at = veil.from[j];
    const Vec3f n = organ.normals()[at.vertex];
    from[j] = organ.positions()[at.vertex] + at.beside - (dot(at.beside, n) + kSunk) * n;
  }
  const Vec3f a = from[kAcross / 2], b = veil.to[kAcross / 2];
  const float far = length(b - a);
  for (int i = 0; i < kAlong; ++i) {
    const float u = float(i) / (kAlong - 1), middle = 4 * u * (1 - u), edge = std::fabs(2 * u - 1);
    const float narrow = veil.waist + (1 - veil.waist) * edge * edge * edge;
    const Vec3f sag = (kSag * far * middle) * m_down;
    for (std::size_t j = 0; j < kAcross; ++j) {
      const Vec3f beside = (1 - u) * (from[j] - a) + u * (veil.to[j] - b);
      const float ripple = 0.12f * middle * std::sin(1.7f * float(j) + 5 * u + float(veil.seed));
      m_buffer.positions[first + std::size_t(i) * kAcross + j] =
          a + u * (b - a) + sag + narrow * beside + (ripple * narrow * length(beside)) * m_down;
    }
  }
}

void Adhesions::update(const std::vector<OrganDrawing>& organs) {
  std::uint64_t version = 0;
  for (const Veil& veil : m_veils) version += organs[veil.organ].version();
  if (version == m_version) return;
  m_version = version;
  place(organs);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
