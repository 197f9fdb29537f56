// Curves through points.
//
//   const Curve tube_axis = curve_through(points);                  // cubic, C2, by chord length
//   const Curve outline = closed_curve_through(points);             // periodic; the first point is not repeated
//
// One system of equations for each set of parameters, solved for any number of rows: what skinning does with all
// columns of its sections.  [PT97 A9.1]
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/numerics/dense_lu.hpp>

namespace trocar::geometry::nurbs {

/// How parameters follow from distances: in proportion to them, or to their roots, which swings less where points lie
/// unevenly [Lee 1989].
enum class Spacing { chord, centripetal };

/// 0 .. 1 from the first point to the last; closed: back to the first point. @throws std::invalid_argument: `who`, and
/// which neighbours coincide or which point is not a number
std::vector<double> parameters_by(Spacing spacing, std::span<const Vec3d> points, const char* who, bool closed = false);

/// The splines of a degree with given values at given parameters.
class Interpolation {
 public:
  /// Clamped. With a slope, the derivative at that end is one more value.
  /// @param parameters ascending; domain from the first to the last. The degree is lowered to what they allow.
  Interpolation(std::span<const double> parameters, int degree, bool start_slope = false, bool end_slope = false);
  /// Periodic: as many control points as parameters, of which there are more than the degree.
  static Interpolation closed(std::span<const double> parameters, double period, int degree);

  const Knots& knots() const noexcept { return m_knots; }
  /// @param values in: rows of `columns` numbers, the parameters' values in order, the start's slope in second place
  /// and
  ///               the end's last but one; out: control points
  void solve(double* values, int columns) const { m_system.solve(values, columns); }

 private:
  Interpolation(Knots knots, numerics::DenseLu system) : m_knots(std::move(knots)), m_system(std::move(system)) {}

  Knots m_knots;
  numerics::DenseLu m_system;
};

struct Slopes {
  std::optional<Vec3d> start, end;  ///< derivatives by the parameter, which runs from 0 to 1 [m]
};
/// Through the points (at least 2), of this degree or the highest that they allow; knots are means of parameters.
Curve curve_through(std::span<const Vec3d> points, int degree = 3, Spacing spacing = Spacing::chord,
                    const Slopes& slopes = {});
/// Closed through the points, of which there are more than the degree.
Curve closed_curve_through(std::span<const Vec3d> points, int degree = 3, Spacing spacing = Spacing::chord);

}  // namespace trocar::geometry::nurbs
