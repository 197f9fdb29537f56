#include <algorithm>
#include <functional>
#include <stdexcept>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/net.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kSeamSlack = 1e-9;  // of weighted points [m]

const Knots& knots_across(const Surface& s, Along way) { return way == Along::u ? s.v : s.u; }

template <class Change>
Surface each_row(const Surface& s, Along way, const char* who, const Change& change) {
  require_valid(s, who);
  std::vector<Row> rows = rows_of(s, way);
  for (Row& row : rows) row = change(row);
  return surface_of(rows, way, knots_across(s, way));
}

// What all rows allow, if they do.
template <class Change>
std::optional<Surface> each_row_within(const Surface& s, Along way, const char* who, double tolerance,
                                       const Change& change) {
  require_valid(s, who);
  const double slack = weighted_tolerance(s.points, s.weights, tolerance);
  std::vector<Row> rows = rows_of(s, way);
  for (Row& row : rows) {
    const std::optional<Removal> removal = change(row);
    if (!removal || !(removal->misfit <= slack)) return {};
    row = removal->row;
  }
  Surface result = surface_of(rows, way, knots_across(s, way));
  return fault_in(result).empty() ? std::optional(result) : std::nullopt;
}

}  // namespace

std::vector<Row> rows_of(const Surface& s, Along way) {
  const int length = knots_along(s, way).points(), count = knots_across(s, way).points();
  std::vector<Row> rows;
  for (int r = 0; r < count; ++r) {
    Row row{knots_along(s, way), {}};
    for (int k = 0; k < length; ++k) {
      const int i = way == Along::u ? s.index(k, r) : s.index(r, k);
      row.points.push_back(weighted(s.points[i], s.weight(i)));
    }
    rows.push_back(row);
  }
  return rows;
}

Surface surface_of(const std::vector<Row>& rows, Along way, const Knots& other) {
  Surface s;
  (way == Along::u ? s.u : s.v) = rows.at(0).knots;
  (way == Along::u ? s.v : s.u) = other;
  s.points.resize(rows.size() * rows[0].points.size());
  s.weights.resize(s.points.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t k = 0; k < rows[r].points.size(); ++k) {
      const std::size_t i = way == Along::u ? k + rows[0].points.size() * r : r + rows.size() * k;
      s.points[i] = rows[r].points[k].place();
      s.weights[i] = rows[r].points[k].w;
    }
  drop_plain_weights(s.weights);
  return s;
}

Surface inserted(const Surface& s, Along way, double t, int times) {
  return each_row(s, way, "inserted", [=](const Row& row) { return inserted(row, t, times); });
}

Surface refined(const Surface& s, Along way, const std::vector<double>& more) {
  return each_row(s, way, "refined", [&](const Row& row) { return refined(row, more); });
}

Surface elevated(const Surface& s, Along way, int times) {
  return each_row(s, way, "elevated", [=](const Row& row) { return elevated(row, times); });
}

Surface reversed(const Surface& s, Along way) {
  return each_row(s, way, "reversed", [](const Row& row) { return reversed(row); });
}

Surface opened(const Surface& s, Along way, double t) {
  return each_row(s, way, "opened", [=](const Row& row) { return opened(row, t); });
}

Surface part(const Surface& s, Along way, double a, double b) {
  if (!(b > a)) throw std::invalid_argument("part: two ascending parameters expected");
  const Knots& knots = knots_along(s, way);
  if (!knots.periodic) return each_row(s, way, "part", [=](const Row& row) { return part(row, a, b); });
  if (!(b - a <= knots.extent())) throw std::invalid_argument("part: at most one period expected");
  return each_row(s, way, "part", [=](const Row& row) {
    const Row open = opened(row, a);
    return part(open, open.knots.start(), open.knots.start() + (b - a));
  });
}

std::pair<Surface, Surface> split(const Surface& s, Along way, double t) {
  const Knots& knots = knots_along(s, way);
  if (knots.periodic) throw std::invalid_argument("split: a closed direction is one piece; open it first");
  if (!(t > knots.start() && t < knots.end()))
    throw std::invalid_argument("split: a parameter inside of the domain expected");
  return {part(s, way, knots.start(), t), part(s, way, t, knots.end())};
}

Surface joined(const Surface& a, const Surface& b, Along way) {
  require_valid(a, "joined"), require_valid(b, "joined");
  if (knots_along(a, way).periodic || knots_along(b, way).periodic)
    throw std::invalid_argument("joined: surfaces that are open along the way expected");
  if (!(knots_across(a, way) == knots_across(b, way)))
    throw std::invalid_argument("joined: the same knots across the way expected");
  const int degree = std::max(knots_along(a, way).degree, knots_along(b, way).degree);
  std::vector<Row> rows = rows_of(a, way), others = rows_of(b, way);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row front = elevated(rows[r], degree - rows[r].knots.degree);
    const Row back = elevated(others[r], degree - others[r].knots.degree);
    if (!(distance(front.points.back(), back.points.front()) <= kSeamSlack))
      throw std::invalid_argument("joined: the second surface does not start where the first ends");
    rows[r] = joined(front, back);
  }
  return surface_of(rows, way, knots_across(a, way));
}

Surface on_domain(const Surface& s, Along way, double start, double end) {
  require_valid(s, "on_domain");
  Surface result = s;
  Knots& knots = way == Along::u ? result.u : result.v;
  knots = on_domain(knots, start, end);
  return result;
}

Surface transposed(const Surface& s) {
  require_valid(s, "transposed");
  return surface_of(rows_of(s, Along::u), Along::v, s.v);
}

Surface moved(const Surface& s, const Mat3d& turn, Vec3d shift) {
  Surface result = s;
  for (Vec3d& p : result.points) p = turn * p + shift;
  return result;
}

Surface mirrored(const Surface& s, Vec3d at, Vec3d plane_normal) {
  const Vec3d n = normalised(plane_normal, Vec3d{});
  if (!finite(n) || n == Vec3d{}) throw std::invalid_argument("mirrored: a plane's normal expected");
  Surface result = reversed(s, Along::u);
  for (Vec3d& p : result.points) p -= 2.0 * dot(p - at, n) * n;
  return result;
}

std::optional<Surface> without_knot(const Surface& s, Along way, double t, double tolerance) {
  return each_row_within(s, way, "without_knot", tolerance, [=](const Row& row) { return without_knot(row, t); });
}

std::optional<Surface> reduced(const Surface& s, Along way, double tolerance) {
  return each_row_within(s, way, "reduced", tolerance, [](const Row& row) { return reduced(row); });
}

Curve iso_curve(const Surface& s, Along way, double at) {
  const Knots& across = knots_across(s, way);
  const Basis2 basis = basis_at(across, at, 0);
  Row result{knots_along(s, way), std::vector<Vec4d>(static_cast<std::size_t>(knots_along(s, way).points()))};
  for (int k = 0; k <= across.degree; ++k) {
    const int r = across.point_of(basis.first + k);
    for (std::size_t n = 0; n < result.points.size(); ++n) {
      const int i = way == Along::u ? s.index(static_cast<int>(n), r) : s.index(r, static_cast<int>(n));
      result.points[n] = result.points[n] + basis.value[0][k] * weighted(s.points[i], s.weight(i));
    }
  }
  return curve_of(result);
}

}  // namespace trocar::geometry::nurbs
