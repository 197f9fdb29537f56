// Points and normals of a surface at parameters that stay while its control points move: basis values are computed
// once, and the sums of the two directions are taken one after the other, along v once for a whole row of points.
//
//   GridEvaluator grid(surface, us, vs);                            // us, vs: parameters each way
//   grid.evaluate(moved_points, positions, normals);                // (i, j) at i + us.size() j
//
// evaluate is noexcept and does not allocate; an evaluator has scratch of its own, so that each thread wants its own.
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/row.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

class GridEvaluator {
 public:
  /// @param us, vs parameters, brought into the domain. @throws std::invalid_argument for a faulty surface
  GridEvaluator(const Surface& surface, std::span<const double> us, std::span<const double> vs);

  int count_u() const noexcept { return static_cast<int>(m_u.size()); }
  int count_v() const noexcept { return static_cast<int>(m_v.size()); }

  /// @param points    control points, as many as the surface had; its weights stay
  /// @param positions out: count_u() count_v() [m]
  /// @param normals   out: as many, unit (0 where normal() has none); empty: not wanted
  void evaluate(std::span<const Vec3d> points, std::span<Vec3d> positions, std::span<Vec3d> normals) noexcept;

 private:
  // The functions at one parameter, and which control points they go with.
  struct Column {
    double parameter = 0.0;
    int point[kHighestDegree + 1] = {};
    BasisRow value{}, slope{};
  };
  static std::vector<Column> columns(const Knots& knots, std::span<const double> parameters);
  template <class Sum>
  void evaluate_rows(std::span<const Vec3d> points, std::span<Vec3d> positions, std::span<Vec3d> normals,
                     std::vector<Sum>& value, std::vector<Sum>& slope) noexcept;
  template <class Sum>
  void sum_along_v(std::span<const Vec3d> points, const Column& v, Sum* value, Sum* slope) const noexcept;

  Surface m_surface;  ///< its points are the last ones evaluated where a normal needed a limit
  std::vector<Column> m_u, m_v;
  std::vector<Vec3d> m_value, m_slope;              ///< of one row, along u, without weights
  std::vector<Vec4d> m_weighted, m_weighted_slope;  ///< with weights
};

}  // namespace trocar::geometry::nurbs
