#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/cleaned.hpp>
#include <trocar/geometry/repair/degenerate.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/repair/oriented.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/repair/resolved.hpp>
#include <trocar/geometry/repair/untangled.hpp>
#include <trocar/geometry/surfaces/crossings.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>

namespace trocar::geometry {
namespace {

class MeshMending {
 public:
  MeshMending(const TriMesh& mesh, const MendOptions& options) : m_options(options) {
    m_out.mesh = mesh;
    m_out.before = examine(mesh, {options.tolerance});
  }

  MendedMesh run() {
    if (m_out.before.is_body() && m_out.before.unused.empty()) {
      m_out.after = m_out.before;
      return std::move(m_out);
    }
    clean();
    close();
    uncross();
    m_out.after = examine(m_out.mesh, {m_options.tolerance});
    tell_what_is_left();
    return std::move(m_out);
  }

 private:
  MendOptions m_options;
  MendedMesh m_out;
  double m_near = 0;  ///< [m] what is nearer is one

  void take(Repaired done) {
    m_out.mesh = std::move(done.mesh);
    m_out.changes.insert(m_out.changes.end(), done.changes.begin(), done.changes.end());
    for (std::string& words : done.left)  // two repairs may leave the same
      if (std::find(m_out.left.begin(), m_out.left.end(), words) == m_out.left.end())
        m_out.left.push_back(std::move(words));
  }

  void clean() {
    take(without_broken(m_out.mesh));
    const double size = diagonal(bounds(m_out.mesh.positions));
    m_near = m_options.tolerance * size;
    take(welded(m_out.mesh, m_near));
    take(without_duplicates(m_out.mesh));
    take(without_unused(m_out.mesh));
    take(with_borders_welded(m_out.mesh, m_options.crack * size));
    take(parted(m_out.mesh));
    take(without_degenerate(m_out.mesh, m_near));
    take(oriented(m_out.mesh));
    take(without_small_shells(m_out.mesh, m_options.smallest_shell, true));
  }

  void close() {
    take(with_holes_closed(m_out.mesh, m_options.holes));
    take(without_degenerate(m_out.mesh, m_near));
    take(oriented(m_out.mesh));
  }

  /// Of what is closed; sheets that were left open are set aside.
  void uncross() {
    TriMesh sheets = set_aside_open();
    if (!m_out.mesh.triangles.empty()) {
      Repaired cut = resolved(m_out.mesh);
      if (cut.left.empty()) {
        take(std::move(cut));
        thin_out();
      } else {
        Repaired eased = untangled(m_out.mesh);
        if (eased.left.empty() || !m_options.refill || !refill()) take(std::move(eased));
      }
    }
    append(m_out.mesh, sheets);
  }

  /// Takes shells with holes, and such as are not consistent, out of the mesh.
  TriMesh set_aside_open() {
    const EdgeTable edges(m_out.mesh);
    const Shells shells = shells_of(m_out.mesh, edges, {});
    TriMesh closed{m_out.mesh.positions, {}}, open = closed;
    for (std::size_t t = 0; t < m_out.mesh.triangles.size(); ++t)
      (shells.list[shells.of[t]].closed() ? closed : open).triangles.push_back(m_out.mesh.triangles[t]);
    if (open.triangles.empty()) return {};
    m_out.mesh = without_unused(closed).mesh;
    return without_unused(open).mesh;
  }

  /// Along lines of crossing there are triangles that hardly have an area: those that can go without a new crossing do.
  void thin_out() {
    for (const double height : {m_near, 0.1 * m_near, 0.0}) {
      Repaired thinner = without_degenerate(m_out.mesh, height);
      if (!thinner.changed()) continue;
      if (check_edges(thinner.mesh).closed() && self_crossings(thinner.mesh).pairs.empty())
        return take(std::move(thinner));
    }
  }

  bool refill() {
    Refilled fresh = refilled(m_out.mesh, m_options.refilling);
    if (fresh.mesh.triangles.empty()) {
      m_out.left.push_back("it could not be rebuilt: " + fresh.why);
      return false;
    }
    m_out.mesh = parted(fresh.mesh).mesh;
    m_out.was_refilled = true;
    m_out.changes.push_back(
        {"refilled", 1,
         tr("rebuilt with cells of {:.3g} mm, largest deviation {:.3g} mm", 1000 * fresh.cell, 1000 * fresh.farthest)});
    return true;
  }

  void tell_what_is_left() {
    if (m_out.after.is_body()) return m_out.left.clear();  // what one repair left, another has mended
    std::vector<std::string>& left = m_out.left;
    const auto is_told = [&left](const std::string& words) {
      return std::any_of(left.begin(), left.end(), [&](const std::string& l) { return l.starts_with(words); });
    };
    for (const Finding& f : findings(m_out.after))
      if (f.fault != MeshFault::several_shells && f.fault != MeshFault::slivers && !is_told(f.words))
        left.push_back(f.words);
  }
};

}  // namespace

MendedMesh mend(const TriMesh& mesh, const MendOptions& options) { return MeshMending(mesh, options).run(); }

}  // namespace trocar::geometry
