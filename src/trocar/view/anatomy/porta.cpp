#include <algorithm>
#include <cmath>
#include <optional>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/geometry/surfaces/point_grid.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/render/meshes/openness.hpp>
#include <trocar/view/anatomy/porta.hpp>
#include <trocar/view/objects/fat_surface.hpp>

namespace trocar::view {
namespace {

constexpr float kPortaCell = 0.0008f;                    // [m] of the grid that its surface is taken from
constexpr float kPortaGrid = 0.006f;                     // [m] in which places of skins are found
constexpr double kBesideWall = 0.02;                     // [m] an entry further from the wall is not its affair
constexpr double kStride = 0.0005;                       // [m] along a strand, looking for where it goes in
constexpr double kSample = 0.0015;                       // [m] between lobules
constexpr double kPortaLobule = 0.0040;                  // [m] reach of a lobule's bell ...
constexpr double kSheetAbove = 0.78;                     // ... of which so much is below the surface of a sheet of them
constexpr double kCleft = 0.0105;                        // [m] so far up the organ and down the ligament it reaches
constexpr double kCleftDeep = 0.0020;                    // [m] how thick it is in the cleft ...
constexpr double kEntryMore = 0.0010;                    // [m] ... and how much more where strands go in
constexpr double kPortaSunk = 0.0009;                    // [m] below what it lies on, where it is lost
constexpr double kNearEntry = 0.010, kFarEntry = 0.034;  // [m] from an entry it is whole, and not there
constexpr double kSleeve = 0.012;                        // [m] along a strand, out of the organ
constexpr double kSleeveThick = 0.0011;                  // [m] where it is thickest
constexpr double kAside = 0.0007;                        // [m] how far from the strand's line its lobules lie
constexpr double kBuried = 0.0014;                       // [m] below a skin nothing of it is seen
constexpr double kThin = 0.0017;                         // [m] above the organ
constexpr double kGoesAlong = 0.001, kStays = 0.011;     // [m] from the organ

/// Places on a skin, as drawn.
class DrawnSkin {
 public:
  explicit DrawnSkin(const tissue::Skin& skin) : m_skin(&skin) {
    std::vector<std::uint8_t> surface;
    for (int v = 0; v < int(skin.rest.size()); ++v) surface.push_back(skin.at_surface(v) ? 1 : 0);
    m_grid.emplace(skin.rest, kPortaGrid, surface);
  }

  struct Place {
    std::uint32_t vertex = 0;
    Vec3d point, normal;
    double above = 1;  ///< [m] < 0: below it
  };
  /// @return above = 1 where nothing is within `reach`
  Place nearest(Vec3d p, double reach) const {
    Place best;
    float least = float(reach * reach);
    bool found = false;
    m_grid->visit(vec_cast<float>(p), float(reach), [&](std::uint32_t v) {
      const Vec3f d = m_skin->rest[v] - vec_cast<float>(p);
      if (const float d2 = dot(d, d); d2 < least) least = d2, best.vertex = v, found = true;
    });
    if (!found) return best;
    double away = 1;
    for (int f = m_skin->face_first[best.vertex]; f < m_skin->face_first[best.vertex + 1]; ++f) {
      const auto& t = m_skin->triangles[std::size_t(m_skin->face[std::size_t(f)])];
      const auto corner = [&](std::size_t k) { return vec_cast<double>(m_skin->rest[std::size_t(t[k])]); };
      const auto normal = [&](std::size_t k) { return vec_cast<double>(m_skin->rest_normal[std::size_t(t[k])]); };
      const auto at = geometry::closest_on_triangle(p, corner(0), corner(1), corner(2));
      if (at.distance2 >= away) continue;
      away = at.distance2;
      best.point = at.point;
      best.normal = normalised(at.weights.x * normal(0) + at.weights.y * normal(1) + at.weights.z * normal(2));
    }
    best.above = dot(p - best.point, best.normal) < 0 ? -std::sqrt(away) : std::sqrt(away);
    return best;
  }
  const tissue::Skin& skin() const { return *m_skin; }

 private:
  const tissue::Skin* m_skin;
  std::optional<geometry::PointGrid> m_grid;
};

/// A strand as drawn, by the way from one of its ends.
class DrawnLine {
 public:
  DrawnLine(const interactions::StrandBody& body, bool from_start) : m_points(body.model.rest) {
    if (!from_start) std::reverse(m_points.begin(), m_points.end());
    for (std::size_t i = 1; i < m_points.size(); ++i) m_length += length(m_points[i] - m_points[i - 1]);
  }
  struct Place {
    Vec3d point, along;
  };
  Place at(double way) const {
    std::size_t i = 1;
    double edge = length(m_points[1] - m_points[0]);
    for (; i + 1 < m_points.size() && way > edge; edge = length(m_points[i] - m_points[i - 1])) way -= edge, ++i;
    const Vec3d along = normalised(m_points[i] - m_points[i - 1], Vec3d{0, 0, 1});
    return {m_points[i - 1] + way * along, along};
  }
  double length_of_it() const { return m_length; }

 private:
  std::vector<Vec3d> m_points;
  double m_length = 0;
};

double radius_of(const sim::StrandAnatomy& strand, bool start) {
  return start ? strand.outer.front() : strand.outer.back();
}

/// Lobules, as they are laid one by one.
class Cushion {
 public:
  Cushion(const DrawnSkin& wall, const DrawnSkin& organ, std::span<const PortaEntry> entries)
      : m_wall(wall), m_organ(organ), m_entries(entries) {}

  void lay_in_cleft() {
    lay_on(m_wall, m_organ);
    lay_on(m_organ, m_wall);
  }

  /// Around a strand, out of the organ: less and less, until the strand has come out of it.
  void lay_around(const DrawnLine& line, const PortaEntry& e, double way) {
    for (double s = -0.003; s < kSleeve; s += kSample) {
      const DrawnLine::Place at = line.at(way + s);
      const Vec3d u = any_perpendicular(at.along), v = cross(at.along, u);
      const double there = smooth(kSleeve, 0.15 * kSleeve, s + 0.001 * waves(at.point, 0.008));
      const double radius = e.radius + (kSleeveThick + kPortaSunk) * there - kPortaSunk;
      // Of a row of bells this far apart the sum is a half at that radius.
      double reach = 2 * radius;
      for (int k = 0; k < 12; ++k)
        reach = radius / std::sqrt(std::max(0.05, 1 - std::pow(0.469 * kSample / reach, 0.4)));
      DrawnLobule l;
      l.place = l.rest =
          vec_cast<float>(at.point + kAside * ((2 * varied(m_next, 5) - 1) * u + (2 * varied(m_next, 6) - 1) * v));
      l.reach = float(reach * (0.96 + 0.08 * varied(m_next++, 7)));
      m_lobules.push_back(l);
    }
  }

  double from_entry(Vec3d p) const {
    double least = 1;
    for (const PortaEntry& e : m_entries) least = std::min(least, length(p - e.at));
    return least;
  }
  std::span<const DrawnLobule> lobules() const { return m_lobules; }

 private:
  /// On one skin, along where it comes near the other one.
  void lay_on(const DrawnSkin& own, const DrawnSkin& other) {
    const tissue::Skin& skin = own.skin();
    for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
      const auto corner = [&](std::size_t k) { return vec_cast<double>(skin.rest[std::size_t(skin.triangles[t][k])]); };
      const Vec3d a = corner(0), b = corner(1), c = corner(2);
      if (from_entry((a + b + c) / 3.0) > kFarEntry + 0.004) continue;
      const auto normal = vec_cast<double>(skin.rest_normal[std::size_t(skin.triangles[t][0])]);
      const int parts = std::max(1, int(std::sqrt(length(cross(b - a, c - a))) / kSample + 0.5));
      for (int j = 0; j < parts; ++j)
        for (int i = 0; i + j < parts; ++i)
          sheet(a + ((i + varied(m_next, 1)) / parts) * (b - a) + ((j + varied(m_next, 2)) / parts) * (c - a), normal,
                other);
    }
  }

  /// Is this the organ's side that strands go into? The ligament's front may be drawn on through it.
  bool faces(Vec3d organ_normal) const {
    return std::any_of(m_entries.begin(), m_entries.end(),
                       [&](const PortaEntry& e) { return dot(organ_normal, e.out) > 0; });
  }
  void sheet(Vec3d p, Vec3d normal, const DrawnSkin& other) {
    const DrawnSkin::Place near = other.nearest(p, kCleft + 0.004);
    const double far = near.above;
    if (far < -0.003 || far > kCleft || !faces(&other == &m_organ ? near.normal : normal)) return;
    const double from = from_entry(p), whole = smooth(kFarEntry, kNearEntry, from + 0.004 * waves(p, 0.02));
    const double ragged = 0.0028 * waves(p, 0.009) + 0.0012 * waves(p, 0.0045);
    const double up = smooth(kCleft, 0.1 * kCleft, std::max(far, 0.0) + ragged) * whole;
    const double more = kEntryMore * smooth(0.012, 0.004, from);
    add(p, normal, (kCleftDeep + more + kPortaSunk) * up - kPortaSunk);
  }
  void add(Vec3d on, Vec3d out, double thick) {
    const double reach = kPortaLobule * (0.85 + 0.3 * varied(m_next, 4)), lump = 0.0006 * waves(on, 0.0055);
    ++m_next;
    DrawnLobule l;
    l.place = l.rest = vec_cast<float>(on + (thick + lump - kSheetAbove * reach) * out);
    l.reach = float(reach);
    m_lobules.push_back(l);
  }

  const DrawnSkin &m_wall, &m_organ;
  std::span<const PortaEntry> m_entries;
  std::vector<DrawnLobule> m_lobules;
  int m_next = 0;
};

/// Leaves out what lies below either skin.
void bare(MeshBuffer& mesh, const DrawnSkin& wall, const DrawnSkin& organ) {
  std::vector<std::uint8_t> buried;
  for (const Vec3f& at : mesh.positions) {
    const auto p = vec_cast<double>(at);
    const double below_wall = wall.nearest(p, 0.012).above, below_organ = organ.nearest(p, 0.012).above;
    buried.push_back(below_wall < -kBuried || below_organ < -kBuried ? 1 : 0);
  }
  std::vector<std::uint32_t> seen;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    if (!buried[mesh.indices[t]] || !buried[mesh.indices[t + 1]] || !buried[mesh.indices[t + 2]])
      seen.insert(seen.end(), mesh.indices.begin() + std::ptrdiff_t(t), mesh.indices.begin() + std::ptrdiff_t(t + 3));
  mesh.indices = std::move(seen);
}

}  // namespace

std::vector<PortaEntry> porta_entries(const sim::Model& model, std::size_t wall, std::size_t solid) {
  const DrawnSkin organ(model.solids[solid].fine), front(model.walls[wall].skin);
  std::vector<PortaEntry> entries;
  for (std::size_t i = 0; i < model.strands.size(); ++i)
    for (const bool start : {true, false}) {
      const sim::StrandAnatomy& strand = model.strands[i];
      if ((start ? strand.start : strand.end).kind != sim::StrandEndModel::fixed) continue;
      const DrawnLine line(model.strand_bodies[i], start);
      // From its middle towards the end: that may lie behind the organ.
      double way = 0.5 * line.length_of_it();
      while (way > 0 && organ.nearest(line.at(way).point, 0.012).above >= 0) way -= kStride;
      if (way <= 0) continue;
      const DrawnLine::Place at = line.at(way);
      if (front.nearest(at.point, kBesideWall).above >= 1) continue;
      entries.push_back(
          {i, at.point, at.along, start ? way : line.length_of_it() - way, start, radius_of(strand, start)});
    }
  return entries;
}

Porta::Porta(const sim::Model& model, std::size_t wall, std::size_t solid, std::span<const PortaEntry> entries,
             render::Backend& backend)
    : m_wall(wall), m_solid(solid), m_detail(levels_of(model, model.walls[wall].name)) {
  const DrawnSkin organ(model.solids[solid].fine), front(model.walls[wall].skin);
  Cushion cushion(front, organ, entries);
  cushion.lay_in_cleft();
  for (const PortaEntry& e : entries) {
    const DrawnLine line(model.strand_bodies[e.strand], e.start);
    cushion.lay_around(line, e, e.start ? e.s : line.length_of_it() - e.s);
  }
  FatSurface(kPortaCell).draw(cushion.lobules(), m_buffer);
  bare(m_buffer, front, organ);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  for (std::uint32_t v = 0; v < m_buffer.size(); ++v) {
    const auto p = vec_cast<double>(m_buffer.positions[v]);
    const DrawnSkin::Place on = organ.nearest(p, kStays);
    const double share = on.above < 1 ? smooth(kStays, kGoesAlong, on.above) : 0;
    // Where it runs out on the organ its peritoneum is thin: what it covers shows through.
    const double thin = on.above < 1 ? smooth(kThin, 0, on.above + 0.0005 * waves(p, 0.004)) : 0;
    m_buffer.paint[v].tint = to_byte(0.8 * thin);
    if (share > 0) m_follow.push_back({v, on.vertex, float(share)});
  }
  m_rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void Porta::settle(const OrganDrawing& organ, const render::OpennessBaker& baker) {
  m_organ.assign(organ.positions().begin(), organ.positions().end());
  std::vector<Paint> shaded(m_buffer.size());
  baker.bake(m_buffer.positions, m_buffer.normals, shaded);
  render::even_openness(m_buffer.indices, shaded, 2);
  for (std::size_t v = 0; v < shaded.size(); ++v) m_buffer.paint[v].openness = shaded[v].openness;
  m_mesh.update(m_buffer);
}

void Porta::update(const OrganDrawing& organ) {
  if (organ.version() == m_version) return;
  m_version = organ.version();
  for (const Follow& f : m_follow)
    m_buffer.positions[f.vertex] = m_rest[f.vertex] + f.share * (organ.positions()[f.on] - m_organ[f.on]);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
