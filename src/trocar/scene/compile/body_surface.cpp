#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/curve_length.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/spline_bridge.hpp>
#include <trocar/geometry/remesh/remeshed.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile_parts.hpp>

namespace trocar::scene {
namespace {

/// Two parts of a body hang together where their ways along it differ by less than this [m]: a hairpin's legs, one
/// against the other, are half pi of its width apart; more than two widths are two loops.
/// @param widest  largest half-width of the body [m]
double width_of_bends(double widest) {
  constexpr double kLoops = 2.25;
  return kLoops * 2 * widest;
}

BodySurface lofted(const std::vector<Section>& of_file) {
  std::vector<geometry::Section> sections;
  for (const Section& s : of_file) sections.push_back({s.centre, s.across, s.deep, s.squareness});
  double way = 0, widest = 0;
  for (std::size_t i = 1; i < sections.size(); ++i) way += length(sections[i].centre - sections[i - 1].centre);
  for (const geometry::Section& s : sections) widest = std::max({widest, length(s.across), length(s.deep)});
  return {geometry::loft(sections), way, width_of_bends(widest)};
}

constexpr double kChord = 0.002;  // of the box's diagonal: how far a spline's triangles may be off it

geometry::TriMesh triangles_of(const geometry::nurbs::Surface& surface) {
  const geometry::Bounds box = geometry::bounds(surface.points);
  return geometry::nurbs::tessellate(surface, kChord * length(box.high - box.low)).mesh;
}

/// Of a solid tube with round ends a spline as a loft is; of the others triangles, whose edges stay sharp.
BodySurface tubular(const TubeShape& tube) {
  const geometry::nurbs::Surface surface = surface_of(tube);
  const geometry::nurbs::Curve line = line_of(tube);
  double widest = 0;
  for (const TubeShape::Station& s : tube.stations) widest = std::max(widest, s.radius);
  const double whole = geometry::nurbs::length(line);
  if (!tube.hollow() && tube.ends == TubeShape::round)
    return {geometry::nurbs::spline_of(surface), whole + 2 * widest, width_of_bends(widest)};
  const int samples = std::clamp(int(4 * whole / widest), 16, 2000);
  std::vector<Vec3d> points;
  for (const double u : geometry::nurbs::parameters_by_length(line, samples))
    points.push_back(geometry::nurbs::point(line, u));
  return {triangles_of(surface), std::move(points), width_of_bends(widest)};
}

/// Middles of a net's rows, of which the first and the last are poles, are what the body runs along.
BodySurface of_net(const NurbsShape& shape) {
  const geometry::nurbs::Surface surface = surface_of(shape);
  if (shape.closing == NurbsShape::ring) return {triangles_of(surface), {}, geometry::Lattice::kNoMatterHowFar};
  double way = 0, widest = 0;
  Vec3d last;
  for (int row = 0; row < shape.rows; ++row) {
    const Vec3d* p = shape.net.data() + std::size_t(row) * std::size_t(shape.columns);
    Vec3d middle;
    for (int i = 0; i < shape.columns; ++i) middle += p[i] / double(shape.columns);
    for (int i = 0; i < shape.columns; ++i) widest = std::max(widest, length(p[i] - middle));
    if (row > 0) way += length(middle - last);
    last = middle;
  }
  return {geometry::nurbs::spline_of(surface), way, width_of_bends(widest)};
}

BodySurface of_shape(const std::vector<Section>& sections, const ClosedShape& shape) {
  if (shape.surface) return {shape.surface->mesh, {}, geometry::Lattice::kNoMatterHowFar};
  if (shape.nurbs) return of_net(*shape.nurbs);
  if (shape.tube) return tubular(*shape.tube);
  if (shape.revolved) return {triangles_of(surface_of(*shape.revolved)), {}, geometry::Lattice::kNoMatterHowFar};
  return lofted(sections);
}

constexpr double kKept = 0.93;  // of its volume: what is thinner than edges are long loses more

/// Is it still the body that it was?
bool is_sound(const geometry::Remeshed& even) {
  return geometry::check_edges(even.mesh).closed() && even.volume > kKept * even.volume_before &&
         even.volume < even.volume_before / kKept;
}

}  // namespace

BodySurface::BodySurface(geometry::NurbsSurface spline, double way, double apart)
    : m_spline(std::move(spline)), m_way(way), m_apart(apart) {}
BodySurface::BodySurface(geometry::TriMesh mesh, std::vector<Vec3d> line, double apart)
    : m_mesh(std::move(mesh)), m_line(std::move(line)), m_apart(apart) {}

EvenSurface BodySurface::with_edges(double edge) const {
  if (m_spline) {
    geometry::Tessellation drawn = geometry::tessellate_with_parameters(*m_spline, edge);
    EvenSurface out{std::move(drawn.mesh), {}, std::move(drawn.parameters)};
    const double start = m_spline->start_v(), way = m_spline->end_v() - m_spline->start_v();
    for (const auto& [u, v] : out.parameters) out.along.push_back(m_way * (v - start) / way);
    return out;
  }
  constexpr int kFiner = 4;
  double finer = edge;
  for (int k = 0; k < kFiner; ++k, finer *= 0.6) {
    geometry::Remeshed even = geometry::remeshed(m_mesh, finer);
    if (!is_sound(even)) continue;
    std::vector<double> along = ways_of(even.mesh.positions);
    return {std::move(even.mesh), std::move(along), {}};
  }
  throw std::invalid_argument(
      tr("a surface that loses its shape with triangles of {:.3g} to {:.3g} mm: shorter edges expected", 1000 * edge,
         1000 * finer / 0.6));
}

geometry::TriMesh BodySurface::as_given(double edge) const { return m_spline ? with_edges(edge).mesh : m_mesh; }

/// Of the line's samples the one that is nearest to a point says how far along it is.
std::vector<double> BodySurface::ways_of(const std::vector<Vec3d>& points) const {
  if (m_line.empty()) return {};
  std::vector<double> way{0};
  for (std::size_t i = 1; i < m_line.size(); ++i) way.push_back(way.back() + length(m_line[i] - m_line[i - 1]));
  std::vector<double> out;
  for (const Vec3d& p : points) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < m_line.size(); ++i)
      if (length(m_line[i] - p) < length(m_line[best] - p)) best = i;
    out.push_back(way[best]);
  }
  return out;
}

geometry::TriMesh in_order(const geometry::TriMesh& mesh, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  geometry::TriMesh out;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[std::size_t(order[i])] = int(i);
    out.positions.push_back(mesh.positions[std::size_t(order[i])]);
  }
  for (const auto& t : mesh.triangles)
    out.triangles.push_back({place[std::size_t(t[0])], place[std::size_t(t[1])], place[std::size_t(t[2])]});
  std::sort(out.triangles.begin(), out.triangles.end(), [](const auto& a, const auto& b) {
    const int la = std::min({a[0], a[1], a[2]}), lb = std::min({b[0], b[1], b[2]});
    return la != lb ? la < lb : a < b;
  });
  return out;
}

EvenSurface skin_surface(const BodySurface& shape, double edge) {
  const EvenSurface even = shape.with_edges(edge);
  const std::vector<int> order = along_curve(even.mesh.positions);
  EvenSurface out{in_order(even.mesh, order), {}, {}};
  for (const int i : order) {
    if (!even.along.empty()) out.along.push_back(even.along[std::size_t(i)]);
    if (!even.parameters.empty()) out.parameters.push_back(even.parameters[std::size_t(i)]);
  }
  return out;
}

BodySurface surface_of_body(const Solid& solid) { return of_shape(solid.sections, solid.shape); }
BodySurface surface_of_body(const Pouch& pouch) { return of_shape(pouch.sections, pouch.shape); }

}  // namespace trocar::scene
