#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/closest.hpp>
#include <trocar/geometry/nurbs_fit/curve_fit.hpp>
#include <trocar/numerics/banded.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr double kNoBetterCurve = 1e-3;
constexpr double kHold = 1e-12;  // of the matrix: keeps control points that no point asks for

// The parameter at a place in their list that may lie between two; behind the last comes 1.
double parameter_at(const std::vector<double>& parameters, double place) {
  const auto i = static_cast<std::size_t>(place);
  const double part = place - double(i), next = i + 1 < parameters.size() ? parameters[i + 1] : 1.0;
  return (1.0 - part) * parameters[i] + part * next;
}

// Knots such that every span has a parameter.  [PT97 eq.9.69]
Knots knots_among(const std::vector<double>& parameters, int degree, int control_points, bool closed) {
  const int spans = closed ? control_points : control_points - degree;
  const double share = double(parameters.size()) / spans;
  std::vector<double> inside;
  if (closed) inside.push_back(0.0);
  for (int j = 1; j < spans; ++j) inside.push_back(parameter_at(parameters, j * share - (closed ? 0.0 : 1.0)));
  return closed ? periodic(degree, inside, 1.0) : clamped(degree, 0.0, inside, 1.0);
}

// Control points that are known before: the ends, and with slopes their neighbours.
struct Held {
  std::vector<bool> is;
  std::vector<Vec3d> at;
};
Held held_points(const Knots& knots, std::span<const Vec3d> points, const CurveFitOptions& o) {
  const int n = knots.points(), p = knots.degree;
  Held held{std::vector<bool>(static_cast<std::size_t>(n)), std::vector<Vec3d>(static_cast<std::size_t>(n))};
  if (o.closed) return held;
  const auto hold = [&held](int i, Vec3d at) { held.is[i] = true, held.at[i] = at; };
  hold(0, points.front());
  hold(n - 1, points.back());
  if (o.slopes.start) hold(1, points.front() + ((knots.values[p + 1] - knots.start()) / p) * *o.slopes.start);
  if (o.slopes.end) hold(n - 2, points.back() - ((knots.end() - knots.values[n - 1]) / p) * *o.slopes.end);
  return held;
}

Curve least_squares(const Knots& knots, std::span<const Vec3d> points, const std::vector<double>& parameters,
                    const Held& held) {
  const int n = knots.points(), half = knots.periodic ? n - 1 : std::min(knots.degree, n - 1);
  std::vector<double> a(numerics::band_size(n, half)), b(3 * static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Basis2 basis = basis_at(knots, parameters[k], 0);
    Vec3d x = points[k];
    for (int i = 0; i <= knots.degree; ++i) {
      const int own = knots.point_of(basis.first + i);
      if (held.is[own]) x -= basis.value[0][i] * held.at[own];
    }
    for (int i = 0; i <= knots.degree; ++i) {
      const int row = knots.point_of(basis.first + i);
      if (held.is[row]) continue;
      for (int j = 0; j <= knots.degree; ++j) {
        const int column = knots.point_of(basis.first + j);
        if (column <= row && !held.is[column])
          a[numerics::band_at(half, row, column)] += basis.value[0][i] * basis.value[0][j];
      }
      for (int c = 0; c < 3; ++c) b[3 * static_cast<std::size_t>(row) + c] += basis.value[0][i] * x[c];
    }
  }
  for (int i = 0; i < n; ++i) a[numerics::band_at(half, i, i)] += held.is[i] ? 1.0 : kHold;
  if (numerics::band_factor(n, half, a.data()) >= 0)
    throw std::runtime_error("fit_curve: the points do not determine the curve");
  numerics::band_solve(n, half, a.data(), b.data(), 3);
  Curve curve{knots, {}, {}};
  for (int i = 0; i < n; ++i) {
    const double* x = &b[3 * static_cast<std::size_t>(i)];
    curve.points.push_back(held.is[i] ? held.at[i] : Vec3d{x[0], x[1], x[2]});
  }
  return curve;
}

// Residuals, and parameters moved to where the curve is nearest; ends of open curves keep theirs.
void measure(CurveFit& fit, std::span<const Vec3d> points, std::vector<double>& parameters, bool closed) {
  const ClosestOnCurve seeker(fit.curve);
  double sum = 0.0;
  fit.residuals.clear(), fit.greatest = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const CurveFoot foot = seeker.find(points[k]);
    if (closed || (k > 0 && k + 1 < points.size())) parameters[k] = foot.u;
    fit.residuals.push_back(foot.distance);
    fit.greatest = std::max(fit.greatest, foot.distance);
    sum += foot.distance * foot.distance;
  }
  fit.rms = std::sqrt(sum / double(points.size()));
}

CurveFit fit_over(const Knots& knots, std::span<const Vec3d> points, std::vector<double>& parameters,
                  const CurveFitOptions& o) {
  const Held held = held_points(knots, points, o);
  CurveFit best;
  for (int round = 0; round < std::max(1, o.rounds); ++round) {
    CurveFit fit{least_squares(knots, points, parameters, held), {}, 0.0, 0.0};
    std::vector<double> moved = parameters;
    measure(fit, points, moved, o.closed);
    const bool better = round == 0 || fit.rms < (1.0 - kNoBetterCurve) * best.rms;
    if (round > 0 && !(fit.rms < best.rms)) break;
    best = std::move(fit), parameters = std::move(moved);
    if (!better) break;
  }
  return best;
}

int fewest_control_points(const CurveFitOptions& o) {
  return o.degree + 1 + (o.closed ? 0 : (o.slopes.start ? 1 : 0) + (o.slopes.end ? 1 : 0));
}

void require_options(std::span<const Vec3d> points, const CurveFitOptions& o) {
  if (o.degree < 1 || o.degree > kHighestDegree)
    throw std::invalid_argument(tr("fit_curve: a degree from 1 to {} expected, got {}", kHighestDegree, o.degree));
  if (static_cast<int>(points.size()) < fewest_control_points(o))
    throw std::invalid_argument(
        tr("fit_curve: at least {} points expected, got {}", fewest_control_points(o), points.size()));
}

// The middles of spans with a point too far away, if there are points on both sides.
std::vector<double> knots_wanted(const CurveFit& fit, const std::vector<double>& parameters, double tolerance) {
  const std::vector<double> ends = breaks(fit.curve.knots);
  std::vector<double> wanted;
  for (std::size_t s = 0; s + 1 < ends.size(); ++s) {
    const double middle = 0.5 * (ends[s] + ends[s + 1]);
    bool far = false, before = false, after = false;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (parameters[k] < ends[s] || parameters[k] > ends[s + 1]) continue;
      far = far || fit.residuals[k] > tolerance;
      (parameters[k] < middle ? before : after) = true;
    }
    if (far && before && after) wanted.push_back(middle);
  }
  return wanted;
}

}  // namespace

CurveFit fit_curve(std::span<const Vec3d> points, int control_points, const CurveFitOptions& options) {
  require_options(points, options);
  if (control_points < fewest_control_points(options) || control_points > static_cast<int>(points.size()))
    throw std::invalid_argument(tr("fit_curve: from {} to {} control points expected, got {}",
                                   fewest_control_points(options), points.size(), control_points));
  std::vector<double> parameters = parameters_by(Spacing::chord, points, "fit_curve", options.closed);
  return fit_over(knots_among(parameters, options.degree, control_points, options.closed), points, parameters, options);
}

CurveFit fit_curve_within(std::span<const Vec3d> points, double tolerance, const CurveFitOptions& options) {
  require_options(points, options);
  if (!(tolerance > 0.0)) throw std::invalid_argument("fit_curve: a tolerance above 0 expected");
  std::vector<double> parameters = parameters_by(Spacing::chord, points, "fit_curve", options.closed);
  Knots knots = knots_among(parameters, options.degree, fewest_control_points(options), options.closed);
  for (;;) {
    CurveFit fit = fit_over(knots, points, parameters, options);
    const std::vector<double> wanted = knots_wanted(fit, parameters, tolerance);
    const auto room = points.size() - static_cast<std::size_t>(knots.points());
    if (fit.greatest <= tolerance || wanted.empty() || room == 0) return fit;
    std::vector<double> all = knots.periodic ? round_of(knots)
                                             : std::vector<double>(knots.values.begin() + knots.degree + 1,
                                                                   knots.values.end() - knots.degree - 1);
    all.insert(all.end(), wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(std::min(room, wanted.size())));
    std::sort(all.begin(), all.end());
    knots = knots.periodic ? periodic(knots.degree, all, knots.extent()) : clamped(knots.degree, 0.0, all, 1.0);
  }
}

}  // namespace trocar::geometry::nurbs
