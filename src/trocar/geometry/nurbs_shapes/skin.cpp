#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>
#include <trocar/geometry/nurbs_shapes/skin.hpp>

namespace trocar::geometry::nurbs {
namespace {

// All knots that any of them has (clamped: between the ends), as often as the one has it that has it most often.
std::vector<double> union_of_knots(const std::vector<Curve>& curves) {
  std::vector<Knot> all;
  for (const Curve& curve : curves)
    for (const Knot& knot : distinct(curve.knots)) {
      const double u = knot.value;
      const auto same =
          std::find_if(all.begin(), all.end(), [u](const Knot& k) { return std::fabs(k.value - u) < 1e-12; });
      if (same == all.end())
        all.push_back(knot);
      else
        same->multiplicity = std::max(same->multiplicity, knot.multiplicity);
    }
  std::sort(all.begin(), all.end(), [](const Knot& a, const Knot& b) { return a.value < b.value; });
  std::vector<double> result;
  for (const Knot& knot : all) result.insert(result.end(), static_cast<std::size_t>(knot.multiplicity), knot.value);
  return result;
}

// `knots` so often as the union has them and the curve has not.
Curve with_knots(const Curve& curve, const std::vector<double>& knots) {
  Curve result = curve;
  for (std::size_t i = 0; i < knots.size();) {
    const auto times = std::count(knots.begin(), knots.end(), knots[i]);
    const double u = snapped(result.knots, knots[i]);
    const int there = multiplicity(result.knots, u);
    if (times > there) result = inserted(result, u, static_cast<int>(times) - there);
    i += static_cast<std::size_t>(times);
  }
  return result;
}

// Mean over all columns of the way from section to section.
std::vector<double> mean_ways(const std::vector<Curve>& sections, bool closed, double& whole) {
  std::vector<double> way{0.0};
  const std::size_t n = sections.size(), columns = sections[0].points.size();
  for (std::size_t s = 1; s < n + (closed ? 1 : 0); ++s) {
    double sum = 0.0;
    for (std::size_t i = 0; i < columns; ++i) sum += length(sections[s % n].points[i] - sections[s - 1].points[i]);
    if (!(sum > 0.0)) throw std::invalid_argument(tr("skinned: sections {} and {} coincide", s - 1, s % n));
    way.push_back(way.back() + sum / double(columns));
  }
  whole = way.back();
  way.resize(n);
  for (double& w : way) w /= whole;
  return way;
}

Interpolation along_sections(const std::vector<Curve>& sections, const SkinOptions& options) {
  double whole = 0.0;
  std::vector<double> v = options.parameters;
  if (v.empty()) {
    v = mean_ways(sections, options.closed, whole);
    if (!options.closed) v.back() = 1.0;
  } else if (v.size() != sections.size()) {
    throw std::invalid_argument("skinned: a parameter for each section expected");
  }
  for (std::size_t i = 1; i < v.size(); ++i)
    if (!(v[i] > v[i - 1])) throw std::invalid_argument("skinned: ascending parameters expected");
  if (!options.closed) return {v, options.degree};
  return Interpolation::closed(v, 1.0, options.degree);
}

}  // namespace

std::vector<Curve> compatible(const std::vector<Curve>& curves) {
  bool all_closed = true;
  int degree = 1;
  for (const Curve& curve : curves) {
    require_valid(curve, "compatible");
    all_closed = all_closed && curve.knots.periodic;
    degree = std::max(degree, curve.knots.degree);
  }
  std::vector<Curve> result;
  for (const Curve& curve : curves) {
    const Curve piece = on_domain(all_closed ? curve : opened(curve), 0.0, 1.0);
    result.push_back(elevated(piece, degree - curve.knots.degree));
  }
  const std::vector<double> knots = union_of_knots(result);
  for (Curve& curve : result) {
    curve = with_knots(curve, knots);
    curve.knots = result[0].knots;  // not only but for rounding
  }
  return result;
}

Surface skinned(const std::vector<Curve>& sections, const SkinOptions& options) {
  if (sections.size() < 2)
    throw std::invalid_argument(tr("skinned: at least 2 sections expected, got {}", sections.size()));
  const std::vector<Curve> alike = compatible(sections);
  const Interpolation system = along_sections(alike, options);
  const int nu = alike[0].knots.points();
  std::vector<double> numbers;
  for (const Curve& curve : alike)
    for (int i = 0; i < nu; ++i) {
      const Vec4d p = weighted(curve.points[i], curve.weight(i));
      numbers.insert(numbers.end(), {p.x, p.y, p.z, p.w});
    }
  system.solve(numbers.data(), 4 * nu);
  std::vector<Row> rows;
  for (int j = 0; j < system.knots().points(); ++j) {
    Row row{alike[0].knots, {}};
    for (int i = 0; i < nu; ++i) {
      const double* p = &numbers[4 * (static_cast<std::size_t>(j) * nu + i)];
      row.points.push_back({p[0], p[1], p[2], p[3]});
    }
    rows.push_back(row);
  }
  Surface result = surface_of(rows, Along::u, system.knots());
  require_valid(result, "skinned: weights of the sections differ too much");
  return result;
}

Surface surface_through(std::span<const Vec3d> points, int count_u, int count_v, int degree) {
  if (count_u < 2 || count_v < 2 || points.size() != static_cast<std::size_t>(count_u) * count_v)
    throw std::invalid_argument("surface_through: at least 2 x 2 points expected, and as many as the counts say");
  // Mean parameters of all rows, and of all columns; then each row is a section.
  std::vector<double> u(static_cast<std::size_t>(count_u), 0.0), v(static_cast<std::size_t>(count_v), 0.0);
  for (int j = 0; j < count_v; ++j) {
    const auto row = parameters_by(Spacing::chord, points.subspan(static_cast<std::size_t>(j) * count_u, count_u),
                                   "surface_through: a row");
    for (int i = 0; i < count_u; ++i) u[i] += row[i] / count_v;
  }
  for (int i = 0; i < count_u; ++i) {
    std::vector<Vec3d> column;
    for (int j = 0; j < count_v; ++j) column.push_back(points[i + static_cast<std::size_t>(j) * count_u]);
    const auto along = parameters_by(Spacing::chord, column, "surface_through: a column");
    for (int j = 0; j < count_v; ++j) v[j] += along[j] / count_u;
  }
  u.back() = v.back() = 1.0;
  const Interpolation system(u, degree);
  std::vector<Curve> sections;
  for (int j = 0; j < count_v; ++j) {
    std::vector<double> numbers;
    for (int i = 0; i < count_u; ++i) {
      const Vec3d p = points[i + static_cast<std::size_t>(j) * count_u];
      numbers.insert(numbers.end(), {p.x, p.y, p.z});
    }
    system.solve(numbers.data(), 3);
    Curve section{system.knots(), {}, {}};
    for (int i = 0; i < count_u; ++i)
      section.points.push_back({numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
    sections.push_back(section);
  }
  return skinned(sections, {degree, false, v});
}

}  // namespace trocar::geometry::nurbs
