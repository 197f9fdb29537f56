#include <algorithm>
#include <cmath>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/adhesions.hpp>
#include <trocar/view/base/looks.hpp>

namespace trocar::view {
namespace {

constexpr double kAdhesionNearest = 0.005, kAdhesionFarthest = 0.04;  // [m] from what they begin on to what they end on
constexpr double kCurtain = 0.018;                                    // [m] shorter curtains would not be seen to span
constexpr float kAdhesionLevel = 0.1f;     // sine: steeper ones would hang down to where blood gathers
constexpr int kFromStill = 2;              // curtains, at most
constexpr float kAdhesionSteepest = 0.6f;  // sine: below an organ blood gathers, which would cut them off
constexpr float kLate = 0.6f;              // of the way: what is there already ...
constexpr double kAdhesionClear = 0.7;     // sine: ... so flat over a wall would sink into it too soon
constexpr float kAim = 0.014f;             // [m] outwards and up: what lies there is aimed at
constexpr float kAdhesionApart = 0.014f;   // [m] between two
constexpr float kOffSkin = 0.003f;         // [m] a broad foot follows a gut that bends away below it
constexpr float kAdhesionSunk = 0.0012f;   // [m] both ends, in what they hang on
constexpr double kFoot = 0.30;             // of the length: there it is lost in what it hangs on ...
// Our choice, from the look of adhesions in endoscopic films.
constexpr double kAdhesionWhole = 0.42;  // openness from which the material's opacity counts in full (surface.frag)
constexpr double kSheer = 0.46;          // of that, between strands
constexpr double kCurtainSheer = 0.76;   // the same of a curtain
constexpr double kAdhesionFrayed = 0.1;  // of half the width
constexpr double kCord = 0.84;           // of half the width: where a border is rolled up
constexpr double kHem = 0.85;            // of half the width: where a veil's border is folded over
constexpr double kString = 0.2, kBroad = 0.34;  // waists
constexpr double kVeilFoot = 0.18;              // ... and of a veil's length
constexpr double kFimbriae = 0.014;             // [m] so long
constexpr double kTongue = 0.3;                 // ... and so much earlier at its sides: no foot is square

std::size_t nearest_vertex(Vec3f p, std::span<const Vec3f> points) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (length(points[i] - p) < length(points[best] - p)) best = i;
  return best;
}

/// A veil is whole but thin, with borders folded over; a string is hardly there between strands that run along it, some
/// of them rolled up at its free borders, with gaps. Frayed at its borders and gone in its feet.
/// @param u along @param v across, -1 .. 1 @param waist see Veil @param sheer of a veil between its strands
Paint paint_at(double u, double v, double waist, double sheer, int seed) {
  const double end = std::min(u, 1 - u), border = std::fabs(v), side = v > 0 ? 1 : -1;
  const double ragged = 0.35 * std::sin(7 * v + 3) + 0.65, sides = kTongue * border * border * ragged;
  const double foot = smooth(0.3 * sides, (waist > kString ? kVeilFoot : kFoot) + sides, end);
  const double frayed = border + kAdhesionFrayed * std::sin(11 * u + seed + 2 * side) * std::sin(23 * u + 1.3 * seed);
  const double broad = smooth(kString, kBroad, waist);  // 0: a string, which is denser
  const double soft = smooth(1.0, 0.7 + 0.14 * broad, frayed);
  const double across = v + 0.12 * std::sin(5 * u + seed);
  const double strands = smooth(0.2, 0.9, std::sin(6 * across + 1.7 * seed) * std::sin(3.7 * across + 0.9 * seed));
  const double cord = smooth(0.22, 0.06, std::fabs(frayed - kCord)) * (0.3 + 0.7 * varied(seed, v > 0 ? 11 : 12));
  const double torn = smooth(-0.2, 0.7, std::sin(6 * u + 4 * v + seed) + std::sin(13 * v - 3 * u + 2 * seed));
  const double narrow = (1 - broad) * 0.7 * (1 - 0.6 * border);
  const double hem = broad * smooth(0.17, 0.04, std::fabs(frayed - kHem));
  const double veil = sheer * (broad + (1 - broad) * torn) * (0.55 + 0.45 * torn);
  const double web = std::max({veil, (0.85 - 0.3 * broad) * strands, (1 - broad) * cord, narrow, hem});
  const double dense = std::max({0.30 * strands, 0.42 * cord, 0.36 * narrow, 0.7 * hem});
  return {to_byte(kAdhesionWhole * foot * soft * web), 0, 0, to_byte(smooth(0.06, 0.4, end) * soft * dense)};
}

}  // namespace

Adhesions::Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
                     std::span<const Still> still, render::Backend& backend, const Detail& detail)
    : m_down(normalised(vec_cast<float>(model.gravity), Vec3f{0, 0, -1})) {
  for (std::size_t i = 0; i < model.strands.size(); ++i) {
    if (!model.strands[i].fimbriated) continue;
    const std::vector<Vec3d>& rest = model.strand_bodies[i].model.rest;
    const Vec3d end = rest.back(), onward = normalised(end - rest[rest.size() - 2]);
    for (const Vec3d& p : rest) m_tubes.push_back(vec_cast<float>(p));
    for (int k = 1; k <= 3; ++k) m_tubes.push_back(vec_cast<float>(end + (k * kFimbriae / 3) * onward));
  }
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const Look& own = look(model, model.solids[i].look);
    const tissue::Skin& skin = model.solids[i].fine;
    if (const int most = own.count(Look::Generator::curtains); most > 0)
      choose({int(i), skin.rest, skin.rest_normal, 150 + 37 * int(i), 1, true}, most, walls);
    choose({int(i), skin.rest, skin.rest_normal, 400 + 37 * int(i)}, own.count(Look::Generator::adhesions), walls);
  }
  for (std::size_t i = 0; i < still.size(); ++i)
    if (still[i].shape->size() > 0 && still[i].to_wall > 0)
      choose({-1, still[i].shape->positions, still[i].shape->normals, 1300 + 37 * int(i), 1, true}, kFromStill, walls);
  for (std::size_t i = 0; i < still.size(); ++i)
    if (still[i].shape->size() > 0)
      choose({-1, still[i].shape->positions, still[i].shape->normals, 900 + 37 * int(i)}, still[i].to_wall, walls);
  if (m_veils.empty()) return;
  for (const Veil& veil : m_veils) {
    const std::uint32_t first = m_buffer.size();
    for (int i = 0; i < kAlong; ++i)
      for (int j = 0; j < kAcross; ++j)
        m_buffer.add({}, paint_at(double(i) / (kAlong - 1), 2.0 * j / (kAcross - 1) - 1, veil.waist,
                                  veil.on.curtains ? kCurtainSheer : kSheer, veil.seed));
    for (int i = 0; i + 1 < kAlong; ++i)
      join_rows(m_buffer, first + std::uint32_t(i * kAcross), first + std::uint32_t((i + 1) * kAcross), kAcross, false);
  }
  place(organs);
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
  for (std::size_t k = 0; k < m_veils.size(); ++k)  // what they begin on need not stay
    if (m_veils[k].on.organ < 0) m_veils[k].on.points = m_veils[k].on.normals = {};
}

/// Is all of it far from every tube, and from the fimbriae beyond its end?
bool Adhesions::clear(const Veil& veil) const {
  std::array<Vec3f, kAlong * kAcross> drawn;
  place_veil(veil, veil.on.points, veil.on.normals, drawn);
  return std::none_of(m_tubes.begin(), m_tubes.end(), [&](Vec3f tube) {
    return std::any_of(drawn.begin(), drawn.end(), [&](Vec3f p) { return length(p - tube) < kFromTubes; });
  });
}

Adhesions::Width Adhesions::width_of(const Source& source, int seed) {
  const double size = varied(seed, 7);
  if (source.curtains) return {0.017 + 0.005 * size, 0.56};
  if (varied(seed, 9) < source.veils) return {0.009 + 0.008 * size, 0.36 + 0.2 * varied(seed, 8)};
  return {(source.veils > 0 ? 0.0034 : 0.0024) + 0.003 * size, 0.1 + 0.1 * varied(seed, 8)};
}

/// Places on the source from where something is near, none near another.
void Adhesions::choose(const Source& source, int count, const WallSurface& walls) {
  const std::size_t before = m_veils.size();
  for (int k = 0; k < 80 * count && int(m_veils.size() - before) < count; ++k) {
    const int seed = source.seed + k;
    const auto v = std::size_t(varied(seed, 3) * double(source.points.size() - 1));
    const Vec3f p = source.points[v], n = source.normals[v];
    const auto close = [&](const Veil& other) {
      return other.on.organ == source.organ &&
             length(other.on.points[other.from[kAcross / 2].vertex] - p) < kAdhesionApart;
    };
    if (std::any_of(m_veils.begin(), m_veils.end(), close)) continue;
    const Vec3d aim{varied(seed, 4) - 0.5, varied(seed, 5) - 0.5, varied(seed, 6) - 0.5};
    const WallSurface::Place wall = walls.nearest(vec_cast<double>(p + kAim * (n - m_down)) + 0.016 * aim);
    const Vec3f way = vec_cast<float>(wall.point) - p;
    const float far = length(way);
    if (!wall.there || far < (source.curtains ? kCurtain : kAdhesionNearest) || far > kAdhesionFarthest ||
        dot(way, n) < 0.35f * far)
      continue;
    if (dot(way, m_down) > (source.curtains ? kAdhesionLevel : kAdhesionSteepest) * far) continue;
    const Vec3d late = vec_cast<double>(p + kLate * way);
    if (length(walls.nearest(late).point - late) < kAdhesionClear * double((1 - kLate) * far)) continue;
    const Vec3f side = normalised(cross(way, m_down + 1.2f * vec_cast<float>(aim)), any_perpendicular(normalised(way)));
    const auto [half, waist] = width_of(source, seed);
    Veil veil{source, {}, {}, 0, 0, seed};
    veil.waist = float(waist);
    veil.sag = float(0.05 + 0.15 * varied(seed, 10));
    for (std::size_t j = 0; j < kAcross; ++j) {
      const Vec3f beside = float(half * (2.0 * double(j) / (kAcross - 1) - 1)) * side;
      const std::size_t vertex = j == kAcross / 2 ? v : nearest_vertex(p + beside, source.points);
      const Vec3f off = p + beside - source.points[vertex];
      veil.from[j] = {vertex, (kOffSkin / std::max(length(off), kOffSkin)) * off};
      const WallSurface::Place foot = walls.nearest(wall.point + 1.3 * vec_cast<double>(beside));
      veil.to[j] = vec_cast<float>(foot.point) - kAdhesionSunk * vec_cast<float>(foot.normal);
    }
    if (clear(veil)) m_veils.push_back(veil);
  }
}

void Adhesions::place(const std::vector<OrganDrawing>& organs) {
  for (std::size_t k = 0; k < m_veils.size(); ++k) {
    const Source& on = m_veils[k].on;
    const std::span<Vec3f> out = std::span(m_buffer.positions).subspan(k * kAlong * kAcross, kAlong * kAcross);
    if (on.organ >= 0) {
      const OrganDrawing& organ = organs[std::size_t(on.organ)];
      place_veil(m_veils[k], organ.positions(), organ.normals(), out);
    } else if (!on.points.empty()) {
      place_veil(m_veils[k], on.points, on.normals, out);
    }
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void Adhesions::place_veil(const Veil& veil, std::span<const Vec3f> points, std::span<const Vec3f> normals,
                           std::span<Vec3f> out) const {
  std::array<Vec3f, kAcross> from;
  for (std::size_t j = 0; j < kAcross; ++j) {
    const OnSkin& at = veil.from[j];
    const Vec3f n = normals[at.vertex];
    from[j] = points[at.vertex] + at.beside - (dot(at.beside, n) + kAdhesionSunk) * n;
  }
  const Vec3f a = from[kAcross / 2], b = veil.to[kAcross / 2];
  const float far = length(b - a);
  for (int i = 0; i < kAlong; ++i) {
    const float u = float(i) / (kAlong - 1), middle = 4 * u * (1 - u), edge = std::fabs(2 * u - 1);
    const float narrow = veil.waist + (1 - veil.waist) * edge * edge * (0.5f + 0.5f * edge);
    const Vec3f sag = (veil.sag * far * middle) * m_down;
    for (std::size_t j = 0; j < kAcross; ++j) {
      const Vec3f beside = (1 - u) * (from[j] - a) + u * (veil.to[j] - b);
      const float ripple = 0.2f * middle * std::sin(1.1f * float(j) + 5 * u + float(veil.seed));
      out[std::size_t(i) * kAcross + j] =
          a + u * (b - a) + sag + narrow * beside + (ripple * narrow * length(beside)) * m_down;
    }
  }
}

void Adhesions::update(const std::vector<OrganDrawing>& organs) {
  std::uint64_t version = 0;
  for (const Veil& veil : m_veils)
    if (veil.on.organ >= 0) version += organs[std::size_t(veil.on.organ)].version();
  if (version == m_version) return;
  m_version = version;
  place(organs);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
