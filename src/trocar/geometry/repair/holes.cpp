#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/remesh/patch_work.hpp>
#include <trocar/geometry/repair/holes.hpp>
#include <trocar/geometry/repair/rim_bridge.hpp>
#include <trocar/geometry/repair/rim_patch.hpp>
#include <trocar/geometry/repair/shells.hpp>
#include <trocar/geometry/surfaces/edge_table.hpp>
#include <trocar/geometry/surfaces/groups.hpp>

namespace trocar::geometry {
namespace {

/// A surface that meets the plane of its rim more steeply than this is a tube that ends there [sine of the angle].
constexpr double kTubeEnd = 0.7;
/// Of a lid that is more than this share of its shell's area nobody knows the shape: it is stretched.
constexpr double kSmallLid = 0.05;

class HoleClosing {
 public:
  HoleClosing(const TriMesh& mesh, const HoleOptions& options)
      : m_mesh(mesh),
        m_options(options),
        m_edges(mesh),
        m_rims(rims_of(mesh, m_edges)),
        m_shells(shells_of(mesh, m_edges, m_rims)),
        m_neighbours(vertex_neighbours(mesh)),
        m_work(mesh),
        m_closed(m_rims.size()) {}

  Repaired run() {
    Groups joined(m_shells.list.size());
    if (m_options.rings) close_walls(joined);
    leave_sheets(joined);
    for (std::size_t r = 0; r < m_rims.size(); ++r)
      if (!m_closed[r]) close(m_rims[r]);
    refine(m_flat, PatchShape::stretched);
    refine(m_curved, PatchShape::continued);
    m_out.mesh = m_rings + m_lids > 0 ? m_work.taken() : m_mesh;
    m_out.tell("with_holes_closed", m_rings, "wall closed by a ring between its rims",
               "walls closed by rings between their rims");
    m_out.tell("with_holes_closed", m_lids, "hole closed", "holes closed");
    if (m_lids > 0) m_out.changes.back().words += tr(", the largest of {:.3g} cm2", 1e4 * m_largest);
    return std::move(m_out);
  }

 private:
  const TriMesh& m_mesh;
  HoleOptions m_options;
  EdgeTable m_edges;
  std::vector<Rim> m_rims;
  Shells m_shells;
  Csr m_neighbours;
  EditableMesh m_work;
  std::vector<bool> m_closed;  ///< rims that are done, or shall not be
  std::vector<int> m_flat, m_curved;
  int m_rings = 0, m_lids = 0;
  double m_largest = 0;  ///< [m^2] of a lid
  Repaired m_out;

  int shell_of(const Rim& rim) const { return m_shells.of[rim.triangles[0]]; }

  void close_walls(Groups& joined) {
    for (const auto& [outer, inner] : concentric_rims(m_mesh, m_rims)) {
      const auto ring = rim_bridge(m_mesh, m_rims[outer], m_rims[inner]);
      if (ring.empty()) continue;
      for (const auto& t : ring) m_work.add_face(t);
      m_closed[outer] = m_closed[inner] = true;
      joined.join(shell_of(m_rims[outer]), shell_of(m_rims[inner]));
      ++m_rings;
    }
  }

  /// What would be closed by lids that are as large as itself is left; shells that rings have joined count as one.
  void leave_sheets(Groups& joined) {
    std::vector<double> area(m_shells.list.size()), lids(area.size());
    for (std::size_t s = 0; s < area.size(); ++s) area[joined.root(int(s))] += m_shells.list[s].area;
    for (std::size_t r = 0; r < m_rims.size(); ++r)
      if (!m_closed[r]) lids[joined.root(shell_of(m_rims[r]))] += 0.5 * fan_twice_area(m_mesh, m_rims[r]);
    const auto is_sheet = [&](int s) { return !m_options.sheets && lids[s] > kSheetLids * area[s]; };
    std::vector<double> sheets;
    for (int s = 0; s < int(area.size()); ++s)
      if (is_sheet(s)) sheets.push_back(area[s]);
    tell_of_sheets(std::move(sheets));
    for (std::size_t r = 0; r < m_rims.size(); ++r)
      if (is_sheet(joined.root(shell_of(m_rims[r])))) m_closed[r] = true;
  }

  /// The largest ones; a soup of triangles has as many as triangles.
  void tell_of_sheets(std::vector<double> areas) {
    constexpr std::size_t kToldSheets = 3;
    const std::size_t told = std::min(areas.size(), kToldSheets);
    std::partial_sort(areas.begin(), areas.begin() + std::ptrdiff_t(told), areas.end(), std::greater<>());
    for (std::size_t i = 0; i < told; ++i)
      m_out.left.push_back(tr("a sheet of {:.3g} cm2 is left open: it encloses nothing", 1e4 * areas[i]));
    if (areas.size() > told) m_out.left.push_back(tr("{} more sheets are left open", areas.size() - told));
  }

  void close(const Rim& rim) {
    if (!rim.is_loop || rim.vertices.size() < 3 || rim.vertices.size() > kLongestRim) {
      m_out.left.push_back(tr("a hole with {} corners is left open", rim.vertices.size()));
      return;
    }
    std::vector<int> loop(rim.vertices.rbegin(), rim.vertices.rend());  // the patch runs against the surface
    const double lid = 0.5 * fan_twice_area(m_mesh, rim);
    const bool curved = m_options.smooth && lid < kSmallLid * m_shells.list[shell_of(rim)].area && !is_tube_end(rim);
    std::vector<int>& group = curved ? m_curved : m_flat;
    m_largest = std::max(m_largest, lid);
    const auto triangles = rim_patch(patch_loop(rim, loop));
    if (triangles.empty())
      add_fan(loop, group);
    else
      for (const auto& [a, b, c] : triangles) group.push_back(m_work.add_face({loop[a], loop[b], loop[c]}));
    ++m_lids;
  }

  PatchLoop patch_loop(const Rim& rim, const std::vector<int>& loop) const {
    const std::size_t n = loop.size();
    PatchLoop out;
    for (const int v : loop) out.places.push_back(m_mesh.positions[v]);
    for (std::size_t i = 0; i < n; ++i)  // loop[i] to loop[i + 1] is the rim's edge from n - 2 - i
      out.normals.push_back(normalised(area_vector(m_mesh, rim.triangles[(2 * n - 2 - i) % n]), Vec3d{}));
    out.taken = [this, loop](int i, int j) {
      const auto row = m_neighbours.row(loop[i]);
      return std::binary_search(row.begin(), row.end(), loop[j]);
    };
    return out;
  }

  /// Around a new vertex in the middle, which has no edge yet.
  void add_fan(const std::vector<int>& loop, std::vector<int>& group) {
    Vec3d middle{};
    for (const int v : loop) middle += m_mesh.positions[v];
    const int centre = m_work.add_vertex(middle / double(loop.size()));
    for (std::size_t i = 0; i < loop.size(); ++i)
      group.push_back(m_work.add_face({loop[i], loop[(i + 1) % loop.size()], centre}));
  }

  /// Does the surface come up to the rim at right angles to its plane?
  bool is_tube_end(const Rim& rim) const {
    const std::size_t n = rim.vertices.size();
    Vec3d axis{};
    const Vec3d first = m_mesh.positions[rim.vertices[0]];
    for (std::size_t i = 0; i < n; ++i)
      axis += cross(m_mesh.positions[rim.vertices[i]] - first, m_mesh.positions[rim.vertices[(i + 1) % n]] - first);
    axis = normalised(axis, Vec3d{});
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d along = m_mesh.positions[rim.vertices[(i + 1) % n]] - m_mesh.positions[rim.vertices[i]];
      const Vec3d out = normalised(cross(along, area_vector(m_mesh, rim.triangles[i])), Vec3d{});
      sum += length(along) * std::fabs(dot(out, axis));
    }
    return sum > kTubeEnd * rim.length;
  }

  void refine(std::vector<int>& faces, PatchShape shape) {
    if (faces.empty() || !m_options.refine) return;
    PatchWork patch(m_work, faces);
    patch.refine();
    patch.fair(shape);
  }
};

}  // namespace

Repaired with_holes_closed(const TriMesh& mesh, const HoleOptions& options) { return HoleClosing(mesh, options).run(); }

}  // namespace trocar::geometry
