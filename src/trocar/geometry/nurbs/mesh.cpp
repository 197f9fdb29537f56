#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kMostStepsOfSpan = 1024;
constexpr std::size_t kMostVertices = 20'000'000;

std::vector<double> steps_of_spans(const Knots& knots, const std::vector<int>& steps) {
  const std::vector<double> ends = breaks(knots);
  std::vector<double> result;
  for (std::size_t s = 0; s + 1 < ends.size(); ++s)
    for (int k = 0; k < steps[s]; ++k) result.push_back(ends[s] + (ends[s + 1] - ends[s]) * k / steps[s]);
  result.push_back(ends.back());
  return result;
}

// Which vertex stands at each place of the grid: poles and seams are one.
class VertexNumbers {
 public:
  VertexNumbers(const Closure& closure, int nu, int nv) : m_nu(nu) {
    std::vector<int> number(static_cast<std::size_t>(nu) * nv, -1);
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        int a = closure.around_u && i == nu - 1 ? 0 : i, b = closure.around_v && j == nv - 1 ? 0 : j;
        if ((closure.pole_at_v[0] && b == 0) || (closure.pole_at_v[1] && b == nv - 1)) a = 0;
        if ((closure.pole_at_u[0] && a == 0) || (closure.pole_at_u[1] && a == nu - 1)) b = 0;
        int& own = number[a + static_cast<std::size_t>(nu) * b];
        if (own < 0) {
          own = static_cast<int>(m_grid_point.size());
          m_grid_point.push_back(a + nu * b);
        }
        m_vertex.push_back(own);
      }
  }
  int vertex(int i, int j) const { return m_vertex[i + static_cast<std::size_t>(m_nu) * j]; }
  const std::vector<int>& grid_points() const { return m_grid_point; }

 private:
  int m_nu;
  std::vector<int> m_vertex, m_grid_point;
};

void add_triangle(TriMesh& mesh, int a, int b, int c) {
  if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
}

// Two triangles, parted along the shorter diagonal.
void add_quad(TriMesh& mesh, int a, int b, int c, int d) {
  const auto& p = mesh.positions;
  if (length(p[a] - p[c]) <= length(p[b] - p[d])) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
  } else {
    add_triangle(mesh, a, b, d);
    add_triangle(mesh, b, c, d);
  }
}

void require_parameters(const Knots& knots, const std::vector<double>& at, bool around) {
  const bool ascending =
      std::adjacent_find(at.begin(), at.end(), [](double a, double b) { return !(a < b); }) == at.end();
  if (at.size() < (around ? 4u : 2u) || !ascending || at.front() != knots.start() || at.back() != knots.end())
    throw std::invalid_argument("tessellate: ascending parameters from start to end expected, at least " +
                                std::to_string(around ? 3 : 1) + " steps");
}

double off_chord(const Surface& s, double u0, double v0, double u1, double v1) {
  const Vec3d a = point(s, u0, v0), b = point(s, u1, v1), m = point(s, 0.5 * (u0 + u1), 0.5 * (v0 + v1));
  const Vec3d ab = b - a, am = m - a;
  const double whole = dot(ab, ab), along = whole > 0.0 ? std::clamp(dot(am, ab) / whole, 0.0, 1.0) : 0.0;
  return length(am - along * ab);
}

// How many steps each span along a way needs so that curves along it are within the tolerance of their chords, looked
// at in places of each span across.
std::vector<int> steps_within(const Surface& s, Along way, double tolerance) {
  const std::vector<double> ends = breaks(knots_along(s, way));
  const std::vector<double> places =
      steps_of_spans(way == Along::u ? s.v : s.u, std::vector<int>(breaks(way == Along::u ? s.v : s.u).size() - 1, 4));
  std::vector<int> result;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    int steps = 1;
    for (bool within = false; !within && steps < kMostStepsOfSpan;) {
      double worst = 0.0;
      const double step = (ends[k + 1] - ends[k]) / steps;
      for (double place : places)
        for (int i = 0; i < steps; ++i) {
          const double a = ends[k] + i * step, b = a + step;
          worst =
              std::max(worst, way == Along::u ? off_chord(s, a, place, b, place) : off_chord(s, place, a, place, b));
        }
      within = worst <= tolerance;
      if (!within) steps += std::max(1, static_cast<int>(steps * (std::sqrt(std::min(worst / tolerance, 16.0)) - 1.0)));
    }
    result.push_back(std::min(steps, kMostStepsOfSpan));
  }
  return result;
}

double worst_diagonal(const Surface& s, const std::vector<double>& us, const std::vector<double>& vs) {
  double worst = 0.0;
  for (std::size_t j = 0; j + 1 < vs.size(); ++j)
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      const double one = off_chord(s, us[i], vs[j], us[i + 1], vs[j + 1]);
      const double other = off_chord(s, us[i + 1], vs[j], us[i], vs[j + 1]);
      worst = std::max({worst, one, other});
    }
  return worst;
}

void at_least_three_around(std::vector<int>& steps, bool around) {
  while (around && static_cast<int>(steps.size()) * *std::min_element(steps.begin(), steps.end()) < 3)
    for (int& n : steps) ++n;
}

}  // namespace

SurfaceMesh tessellate(const Surface& surface, std::vector<double> us, std::vector<double> vs) {
  const Closure closure = closure_of(surface);
  require_parameters(surface.u, us, closure.around_u);
  require_parameters(surface.v, vs, closure.around_v);
  if (us.size() * vs.size() > kMostVertices)
    throw std::invalid_argument("tessellate: more than " + std::to_string(kMostVertices) + " vertices");
  const int nu = static_cast<int>(us.size()), nv = static_cast<int>(vs.size());
  GridEvaluator grid(surface, us, vs);
  std::vector<Vec3d> positions(us.size() * vs.size()), normals(positions.size());
  grid.evaluate(surface.points, positions, normals);

  const VertexNumbers numbers(closure, nu, nv);
  SurfaceMesh result;
  for (int g : numbers.grid_points()) {
    result.mesh.positions.push_back(positions[g]);
    result.normals.push_back(normals[g]);
    result.parameters.push_back({us[g % nu], vs[g / nu]});
  }
  for (int j = 0; j + 1 < nv; ++j)
    for (int i = 0; i + 1 < nu; ++i)
      add_quad(result.mesh, numbers.vertex(i, j), numbers.vertex(i + 1, j), numbers.vertex(i + 1, j + 1),
               numbers.vertex(i, j + 1));
  if (closure.closed() && geometry::volume(result.mesh) < 0.0) {
    result.turned = true;
    for (auto& t : result.mesh.triangles) std::swap(t[1], t[2]);
    for (Vec3d& n : result.normals) n = -n;
  }
  result.grid_point = numbers.grid_points();
  result.us = std::move(us), result.vs = std::move(vs);
  return result;
}

SurfaceMesh tessellate(const Surface& surface, Steps steps) {
  require_valid(surface, "tessellate");
  if (steps.u < 1 || steps.v < 1) throw std::invalid_argument("tessellate: at least one step to a span expected");
  const std::vector<int> u(breaks(surface.u).size() - 1, steps.u), v(breaks(surface.v).size() - 1, steps.v);
  return tessellate(surface, steps_of_spans(surface.u, u), steps_of_spans(surface.v, v));
}

SurfaceMesh tessellate(const Surface& surface, double tolerance) {
  const Closure closure = closure_of(surface);
  if (!(tolerance > 0.0)) throw std::invalid_argument("tessellate: a tolerance above 0 expected");
  std::vector<int> u = steps_within(surface, Along::u, tolerance), v = steps_within(surface, Along::v, tolerance);
  at_least_three_around(u, closure.around_u);
  at_least_three_around(v, closure.around_v);
  for (;;) {
    std::vector<double> us = steps_of_spans(surface.u, u), vs = steps_of_spans(surface.v, v);
    const double worst = worst_diagonal(surface, us, vs);
    const bool fine = *std::max_element(u.begin(), u.end()) >= kMostStepsOfSpan;
    if (worst <= tolerance || fine) return tessellate(surface, std::move(us), std::move(vs));
    for (std::vector<int>* steps : {&u, &v})
      for (int& n : *steps) n += (n + 3) / 4;
  }
}

MovingMesh::MovingMesh(const Surface& surface, const SurfaceMesh& mesh)
    : m_grid(surface, mesh.us, mesh.vs),
      m_grid_point(mesh.grid_point),
      m_sign(mesh.turned ? -1.0 : 1.0),
      m_positions(mesh.us.size() * mesh.vs.size()),
      m_normals(m_positions.size()) {}

void MovingMesh::move(std::span<const Vec3d> points, std::span<Vec3d> positions, std::span<Vec3d> normals) noexcept {
  m_grid.evaluate(points, m_positions, m_normals);
  for (std::size_t i = 0; i < m_grid_point.size(); ++i) {
    positions[i] = m_positions[m_grid_point[i]];
    normals[i] = m_sign * m_normals[m_grid_point[i]];
  }
}

}  // namespace trocar::geometry::nurbs
